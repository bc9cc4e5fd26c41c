#include "reference/filters/repulsion.h"

#include <algorithm>

#include "reference/fast/loops.h"

namespace foldproof {

namespace {

constexpr double overlap_per_step = 0.1;  // the most of the overlap removed in a step

/// sum(w_i^2/m_i) [1/kg].
double compliance(const FeaturePair& pair, const Eigen::Vector4d& weights,
                  const PerParticle& inverse_mass) {
  double sum = 0;
  for (int k = 0; k < 4; ++k)
    sum += weights[k] * weights[k] * inverse_mass[pair.particles[size_t(k)]];
  return sum;
}

/// The mean over the nearest points of both features; `otherwise` where there are no values.
double mean_of(const PerParticle& values, const FeaturePair& pair, const Eigen::Vector4d& weights,
               double otherwise) {
  if (values.size() == 0) return otherwise;
  double sum = 0;
  for (int k = 0; k < 4; ++k) sum += std::abs(weights[k]) * values[pair.particles[size_t(k)]];
  return sum / 2;
}

}  // namespace

double LayerProperties::thickness_of(const FeaturePair& pair, const Eigen::Vector4d& weights,
                                     const SelfCollisionSettings& settings) const {
  return mean_of(thickness, pair, weights, settings.thickness);
}

double LayerProperties::friction_of(const FeaturePair& pair, const Eigen::Vector4d& weights,
                                    const SelfCollisionSettings& settings) const {
  return mean_of(friction, pair, weights, settings.friction);
}

double LayerProperties::least_thickness(const SelfCollisionSettings& settings) const {
  return thickness.size() == 0 ? settings.thickness : thickness.minCoeff();
}

void push_apart(const FeaturePair& pair, const Eigen::Vector4d& weights, const Vector3& change,
                const PerParticle& inverse_mass, PerParticle3& v) {
  const double pair_compliance = compliance(pair, weights, inverse_mass);
  if (!(pair_compliance > 0)) return;
  for (int k = 0; k < 4; ++k) {
    const int i = pair.particles[size_t(k)];
    if (inverse_mass[i] > 0) v.col(i) += weights[k] * inverse_mass[i] / pair_compliance * change;
  }
}

Vector3 friction_impulse(const Vector3& relative, const Vector3& N, double push, double friction) {
  const Vector3 along = relative - relative.dot(N) * N;
  const double speed = along.norm();
  return speed > 0 ? Vector3(-std::min(1.0, friction * push / speed) * along) : Vector3::Zero();
}

namespace {

/// A pair within its thickness.
struct ClosePair {
  FeaturePair pair;
  Nearness at;
  double thickness;  // m
};

bool inside_both(const Eigen::Vector4d& weights) { return (weights.array() != 0).all(); }

/// Load-bearing pairs within the thickness. Where two layers lie flat on each other, most pairs are
/// nearest at ends and corners, with tilted normals: sliding layers would catch on each other's
/// edges. So two edges count if they are nearest inside both. A vertex counts over a triangle, and
/// at its rim only if no other triangle is nearer, as over a fold or at the cloth's border.
std::vector<ClosePair> load_bearing_pairs(const std::vector<FeaturePair>& pairs,
                                          const PerParticle3& x,
                                          const SelfCollisionSettings& settings,
                                          const LayerProperties& layers, const Team& team) {
  const auto close_pair = [&](const FeaturePair& pair) -> std::optional<ClosePair> {
    const Corners4 corners = corners_of(pair, x);
    const bool are_edges = pair.kind == PairKind::edge_edge;
    const std::optional<Nearness> at =
        are_edges ? nearness_inside_edges(corners) : nearness(pair.kind, corners);
    if (!at || (are_edges && !inside_both(at->weights))) return {};
    const double thickness = layers.thickness_of(pair, at->weights, settings);
    if (!(at->distance < thickness) || !(at->distance > 0)) return {};
    return ClosePair{pair, *at, thickness};
  };
  std::vector<ClosePair> close = found_among<ClosePair>(team, pairs, close_pair);
  // of each vertex to a triangle [m]
  PerParticle nearest = PerParticle::Constant(x.cols(), settings.thickness);
  for (const ClosePair& one : close) {
    double& least = nearest[one.pair.particles[0]];
    if (one.pair.kind == PairKind::vertex_triangle) least = std::min(least, one.at.distance);
  }
  std::erase_if(close, [&](const ClosePair& one) {
    return one.pair.kind == PairKind::vertex_triangle && !inside_both(one.at.weights) &&
           one.at.distance > nearest[one.pair.particles[0]];
  });
  return close;
}

}  // namespace

long repel(const std::vector<FeaturePair>& pairs, const PerParticle3& x,
           const SelfCollisionSettings& settings, const LayerProperties& layers, double h,
           const PerParticle& inverse_mass, PerParticle3& v, const Team& team) {
  long answered = 0;
  for (const auto& [pair, at, thickness] : load_bearing_pairs(pairs, x, settings, layers, team)) {
    const double overlap = thickness - at.distance;                             // d [m]
    const double pair_compliance = compliance(pair, at.weights, inverse_mass);  // 1/kg
    const Vector3 relative = corners_of(pair, v) * at.weights;
    const double parting = relative.dot(at.normal),
                 wanted = overlap_per_step * overlap / h;  // v_N, 0.1 d/h [m/s]
    double after = std::max(0.0, parting);
    if (after < wanted)
      after += std::min(h * settings.stiffness * overlap * pair_compliance, wanted - after);
    const double push = after - parting;
    if (!(push > 0) || !(pair_compliance > 0)) continue;
    const double friction = layers.friction_of(pair, at.weights, settings);
    push_apart(pair, at.weights,
               push * at.normal + friction_impulse(relative, at.normal, push, friction),
               inverse_mass, v);
    ++answered;
  }
  return answered;
}

}  // namespace foldproof
