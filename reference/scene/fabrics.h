// A measured fabric in place of made-up constants: cases/fabrics.toml.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

constexpr double none_measured = std::numeric_limits<double>::quiet_NaN();

/// A fabric as it was measured.
struct Fabric {
  std::string name, words, source, place, method;
  double density;                  // kg/m^2
  std::array<double, 2> rigidity;  // B along the first and the second direction [N m]
  double scatter;                  // relative, of B [1]; NaN if the source gives none, as the next
  std::vector<std::string> missing;
  double thickness = none_measured, shear = none_measured;  // [m]; rigidity in shear [N/m]
  double drape = none_measured;                             // coefficient of the drape test [1]
};

/// All fabrics of a file. Throws InputError "file:line: ..." for an unknown key, a missing
/// text, a number that is not positive, a fabric without rigidity or with two kinds of it, or a
/// duplicate name.
std::vector<Fabric> read_fabrics(const std::string& path);

/// Throws InputError at `where` with the known names.
const Fabric& fabric_named(const std::vector<Fabric>& fabrics, const std::string& name,
                           const std::string& where);

/// The hinge stiffness of this mesh that gives the fabric its rigidity along its first direction.
struct FabricOnMesh {
  double stiffness;  // ke [J]
  // B/ke of a narrow strip of the mesh along x, as a laboratory would cut it; on a mesh that is not
  // flat, a median of D/ke [1]
  double rigidity_ratio;
  double anisotropy;  // of the mesh: its greatest D over its least [1]
  // of strips along y over strips along x of this mesh [1]; NaN for a mesh that is not flat
  double second_over_first;
  std::string report;  // a summary in words
};

/// On a flat mesh, and in a flat pattern, the fabric's first direction is the x axis. On others ke
/// follows from the median over particles of the mean of the least and greatest D/ke around them.
FabricOnMesh fabric_on_mesh(const Fabric& fabric, const TriangleMesh& cloth);

}  // namespace foldproof
