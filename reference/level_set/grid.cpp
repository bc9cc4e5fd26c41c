#include "reference/level_set/grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace foldproof {

namespace {

constexpr int rounds = 6;  // of the search for what is nearest to a point beyond the lattice

/// The cell that holds a point, and where in it the point is.
struct Place {
  Node cell;       // its lowest node
  Vector3 within;  // in [0, 1] along each axis
};

Place place_of(const Lattice& lattice, const Vector3& p) {
  const Vector3 steps = (p - lattice.origin) / lattice.spacing;
  Place place;
  for (int axis = 0; axis < 3; ++axis) {
    place.cell[axis] = std::clamp(int(std::floor(steps[axis])), 0, lattice.nodes[axis] - 2);
    place.within[axis] = steps[axis] - place.cell[axis];
  }
  return place;
}

/// The weights of the eight nodes of a cell: bit 0 of the corner's number is its step along x, and so on.
std::array<double, 8> corner_weights(const Vector3& within) {
  std::array<double, 8> weights;
  for (int corner = 0; corner < 8; ++corner) {
    weights[corner] = 1;
    for (int axis = 0; axis < 3; ++axis)
      weights[corner] *= corner >> axis & 1 ? within[axis] : 1 - within[axis];
  }
  return weights;
}

/// Central differences at a node, one-sided at the border [1].
Vector3 nodal_gradient(const Grid& grid, const Node& node, const std::array<long, 3>& strides) {
  const double* phi = &grid.phi[grid.lattice.index(node)];
  Vector3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const long ahead = node[axis] + 1 < grid.lattice.nodes[axis] ? strides[axis] : 0;
    const long behind = node[axis] > 0 ? strides[axis] : 0;
    const int steps = (ahead > 0) + (behind > 0);
    gradient[axis] = (phi[ahead] - phi[-behind]) / (steps * grid.lattice.spacing);
  }
  return gradient;
}

/// The part of the way that leads to p which lies outside of the bounds; it begins inside.
double share_outside(const Bounds& bounds, const Vector3& p, const Vector3& way) {
  double share = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double beyond = std::max(p[axis] - bounds.max()[axis], bounds.min()[axis] - p[axis]);
    if (beyond > 0) share = std::max(share, beyond / std::abs(way[axis]));
  }
  return std::min(share, 1.0);
}

Distance blended(const Grid& grid, const Vector3& p) {
  const Place place = place_of(grid.lattice, p);
  const std::array<double, 8> weights = corner_weights(place.within);
  const std::array<long, 3> strides = grid.lattice.strides();
  Distance blend{0, Vector3::Zero()};
  for (int corner = 0; corner < 8; ++corner) {
    const Node node{place.cell[0] + (corner & 1), place.cell[1] + (corner >> 1 & 1),
                    place.cell[2] + (corner >> 2)};
    blend.phi += weights[corner] * grid.phi[grid.lattice.index(node)];
    blend.normal += weights[corner] * nodal_gradient(grid, node, strides);
  }
  const double length = blend.normal.norm();
  if (length > 0) blend.normal /= length;
  return blend;
}

}  // namespace

Node Lattice::node(long index) const {
  const long row = index / nodes[0];
  return {int(index % nodes[0]), int(row % nodes[1]), int(row / nodes[1])};
}

Bounds Lattice::bounds() const { return {origin, position({nodes[0] - 1, nodes[1] - 1, nodes[2] - 1})}; }

Lattice lattice_about(const Bounds& bounds, int cells, int margin) {
  if (cells < 4 || margin < 1)
    throw InputError("grid: " + std::to_string(cells) + " cells along the longest side and a margin of " +
                     std::to_string(margin) + "; give at least 4 and 1");
  const Vector3 sizes = bounds.sizes();
  if (!(sizes.maxCoeff() > 0) || !sizes.allFinite())
    throw InputError("grid: the bounds to be covered have no extent; give a surface with positions in m");
  const double spacing = sizes.maxCoeff() / cells;
  Lattice lattice{Vector3::Zero(), spacing, {}};
  for (int axis = 0; axis < 3; ++axis) {
    // an amount that rounding alone puts above a whole number of cells does not ask for one more
    const int across = std::max(1, int(std::ceil(sizes[axis] / spacing - 1e-9)));
    lattice.nodes[axis] = across + 2 * margin + 1;
    lattice.origin[axis] = bounds.center()[axis] - spacing * (across + 2 * margin) / 2;
  }
  if (lattice.size() > 1L << 30)
    throw InputError("grid: " + std::to_string(lattice.size()) +
                     " nodes; give fewer cells (2^30 nodes at most)");
  return lattice;
}

// Beyond the lattice: q on its border names the surface point s = q - phi N. Where the way from s to p leaves the
// lattice is a better q: |p - s| never grows, and stands still where s is a nearest point of p.
Distance Grid::at(const Vector3& p) const {
  const Bounds bounds = lattice.bounds();
  if (bounds.contains(p)) return blended(*this, p);
  if (!p.allFinite()) return {std::numeric_limits<double>::quiet_NaN(), Vector3::Zero()};
  Vector3 q = p.cwiseMax(bounds.min()).cwiseMin(bounds.max()), way;
  for (int round = 0; round < rounds; ++round) {
    const Distance there = blended(*this, q);
    way = p - (q - there.phi * there.normal);
    q = p - share_outside(bounds, p, way) * way;
  }
  const double distance = way.norm();
  return {distance, way / distance};
}

Distance Grid::in_cell(const Vector3& p) const {
  const Place place = place_of(lattice, p);
  const std::array<double, 8> weights = corner_weights(place.within);
  const std::array<long, 3> strides = lattice.strides();
  const long lowest = lattice.index(place.cell);
  std::array<double, 8> corners;
  Distance result{0, Vector3::Zero()};
  for (int corner = 0; corner < 8; ++corner) {
    corners[corner] =
        phi[lowest + (corner & 1) * strides[0] + (corner >> 1 & 1) * strides[1] + (corner >> 2) * strides[2]];
    result.phi += weights[corner] * corners[corner];
  }
  for (int axis = 0; axis < 3; ++axis) {
    Vector3 face = place.within;
    face[axis] = 1;  // corners of the far face, weighted as in that face
    const std::array<double, 8> across = corner_weights(face);
    for (int corner = 0; corner < 8; ++corner)
      result.normal[axis] +=
          across[corner] * (corners[corner] - corners[corner & ~(1 << axis)]) / lattice.spacing;
  }
  return result;
}

}  // namespace foldproof
