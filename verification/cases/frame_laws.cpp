#include "verification/cases/frame_laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "verification/cases/face_bound.h"
#include "verification/cases/frame_dynamics.h"

namespace foldproof {

namespace {

constexpr double degrees_per_radian = 180 / pi;

// ---- is it the case's cloth, all of its motion?

Finding start_is_the_case_s(const FrameMotion& motion) {
  require_particles(motion);
  const State& first = motion.states.front();
  const Scene& scene = motion.of.scene;
  require_start(motion);
  const double edge = rest_lengths(scene.mesh).mean();
  Table measured{{"particle", "1"}, {"distance from the case's start", "of the mean edge"}};
  for (Eigen::Index i = 0; i < first.x.cols(); ++i)
    measured.row(i, (first.x.col(i) - scene.x.col(i)).norm() / edge);
  return judge_worst(measured, 0.01,
                     "a hundredth of an edge: units, axes, order of vertices and time are right");
}

Finding end_is_reached(const FrameMotion& motion) {
  const Schedule& schedule = motion.of.scene.schedule;
  const double last = motion.frames.back().time;
  Table measured("last frame [s]; end of the case [s]; missing [frames]");
  measured.row(last, schedule.end, std::max(0.0, schedule.end - last) / schedule.frame_interval);
  return judge_worst(measured, 1, "the last frame is at most one frame before the end");
}

Finding prescribed_particles_follow(const FrameMotion& motion) {
  require_particles(motion);
  const std::vector<PrescribedParticle>& prescribed = motion.of.scene.prescribed;
  if (prescribed.empty()) throw NotOffered{"prescribed particles: the case has no [[hold]]"};
  Table measured{{"time", "s"}, {"largest distance from the prescribed place", "m"}};
  for (const State& frame : motion.states) {
    Worst worst;
    for (const PrescribedParticle& p : prescribed)
      worst.observe((frame.x.col(p.particle) - position_at(p.motion, p.start, frame.time)).norm());
    measured.row(frame.time, worst.value());
  }
  return judge_worst(measured, 2 * motion.rounding(),
                     "the case says where they are; a file of six digits rounds each coordinate");
}

// ---- geometry

Finding never_cross_themselves(const FrameMotion& motion) {
  const double at_start = crossings_in({"", 0, motion.of.scene.x, motion.of.scene.mesh.triangles});
  Table measured{{"time", "s"}, {"crossings", "pairs"}};
  for (const TimedMesh& frame : motion.frames) measured.row(frame.time, crossings_in(frame));
  return judge_worst(measured, at_start + crossings_by_rounding(motion),
                     "cloth cannot pass through itself: no more than at the case's start, or than "
                     "it has there by rounding of the file");
}

Finding vertices_stay_outside(const FrameMotion& motion) {
  if (motion.built.objects.empty()) throw NotOffered{"objects: the case has no [[object]]"};
  const Expectation* bound = find_expectation("stays_outside", motion.of.expectations);
  if (!bound && find_expectation("lies_inside", motion.of.expectations))
    throw NotOffered{"a bound: the case expects that particles lie inside"};
  Table measured{{"time", "s"}, {"depth of the deepest vertex", "m"}};
  for (const TimedMesh& frame : motion.frames) measured.row(frame.time, depth_in(motion, frame));
  const double depth = bound ? bound->bound : usual_particle_depth(motion.of.scene);
  const double rounding = 2 * motion.rounding();
  return judge_worst(measured, depth + rounding,
                     bound ? "of the case: " + bound->why
                           : "empirical: a tenth of the radius of the largest triangle's circle, "
                             "the depth that the bound on whole triangles takes for granted");
}

Finding touches_objects(const FrameMotion& motion) {
  constexpr std::array expect_contact = {"makes_contact", "is_pinched", "lies_inside",
                                         "stays_between"};
  if (motion.built.objects.empty()) throw NotOffered{"objects: the case has no [[object]]"};
  if (std::ranges::none_of(expect_contact, [&](const char* key) {
        return find_expectation(key, motion.of.expectations);
      }))
    throw NotOffered{"contact: the case does not expect any, such as [expect.makes_contact]"};
  Table measured{{"time", "s"}, {"distance of the nearest vertex from an object", "m"}};
  double nearest = std::numeric_limits<double>::infinity();
  for (const TimedMesh& frame : motion.frames) {
    const double clearance = clearance_in(motion, frame);
    if (std::isnan(clearance)) throw InputError(frame.file + ": a position is not finite");
    measured.row(frame.time, clearance);
    nearest = std::min(nearest, clearance);
  }
  const Verdict verdict{nearest, largest_enclosing_radius(motion.of.scene), 0, "m",
                        "the case expects contact: in some frame a vertex is as near to an object "
                        "as the radius of the largest triangle's circle"};
  return {verdict, std::move(measured), ""};
}

Finding springs_stay_within_limits(const FrameMotion& motion) {
  require_particles(motion);
  const Scene& scene = motion.of.scene;
  if (!scene.strain_limits || !scene.stretch)
    throw NotOffered{"a limit: the case has no [strain_limits]; --set states one"};
  const Quantity& violation = *find_quantity("stays_within_strain_limits");
  Table measured{{"time", "s"}, {"strain beyond a limit", "1"}};
  for (const State& frame : motion.states)
    measured.row(frame.time, value_at(violation, scene, {}, frame));
  const Expectation* bound = find_expectation(violation.key, motion.of.expectations);
  const double rounding = 2 * motion.rounding() / rest_lengths(scene.mesh).minCoeff();
  return judge_worst(measured, (bound ? bound->bound : scene.strain_limits->tolerance) + rounding,
                     bound ? "of the case: " + bound->why
                           : "the case's own limits and their tolerance; a file of six digits "
                             "rounds an edge's length");
}

/// The mesh of the frames, if all have the same triangles and these form a surface.
std::optional<TriangleMesh> surface_of(const FrameMotion& motion) {
  if (motion.matching == Matching::particles) return motion.of.scene.mesh;
  const TimedMesh& first = motion.frames.front();
  for (const TimedMesh& frame : motion.frames)
    if (frame.triangles != first.triangles || frame.x.cols() != first.x.cols()) return {};
  try {
    return make_triangle_mesh(first.x, first.triangles);
  } catch (const InputError&) {  // holes, fans or flaps
    return {};
  }
}

/// By how much hinges turn between two frames [degrees].
struct Turns {
  double largest = 0;       // without those that surely did not pass 180, but turned by more
  double fastest_seen = 0;  // of those that did not pass it: how fast this cloth turns anyway
};

/// The hinge's angle changes by more than 180 degrees from frame k to k + 1. Does that go on as it
/// turned before and turns afterwards, rather than the other way, through 180 degrees?
bool turns_on(const std::vector<std::vector<double>>& angles, std::size_t k, std::size_t hinge) {
  const auto change = [&](std::size_t at) { return angles[at + 1][hinge] - angles[at][hinge]; };
  if (k == 0 || k + 2 >= angles.size()) return false;
  const double open = change(k), through = open - std::copysign(2 * pi, open);
  const double trend = (change(k - 1) + change(k + 1)) / 2;
  return std::abs(open - trend) < std::abs(through - trend);
}

Turns turns_after(const std::vector<std::vector<double>>& angles, std::size_t k) {
  Worst largest, seen;
  for (std::size_t h = 0; h < angles[k].size(); ++h) {
    const double turn = std::abs(angles[k + 1][h] - angles[k][h]) * degrees_per_radian;
    const bool is_short = turn <= 180, is_seen = is_short || turns_on(angles, k, h);
    if (is_short || !is_seen) largest.observe(turn);
    if (is_seen) seen.observe(turn);
  }
  return {largest.value(), seen.value()};
}

/// Neighbouring triangles share an edge, so that the judge of crossings sees nothing when one goes
/// through the other: their angle then jumps from 180 to -180 degrees, or back. So it seems, too,
/// where a fold turns over the long way between two frames: it counts as that where it turned so
/// before and turns so afterwards, else it is inconclusive if others turn as fast.
Finding folds_never_pass_through(const FrameMotion& motion) {
  if (motion.frames.size() < 2) throw NotOffered{"a second frame"};
  const auto mesh = surface_of(motion);
  if (!mesh) throw NotOffered{"one oriented surface for all frames"};
  Table measured(
      "time [s]; fastest turn of other hinges [degrees]; largest change of a hinge's angle "
      "[degrees]");
  Turns worst;
  std::vector<std::vector<double>> angles;
  for (const TimedMesh& frame : motion.frames) angles.push_back(hinge_angles(*mesh, frame.x));
  for (std::size_t k = 0; k + 1 < angles.size(); ++k) {
    const Turns turns = turns_after(angles, k);
    measured.row(motion.frames[k + 1].time, turns.fastest_seen, turns.largest);
    if (turns.largest > 180 &&
        turns.largest - turns.fastest_seen > worst.largest - worst.fastest_seen)
      worst = turns;
  }
  Finding finding = judge_worst(measured, 180,
                                "an angle in [-180, 180] that changes by more has passed 180, or "
                                "was the other way open by a fast turn: uncertain by the fastest "
                                "turn of other hinges between the same frames (empirical)");
  if (worst.largest > 180) {
    finding.verdict.measured = worst.largest;
    finding.verdict.uncertainty = worst.fastest_seen;
    if (worst.largest - worst.fastest_seen <= 180)
      finding.note = "more frames a second decide: other hinges turn nearly as fast";
  }
  return finding;
}

// ---- energy

/// By which rounding of the file may change the potential energy [J]: each particle moves by up to
/// e = sqrt(3) rounding, so with the forces f and the rows of the stiffness matrix K there by up to
/// e sum |f_i| + e^2/2 sum_ij |K_ij|.
double energy_rounding(const FrameMotion& motion, const State& s) {
  const std::vector<Force>& forces = motion.built.system.forces;
  const double e = std::sqrt(3.0) * motion.rounding();
  Work work;
  return e * elastic_forces(forces, s, work).colwise().norm().sum() +
         e * e / 2 * stiffness_row_bounds(forces, s, StickingPart::all).sum();
}

Finding energy_stays_in_budget(const FrameMotion& motion) {
  require_closed_budget(motion);
  constexpr double share = 0.01;
  const Energies start = energies(motion.built.system, start_state(motion.of.scene));
  Table measured(
      "time [s]; potential less the start's total [J]; allowed excess [J]; measured over allowed "
      "[1]");
  double largest = 0;
  for (const State& frame : motion.states) {
    const State still{frame.time, frame.x, PerParticle3::Zero(3, frame.x.cols())};
    const Energies now = energies(motion.built.system, still);
    largest = std::max(largest, exchanged(now, start));
    const double excess = now.total() - start.total();
    const double allowed = share * largest + energy_rounding(motion, still);
    measured.row(frame.time, excess, allowed, excess <= 0 ? 0 : excess / allowed);
  }
  return judge_worst(measured, 1,
                     "nothing does work on the cloth, so elastic and potential energy never exceed "
                     "the start's total; 1 % of the largest exchange (empirical: the balance of "
                     "cases without contact) and rounding of the file are allowed");
}

}  // namespace

const std::vector<FrameLaw>& frame_laws() {
  static const std::vector<FrameLaw> laws = {
      {"frames.start-is-that-of-the-case", "The first frame is the start of the case.",
       "cases/KEYS.md", start_is_the_case_s},
      {"frames.end-is-reached", "The frames go on to the end of the case.", "cases/KEYS.md",
       end_is_reached},
      {"frames.prescribed-particles-follow", "Prescribed particles are where the case says.",
       "cases/KEYS.md", prescribed_particles_follow},
      {"frames.never-cross-themselves", "In no frame does the cloth pass through itself.",
       "exact arithmetic", never_cross_themselves},
      {"frames.vertices-stay-outside", "In no frame is a vertex deep inside an object.",
       "the objects' signed distance", vertices_stay_outside},
      {"frames.touches-objects", "In some frame the cloth is at an object that it should touch.",
       "[expect] of the case", touches_objects},
      {"frames.springs-stay-within-limits", "No edge is longer or shorter than the case allows.",
       "BMF03 section 4", springs_stay_within_limits},
      {"frames.folds-never-pass-through",
       "No two neighbouring triangles pass through each other about their common edge.",
       "continuity of the angle", folds_never_pass_through},
      {"frames.energy-stays-in-budget",
       "Elastic and potential energy never exceed the energy of the start.",
       "conservation of energy", energy_stays_in_budget},
      {"frames.motion-stays-in-budget",
       "Kinetic and potential energy never exceed the energy of the start.",
       "conservation of energy", motion_stays_in_budget},
      {"frames.centre-falls-freely",
       "Before the cloth is near an object, its centre of mass falls with g.",
       "conservation of momentum", centre_falls_freely},
      {"frames.starts-as-fast-as-the-reference",
       "Where the centre does not fall freely, it first moves as that of the reference.",
       "a run of the reference", starts_as_the_reference},
  };
  return laws;
}

}  // namespace foldproof
