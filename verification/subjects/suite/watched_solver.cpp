#include "verification/subjects/suite/watched_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "verification/evidence.h"

namespace foldproof {

namespace {

double size_of(const PortableScene& scene) {
  return (scene.x.rowwise().maxCoeff() - scene.x.rowwise().minCoeff()).norm();
}

Eigen::VectorXd lengths_of(const PortableScene& scene, const PerParticle3& x) {
  Eigen::VectorXd lengths(Eigen::Index(scene.mesh.edges.size()));
  for (Eigen::Index e = 0; e < lengths.size(); ++e) {
    const Edge& edge = scene.mesh.edges[size_t(e)];
    lengths[e] = (x.col(edge.b) - x.col(edge.a)).norm();
  }
  return lengths;
}

bool is_strained(const PortableScene& scene) {
  constexpr double least = 1e-3;
  const Eigen::VectorXd rest = scene.material.rest_length_scale * rest_lengths(scene.mesh);
  return ((lengths_of(scene, scene.x) - rest).array().abs() > least * rest.array()).any();
}

bool has_obstacles(const PortableScene& scene) {
  return !(scene.planes.empty() && scene.boxes.empty() && scene.spheres.empty() &&
           scene.capsules.empty() && scene.bodies.empty());
}

Vector3 mean_of(const PortableScene& scene, const PerParticle3& v) {
  return v * scene.mass / scene.mass.sum();
}

/// Whether the mean velocity is another than free flight's by a hundredth. Inner forces do not
/// change it, and every scheme has it to rounding.
bool was_deflected(const PortableScene& scene, const Snapshot& start, const Snapshot& now,
                   double time) {
  const Vector3 before = mean_of(scene, start.v), gained = time * scene.gravity;
  return (mean_of(scene, now.v) - before - gained).norm() > 0.01 * (before.norm() + gained.norm());
}

}  // namespace

std::string Observed::nothing_happened(bool touches, double rounding) const {
  const double least = 1e-6 + 64 * rounding;
  const char* const begin = "nothing happened: ";
  constexpr double begun = 0.01;  // however short the motion is
  if (sent_motion && !(moved > least || sped > begun))
    return fmt::format("{}no particle of its scenes moved by more than {:.1g} of their size", begin,
                       moved);
  if (sent_motion && sent_strain && !(deformed > least))
    return fmt::format("{}no edge changed its length, though edges were strained at the start",
                       begin);
  if (asked_inner_force && !(inner_force > least))
    return fmt::format("{}no force but weight is stated for strained or damped edges", begin);
  if (touches && !met_obstacle)
    return fmt::format("{}no obstacle changed the sheet's mean velocity", begin);
  return "";
}

PortableScene within_contact_offset(PortableScene scene, double offset) {
  if (offset > 0 && !scene.bodies.empty())
    throw NotOffered{"bodies without a contact_offset: meshes are not made smaller by it"};
  for (PortablePlane& plane : scene.planes) plane.point -= offset * plane.normal;
  for (PortableBox& box : scene.boxes) box.half_extents.array() -= offset;
  for (PortableSphere& sphere : scene.spheres) sphere.radius -= offset;
  for (PortableCapsule& capsule : scene.capsules) capsule.radius -= offset;
  const auto is_gone = [](const auto& round) { return !(round.radius > 0); };
  if (std::ranges::any_of(scene.boxes, [](auto& b) { return !(b.half_extents.minCoeff() > 0); }) ||
      std::ranges::any_of(scene.spheres, is_gone) || std::ranges::any_of(scene.capsules, is_gone))
    throw NotOffered{
        fmt::format("obstacles thinner than twice its contact_offset of {} m", offset)};
  return scene;
}

void WatchedSolver::require_time() const {
  if (std::chrono::steady_clock::now() >= observed_.end) throw LawTimeIsUp();
}

void WatchedSolver::begin(const PortableScene& scene) {
  require_time();
  scene_ = scene;
  size_ = size_of(scene), is_strained_ = is_strained(scene);
  time_ = 0, steps_ = 0;
  ++observed_.scenes;
  observed_.most_particles = std::max<long>(observed_.most_particles, scene.x.cols());
}

std::vector<std::pair<std::string, std::string>> WatchedSolver::prepare(
    const PortableScene& scene) {
  begin(scene);
  return PipedSolver::prepare(within_contact_offset(scene, declaration().contact_offset));
}

void WatchedSolver::count(long calls, long steps) {
  observed_.advances += calls;
  observed_.steps += double(steps);
  observed_.particle_steps += double(steps) * double(scene_.x.cols());
}

/// Of a state that a motion from `start` has led to.
void WatchedSolver::observe(const Snapshot& start, const Snapshot& now, double time) {
  observed_.sent_motion = true;
  observed_.sent_strain |= is_strained_;
  observed_.moved =
      std::max(observed_.moved, (now.x - start.x).colwise().norm().maxCoeff() / size_);
  if (const double gained = time * scene_.gravity.norm(); gained > 0)
    observed_.sped =
        std::max(observed_.sped, (now.v - start.v).colwise().norm().maxCoeff() / gained);
  const Eigen::VectorXd change = lengths_of(scene_, now.x) - lengths_of(scene_, start.x);
  observed_.deformed = std::max(observed_.deformed, change.cwiseAbs().maxCoeff() / size_);
  if (has_obstacles(scene_) && scene_.held.empty())
    observed_.met_obstacle |= was_deflected(scene_, start, now, time);
  if (heard_) heard_(scene_, steps_, now);
}

Snapshot WatchedSolver::advance(double dt, long steps, long of) {
  require_time();
  Snapshot now = PipedSolver::advance(dt, steps, of);
  count(1, steps);
  time_ += double(steps) * dt, steps_ += steps;
  observe({scene_.x, scene_.v}, now, time_);
  return now;
}

Snapshot WatchedSolver::step(const std::vector<Snapshot>& past, const std::vector<double>& times,
                             double dt) {
  Snapshot now = PipedSolver::step(past, times, dt);
  count(1, 1);
  observe(past.back(), now, dt);
  return now;
}

std::vector<Snapshot> WatchedSolver::run(const PortableScene& scene,
                                         const std::vector<long>& frames) {
  begin(scene);
  std::vector<Snapshot> states =
      PipedSolver::run(within_contact_offset(scene, declaration().contact_offset), frames);
  count(1, frames.back());
  for (size_t k = 0; k < states.size(); ++k) {
    steps_ = frames[k];
    observe({scene.x, scene.v}, states[k], double(frames[k]) * scene.dt);
  }
  return states;
}

void WatchedSolver::observe_force(const PerParticle3& force) {
  const double scale = edge_stiffness(scene_).maxCoeff() * size_;
  observed_.asked_inner_force = true;
  observed_.inner_force =
      std::max(observed_.inner_force, force.colwise().norm().maxCoeff() / scale);
}

PerParticle3 WatchedSolver::forces(const Snapshot& state, double time) {
  PerParticle3 force = PipedSolver::forces(state, time);
  const PerParticle3 inner = force - scene_.gravity * scene_.mass.transpose();
  if (is_strained_) observe_force(force.norm() < inner.norm() ? force : inner);
  return force;
}

PerParticle3 WatchedSolver::damping(const Snapshot& state, double time) {
  PerParticle3 force = PipedSolver::damping(state, time);
  if (scene_.material.stretch_damping > 0 && state.v.norm() > 0) observe_force(force);
  return force;
}

}  // namespace foldproof
