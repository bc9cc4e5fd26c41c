// Layers of cloth closer than the thickness repel each other, with friction (Bridson, Fedkiw,
// Anderson 2002, section 7.1).
#pragma once

#include <vector>

#include "reference/fast/team.h"
#include "reference/filters/feature_pair.h"
#include "reference/types.h"

namespace foldproof {

/// Settings of self-collision. It is active, and costs time, only if the case names it.
struct SelfCollisionSettings {
  // s: layers nearer than this push each other apart [m], > 0; of several the largest
  double thickness = 0;
  double stiffness = 0;  // k: stiffness of the repulsion per pair of features [N/m]
  double friction = 0;   // mu, Coulomb's coefficient between layers [1]
  // rounds of impulses against crossings before colliding parts move as rigid zones
  int rounds = 8;
  // runs a start that crosses itself, with a message; false: refuses it
  bool untangle = true;
};

/// Of a cloth of several fabrics: each N, or empty. Two layers have the mean of their thicknesses,
/// half of each, and the mean of their coefficients.
struct LayerProperties {
  PerParticle thickness, friction;  // [m], [1]

  double thickness_of(const FeaturePair& pair, const Eigen::Vector4d& weights,
                      const SelfCollisionSettings& settings) const;
  double friction_of(const FeaturePair& pair, const Eigen::Vector4d& weights,
                     const SelfCollisionSettings& settings) const;
  double least_thickness(const SelfCollisionSettings& settings) const;  // m
};

/// Changes the relative velocity of the two features, sum_i w_i v_i, by `change` [m/s], with
/// impulses w_i j that sum to zero: j = change / sum(w_i^2/m_i). A pair of prescribed particles
/// only is left unchanged.
void push_apart(const FeaturePair& pair, const Eigen::Vector4d& weights, const Vector3& change,
                const PerParticle& inverse_mass, PerParticle3& v);

/// Coulomb friction: reduces the relative velocity tangential to N by at most friction times `push`
/// [m/s], never beyond zero. Returns the change [m/s].
Vector3 friction_impulse(const Vector3& relative, const Vector3& N, double push, double friction);

/// Repels the load-bearing pairs (repulsion.cpp) among those closer than the thickness s at x,
/// one after the other, each with the current v. With d = s - distance and v_N the rate at
/// which they separate,
///   v_N' = max(0, v_N),   and then, if v_N' < 0.1 d/h,
///   v_N' += min(h k d sum(w_i^2/m_i), 0.1 d/h - v_N')
/// so that a step of h removes at most a tenth of the overlap, with friction against v_N' - v_N.
/// Impulses along the line between the nearest points conserve linear and angular momentum;
/// friction conserves linear momentum and exerts a torque of its size times the distance. Returns
/// the number of pairs repelled.
///   team   searches for the load-bearing pairs
long repel(const std::vector<FeaturePair>& pairs, const PerParticle3& x,
           const SelfCollisionSettings& settings, const LayerProperties& layers, double h,
           const PerParticle& inverse_mass, PerParticle3& v, const Team& team);

}  // namespace foldproof
