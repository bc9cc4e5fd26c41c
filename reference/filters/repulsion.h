// Layers of cloth nearer to each other than the thickness push each other apart, and rub (Bridson,
// Fedkiw, Anderson 2002, section 7.1).
#pragma once

#include <vector>

#include "reference/filters/feature_pair.h"
#include "reference/types.h"

namespace foldproof {

/// How cloth is kept from itself. The case names it, or it costs nothing.
struct SelfCollisionSettings {
  double thickness = 0;  // s: layers nearer than this push each other apart [m], > 0
  double stiffness = 0;  // k: of that push, per pair of features and metre of overlap [N/m]
  double friction = 0;   // mu, Coulomb's coefficient between layers [1]
  int rounds = 8;  // of impulses against crossings, before colliding parts move as rigid zones
  // a start that crosses itself is run, and said to do so; false: it is refused
  bool untangle = true;
};

/// Changes the relative velocity of the two features, sum_i w_i v_i, by `change` [m/s], with
/// impulses w_i j that sum to zero: j = change / sum(w_i^2/m_i). Nothing happens to a pair of which
/// all particles are prescribed.
void push_apart(const FeaturePair& pair, const Eigen::Vector4d& weights, const Vector3& change,
                const PerParticle& inverse_mass, PerParticle3& v);

/// Coulomb: of the relative velocity that is left across N, at most friction times `push` [m/s] is
/// taken, and no more than there is. Returns the change [m/s].
Vector3 friction_impulse(const Vector3& relative, const Vector3& N, double push, double friction);

/// Pairs nearer than the thickness s at x, those of them that carry (repulsion.cpp), one after the
/// other as v then is: with d = s - distance and v_N the rate at which they part,
///   v_N' = max(0, v_N),   and then, if v_N' < 0.1 d/h,
///   v_N' += min(h k d sum(w_i^2/m_i), 0.1 d/h - v_N')
/// so that at most a tenth of the overlap goes in a step of h, and friction against v_N' - v_N.
/// Impulses along the line between the nearest points keep linear and angular momentum; those of
/// friction keep linear momentum, and turn by their size times the distance. Returns the number of
/// pairs that were answered.
long repel(const std::vector<FeaturePair>& pairs, const PerParticle3& x,
           const SelfCollisionSettings& settings, double h, const PerParticle& inverse_mass,
           PerParticle3& v);

}  // namespace foldproof
