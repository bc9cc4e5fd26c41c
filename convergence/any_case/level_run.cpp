#include "convergence/any_case/level_run.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>

#include "convergence/work_precision/precision_problem.h"
#include "verification/files/content_key.h"
#include "verification/cases/judge.h"
#include "verification/evidence.h"
#include "verification/files/checkpoint_file.h"
#include "verification/processor_time.h"

namespace foldproof {

namespace {

constexpr double most_numbers = 1e6;  // that a trial keeps

LevelRun measured_run(const Level& level, const BuiltScene& built, const Progress& progress) {
  const Scene& scene = level.input_case.scene;
  Measurer measurer(scene, built, level.measurements);
  LevelRun run;
  long contacts = 0;  // of the latest step
  const Observer observer{[&](const State& s) {
                            measurer.record(s);
                            run.times.push_back(s.time);
                            run.x.push_back(level.common.empty()
                                                ? PerParticle3(s.x.leftCols(level.particles))
                                                : PerParticle3(s.x(Eigen::all, level.common)));
                            const Energies e = energies(built.system, s);
                            run.kinetic.push_back(e.kinetic);
                            run.elastic.push_back(e.stretch + e.bending);
                            run.contacts.push_back(double(contacts));
                          },
                          [&](const Diagnostics& row) {
                            measurer.record(row);
                            contacts = row.work.object_contacts;
                            if (row.step > 0) run.step_ends.push_back(row.time);
                            progress(row.time / scene.schedule.end);
                          }};
  const RunResult result = simulate(built.system, integrator_named(scene.integrator), built.start,
                                    scene.schedule, observer);
  run.values = measurer.values(result);
  run.work = result.work;
  run.steps = result.steps;
  if (result.stop) run.stopped = describe(*result.stop);
  return run;
}

struct OverBudget {};

/// Every so many frames of a trial one is kept.
long stride_of(const Scene& scene, int times) {
  if (times > 1) return std::numeric_limits<long>::max();
  const double frames = scene.schedule.end / scene.schedule.frame_interval + 1;
  return std::max(1L, std::lround(std::ceil(3 * frames * scene.mesh.particles() / most_numbers)));
}

double elements(const Scene& scene) {
  return double((scene.stretch ? scene.mesh.edges.size() : 0) +
                (scene.bending ? scene.mesh.hinges.size() : 0) +
                (scene.membrane ? scene.mesh.triangles.size() : 0) +
                (scene.air ? scene.mesh.triangles.size() : 0) + 1);
}

LevelRun tried_run(const Level& trial, const BuiltScene& built, const Progress& progress) {
  const Scene& scene = trial.input_case.scene;
  const PerParticle free_mass =
      (built.system.inverse_mass.array() > 0).select(built.system.mass.array(), 0.0);
  LevelRun run;
  Schedule schedule = scene.schedule;
  schedule.max_steps =
      std::min(schedule.max_steps, std::lround(std::ceil(trial.budget / elements(scene))));
  const double case_end = scene.schedule.end / trial.times;
  const long stride = stride_of(scene, trial.times);
  long frame = 0;
  double reached = 0;
  Observer observer;
  observer.frame = [&](const State& s) {
    reached = s.time;
    const double kinetic = 0.5 * s.v.colwise().squaredNorm().dot(free_mass.transpose());
    run.energy.largest = std::max(run.energy.largest, kinetic);
    if (s.time > case_end * (1 + 1e-9)) run.energy.added = std::max(run.energy.added, kinetic);
    if (frame++ % stride != 0 && s.time < schedule.end) return;
    run.times.push_back(s.time);
    run.x.push_back(s.x);
  };
  observer.checkpoint = [&](const Checkpoint& at) {
    run.work = at.work;
    run.steps = at.steps;
    const double spent = visits(scene, at.work) / trial.budget;
    progress(std::min(1.0, std::max(spent, reached / schedule.end)));
    if (spent > 1) throw OverBudget{};
  };
  try {
    const RunResult result =
        simulate(built.system, integrator_named(scene.integrator), built.start, schedule, observer);
    run.work = result.work;
    run.steps = result.steps;
    reached = result.last.time;
    if (result.stop) run.stopped = describe(*result.stop);
    if (result.stop && schedule.max_steps < scene.schedule.max_steps &&
        result.steps >= schedule.max_steps)
      throw OverBudget{};
  } catch (const OverBudget&) {
    run.over_budget = trial.budget;
    run.stopped = "its work exceeds the budget";
  }
  run.part = reached / schedule.end;
  return run;
}

LevelRun timed_trial(const Level& trial, const BuiltScene& built, const Progress& progress) {
  auto [run, seconds] = timed_run([&] { return tried_run(trial, built, progress); });
  run.seconds = seconds;
  return run;
}

void add(const std::string& text, ContentKey& key) {
  key.add(std::uint64_t(text.size()));
  key.add(text.data(), text.size());
}

/// The arrays that are stored beside a run's frames, work and end.
constexpr std::pair<const char*, std::vector<double> LevelRun::*> kept_arrays[] = {
    {"values", &LevelRun::values},
    {"kinetic", &LevelRun::kinetic},
    {"elastic", &LevelRun::elastic},
    {"contacts", &LevelRun::contacts},
    {"step_ends", &LevelRun::step_ends}};

StoredResult packed(const LevelRun& run) {
  StoredResult kept = packed_frames(run);
  for (const auto& [name, array] : kept_arrays) kept.arrays[name] = run.*array;
  for_each_counter(run.work, [&](auto count) { kept.arrays["work"].push_back(double(count)); });
  kept.arrays["end"] = {double(run.steps), run.part, run.over_budget, run.energy.largest,
                        run.energy.added};
  return kept;
}

/// The run; none where something is missing of it, or of the level's measurements and particles,
/// and where a smaller budget ended it.
std::optional<LevelRun> unpacked(const StoredResult& kept, const Level& level) {
  LevelRun run;
  const size_t particles = level.common.empty() ? size_t(level.particles) : level.common.size();
  if (!unpack_frames(kept, Eigen::Index(particles), run)) return {};
  for (const auto& [name, array] : kept_arrays) run.*array = array_of(kept, name);
  const std::vector<double> work = array_of(kept, "work"), end = array_of(kept, "end");
  size_t counters = 0;
  for_each_counter(run.work, [&](auto& count) {
    if (counters < work.size()) count = std::remove_reference_t<decltype(count)>(work[counters]);
    ++counters;
  });
  if (work.size() != counters || run.values.size() != level.measurements.size()) return {};
  if (end.size() != 5) return {};
  run.steps = long(end[0]);
  run.part = end[1];
  run.over_budget = end[2];
  run.energy = {end[3], end[4]};
  if (run.over_budget > 0 && run.over_budget < level.budget) return {};
  const size_t frames = level.budget > 0 ? 0 : run.times.size();
  for (const std::vector<double>* of_frames : {&run.kinetic, &run.elastic, &run.contacts})
    if (of_frames->size() != frames) return {};
  return run;
}

}  // namespace

double visits(const Scene& scene, const Work& w) {
  return operator_applications(w) * elements(scene) +
         double(w.strain_sweeps) * double(scene.mesh.edges.size()) + double(w.object_queries) +
         double(w.close_pairs + w.crossing_queries);
}

LevelRun run_level(const Level& level, const LevelSetProvider& level_sets,
                   const Progress& progress) {
  const double start = processor_seconds();
  LevelRun run;
  try {
    const BuiltScene built = build(level.input_case.scene, level_sets);
    if (level.budget > 0) return timed_trial(level, built, progress);
    run = measured_run(level, built, progress);
  } catch (const std::exception& error) {
    run.stopped = error.what();
  }
  run.values.resize(level.measurements.size(), nan);
  run.seconds = processor_seconds() - start;
  return run;
}

std::string key_of(const Level& level, const std::string& program) {
  const Scene& scene = level.input_case.scene;
  const RunIdentity identity = identity_of(scene, program);
  ContentKey key;
  for (const std::string& text :
       {identity.case_text, identity.meshes, identity.program, scene.integrator})
    add(text, key);
  const StepRule& step = scene.schedule.step;
  for (const double number :
       {scene.schedule.end, scene.schedule.frame_interval, step.fixed, step.safety,
        step.strain_per_step, scene.solver.tolerance, double(scene.solver.max_iterations),
        double(scene.schedule.max_steps)})
    key.add(number);
  key.add(step.ends);
  key.add(level.particles);
  key.add(level.common);
  key.add(int(level.budget > 0));
  for (const Measurement& m : level.measurements) {
    for (const std::string& text : {m.name, m.what}) add(text, key);
    key.add(m.of.particles);
    if (m.of.box) key.add(m.of.box->first.data(), 3), key.add(m.of.box->second.data(), 3);
    key.add(int(m.when));
    key.add(m.time);
    key.add(m.along.data(), 3);
  }
  return key.text();
}

LevelRun stored_level(const Level& level, const KeptRuns& by, const Progress& progress) {
  const std::string key = key_of(level, by.program);
  if (const auto kept = by.store.find(key))
    if (std::optional<LevelRun> run = unpacked(*kept, level)) return *std::move(run);
  by.store.start(key, level.label);
  LevelRun run = run_level(level, by.level_sets, progress);
  by.store.keep(key, packed(run));
  return run;
}

bool is_whole(const FramedRun& run) { return run.stopped.empty() && !run.x.empty(); }

StoredResult packed_frames(const FramedRun& run) {
  StoredResult kept;
  std::vector<double> positions;
  for (const PerParticle3& x : run.x)
    positions.insert(positions.end(), x.data(), x.data() + x.size());
  kept.arrays = {{"times", run.times}, {"positions", positions}, {"seconds", {run.seconds}}};
  kept.texts["stopped"] = run.stopped;
  return kept;
}

std::vector<double> array_of(const StoredResult& kept, const std::string& name) {
  const auto found = kept.arrays.find(name);
  return found == kept.arrays.end() ? std::vector<double>() : found->second;
}

bool unpack_frames(const StoredResult& kept, Eigen::Index particles, FramedRun& run) {
  run.times = array_of(kept, "times");
  const std::vector<double> positions = array_of(kept, "positions"),
                            seconds = array_of(kept, "seconds");
  const auto stopped = kept.texts.find("stopped");
  const size_t numbers = 3 * size_t(particles);  // of a frame
  if (seconds.size() != 1 || stopped == kept.texts.end() ||
      positions.size() != run.times.size() * numbers)
    return false;
  run.seconds = seconds[0];
  run.stopped = stopped->second;
  for (size_t k = 0; k < run.times.size(); ++k)
    run.x.push_back(Eigen::Map<const PerParticle3>(positions.data() + k * numbers, 3, particles));
  return true;
}

double longest_side(const PerParticle3& x) {
  return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
}

double rounding_floor(double size) { return 1e3 * epsilon * size; }

double mean_square_root(const PerParticle3& u, const PerParticle& mass) {
  const Eigen::VectorXd squares = u.colwise().squaredNorm().transpose();
  return std::sqrt(squares.dot(mass.matrix()) / mass.sum());
}

double largest_difference(const std::vector<PerParticle3>& a, const std::vector<PerParticle3>& b,
                          const PerParticle& mass) {
  Worst worst;
  for (size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    worst.observe(mean_square_root(a[k] - b[k], mass));
  return worst.value();
}

double frame_distance(const std::vector<PerParticle3>& a, const std::vector<PerParticle3>& b,
                      const PerParticle& mass) {
  return a.size() == b.size() && !a.empty() ? largest_difference(a, b, mass) : nan;
}

double field_difference(const FramedRun& a, const FramedRun& b, const PerParticle& mass) {
  return is_whole(a) && is_whole(b) ? frame_distance(a.x, b.x, mass) : nan;
}

double largest_motion(const std::vector<PerParticle3>& x, const PerParticle& mass) {
  Worst worst;
  for (const PerParticle3& frame : x) worst.observe(mean_square_root(frame - x.front(), mass));
  return worst.value();
}

}  // namespace foldproof
