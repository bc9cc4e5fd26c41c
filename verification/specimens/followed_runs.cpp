#include "verification/specimens/followed_runs.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "verification/specimens/layered_cloth.h"
#include "verification/specimens/moving_sheets.h"
#include "verification/specimens/sticking_scenes.h"

namespace foldproof {

namespace {

Observer follower(Followed& run) {
  return {[&run](const State& s) { run.frames.push_back(s); },
          [&run](const Diagnostics& row) { run.rows.push_back(row); },
          [&run](const Checkpoint& checkpoint) {
            run.checkpoints.push_back(checkpoint);
            run.rows_at.push_back(run.rows.size());
          }};
}

void add(const State& s, Numbers& all) {
  all.push_back(s.time);
  all.insert(all.end(), s.x.data(), s.x.data() + s.x.size());
  all.insert(all.end(), s.v.data(), s.v.data() + s.v.size());
  for (const Bond& b : s.bonds)
    all.insert(all.end(), {double(b.patch), double(b.triangle), double(b.particle), b.place[0],
                           b.place[1], b.place[2]});
}

/// All of a row except clock time.
void add(const Diagnostics& row, Numbers& all) {
  for_each_value(row, [&](auto number) { all.push_back(double(number)); });
}

void add(const Work& w, Numbers& all) {
  for_each_counter(w, [&](auto number) { all.push_back(double(number)); });
}

void add(const RunResult& result, Numbers& all) {
  add(result.last, all);
  add(result.work, all);
  all.push_back(double(result.steps));
  if (result.stop)
    all.insert(all.end(),
               {result.stop->time, double(result.stop->step), double(result.stop->particle)});
}

/// All of a checkpoint except clock time.
void add(const Checkpoint& checkpoint, Numbers& all) {
  for (const State& s : checkpoint.past) add(s, all);
  add(checkpoint.work, all);
  all.insert(all.end(), {double(checkpoint.frame), double(checkpoint.steps), checkpoint.start_time,
                         checkpoint.size, checkpoint.event_time, checkpoint.damping_work,
                         checkpoint.damping_power});
}

}  // namespace

Followed followed_run(const System& system, const Integrator& integrator, const State& start,
                      const Schedule& schedule) {
  Followed run;
  run.result = simulate(system, integrator, start, schedule, follower(run));
  return run;
}

Followed followed_rest(const System& system, const Integrator& integrator,
                       const Checkpoint& checkpoint, const Schedule& schedule) {
  Followed run;
  run.result = resume(system, integrator, checkpoint, schedule, follower(run));
  return run;
}

Followed followed_run(const NamedRun& of, const System& system, const Integrator& integrator) {
  return followed_run(system, integrator, start_state(of.scene), of.scene.schedule);
}

Numbers numbers_of(const NamedRun& of, const Followed& run) {
  if (run.result.stop.has_value() != of.stops || run.frames.empty()) return {};
  return numbers_after(run, 0, 0, 0);
}

Numbers numbers_after(const Followed& run, std::size_t frames, std::size_t rows,
                      std::size_t checkpoints) {
  Numbers all;
  for (std::size_t k = frames; k < run.frames.size(); ++k) add(run.frames[k], all);
  for (std::size_t k = rows; k < run.rows.size(); ++k) add(run.rows[k], all);
  for (std::size_t k = checkpoints; k < run.checkpoints.size(); ++k) add(run.checkpoints[k], all);
  add(run.result, all);
  return all;
}

double bits_that_differ(const Numbers& a, const Numbers& b) {
  if (a.size() != b.size()) return NAN;
  double count = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    count += std::bit_cast<std::uint64_t>(a[k]) != std::bit_cast<std::uint64_t>(b[k]);
  return count;
}

namespace {

/// Damped springs and hinges in automatic steps. Some particles are prescribed and start and stop
/// during the run, one of them a rounding after a frame.
Scene stopping_and_starting() {
  Scene scene = partly_prescribed_sheet();
  scene.schedule = {0.057, 0.0081, {0.0017, 0.5, 0.1}, 100000};
  const double at_frame = 2 * 0.0081;
  scene.prescribed.at(1).motion.from = std::nextafter(at_frame, 1.0);
  scene.prescribed.at(1).motion.until = 0.0431;
  scene.prescribed.at(2).motion.until = 0.0297;
  return scene;
}

/// Cloth that sticks to a palm, present for part of the run, and to itself.
Scene stuck_for_a_while() {
  Scene scene = free_sheet();
  StickyPatch hand = swinging_palm(scene);
  hand.from = 0.013;
  hand.until = 0.061;
  hand.release = 0.02;
  scene.sticky = {hand};
  scene.schedule = {0.075, 0.0091, {0, 0.4, 0.05}, 100000};
  return scene;
}

Scene layers_that_meet() {
  LayeredSheets layers;
  layers.settings = {0.004, 3.0, 0.3, 8, true};
  Scene scene = layered_scene(layers);
  scene.stretch = StretchMaterial{20, 0.01, 1};
  scene.strain_limits = StrainLimits{};
  scene.schedule = {0.03, 0.0043, {0.0011, 0.5, 0.1}, 100000};
  return scene;
}

/// Cloth that diverges because its steps are too long.
Scene flying_apart() {
  Scene scene = undamped_sheet();
  const double h = 1.6 * elastic_limit(build_system(scene), start_state(scene));
  scene.schedule = {400 * h, h, {h, 0.5, 0.1}, 100000};
  return scene;
}

}  // namespace

std::vector<NamedRun> runs_of_all_parts() {
  std::vector<NamedRun> runs;
  for (const Integrator& integrator : integrators())
    if (integrator.family != Family::fully_explicit || integrator.name == "RK4")
      runs.push_back({"led", std::string(integrator.name), stopping_and_starting()});
  for (const char* integrator : {"C", "BDF2"}) {
    runs.push_back({"sticking", integrator, stuck_for_a_while()});
    runs.push_back({"layers", integrator, layers_that_meet()});
  }
  runs.push_back({"divergence", "C", flying_apart(), true});
  return runs;
}

}  // namespace foldproof
