#include "reference/forces/sticking.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "reference/forces/degenerate.h"

namespace foldproof {

namespace {

/// From 1 at 0 down to 0 at 1 and beyond; flat at both ends. [1]
double fade(double part) { return part < 1 ? std::pow(1 - part * part, 2) : 0; }

/// k0 at time t, including the release before the patch's end.
double stiffness_at(const StickyPatch& patch, double t) {
  if (!(patch.release > 0) || !(t > patch.until - patch.release)) return patch.stiffness;
  return patch.stiffness * fade((t - (patch.until - patch.release)) / patch.release);
}

/// F [N]: the force of the spring on the particle.
Vector3 pull_of(const StickyTarget& target, const State& s) {
  return target.stiffness * (target.x - s.x.col(target.particle));
}

/// H of dF = H du, u = x_t - x: k across u, k + d dk/dd along it.
Eigen::Matrix3d spring_matrix(const StickyTarget& target, const State& s,
                              Definiteness definiteness) {
  const Vector3 u = target.x - s.x.col(target.particle);
  double stiffness_slope = target.stiffness_slope;
  const double squared = target.distance * target.distance;
  if (definiteness == Definiteness::semidefinite && squared > 0)
    stiffness_slope = std::max(stiffness_slope, -target.stiffness / squared);
  return target.stiffness * Eigen::Matrix3d::Identity() + stiffness_slope * u * u.transpose();
}

/// Positions and velocities of the corners of a patch that has its own motion.
struct Surface {
  PerParticle3 x, v;  // m, m/s
};

StickyTarget target_of(const StickyPatch& patch, const State& s, const Surface& surface,
                       size_t first, size_t count) {
  const Bond& bond = s.bonds[first];
  const PerParticle3& x = patch.place ? surface.x : s.x;
  StickyTarget target{bond.patch, bond.particle, first, count, {}, Vector3::Zero(), {}, {}, {}, {}};
  for (size_t k = first; k < first + count; ++k) {
    const Triangle& corners = patch.triangles.at(size_t(s.bonds[k].triangle));
    target.frames.push_back(frame_of(corners, x, s.bonds[k].place, 1 / double(count)));
    if (!target.frames.back().slopes.allFinite())
      throw DegenerateElement("a triangle of sticky '" + patch.name + "' has no area",
                              {bond.particle});
  }
  target.x = place_of(target.frames, x);
  if (patch.place) {
    target.v = frame_velocity(target.frames, surface.v);
    target.frames.clear();
  }
  target.distance = (target.x - s.x.col(bond.particle)).norm();
  const double k0 = stiffness_at(patch, s.time), part = target.distance / patch.far;
  target.stiffness = k0 * fade(part);
  target.stiffness_slope = part < 1 ? -4 * k0 * (1 - part * part) / (patch.far * patch.far) : 0;
  return target;
}

double norm_of_corner(const TriangleFrame& frame, int i) {
  return std::abs(frame.weights[i]) + std::abs(frame.height) * frame.slopes.col(i).norm();
}

}  // namespace

std::vector<StickyTarget> Sticking::targets_at(const State& s) const {
  std::vector<StickyTarget> targets;
  const std::vector<Bond>& bonds = s.bonds;
  Surface surface;  // of the patch of the current bonds
  for (size_t first = 0, end = 0; first < bonds.size(); first = end) {
    const Bond& bond = bonds[first];
    const StickyPatch& patch = patches.at(size_t(bond.patch));
    if (patch.place && (first == 0 || bonds[first - 1].patch != bond.patch))
      surface = {patch.place(s.time), patch.velocity(s.time)};
    while (end < bonds.size() && bonds[end].patch == bond.patch &&
           bonds[end].particle == bond.particle)
      ++end;
    targets.push_back(target_of(patch, s, surface, first, end - first));
  }
  return targets;
}

void Sticking::add_elastic(const State& s, PerParticle3& f) const {
  for (const StickyTarget& target : targets_at(s)) {
    const Vector3 pull = pull_of(target, s);
    f.col(target.particle) += pull;
    add_corner_forces(target.frames, -pull, f);
    // the damping from the motion of a surface does not depend on the cloth's velocity
    f.col(target.particle) +=
        target.stiffness * patches[size_t(target.patch)].forecast_time * target.v;
  }
}

double Sticking::energy(const State& s) const {
  double sum = 0;
  for (const StickyTarget& target : targets_at(s)) {
    const StickyPatch& patch = patches[size_t(target.patch)];
    const double part = std::min(1.0, target.distance / patch.far), p2 = part * part;
    // 1 - (1 - p2)^3, without its cancellation
    sum += stiffness_at(patch, s.time) * patch.far * patch.far / 6 * p2 * (3 - 3 * p2 + p2 * p2);
  }
  return sum;
}

void Sticking::prepare_damping(const State& s, DampingOperator& damping) const {
  for (StickyTarget& target : targets_at(s)) {
    const double coefficient = target.stiffness * patches[size_t(target.patch)].forecast_time;
    if (coefficient == 0) continue;
    damping.targets.push_back({target.particle, coefficient, std::move(target.frames)});
  }
}

// With u = x_t - x and du = J dx - dx_particle: dF = H du on the particle, -J^T dF - (dJ)^T F
// on the corners.
void Sticking::add_elastic_differential(const State& s, Definiteness definiteness,
                                        ForceDifferential& differential) const {
  for (const StickyTarget& target : targets_at(s)) {
    const Eigen::Matrix3d H = spring_matrix(target, s, definiteness);
    const Vector3 pull = definiteness == Definiteness::exact ? pull_of(target, s) : Vector3::Zero();
    differential.custom.push_back([target, H, pull](const PerParticle3& dx, PerParticle3& df) {
      const Vector3 change = H * (frame_velocity(target.frames, dx) - dx.col(target.particle));
      df.col(target.particle) += change;
      add_corner_forces(target.frames, -change, df);
      add_corner_force_change(target.frames, -pull, dx, df);
    });
  }
}

// The damping is F = c q, c = k tau_s, q = v_t - v: dF = dc q + c (dJ) v with dc = tau_s
// (dk/dd)/d (u . du).
void Sticking::add_force_differential(const State& s, ForceDifferential& differential) const {
  add_elastic_differential(s, Definiteness::exact, differential);
  for (const StickyTarget& target : targets_at(s)) {
    const double tau = patches[size_t(target.patch)].forecast_time, c = tau * target.stiffness;
    if (tau == 0) continue;
    const Vector3 u = target.x - s.x.col(target.particle);
    const Vector3 q = target.v + frame_velocity(target.frames, s.v) - s.v.col(target.particle);
    const double stiffness_slope = tau * target.stiffness_slope;
    differential.symmetric = false;
    differential.custom.push_back([=, v = s.v](const PerParticle3& dx, PerParticle3& df) {
      const Vector3 du = frame_velocity(target.frames, dx) - dx.col(target.particle);
      const Vector3 change =
          stiffness_slope * u.dot(du) * q + c * frame_velocity_change(target.frames, dx, v);
      df.col(target.particle) += change;
      add_corner_forces(target.frames, -change, df);
      add_corner_force_change(target.frames, -c * q, dx, df);
    });
  }
}

void add_row_sums(int particle, const std::vector<TriangleFrame>& frames, double coefficient,
                  PerParticle& rows) {
  double sum = 1;
  for (const TriangleFrame& frame : frames)
    for (int i = 0; i < 3; ++i) sum += norm_of_corner(frame, i);
  rows[particle] += coefficient * sum;
  for (const TriangleFrame& frame : frames)
    for (int i = 0; i < 3; ++i)
      rows[frame.corners[size_t(i)]] += coefficient * norm_of_corner(frame, i) * sum;
}

void Sticking::add_stiffness_bound(const State& s, PerParticle& rows) const {
  for (const StickyTarget& target : targets_at(s)) {
    const double along =
        target.stiffness + target.stiffness_slope * target.distance * target.distance;
    add_row_sums(target.particle, target.frames, std::max(target.stiffness, std::abs(along)), rows);
  }
  add_bound_without_springs(s, rows);
}

// (dJ)^T F is a sum of three terms over pairs of corners, each at most |height| |F|
// |g_i| |g_j| |dx_j|.
void Sticking::add_bound_without_springs(const State& s, PerParticle& rows) const {
  for (const StickyTarget& target : targets_at(s)) {
    const double force = pull_of(target, s).norm();
    for (const TriangleFrame& frame : target.frames) {
      const Vector3 steepness = frame.slopes.colwise().norm().transpose();
      for (int i = 0; i < 3; ++i)
        rows[frame.corners[size_t(i)]] +=
            3 * force * std::abs(frame.height) * steepness[i] * steepness.sum();
    }
  }
}

double Sticking::shortest_forecast(const State& s) const {
  double shortest = std::numeric_limits<double>::infinity();
  for (const Bond& bond : s.bonds)
    shortest = std::min(shortest, patches.at(size_t(bond.patch)).forecast_time);
  return shortest;
}

}  // namespace foldproof
