#include "verification/subjects/served/piped_subject.h"

#include <memory>
#include <vector>

#include "verification/subjects/served/scene_message.h"

namespace foldproof {

namespace {

/// Processes that serve no scene at the moment: starting one takes longer than most questions.
using Idle = std::vector<PipedSolver>;

struct PreparedPipedScene : PreparedScene {
  std::shared_ptr<Idle> idle;
  PipedSolver solver;

  PreparedPipedScene(const SolverCommand& command, std::shared_ptr<Idle> others)
      : idle(std::move(others)), solver(take(command, *idle)) {}
  ~PreparedPipedScene() override {
    if (!solver.has_failed()) idle->push_back(std::move(solver));
  }

  static PipedSolver take(const SolverCommand& command, Idle& idle) {
    if (idle.empty()) return PipedSolver(command);
    PipedSolver one = std::move(idle.back());
    idle.pop_back();
    return one;
  }
};

PipedSolver& solver_of(PreparedScene& prepared) {
  return static_cast<PreparedPipedScene&>(prepared).solver;
}

State step_over_pipe(PreparedScene& prepared, std::span<const State> past, double dt, Work& work) {
  std::vector<Snapshot> states;
  std::vector<double> times;
  for (const State& s : past.last(std::min<size_t>(past.size(), 2))) {
    if (!s.bonds.empty()) throw NotOffered{"sticking over the pipe"};
    states.push_back({s.x, s.v});
    times.push_back(s.time);
  }
  PipedSolver& solver = solver_of(prepared);
  Snapshot end = solver.step(states, times, dt);
  add(work, solver.last_work());
  return {times.back() + dt, std::move(end.x), std::move(end.v)};
}

}  // namespace

Subject piped_reference(const SolverCommand& command) {
  Subject subject;
  subject.name = "foldproof reference over the pipe";
  subject.prepare = [command, idle = std::make_shared<Idle>()](const Scene& scene) {
    const PortableScene portable = portable_scene(scene);
    auto prepared = std::make_unique<PreparedPipedScene>(command, idle);
    prepared->solver.prepare(portable);
    return prepared;
  };
  subject.elastic_forces = [](PreparedScene& prepared, const State& s) {
    return solver_of(prepared).forces({s.x, s.v}, s.time);
  };
  subject.damping_forces = [](PreparedScene& prepared, const State& s, const PerParticle3& v) {
    return solver_of(prepared).damping({s.x, v}, s.time);
  };
  subject.potential_energy = [](PreparedScene& prepared, const State& s) {
    return solver_of(prepared).energy({s.x, s.v}, s.time);
  };
  subject.step = step_over_pipe;
  return subject;
}

}  // namespace foldproof
