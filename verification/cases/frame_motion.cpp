#include "verification/cases/frame_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "verification/cases/face_bound.h"
#include "verification/cases/quantities.h"
#include "verification/oracles/exact_crossings.h"

namespace foldproof {

namespace {

bool is_at_rest(const SceneObject& part, std::span<const TimedMesh> frames) {
  const PerParticle3 start = surface_at(part, 0);
  return std::ranges::all_of(
      frames, [&](const TimedMesh& frame) { return surface_at(part, frame.time) == start; });
}

/// What objects are nearest to each vertex that the case leaves free.
std::vector<Nearest> nearest_of_free_vertices(const FrameMotion& motion, const TimedMesh& frame) {
  std::vector<char> counts(std::size_t(frame.x.cols()), 1);
  if (motion.matching == Matching::particles)
    for (const PrescribedParticle& p : motion.of.scene.prescribed)
      counts[std::size_t(p.particle)] = 0;
  ObjectsOverSpan now(motion.built.objects, {frame.time, frame.time, 0});
  std::vector<Nearest> all;
  for (Eigen::Index i = 0; i < frame.x.cols(); ++i)
    if (counts[std::size_t(i)]) all.push_back(nearest_of(now.at(frame.x.col(i))));
  return all;
}

/// Corrections of a start that breaks a constraint do work.
void require_sound_start(const FrameMotion& motion) {
  const Scene& scene = motion.of.scene;
  if (depth_in(motion, {"", 0, scene.x, scene.mesh.triangles}) > usual_particle_depth(scene))
    throw NotOffered{"a closed budget: the cloth starts inside an object"};
  if (crossings_in({"", 0, scene.x, scene.mesh.triangles}) > 0)
    throw NotOffered{"a closed budget: the cloth starts crossed"};
  if (!scene.strain_limits || !scene.stretch) return;
  const Quantity& violation = *find_quantity("stays_within_strain_limits");
  if (value_at(violation, scene, {}, start_state(scene)) > scene.strain_limits->tolerance)
    throw NotOffered{"a closed budget: springs start beyond a strain limit"};
}

}  // namespace

double FrameMotion::rounding() const {
  double largest = 0;  // m
  for (const TimedMesh& frame : frames) largest = std::max(largest, frame.x.cwiseAbs().maxCoeff());
  return std::max(0.5e-5 * largest, 0.5e-6);
}

FrameMotion motion_of(const Case& of, const BuiltScene& built, std::span<const TimedMesh> frames) {
  FrameMotion motion{of, built, matching_of(of.scene.mesh, frames), frames, {}};
  if (motion.matching == Matching::surface) return motion;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const TimedMesh& before = frames[k == 0 ? 0 : k - 1];
    const TimedMesh& after = frames[std::min(k + 1, frames.size() - 1)];
    State state{frames[k].time, frames[k].x, PerParticle3::Zero(3, frames[k].x.cols())};
    if (after.time > before.time) state.v = (after.x - before.x) / (after.time - before.time);
    motion.states.push_back(std::move(state));
  }
  return motion;
}

double crossings_in(const TimedMesh& frame) {
  if (!frame.x.allFinite()) return nan;
  return double(oracles::exact_crossings(frame.x, frame.triangles).size());
}

double crossings_by_rounding(const FrameMotion& motion) {
  const PerParticle3& start = motion.of.scene.x;
  if (motion.matching == Matching::surface || motion.frames.front().x.cols() != start.cols())
    return 0;
  const double apart = (motion.frames.front().x - start).cwiseAbs().maxCoeff();
  if (!(apart <= motion.rounding())) return 0;
  const double at_start = crossings_in({"", 0, start, motion.of.scene.mesh.triangles});
  return std::max(0.0, crossings_in(motion.frames.front()) - at_start);
}

double depth_in(const FrameMotion& motion, const TimedMesh& frame) {
  if (!frame.x.allFinite()) return nan;
  Worst worst;
  for (const Nearest& nearest : nearest_of_free_vertices(motion, frame))
    if (!nearest.held_between()) worst.observe(-nearest.first.phi);
  return worst.value();
}

double clearance_in(const FrameMotion& motion, const TimedMesh& frame) {
  if (!frame.x.allFinite()) return nan;
  double smallest = std::numeric_limits<double>::infinity();
  for (const Nearest& nearest : nearest_of_free_vertices(motion, frame))
    smallest = std::min(smallest, nearest.first.phi);
  return smallest;
}

void require_particles(const FrameMotion& motion) {
  if (motion.matching != Matching::particles)
    throw NotOffered{"the case's mesh: vertex i must be particle i, with the same triangles"};
}

void require_start(const FrameMotion& motion) {
  if (motion.frames.front().time > motion.rounding()) throw NotOffered{"a frame at t = 0"};
}

void require_closed_budget(const FrameMotion& motion) {
  require_particles(motion);
  const Scene& scene = motion.of.scene;
  if (is_driven(scene)) throw NotOffered{"a closed budget: prescribed particles do work"};
  for (const SceneObject& part : scene.objects)
    if (!is_at_rest(part, motion.frames))
      throw NotOffered{"a closed budget: an object moves, and does work"};
  if (!scene.sticky.empty()) throw NotOffered{"the energy of bonds, which frames do not show"};
  if (scene.bending && scene.bending->weighting != Weighting::rest)
    throw NotOffered{"an energy: the case's bending has none"};
  require_sound_start(motion);
}

double exchanged(const Energies& now, const Energies& start) {
  double largest = 0;
  for (const auto term : energy_terms)
    largest = std::max(largest, std::abs(now.*term - start.*term));
  return largest;
}

}  // namespace foldproof
