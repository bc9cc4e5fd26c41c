#include "convergence/any_case/solver_ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "reference/dynamics/system.h"

namespace foldproof {

namespace {

/// A frame may be off by so much of the end [1].
constexpr double same_frame = 1e-9;

[[noreturn]] void refuse(const std::string& part) {
  throw InputError("the protocol of other solvers cannot say " + part);
}

void require_portable(const Scene& scene) {
  if (is_driven(scene)) refuse("held particles that move");
  if (scene.strain_limits) refuse("strain limits; remove [strain_limits]");
  if (!scene.sticky.empty()) refuse("what cloth sticks to");
  if (scene.air) refuse("air; remove [air]");
  if (scene.membrane) refuse("a membrane; remove [membrane], or give [stretch] in its place");
  if (!scene.fabrics.empty()) refuse("several fabrics; remove [[fabric]]");
  if (!scene.mesh.pattern.empty()) refuse("a flat pattern; remove pattern");
}

/// Throws InputError unless it is rigid and stands still.
const RigidObject& still_body(const Object& object) {
  const auto* rigid = std::get_if<RigidObject>(&object.body);
  const auto* motion = rigid ? std::get_if<Motion>(&rigid->motion) : nullptr;
  if (!motion || motion->velocity.norm() > 0 || motion->amplitude.norm() > 0 ||
      motion->angular_velocity.norm() > 0)
    refuse("object '" + object.name + "', which moves or deforms");
  return *rigid;
}

void add_object(const Object& object, PortableScene& portable) {
  const RigidObject& body = still_body(object);
  const Pose& place = body.place;
  if (std::holds_alternative<HalfSpace>(body.solid)) {
    portable.planes.push_back(
        {place.translation, place.rotation * Vector3::UnitZ(), object.friction});
    return;
  }
  if (const auto* sphere = std::get_if<Sphere>(&body.solid)) {
    portable.spheres.push_back({place.translation, sphere->radius, object.friction});
    return;
  }
  if (const auto* capsule = std::get_if<Capsule>(&body.solid)) {
    const Vector3 half = capsule->half_length * (place.rotation * Vector3::UnitZ());
    portable.capsules.push_back(
        {place.translation - half, place.translation + half, capsule->radius, object.friction});
    return;
  }
  const auto* box = std::get_if<Box>(&body.solid);
  if (!box) refuse("object '" + object.name + "', which is no plane, box, sphere or capsule");
  if (!place.rotation.isApprox(Eigen::Quaterniond::Identity()))
    refuse("object '" + object.name + "', a box whose edges are not along the axes");
  portable.boxes.push_back({place.translation, box->half_extents, object.friction});
}

PortableMaterial material_of(const Scene& scene) {
  PortableMaterial material{scene.density, 0, 0, 0, 0, 1};
  if (scene.stretch) {
    material.young = scene.stretch->stiffness;
    material.stretch_damping = scene.stretch->damping;
    material.rest_length_scale = scene.stretch->rest_length_scale;
  }
  if (scene.bending) {
    material.bending_rigidity = scene.bending->stiffness / 4;
    material.bending_damping = scene.bending->damping;
  }
  return material;
}

/// The scene as physical constants: Young's modulus, bending rigidity B = ke/4, dampings, held
/// particles, fixed planes, boxes, spheres and capsules, thickness. `dt` is left to the caller.
/// The reference's own method (bending law, weighting, time integrator) stays out. Throws
/// InputError naming a part that the protocol cannot say: particles or objects that move, objects
/// of other shapes, strain limits, sticking, and what the paper does not have.
PortableScene portable_case(const Scene& scene) {
  require_portable(scene);
  PortableScene portable;
  portable.name = scene.name;
  portable.mesh = scene.mesh;
  portable.x = scene.x, portable.v = scene.v;
  portable.mass = masses_of(scene);
  for (const PrescribedParticle& p : scene.prescribed) portable.held.push_back(p.particle);
  if (scene.gravity) portable.gravity = *scene.gravity;
  portable.material = material_of(scene);
  portable.rest_angles = scene.rest_angles;
  for (const SceneObject& part : scene.objects) add_object(part.object, portable);
  if (scene.self_collision) portable.thickness = scene.self_collision->thickness;
  return portable;
}

/// Throws InputError unless the solver declares every capability that the scene needs.
void require_offered(const PortableScene& scene, Trial& solver) {
  try {
    if (!scene.held.empty()) solver.require("held");
    if (!scene.planes.empty()) solver.require("planes");
    if (!scene.boxes.empty()) solver.require("boxes");
    if (!scene.spheres.empty()) solver.require("spheres");
    if (!scene.capsules.empty()) solver.require("capsules");
    if (scene.material.stretch_damping > 0) solver.require("damping");
    if (scene.thickness > 0) solver.require("self_collision");
  } catch (const NotOffered& missing) {
    throw InputError("the solver does not offer " + missing.operation + ", which the case needs");
  } catch (const SolverFailure& failure) {
    throw InputError(failure.in_one_line());
  }
}

}  // namespace

std::vector<Measurement> shown_by_states(const std::vector<Measurement>& measurements) {
  std::vector<Measurement> shown;
  for (const Measurement& m : measurements) {
    const bool is_of_states = std::ranges::any_of(
        measurable(), [&](const Measurable& row) { return m.what == row.what; });
    if (is_of_states && m.what != "contact_points") shown.push_back(m);
  }
  return shown;
}

SolverSteps solver_steps(const Scene& scene, const BuiltScene& built) {
  const Schedule& schedule = scene.schedule;
  SolverSteps steps;
  steps.interval = std::min(schedule.frame_interval, schedule.end);
  steps.frames = std::lround(schedule.end / steps.interval);
  if (std::abs(double(steps.frames) * steps.interval - schedule.end) > same_frame * schedule.end)
    throw InputError(
        fmt::format("another solver takes equal steps from frame to frame, and the end, {:g} s, is "
                    "not a whole number of frames; try --until {:g}",
                    schedule.end, std::floor(schedule.end / steps.interval) * steps.interval));
  const double longest = schedule.step.fixed > 0
                             ? schedule.step.fixed
                             : schedule.step.safety * elastic_limit(built.system, built.start);
  steps.a_frame = std::max(1L, std::lround(std::ceil(steps.interval / longest - same_frame)));
  return steps;
}

SolverLadder::SolverLadder(LadderPlan plan, Trial& solver, const LevelSetProvider& level_sets)
    : plan_(std::move(plan)),
      solver_(solver),
      built_(build(plan_.input_case.scene, level_sets)),
      portable_(portable_case(plan_.input_case.scene)),
      steps_(solver_steps(plan_.input_case.scene, built_)) {
  plan_.measurements = shown_by_states(plan_.measurements);
  require_offered(portable_, solver_);
}

LevelRun SolverLadder::run(int k) { return run_with(steps_.a_frame << k); }

LevelRun SolverLadder::run_with(long a_frame) {
  portable_.dt = steps_.interval / double(a_frame);
  std::vector<long> at;
  for (long frame = 1; frame <= steps_.frames; ++frame) at.push_back(frame * a_frame);
  LevelRun run;
  try {
    run = measured(a_frame, solver_.motion(portable_, at));
  } catch (const SolverFailure& failure) {
    solver_.note(failure);
    run.stopped = failure.in_one_line();
  } catch (const NotOffered& declined) {
    run.stopped = "the solver declines: " + declined.operation;
  }
  run.values.resize(plan_.measurements.size(), nan);
  run.seconds = solver_.processor_seconds_of_motion();
  run.clock = solver_.seconds_of_motion();
  run.steps = steps_.frames * a_frame;
  return run;
}

LevelRun SolverLadder::measured(long a_frame, const std::vector<Snapshot>& frames) const {
  const Scene& scene = plan_.input_case.scene;
  Measurer measurer(scene, built_, plan_.measurements);
  LevelRun run;
  RunResult result;
  result.last = built_.start;
  const auto record = [&](const State& frame) {
    measurer.record(frame);
    run.times.push_back(frame.time);
    run.x.push_back(frame.x);
  };
  record(built_.start);
  for (size_t f = 0; f < frames.size(); ++f) {
    State& state = result.last;
    state.time = double(f + 1) * steps_.interval;
    state.x = frames[f].x, state.v = frames[f].v;
    record(state);
  }
  for (long n = 1; n <= steps_.frames * a_frame; ++n)
    run.step_ends.push_back(double(n) * portable_.dt);
  run.values = measurer.values(result);
  return run;
}

LadderAnswer SolverLadder::answer(const std::vector<LevelRun>& runs) {
  const Declaration& declared = solver_.declaration();
  LadderAnswer answer = time_answer(plan_, runs, std::max(1, declared.order));
  answer.method = declared.name + (declared.version.empty() ? "" : " " + declared.version);
  answer.work_name = "steps";
  answer.work.clear();
  for (const LevelRun& run : runs) {
    answer.work.push_back(double(run.steps));
    answer.clock.push_back(run.clock);
  }
  if (declared.order < 1)
    answer.warnings.emplace_back(
        "the solver claims no order; its steps are read as of first order");
  return answer;
}

SolverGap solver_gap(const LevelRun& solver, const LadderAnswer& solver_answer,
                     const LevelRun& reference, const LadderAnswer& reference_answer,
                     const PerParticle& mass) {
  const ErrorBar &ours = reference_answer.quantities.front().bar,
                 &theirs = solver_answer.quantities.front().bar;
  return {field_difference(solver, reference, mass), theirs.half_width, ours.half_width,
          ours.reading != Reading::inconclusive && theirs.reading != Reading::inconclusive};
}

std::string in_words(const SolverGap& gap, const std::string& solver) {
  const std::string apart = fmt::format(
      "the finest runs of {} and of the reference are {:.2g} m apart; the error bars of their "
      "steps are {:.2g} m and {:.2g} m: ",
      solver, gap.distance, gap.solver_bar, gap.reference_bar);
  if (!gap.are_estimates || !std::isfinite(gap.distance))
    return apart + "without an order of both, nothing can be said";
  return apart + (gap.is_beyond_steps()
                      ? "the time step does not explain the difference, so the models differ"
                      : "steps may explain it");
}

}  // namespace foldproof
