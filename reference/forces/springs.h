// Springs along the edges: stretch and shear of the sheet (assumed by BMF03; the
// mesh-independent form is ours).
#pragma once

#include <vector>

#include "reference/fast/elements.h"
#include "reference/forces/damping.h"
#include "reference/forces/energies.h"
#include "reference/forces/force_differential.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

//   a ----- b     d = x_b - x_a, d^ = d/|d|, L0 rest length, A_e full rest areas of its triangles
//
//   F_a =  Y (A_e/L0) (|d|/L0 - 1) d^  +  kd_s (A_e/L0^2) ((v_b - v_a).d^) d^,     F_b = -F_a
//
// so that the spring's stiffness is Y A_e/L0^2 [N/m]. On an equilateral mesh the sheet has Young's
// modulus Y [N/m] and Poisson ratio 1/3 exactly; elsewhere effective ones.
struct Spring {
  int a, b;
  double rest_length;  // L0 [m]
  double stiffness;    // Y A_e/L0^2 [N/m]
  double damping;      // kd_s A_e/L0^2 [N s/m]
};

/// One spring at its current positions.
struct SpringShape {
  Vector3 d;      // x_b - x_a [m]
  double length;  // |d| [m]
};

/// The shapes of all springs at one x: computed once, read by elastic forces, damping, step
/// bound and energy.
using SpringShapes = Elements<SpringShape>;

struct StretchMaterial {
  double stiffness = 0;          // Y, 2D Young's modulus [N/m]
  double damping = 0;            // kd_s [N s/m]
  double rest_length_scale = 1;  // rest lengths over those of the rest shape [1]
};

struct StretchSprings {
  static constexpr auto energy_term = &Energies::stretch;
  Elements<Spring> springs;

  /// Its loops run on the team; the number of springs must not change afterwards.
  void set_team(const Team& team, Eigen::Index particles) { springs.divide(team, particles); }

  /// At x (3 x N [m]). Throws DegenerateElement when the ends of a spring coincide: its direction
  /// is then undefined.
  SpringShapes shapes_at(const PerParticle3& x) const;

  // the shapes are those at s.x
  void add_elastic(const State& s, const SpringShapes& shapes, PerParticle3& f) const;

  /// The largest rate at which a spring changes its length, over its rest length [1/s].
  double fastest_strain_rate(const State& s, const SpringShapes& shapes) const;

  /// sum of stiffness/2 (|d| - L0)^2 [J].
  double energy(const State& s, const SpringShapes& shapes) const;

  void prepare_damping(const State& s, const SpringShapes& shapes, DampingOperator& damping) const;

  /// A spring's block is k along d and tension/|d| across it; semidefinite drops the second
  /// where tension < 0.
  void add_elastic_differential(const State& s, Definiteness definiteness,
                                ForceDifferential& differential) const;

  /// The same, exact, plus the derivative of the damping forces with respect to the positions at
  /// the velocities of s: for the unit direction n and dv = v_b - v_a, block = -damping (n dv^T +
  /// (n.dv) I)(I - n n^T)/|d|.
  void add_force_differential(const State& s, ForceDifferential& differential) const;

  /// Adds to rows (N [N/m]) a bound on each particle's row of the elastic stiffness; see
  /// forces/force.h.
  void add_stiffness_bound(const State& s, const SpringShapes& shapes, PerParticle& rows) const;
};

/// One spring per edge. Throws InputError unless stiffness >= 0, damping >= 0 and scale > 0.
StretchSprings make_springs(const TriangleMesh& mesh, const StretchMaterial& material);

}  // namespace foldproof
