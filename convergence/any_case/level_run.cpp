#include "convergence/any_case/level_run.h"

#include <chrono>
#include <cmath>
#include <exception>

#include "convergence/work_precision/precision_problem.h"
#include "reference/bodies/content_key.h"
#include "verification/cases/judge.h"
#include "verification/files/checkpoint_file.h"

namespace foldproof {

namespace {

LevelRun watched_level(const Level& level, const LevelSetProvider& level_sets) {
  const Scene& scene = level.input_case.scene;
  const BuiltScene built = build(scene, level_sets);
  Measurer measurer(scene, built, level.measurements);
  LevelRun run;
  long contacts = 0;  // of the latest step
  const Observer observer{[&](const State& s) {
                            measurer.record(s);
                            run.times.push_back(s.time);
                            run.x.push_back(s.x.leftCols(level.particles));
                            const Energies e = energies(built.system, s);
                            run.kinetic.push_back(e.kinetic);
                            run.elastic.push_back(e.stretch + e.bending);
                            run.contacts.push_back(double(contacts));
                          },
                          [&](const Diagnostics& row) {
                            measurer.record(row);
                            contacts = row.work.object_contacts;
                            if (row.step > 0) run.step_ends.push_back(row.time);
                          }};
  const RunResult result = simulate(built.system, integrator_named(scene.integrator), built.start,
                                    scene.schedule, observer);
  run.values = measurer.values(result);
  run.work = operator_applications(result.work);
  if (result.stop) run.stopped = describe(*result.stop);
  return run;
}

void add(const std::string& text, ContentKey& key) {
  key.add(std::uint64_t(text.size()));
  key.add(text.data(), text.size());
}

StoredResult pack(const LevelRun& run) {
  StoredResult kept;
  std::vector<double> positions;
  for (const PerParticle3& x : run.x)
    positions.insert(positions.end(), x.data(), x.data() + x.size());
  kept.arrays = {{"values", run.values},       {"times", run.times},
                 {"positions", positions},     {"kinetic", run.kinetic},
                 {"elastic", run.elastic},     {"contacts", run.contacts},
                 {"step_ends", run.step_ends}, {"cost", {run.work, run.seconds}}};
  kept.texts["stopped"] = run.stopped;
  return kept;
}

/// The array of this name; empty where it is none.
std::vector<double> array_of(const StoredResult& kept, const std::string& name) {
  const auto found = kept.arrays.find(name);
  return found == kept.arrays.end() ? std::vector<double>() : found->second;
}

LevelRun unpack(const StoredResult& kept) {
  LevelRun run;
  run.values = array_of(kept, "values");
  run.times = array_of(kept, "times");
  run.kinetic = array_of(kept, "kinetic");
  run.elastic = array_of(kept, "elastic");
  run.contacts = array_of(kept, "contacts");
  run.step_ends = array_of(kept, "step_ends");
  const std::vector<double> positions = array_of(kept, "positions"), cost = array_of(kept, "cost");
  run.work = cost.at(0);
  run.seconds = cost.at(1);
  run.stopped = kept.texts.at("stopped");
  if (run.times.empty()) return run;
  const Eigen::Index particles = Eigen::Index(positions.size() / run.times.size()) / 3;
  for (size_t k = 0; k < run.times.size(); ++k)
    run.x.push_back(Eigen::Map<const PerParticle3>(
        positions.data() + Eigen::Index(k) * 3 * particles, 3, particles));
  return run;
}

}  // namespace

LevelRun run_level(const Level& level, const LevelSetProvider& level_sets) {
  const auto start = std::chrono::steady_clock::now();
  LevelRun run;
  try {
    run = watched_level(level, level_sets);
  } catch (const std::exception& error) {
    run.stopped = error.what();
  }
  run.values.resize(level.measurements.size(), nan);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
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
        step.strain_per_step, scene.solver.tolerance, double(scene.solver.max_iterations)})
    key.add(number);
  key.add(step.ends);
  key.add(level.particles);
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

LevelRun stored_level(const Level& level, const LevelSetProvider& level_sets, ResultStore& store,
                      const std::string& program) {
  const std::string key = key_of(level, program);
  if (const auto kept = store.find(key)) return unpack(*kept);
  store.start(key, level.label);
  LevelRun run = run_level(level, level_sets);
  store.keep(key, pack(run));
  return run;
}

double field_difference(const LevelRun& a, const LevelRun& b, const PerParticle& mass) {
  if (!a.stopped.empty() || !b.stopped.empty() || a.x.size() != b.x.size()) return nan;
  Worst worst;
  for (size_t k = 0; k < a.x.size(); ++k) {
    const Eigen::VectorXd squares = (a.x[k] - b.x[k]).colwise().squaredNorm().transpose();
    worst.observe(std::sqrt(squares.dot(mass.matrix()) / mass.sum()));
  }
  return worst.value();
}

}  // namespace foldproof
