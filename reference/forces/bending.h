// Bending: forces on a pair of triangles along the one mode that changes only their dihedral angle
// (BMF03 section 4).
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "reference/fast/elements.h"
#include "reference/forces/damping.h"
#include "reference/forces/energies.h"
#include "reference/forces/force_differential.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

//      x1
//     /  \      E  = x4 - x3, e^ = E/|E|
//   x3 -- x4    N1 = (x1 - x3) x (x1 - x4),  N2 = (x2 - x4) x (x2 - x3);  |N|: twice the area [m^2]
//     \  /      theta = angle from n1 to n2, signed by (n1 x n2).e^; 0 when flat, +-pi when folded
//      x2
//
//   u1 = |E| N1/|N1|^2        u3 = -(b1 u1 + b2 u2)                 b1 = (x4 - x1).E/|E|^2
//   u2 = |E| N2/|N2|^2        u4 = -((1 - b1) u1 + (1 - b2) u2)     b2 = (x4 - x2).E/|E|^2
//
//   F_elastic_i = ke c (sin(theta/2) - sin(theta0/2)) u_i   c = |E|^2/(|N1| + |N2|), at rest or now
//   F_damping_i = -kd s (u.v) u_i                           s = |E| as printed, or
//                                                               |E|^2/(|N1| + |N2|)
//
// u = -grad theta: the printed line d(theta)/dt = u.v has the wrong sign, the forces as printed
// have the right one.

/// Where c is evaluated. Only at rest is the elastic force the gradient of an energy; the paper
/// does not specify which.
enum class Weighting { rest, current };

/// The factor s of the damping force: the edge's length as printed (kd in N s), or |E|^2/(|N1| +
/// |N2|) (kd in J s).
enum class DampingFactor { edge, edge_squared_over_area };

/// Bending resistance as a function of the angle: a magnitude that replaces sin(theta/2) -
/// sin(theta0/2) and multiplies all four forces alike, as BMF03 section 4 requires of any such law.
/// Slope 1/2 in theta at theta0 = 0, so that ke keeps its meaning.
struct BendingLaw {
  std::string_view name;
  double (*magnitude)(double theta, double rest_angle);  // [1]
  double (*slope)(double theta, double rest_angle);      // derivative with respect to theta [1/rad]
  // its integral over theta from the rest angle [1]
  double (*potential)(double theta, double rest_angle);
};

/// The table of laws: "sine" (the paper's), "cubic" ((theta - theta0)/2 (1 + (theta - theta0)^2)).
const std::vector<BendingLaw>& bending_laws();
const BendingLaw& bending_law(std::string_view name);  // throws InputError with the known names

struct BendingMaterial {
  double stiffness = 0;  // ke [J]
  double damping = 0;    // kd [N s] with DampingFactor::edge, [J s] with the other
  Weighting weighting = Weighting::rest;
  DampingFactor damping_factor = DampingFactor::edge;
  std::string_view law = "sine";
};

struct BendingHinge {
  std::array<int, 4> particles;
  double rest_weight;    // c at rest [1]
  double rest_angle;     // theta0 [rad]
  double sin_half_rest;  // sin(theta0/2)
};

/// Geometry of one hinge at its current positions. Does not throw; callers check `degenerate`.
struct HingeShape {
  Vector3 u1, u2;       // the bending mode at the opposite vertices [1/m]
  double b1, b2;        // their barycentric coordinates along the edge: 1 at x3, 0 at x4
  double edge;          // |E| [m]
  double area_sum;      // |N1| + |N2| [m^2]
  double sin_half;      // sin(theta/2), to about one rounding of 1 for every theta in [-pi, pi]
  double sine, cosine;  // of theta, times |N1| |N2| [m^4]
  bool degenerate;      // a triangle's height is below 1e-10 of the edge, or NaN

  /// theta in [-pi, pi] [rad]; 0 and pi count as positive. Near pi sin_half is too
  /// insensitive to give it.
  double angle() const;
};

/// The shapes of all hinges at one x: computed once, read by elastic forces, damping, step
/// bound and energy.
using HingeShapes = Elements<HingeShape>;

