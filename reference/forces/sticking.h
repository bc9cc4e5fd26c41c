// Dynamic sticking constraints (BMF03 section 6): cloth sticks to patches of an object or of cloth,
// is carried along, and breaks off.
//
// A bond stores the place of a particle in the frame of a triangle (triangle_frame.h); the current
// position of that place is the bond's target. x_t is the mean target of a particle's bonds to one
// patch, v_t its velocity. The force is that of a zero-length spring between the positions of the
// particle and its target forecast tau_s ahead,
//
//   F = k(d) ((x_t + tau_s v_t) - (x + tau_s v)),   d = |x_t - x|, the distance now
//   k(d) = k0 (1 - (d/far)^2)^2,  0 beyond far      neither F nor its slope jumps as a bond breaks
//
// k(d) (x_t - x) is minus the gradient of W = k0 far^2/6 (1 - (1 - (d/far)^2)^3); k(d) tau_s (v_t -
// v) is a damping force, linear in v and treated as such. (If k depended on the forecast distance,
// F would not be linear in v.) Corners of cloth take the reaction through the transpose of the
// derivative of x_t, which makes the damping symmetric and conserves linear momentum; the damping
// torque k tau_s (x - x_t) x (v_t - v) remains.
//
// Step limits, from the linear problem x'' = -(k/m) (x + tau_s x'): schemes A and B are stable for
// h < 2/omega, omega^2 = k/m, for any tau_s. Scheme C is stable for h^2 omega^2 < 4 + 2 h tau_s
// omega^2: for every h <= 2 tau_s, however stiff, and beyond that for h < tau_s + sqrt(tau_s^2 +
// 4/omega^2).
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

/// Triangles that particles may stick to: of the cloth itself, or of a surface with its own motion.
struct StickyPatch {
  std::string name;
  std::vector<Triangle> triangles;  // corners: particles of the cloth, or columns of `place`
  std::function<PerParticle3(double t)> place,
      velocity;                // of the surface's corners at t [m], [m/s]; empty: cloth
  std::vector<int> particles;  // particles that may stick to it, each once
  double stiffness = 0;        // k0 [N/m]
  double forecast_time = 0;    // tau_s [s]; 0: no forecast and no damping
  double near = 0;             // bonds form within this distance of a triangle [m]
  double far = 0;              // bonds break beyond this distance from the target [m]
  // active between these times [s]
  double from = 0, until = std::numeric_limits<double>::infinity();
  double release = 0;  // during this time before `until` the stiffness falls smoothly to zero [s]
};

/// Where a stuck particle should be, and how stiffly it is held there.
struct StickyTarget {
  int patch, particle;
  size_t first, count;                // its bonds: bonds[first] .. bonds[first + count - 1]
  Vector3 x;                          // x_t [m]
  Vector3 v;                          // v_t of a surface with its own motion [m/s]; else 0
  double distance;                    // d [m]
  double stiffness, stiffness_slope;  // k [N/m], and dk/dd over d [N/m^3]
  // frames of cloth, divided by their number; none for other surfaces
  std::vector<TriangleFrame> frames;
};

/// At most one per system: bonds refer to its patches by index.
struct Sticking {
  static constexpr auto energy_term = &Energies::sticking;
  std::vector<StickyPatch> patches;

  /// Breaks and forms bonds, once per step; a second call changes nothing. Bonds of a particle to a
  /// patch break together, when the patch is inactive or beyond `far`. A particle without bonds to
  /// an active patch bonds with all of its triangles within `near`, at its current place, even if
  /// it broke off elsewhere in the same call (slip). It forms no more bonds while these hold. A
  /// particle never sticks to a triangle that it is a corner of.
  void update_bonds(State& s) const;

  /// The targets of all bonds of s, in order. Throws DegenerateElement for a triangle without area.
  std::vector<StickyTarget> targets_at(const State& s) const;

  void add_elastic(const State& s, PerParticle3& f) const;
  double energy(const State& s) const;  // W [J]
  void prepare_damping(const State& s, DampingOperator& damping) const;

  /// The derivative with respect to the positions, including that of the frames; semidefinite omits
  /// the indefinite parts. The elastic one omits the change of k tau_s v_t on a moving surface,
  /// which is not symmetric.
  void add_elastic_differential(const State& s, Definiteness definiteness,
                                ForceDifferential& differential) const;
  void add_force_differential(const State& s, ForceDifferential& differential) const;

  /// Adds to rows (N [N/m]) a bound on each particle's row of the elastic stiffness; see
  /// forces/force.h. It covers the springs, and the part that forecasts do not stabilise: cloth
  /// frames that turn while springs pull on them.
  void add_stiffness_bound(const State& s, PerParticle& rows) const;
  void add_bound_without_springs(const State& s, PerParticle& rows) const;

  /// The shortest tau_s of any patch that has bonds [s]; infinite without bonds.
  double shortest_forecast(const State& s) const;
};

/// Bounds the rows of coefficient G^T G, G = (-1 at the particle, J at the corners): adds the row
/// sums of its blocks' norms to rows (N).
void add_row_sums(int particle, const std::vector<TriangleFrame>& frames, double coefficient,
                  PerParticle& rows);

}  // namespace foldproof
