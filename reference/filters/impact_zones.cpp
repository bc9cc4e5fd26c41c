#include "reference/filters/impact_zones.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>

#include "reference/forces/symmetric_modes.h"

namespace foldproof {

ImpactZones::ImpactZones(Eigen::Index particles)
    : parent_(size_t(particles)), size_(size_t(particles), 1), grown_(size_t(particles), 0) {
  std::iota(parent_.begin(), parent_.end(), 0);
}

int ImpactZones::root_of(int particle) const {
  while (parent_[size_t(particle)] != particle) particle = parent_[size_t(particle)];
  return particle;
}

void ImpactZones::join(const FeaturePair& pair) {
  int into = root_of(pair.particles[0]);
  for (const int particle : pair.particles) {
    int other = root_of(particle);
    if (other == into) continue;
    if (size_[size_t(other)] > size_[size_t(into)]) std::swap(other, into);  // paths stay short
    parent_[size_t(other)] = into;
    size_[size_t(into)] += size_[size_t(other)];
  }
  grown_[size_t(into)] = 1;
}

bool ImpactZones::are_joined(const FeaturePair& pair) const {
  const int root = root_of(pair.particles[0]);
  return std::all_of(pair.particles.begin(), pair.particles.end(),
                     [&](int i) { return root_of(i) == root; });
}

std::vector<std::vector<int>> ImpactZones::take_grown_zones() {
  std::map<int, std::vector<int>> zones;  // by root
  for (int i = 0; i < int(parent_.size()); ++i)
    if (const int root = root_of(i); grown_[size_t(root)]) zones[root].push_back(i);
  std::fill(grown_.begin(), grown_.end(), 0);
  std::vector<std::vector<int>> members;
  for (auto& [root, zone] : zones) members.push_back(std::move(zone));
  return members;
}

long ImpactZones::zones() const {
  long count = 0;
  for (int i = 0; i < int(parent_.size()); ++i)
    count += parent_[size_t(i)] == i && size_[size_t(i)] > 1;
  return count;
}

long ImpactZones::particles() const {
  long count = 0;
  for (int i = 0; i < int(parent_.size()); ++i)
    if (parent_[size_t(i)] == i && size_[size_t(i)] > 1) count += size_[size_t(i)];
  return count;
}

namespace {

using Motion6 = Eigen::Matrix<double, 6, 1>;  // u, then omega times the zone's size: both m/s
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// A mode with less than this fraction of the zone's inertia is not a motion: it rotates about the
// line on which all particles lie.
constexpr double no_motion = 1e-12;

/// A zone's particles relative to its middle, in units of its size: v = J w with J = [1, -[r]x].
struct Frame {
  Vector3 centre;  // m
  double size;     // m

  Eigen::Matrix<double, 3, 6> velocity_of(const Vector3& x) const {
    const Vector3 r = (x - centre) / size;
    Eigen::Matrix<double, 3, 6> J;
    J << Eigen::Matrix3d::Identity(),
        (Eigen::Matrix3d() << 0, r[2], -r[1], -r[2], 0, r[0], r[1], -r[0], 0).finished();
    return J;
  }
};

Frame frame_of(const std::vector<int>& zone, const PerParticle3& x) {
  Vector3 centre = Vector3::Zero();
  for (const int i : zone) centre += x.col(i);
  centre /= double(zone.size());
  double size = 0;
  for (const int i : zone) size = std::max(size, (x.col(i) - centre).norm());
  return {centre, size > 0 ? size : 1};
}

/// sum weight J^T J and sum weight J^T v.
struct NormalEquations {
  Matrix6 left = Matrix6::Zero();
  Motion6 right = Motion6::Zero();

  void add(const Eigen::Matrix<double, 3, 6>& J, const Vector3& v, double weight) {
    left += weight * J.transpose() * J;
    right += weight * J.transpose() * v;
  }
};

/// The minimum-norm solution, and a basis of the motions that the equations leave free.
struct Solved {
  Motion6 motion;
  Eigen::Matrix<double, 6, Eigen::Dynamic> open;
};

/// scale: the size of nonzero eigenvalues; any below a tiny fraction of it count as zero.
Solved solve(const Matrix6& left, const Motion6& right, double scale) {
  const SymmetricModes modes = symmetric_modes(left);
  const double cut = no_motion * scale;
  Solved solved{Motion6::Zero(), {}};
  int open = 0;
  for (int k = 0; k < 6; ++k) {
    const Motion6 mode = modes.vectors.col(k);
    if (modes.values[k] > cut)
      solved.motion += mode.dot(right) / modes.values[k] * mode;
    else
      ++open;  // eigenvalues ascend
  }
  solved.open = modes.vectors.leftCols(open);
  return solved;
}

}  // namespace

double move_as_one(const std::vector<int>& zone, const PerParticle3& x, const PerParticle& mass,
                   const PerParticle& inverse_mass, PerParticle3& v) {
  const Frame frame = frame_of(zone, x);
  NormalEquations prescribed, free;
  for (const int i : zone) {
    const bool is_led = inverse_mass[i] == 0;
    (is_led ? prescribed : free).add(frame.velocity_of(x.col(i)), v.col(i), is_led ? 1 : mass[i]);
  }
  // prescribed particles first; momentum determines the remaining motion
  const Solved by_led = solve(prescribed.left, prescribed.right, prescribed.left.trace());
  const Matrix6 onto = by_led.open * by_led.open.transpose();
  const Solved by_momentum = solve(
      onto * free.left * onto, onto * (free.right - free.left * by_led.motion), free.left.trace());
  const Motion6 motion = by_led.motion + by_momentum.motion;
  double missed = 0;
  for (const int i : zone) {
    const Vector3 rigid = frame.velocity_of(x.col(i)) * motion;
    if (inverse_mass[i] > 0)
      v.col(i) = rigid;
    else
      update_worst(missed, (rigid - v.col(i)).norm());
  }
  return missed;
}

}  // namespace foldproof
