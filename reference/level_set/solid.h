// The table of solids that a body can be made of.
#pragma once

#include <variant>

#include "reference/level_set/grid.h"
#include "reference/level_set/mesh_distance.h"
#include "reference/level_set/octree.h"
#include "reference/level_set/signed_distance.h"

namespace foldproof {

using Solid =
    std::variant<HalfSpace, Sphere, Box, Capsule, Torus, MeshSolid, GridSolid, OctreeSolid>;

/// The solid's answer at p, in its own frame.
inline Distance distance_to(const Solid& solid, const Vector3& p) {
  return std::visit([&](const auto& s) { return s.at(p); }, solid);
}

}  // namespace foldproof