HingeShape hinge_shape(const Vector3& x1, const Vector3& x2, const Vector3& x3, const Vector3& x4);

/// theta in [-pi, pi] [rad]; 0 and pi count as positive.
double hinge_angle(const Vector3& x1, const Vector3& x2, const Vector3& x3, const Vector3& x4);

/// The same for the hinge's particles at x (3 x N [m]). Throws DegenerateElement naming them if a
/// triangle has lost its area.
HingeShape checked_hinge_shape(const BendingHinge& hinge, const PerParticle3& x);

double weight_of(const BendingHinge& hinge, const HingeShape& shape, Weighting weighting);  // c [1]

/// The law's magnitude; the paper's law needs no angle.
double magnitude_of(const BendingLaw& law, const BendingHinge& hinge, const HingeShape& shape);

/// u1, u2, u3, u4 as columns [1/m].
Eigen::Matrix<double, 3, 4> bending_mode(const HingeShape& shape);

/// grad u = -(second derivative of theta), exact: row 3 i + a, column 3 j + b is d(u_i)_a/d(x_j)_b
/// [1/m^2]. Symmetric. The hinge must not be degenerate.
Matrix12 bending_mode_gradient(const Vector3& x1, const Vector3& x2, const Vector3& x3,
                               const Vector3& x4);

/// Derivatives of the factors of a hinge's forces with respect to x1, x2, x3, x4, three entries per
/// corner: |E| [1], and |E|^2/(|N1| + |N2|) [1/m].
Vector12 edge_gradient(const Vector3& x3, const Vector3& x4);
Vector12 weight_gradient(const Vector3& x1, const Vector3& x2, const Vector3& x3,
                         const Vector3& x4);

struct Bending {
  static constexpr auto energy_term = &Energies::bending;
  BendingMaterial material;
  Elements<BendingHinge> hinges;

  /// Its loops run on the team; the number of hinges must not change afterwards.
  void set_team(const Team& team, Eigen::Index particles) { hinges.divide(team, particles); }

  /// At x (3 x N [m]). Throws DegenerateElement naming the particles of a hinge that has a triangle
  /// without area.
  HingeShapes shapes_at(const PerParticle3& x) const;

  // the shapes are those at s.x
  void add_elastic(const State& s, const HingeShapes& shapes, PerParticle3& f) const;

  /// sum of ke c (potential of the law) [J]; with current weighting c is taken at s, and the force
  /// is not its gradient.
  double energy(const State& s, const HingeShapes& shapes) const;

  void prepare_damping(const State& s, const HingeShapes& shapes, DampingOperator& damping) const;

  /// A hinge's block is ke c (-magnitude' u u^T + magnitude grad u), made semidefinite by its
  /// eigenvalues. With current weighting the change of c is omitted: it would not be symmetric.
  void add_elastic_differential(const State& s, Definiteness definiteness,
                                ForceDifferential& differential) const;

  /// The same, exact, with the change of c, plus the derivative of the damping forces with respect
  /// to the positions at the velocities of s: a hinge's block gets -kd (rate u (grad s)^T + s u
  /// (grad u v)^T + s rate grad u), rate = u.v.
  void add_force_differential(const State& s, ForceDifferential& differential) const;

  /// Adds to rows (N [N/m]) a bound on each particle's row of the elastic stiffness; see
  /// forces/force.h.
  void add_stiffness_bound(const State& s, const HingeShapes& shapes, PerParticle& rows) const;
};

/// The angle of every hinge of the mesh at positions x (3 x N [m]); H values [rad].
std::vector<double> hinge_angles(const TriangleMesh& mesh, const PerParticle3& x);

/// One element per hinge, with the given rest angles (H values [rad]). Throws InputError for a
/// negative or NaN constant, an unknown law, a wrong number of angles, or one outside [-pi, pi].
Bending make_bending(const TriangleMesh& mesh, const BendingMaterial& material,
                     const std::vector<double>& rest_angles);

}  // namespace foldproof
