#include "convergence/any_case/level_run.h"

#include <cmath>
#include <exception>
#include <optional>

#include "convergence/any_case/distances.h"
#include "convergence/work_precision/precision_problem.h"
#include "reference/bodies/content_key.h"
#include "verification/cases/judge.h"
#include "verification/files/checkpoint_file.h"
#include "verification/processor_time.h"

namespace foldproof {

namespace {

LevelRun watched_level(const Level& level, const LevelSetProvider& level_sets,
                       const Progress& progress) {
  const Scene& scene = level.input_case.scene;
  const BuiltScene built = build(scene, level_sets);
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
  run.work = operator_applications(result.work);
  if (result.stop) run.stopped = describe(*result.stop);
  return run;
}

void add(const std::string& text, ContentKey& key) {
  key.add(std::uint64_t(text.size()));
  key.add(text.data(), text.size());
}

StoredResult packed(const LevelRun& run) {
  StoredResult kept = packed_frames(run);
  kept.arrays.insert({{"values", run.values},
                      {"kinetic", run.kinetic},
                      {"elastic", run.elastic},
                      {"contacts", run.contacts},
                      {"step_ends", run.step_ends},
                      {"work", {run.work}}});
  return kept;
}

/// The run; none where something is missing of it, or of the level's measurements and particles.
std::optional<LevelRun> unpacked(const StoredResult& kept, const Level& level) {
  LevelRun run;
  const size_t particles = level.common.empty() ? size_t(level.particles) : level.common.size();
  if (!unpack_frames(kept, Eigen::Index(particles), run)) return {};
  run.values = array_of(kept, "values");
  run.kinetic = array_of(kept, "kinetic");
  run.elastic = array_of(kept, "elastic");
  run.contacts = array_of(kept, "contacts");
  run.step_ends = array_of(kept, "step_ends");
  const std::vector<double> work = array_of(kept, "work");
  if (work.size() != 1 || run.values.size() != level.measurements.size()) return {};
  for (const std::vector<double>* of_frames : {&run.kinetic, &run.elastic, &run.contacts})
    if (of_frames->size() != run.times.size()) return {};
  run.work = work[0];
  return run;
}

}  // namespace

LevelRun run_level(const Level& level, const LevelSetProvider& level_sets,
                   const Progress& progress) {
  const double start = processor_seconds();
  LevelRun run;
  try {
    run = watched_level(level, level_sets, progress);
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
                      const std::string& program, const Progress& progress) {
  const RunKeeper<LevelRun> keeper{[&] { return run_level(level, level_sets, progress); }, packed,
                                   [&](const StoredResult& kept) { return unpacked(kept, level); }};
  return stored_or_made(store, key_of(level, program), level.label, keeper);
}

double field_difference(const LevelRun& a, const LevelRun& b, const PerParticle& mass) {
  if (!a.stopped.empty() || !b.stopped.empty() || a.x.size() != b.x.size()) return nan;
  return largest_difference(a.x, b.x, mass);
}

}  // namespace foldproof
