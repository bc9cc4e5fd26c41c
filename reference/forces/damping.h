// The damping forces at one set of positions: F_damping = D v, linear in v, D symmetric
// negative semidefinite.
//
// Every damper of cloth resists one mode: F = -w (w.v), a matrix of rank one that is never
// assembled; sticking resists three. All dependence on positions is in w, computed once and used
// for every product of a solve (BMF03 section 3).
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "reference/fast/elements.h"
#include "reference/forces/triangle_frame.h"
#include "reference/types.h"

namespace foldproof {

/// Resists the lengthening of a pair: w = (-along, +along).
struct PairDamper {
  int a, b;
  Vector3 along;  // sqrt(coefficient [N s/m]) times the unit direction from a to b
};

/// Resists the folding of a hinge: w = sqrt(coefficient) u, stored as two vectors and two weights:
///   w3 = -(weight1 w1 + weight2 w2),   w4 = -((1 - weight1) w1 + (1 - weight2) w2)
struct HingeDamper {
  std::array<int, 4> particles;
  // barycentric coordinates of x1 and x2 along the edge, 1 at x3 and 0 at x4
  double weight1, weight2;
  Vector3 w1, w2;
};

/// Resists the motion of a particle relative to its place on triangles of cloth, with rank three:
///   F = coefficient (J v - v_particle) on the particle, -J^T F on the corners
/// Without frames the place counts as at rest: the velocity of a surface with its own motion enters
/// the forces that do not depend on v.
struct TargetDamper {
  int particle;
  double coefficient;                 // N s/m
  std::vector<TriangleFrame> frames;  // J of triangle_frame.h
};

struct DampingOperator {
  /// Given as functions.
  struct Custom {
    std::function<void(const PerParticle3& v, PerParticle3& f)> add_product;  // f += D v
    // adds each particle's bound on its row sum of D [N s/m], for automatic steps; {} if unknown
    std::function<void(PerParticle& rows)> add_rows;
  };

  Elements<PairDamper> pairs;
  Elements<HingeDamper> hinges;
  std::vector<TargetDamper> targets;
  std::vector<Custom> custom;

  /// True if there are no dampers.
  bool empty() const {
    return pairs.empty() && hinges.empty() && targets.empty() && custom.empty();
  }

  /// f += D v; both 3 x N, v in m/s, f in N.
  void add_product(const PerParticle3& v, PerParticle3& f) const;
};

}  // namespace foldproof
