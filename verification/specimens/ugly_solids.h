// Combined surfaces, and closed meshes on which inside and outside are hard to tell, with an exact
// inside test.
#pragma once

#include <string>
#include <vector>

#include "reference/mesh/triangle_soup.h"
#include "verification/oracles/solid_prisms.h"

namespace foldproof {

TriangleSoup soup_of(const TriangleMesh& mesh);

/// Both surfaces in one, the second moved by `shift` [m].
TriangleSoup join(TriangleSoup first, const TriangleSoup& second, const Vector3& shift);

/// Nested prisms over a star with thin rays, sheared so that no face lies along an axis. Corners
/// are whole numbers.
struct UglySolid {
  std::string name;
  TriangleSoup soup;                        // closed, normals outward [m]
  std::vector<oracles::WholePrism> prisms;  // before the shear, in units of 1/1024 m
};

/// A thick star, a fin one unit thick and eighty wide, four nested shells.
std::vector<UglySolid> ugly_solids();

/// Units in a metre: points at whole multiples of 1/units have exact answers.
constexpr long units = 1024;

/// +1 inside, -1 outside, 0 on the surface; p must be a multiple of 1/units.
int inside_exactly(const UglySolid& solid, const Vector3& p);

}  // namespace foldproof
