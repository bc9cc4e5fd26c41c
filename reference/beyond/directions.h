// Warp and weft of springs and hinges: stiffness by direction, as far as a mesh can have it. Not in
// BMF03, whose material has one constant for each.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "reference/mesh/rigidity_map.h"

namespace foldproof {

/// The corners of each triangle in the pattern, or in the plane of a flat mesh (is_flat). Throws
/// InputError, naming the part that asks, where there is neither.
std::vector<FlatTriangle> flat_corners(const TriangleMesh& mesh, const std::string& part);

/// A factor of an element's stiffness, by the angle from the warp that it resists along:
///   1 + second cos(2 angle) + fourth cos(4 angle).
struct ByDirection {
  double second = 0, fourth = 0;  // 1
  double warp = 0;                // from the first axis of the pattern or rest plane [rad]

  double at(double angle) const;  // angle: from that axis [rad]
  bool is_uniform() const { return second == 0 && fourth == 0; }
};

/// The angle of each edge in both of its triangles, from the first axis of the pattern or rest
/// plane [rad]; at a seam they differ. 0 where there is no triangle. Throws as flat_corners.
std::vector<std::array<double, 2>> angles_of_edges(const TriangleMesh& mesh);

/// The wanted stiffness of strips cut along the warp, the weft, and the bias half way between:
/// moduli of springs [N/m], rigidities of hinges [N m]. NaN: any bias.
struct StripStiffness {
  double warp, weft, bias;
};

struct DirectedStiffness {
  double stiffness;  // Y [N/m] or ke [J], of the factor 1
  ByDirection factor;
  std::string report;  // the stiffness of strips at five angles, in words
};

/// The stiffness and factors with which the elements, springs or hinges of a flat mesh, make such
/// strips, all particles following the strain or curvature. Throws InputError with the numbers that
/// the mesh can have where that takes an element of negative stiffness.
DirectedStiffness fit_directions(std::span<const FlatElement> elements,
                                 const StripStiffness& wanted, double warp);

}  // namespace foldproof
