// Fast marching: signed distance over a whole grid from its values next to the surface
// (Sethian 1996, 1999).
#pragma once

#include <vector>

#include "reference/level_set/grid.h"

namespace foldproof {

/// Nodes whose signed distance is known.
struct Seeds {
  std::vector<long> nodes;  // indices into the lattice
  std::vector<double> phi;  // m
};

enum class MarchingOrder { first, second };

/// Solves |grad phi| = 1 outward from the seeds on both sides, nodes in the order of their
/// distance. The seeds keep their values; they must separate inside from outside: no other node has
/// neighbours of both signs (a seed on the surface counts as inside if its phi is -0).
///
/// first: upwind differences over one cell: O(h) (h log h in the largest error).
/// second: over two cells where both nodes are known and nearer to the surface, else over
/// one: O(h^2) away from kinks of phi, O(h) next to them; it needs seeds at least two nodes
/// deep. Throws InputError when there are no seeds, std::logic_error when they do not
/// separate inside from outside.
Grid march(const Lattice& lattice, const Seeds& seeds, MarchingOrder order);

/// The cruder start of BMF03 section 5.1: only the side of each node is known. Seeds are the nodes
/// with a neighbour on the other side; `side` (one value per node, negative inside) is interpolated
/// linearly along each axis to its zero: t along an axis, 1/sqrt(sum 1/t^2) from the plane through
/// up to three such points. With side = +1 and -1 that is the paper's start, small positive and
/// small negative.
Seeds seeds_from_sides(const Lattice& lattice, const std::vector<float>& side);

}  // namespace foldproof
