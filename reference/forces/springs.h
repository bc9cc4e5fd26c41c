// Springs along the edges: stretch and shear of the sheet (assumed by BMF03; the
// mesh-independent form is ours).
#pragma once

#include <vector>

#include "reference/fast/loops.h"
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

struct StretchMaterial {
  double stiffness = 0;          // Y, 2D Young's modulus [N/m]
  double damping = 0;            // kd_s [N s/m]
  double rest_length_scale = 1;  // rest lengths over those of the rest shape [1]
};

struct StretchSprings {
  static constexpr auto energy_term = &Energies::stretch;
  std::vector<Spring> springs;
  // of the springs among threads, and the same of their dampers if each spring has one
  Sharing sharing = {}, damper_sharing = {};

  /// Shares out the springs, whose number must then stay.
  void use_threads(int threads, Eigen::Index particles);

  /// Throws DegenerateElement when the ends of a spring coincide: its direction is then undefined.
  void add_elastic(const State& s, PerParticle3& f) const;

  /// sum of stiffness/2 (|d| - L0)^2 [J].
  double energy(const State& s) const;

  void prepare_damping(const State& s, DampingOperator& damping) const;

  /// A spring's block is k along d and tension/|d| across it; semidefinite drops the second
  /// where tension < 0.
  void add_elastic_differential(const State& s, Definiteness definiteness,
                                ForceDifferential& differential) const;

  /// The same, exact, plus the derivative of the damping forces with respect to the positions at
  /// the velocities of s: for the unit direction n and dv = v_b - v_a, block = -damping (n dv^T +
  /// (n.dv) I)(I - n n^T)/|d|.
  void add_force_differential(const State& s, ForceDifferential& differential) const;

  /// Adds to rows (N [N/m]) each particle's share of a bound on the elastic stiffness; see
  /// forces/force.h.
  void add_stiffness_bound(const State& s, PerParticle& rows) const;
};

/// One spring per edge. Throws InputError unless stiffness >= 0, damping >= 0 and scale > 0.
StretchSprings make_springs(const TriangleMesh& mesh, const StretchMaterial& material);

}  // namespace foldproof
