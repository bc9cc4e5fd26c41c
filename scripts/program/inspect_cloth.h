// foldproof inspect --cloth: what a mesh makes of a cloth's material.
#pragma once

#include <string>

#include "reference/mesh/triangle_soup.h"
#include "scripts/program/options.h"

namespace foldproof {

/// "(1, 0.5, 0)".
std::string point(const Vector3& p);

/// Prints the mesh's size, its rigidity and Young's modulus by direction, its largest anisotropy,
/// the elastic limits that it imposes and its thinnest triangles. Throws InputError for a mesh that
/// can be no cloth.
int inspect_cloth(const Options& options, TriangleSoup soup);

}  // namespace foldproof
