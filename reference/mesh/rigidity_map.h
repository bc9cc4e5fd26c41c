// Stiffness of a mesh of hinges and springs, by direction and place: the material sets ke and Y,
// the mesh the rest.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

/// Bending of hinges (BMF03 section 4) at small curvature, all particles on the curved surface.
/// With the curvatures k = (K11, K22, 2 K12) [1/m] along two directions of the plane at rest,
///   energy per area = ke/2 k.R k,   R symmetric, 3 x 3, in units of ke [1].
/// A hinge turns by theta = q.k and stores ke c theta^2/4 with c = |E|^2/(|N1| + |N2|); it stands
/// for a third of the areas of its two triangles.
struct Rigidity {
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();  // 1

  /// D/ke of bending to a cylinder that is curved along the direction at `angle` [rad]
  /// from the first [1].
  double along(double angle) const;

  /// B/ke of a narrow strip cut along that direction, whose long edges are free to curve and to
  /// twist: the least energy for its curvature along itself [1]. NaN if R is singular.
  double of_strip(double angle) const;
};

/// The least and greatest of 180 directions, a degree apart [1].
struct RigidityExtremes {
  double least, greatest, greatest_angle;  // the last in [0, pi) [rad]
  double anisotropy() const { return greatest / least; }
};
RigidityExtremes extremes_of(const Rigidity& rigidity);

/// A plane that the rest shape lies in, to a millionth of its extent.
struct RestPlane {
  Vector3 first, second;  // directions, perpendicular, of length 1
};

/// Whether the rest shape is flat, and its plane: `first` is the x axis, or y if x is closer to the
/// normal than 45 degrees, projected on the plane.
bool is_flat(const TriangleMesh& mesh, RestPlane& plane);

/// A hinge or spring of a flat mesh: its part of the sheet's energy at small strain or curvature.
struct FlatElement {
  Eigen::Matrix3d energy;  // of `area`, by ke or Y [m^2]
  double area;             // that it stands for [m^2]
  // that it resists along, from the plane's first direction: along a spring, across a hinge's edge
  double angle;  // rad
};

std::vector<FlatElement> flat_hinges(const TriangleMesh& mesh, const RestPlane& plane);
std::vector<FlatElement> flat_springs(const TriangleMesh& mesh, const RestPlane& plane);

/// The rigidity of all hinges of a flat mesh together. A sheet of few cells lacks the hinges of its
/// border.
Rigidity rigidity_of(const TriangleMesh& mesh, const RestPlane& plane);

/// The stiffness of all springs of a flat mesh in its plane, if every particle follows the strain
/// (e11, e22, 2 e12), in units of Y [1]: `of_strip` is then Young's modulus over Y along a
/// direction, with free sides. In a pattern whose particles all are centres of symmetry they do.
Rigidity membrane_of(const TriangleMesh& mesh, const RestPlane& plane);

/// The rigidity of the hinges around each particle, on the edges of its triangles. A local plane
/// replaces the rest shape there. NaN for a particle with fewer than three hinges. N values.
std::vector<RigidityExtremes> rigidity_around_particles(const TriangleMesh& mesh);

}  // namespace foldproof
