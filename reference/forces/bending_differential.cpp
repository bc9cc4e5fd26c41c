// Derivatives of a hinge's forces with respect to its corners, for the methods that are implicit in
// the elastic forces too.
#include "reference/forces/bending.h"

namespace foldproof {

namespace {

/// Terms shared by both derivatives.
struct HingeRates {
  HingeShape shape;
  double theta;       // rad
  Vector12 u;         // the bending mode [1/m]
  Matrix12 gradient;  // grad u [1/m^2]
};

HingeRates rates_of(const BendingHinge& hinge, const PerParticle3& x) {
  const HingeShape shape = checked_hinge_shape(hinge, x);
  const auto [i1, i2, i3, i4] = hinge.particles;
  const Eigen::Matrix<double, 3, 4> mode = bending_mode(shape);
  return {shape, shape.angle(), Eigen::Map<const Vector12>(mode.data()),
          bending_mode_gradient(x.col(i1), x.col(i2), x.col(i3), x.col(i4))};
}

/// Velocities or positions of the hinge's corners, three entries a corner.
Vector12 at_corners(const BendingHinge& hinge, const PerParticle3& all) {
  Vector12 list;
  for (int k = 0; k < 4; ++k) list.segment<3>(3 * k) = all.col(hinge.particles[size_t(k)]);
  return list;
}

Matrix12 elastic_block(const BendingMaterial& material, const BendingHinge& hinge,
                       const HingeRates& rates) {
  const BendingLaw& law = bending_law(material.law);
  const double weight = material.stiffness * weight_of(hinge, rates.shape, material.weighting);
  return weight * (law.magnitude(rates.theta, hinge.rest_angle) * rates.gradient -
                   law.slope(rates.theta, hinge.rest_angle) * (rates.u * rates.u.transpose()));
}

/// ke magnitude u (grad c)^T [N/m], c at the current positions x.
Matrix12 weight_block(const BendingMaterial& material, const BendingHinge& hinge,
                      const HingeRates& rates, const PerParticle3& x) {
  const auto [i1, i2, i3, i4] = hinge.particles;
  const double magnitude = bending_law(material.law).magnitude(rates.theta, hinge.rest_angle);
  return material.stiffness * magnitude *
         (rates.u * weight_gradient(x.col(i1), x.col(i2), x.col(i3), x.col(i4)).transpose());
}

// F = -kd s (u.v) u with s = |E| or |E|^2/(|N1| + |N2|), and grad u symmetric:
//   dF = -kd ((u.v) u (grad s.dx) + s u ((grad u v).dx) + s (u.v) grad u dx)
Matrix12 damping_block(const BendingMaterial& material, const BendingHinge& hinge,
                       const HingeRates& rates, const State& s) {
  const auto [i1, i2, i3, i4] = hinge.particles;
  const Vector3 x1 = s.x.col(i1), x2 = s.x.col(i2), x3 = s.x.col(i3), x4 = s.x.col(i4);
  const bool by_edge = material.damping_factor == DampingFactor::edge;
  const double edge = rates.shape.edge,
               factor = by_edge ? edge : edge * edge / rates.shape.area_sum;
  const Vector12 of_factor = by_edge ? edge_gradient(x3, x4) : weight_gradient(x1, x2, x3, x4);
  const Vector12 v = at_corners(hinge, s.v);
  const double rate = rates.u.dot(v);
  const Vector12 of_rate = rates.gradient * v;
  return -material.damping * (rates.u * (rate * of_factor + factor * of_rate).transpose() +
                              factor * rate * rates.gradient);
}

}  // namespace

void Bending::add_elastic_differential(const State& s, Definiteness definiteness,
                                       ForceDifferential& differential) const {
  differential.hinges.reserve(differential.hinges.size() + hinges.size());
  for (const BendingHinge& hinge : hinges) {
    const Matrix12 block = elastic_block(material, hinge, rates_of(hinge, s.x));
    differential.hinges.push_back(
        {hinge.particles, definiteness == Definiteness::exact ? block : negative_part(block)});
  }
}

void Bending::add_force_differential(const State& s, ForceDifferential& differential) const {
  const bool weighted = material.weighting == Weighting::current && material.stiffness > 0;
  const bool damped = material.damping > 0;
  if (weighted || damped) differential.symmetric = false;
  differential.hinges.reserve(differential.hinges.size() + hinges.size());
  for (const BendingHinge& hinge : hinges) {
    const HingeRates rates = rates_of(hinge, s.x);
    Matrix12 block = elastic_block(material, hinge, rates);
    if (weighted) block += weight_block(material, hinge, rates, s.x);
    if (damped) block += damping_block(material, hinge, rates, s);
    differential.hinges.push_back({hinge.particles, block});
  }
}

}  // namespace foldproof
