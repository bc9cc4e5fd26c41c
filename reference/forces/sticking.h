// Dynamic sticking constraints (BMF03 section 6): cloth that sticks to patches of an object or of
// cloth, is carried, and breaks off.
//
// A bond keeps the place of a particle in the frame of a triangle (triangle_frame.h): where that
// place is now is the bond's target. Of a particle's bonds to one patch the target x_t is the mean,
// v_t its velocity. The force is that of a spring without length between where the particle and its
// target are forecast to be tau_s from now,
//
//   F = k(d) ((x_t + tau_s v_t) - (x + tau_s v)),   d = |x_t - x|, the distance now
//   k(d) = k0 (1 - (d/far)^2)^2,  0 beyond far      neither F nor its slope jumps as a bond breaks
//
// k(d) (x_t - x) is minus the gradient of W = k0 far^2/6 (1 - (1 - (d/far)^2)^3); k(d) tau_s (v_t -
// v) is a damping, linear in v and handled with it. (With k a function of the forecast distance F
// would not be linear in v.) Corners of cloth take the reaction by the transpose of x_t's
// derivative, which makes the damping symmetric and keeps linear momentum; the damping's torque k
// tau_s (x - x_t) x (v_t - v) remains.
//
// What limits the step, by the linear problem x'' = -(k/m) (x + tau_s x'): schemes A and B are
// stable for h < 2/omega, omega^2 = k/m, whatever tau_s. Scheme C is stable for h^2 omega^2 < 4 + 2
// h tau_s omega^2: for every h <= 2 tau_s, however stiff, and beyond that for h < tau_s +
// sqrt(tau_s^2 + 4/omega^2).
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "reference/forces/damping.h"
#include "reference/forces/energies.h"
#include "reference/forces/force_differential.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

/// Triangles that particles may stick to: of the cloth itself, or of a surface that
/// moves by itself.
struct StickyPatch {
  std::string name;
  std::vector<Triangle> triangles;  // corners: particles of the cloth, or columns of `place`
  std::function<PerParticle3(double t)> place,
      velocity;                // of a surface's corners at t [m], [m/s]; empty: cloth
  std::vector<int> particles;  // that may stick to it, each once
  double stiffness = 0;        // k0 [N/m]
  double forecast_time = 0;    // tau_s [s]; 0: a spring without forecast or damping
  double near = 0;             // bonds form within this distance of a triangle [m]
  double far = 0;              // they break beyond this distance from the target [m]
  double from = 0, until = std::numeric_limits<double>::infinity();  // active in between [s]
  double release = 0;  // over this time before `until` the stiffness falls smoothly to zero [s]
};

/// Where a stuck particle should be, and how stiffly it is held there.
struct StickyTarget {
  int patch, particle;
  size_t first, count;                // its bonds: bonds[first] .. bonds[first + count - 1]
  Vector3 x;                          // x_t [m]
  Vector3 v;                          // v_t of a surface that moves by itself [m/s]; else 0
  double distance;                    // d [m]
  double stiffness, stiffness_slope;  // k [N/m], and dk/dd over d [N/m^3]
  std::vector<TriangleFrame> frames;  // of cloth, over their number; of other surfaces none
};

/// At most one in a system: bonds name its patches by their places in the list.
struct Sticking {
  static constexpr auto energy_term = &Energies::sticking;
  std::vector<StickyPatch> patches;

  /// Breaks and makes bonds, once a step; a second call changes nothing. Bonds of a particle to a
  /// patch break together: when the patch is not active, or beyond `far`. A particle without bonds
  /// to an active patch bonds with all of its triangles within `near`, at its place as it is (in
  /// the very same call, if it broke off and is near another place: so it slips); as long as they
  /// hold it makes no more. A particle never sticks to a triangle that it is a corner of.
  void update_bonds(State& s) const;

  /// The targets of all bonds of s, in their order. Throws DegenerateElement for a
  /// triangle without area.
  std::vector<StickyTarget> targets_at(const State& s) const;

  void add_elastic(const State& s, PerParticle3& f) const;
  double energy(const State& s) const;  // W [J]
  void prepare_damping(const State& s, DampingOperator& damping) const;

  /// The derivative by the positions, that of the frames included; semidefinite leaves out what
  /// is not. The elastic one leaves out how k tau_s v_t changes on a surface that moves, which
  /// is not symmetric.
  void add_elastic_differential(const State& s, Definiteness definiteness,
                                ForceDifferential& differential) const;
  void add_force_differential(const State& s, ForceDifferential& differential) const;

  /// Adds to rows (N [N/m]) each particle's share of a bound on the elastic stiffness; see
  /// forces/force.h. It is that of the springs, and that beyond what forecasts keep stable: of
  /// frames of cloth that turn while springs pull.
  void add_stiffness_bound(const State& s, PerParticle& rows) const;
  void add_bound_without_springs(const State& s, PerParticle& rows) const;

  /// The shortest tau_s of a patch that has bonds [s]; infinite without any.
  double shortest_forecast(const State& s) const;
};

/// Bounds the rows of coefficient G^T G, G = (-1 at the particle, J at the corners): adds the row
/// sums of its blocks' norms to rows (N).
void add_row_sums(int particle, const std::vector<TriangleFrame>& frames, double coefficient,
                  PerParticle& rows);

}  // namespace foldproof
