#include "reference/level_set/grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace foldproof {

namespace {

constexpr int rounds = 6;  // of the search from a point beyond the lattice

/// The cell that holds a point, and the place of the point in it.
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

/// The weight of a cell's lower or upper nodes along an axis.
double weight_along(const Vector3& within, int axis, int upper) {
  return upper ? within[axis] : 1 - within[axis];
}

/// The weights of the eight nodes of a cell: bit 0 of the corner's number is its step
/// along x, and so on.
std::array<double, 8> corner_weights(const Vector3& within) {
  std::array<double, 8> weights;
  for (int corner = 0; corner < 8; ++corner) {
    weights[corner] = 1;
    for (int axis = 0; axis < 3; ++axis)
      weights[corner] *= weight_along(within, axis, corner >> axis & 1);
  }
  return weights;
}

/// The differences at a cell's two nodes along an axis, central or at the border one-sided,
/// blended: the sum of weights times the values these steps away from the lower node.
struct Slope {
  std::array<long, 4> steps;
  std::array<double, 4> weights;  // 1/m
};

Slope slope_along(const Lattice& lattice, int axis, const Place& place) {
  const long stride = lattice.strides()[axis];
  const int lower = place.cell[axis];
  const bool first = lower == 0, last = lower + 2 == lattice.nodes[axis];
  const double at_lower = weight_along(place.within, axis, 0) / ((first ? 1 : 2) * lattice.spacing);
  const double at_upper = weight_along(place.within, axis, 1) / ((last ? 1 : 2) * lattice.spacing);
  return {{first ? 0 : -stride, 0, stride, last ? stride : 2 * stride},
          {-at_lower, -at_upper, at_lower, at_upper}};
}

/// The fraction of the displacement to p that lies outside the bounds; it starts inside.
double share_outside(const Bounds& bounds, const Vector3& p, const Vector3& displacement) {
  double share = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double beyond = std::max(p[axis] - bounds.max()[axis], bounds.min()[axis] - p[axis]);
    if (beyond > 0) share = std::max(share, beyond / std::abs(displacement[axis]));
  }
  return std::min(share, 1.0);
}

Distance blend_gradients(const Grid& grid, const Vector3& p) {
  const Place place = place_of(grid.lattice, p);
  const std::array<double, 8> weights = corner_weights(place.within);
  const std::array<long, 3> strides = grid.lattice.strides();
  const double* lowest = &grid.phi[grid.lattice.index(place.cell)];
  Distance blend{0, Vector3::Zero()};
  for (int corner = 0; corner < 8; ++corner)
    blend.phi +=
        weights[corner] * lowest[(corner & 1) * strides[0] + (corner >> 1 & 1) * strides[1] +
                                 (corner >> 2) * strides[2]];
  for (int axis = 0; axis < 3; ++axis) {
    const Slope slope = slope_along(grid.lattice, axis, place);
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    for (int row = 0; row < 4; ++row) {
      const int on_b = row & 1, on_c = row >> 1;
      const double* phi = lowest + on_b * strides[b] + on_c * strides[c];
      const double weight =
          weight_along(place.within, b, on_b) * weight_along(place.within, c, on_c);
      for (int k = 0; k < 4; ++k)
        blend.normal[axis] += weight * slope.weights[k] * phi[slope.steps[k]];
    }
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

Bounds Lattice::bounds() const {
  return {origin, position({nodes[0] - 1, nodes[1] - 1, nodes[2] - 1})};
}

Lattice lattice_about(const Bounds& bounds, int cells, int margin) {
  constexpr int most = 1 << 20;  // so that the number of nodes along a side fits an int
  if (cells < 4 || margin < 1 || cells > most || margin > most)
    throw InputError("grid: " + std::to_string(cells) +
                     " cells along the longest side and a margin of " + std::to_string(margin) +
                     "; give at least 4 and 1, and at most 2^20");
  const Vector3 sizes = bounds.sizes();
  if (!(sizes.maxCoeff() > 0) || !sizes.allFinite())
    throw InputError(
        "grid: the bounds to be covered have no extent; give a surface with positions in m");
  const double spacing = sizes.maxCoeff() / cells;
  Lattice lattice{Vector3::Zero(), spacing, {}};
  for (int axis = 0; axis < 3; ++axis) {
    // an amount above a whole number of cells by rounding alone does not add a cell
    const int across = std::max(1, int(std::ceil(sizes[axis] / spacing - 1e-9)));
    lattice.nodes[axis] = across + 2 * margin + 1;
    lattice.origin[axis] = bounds.center()[axis] - spacing * (across + 2 * margin) / 2;
  }
  const auto& [x, y, z] = lattice.nodes;
  if (x > (1 << 30) / y / z)  // their product may exceed a long
    throw InputError("grid: " + std::to_string(x) + " x " + std::to_string(y) + " x " +
                     std::to_string(z) + " nodes; give fewer cells (2^30 nodes at most)");
  return lattice;
}

// Beyond the lattice: q on its border gives the surface point s = q - phi N. The point where the
// line from s to p leaves the lattice is a better q: |p - s| never grows, and stops shrinking where
// s is a nearest point of p.
Distance Grid::at(const Vector3& p) const {
  const Bounds bounds = lattice.bounds();
  if (bounds.contains(p)) return blend_gradients(*this, p);
  if (!p.allFinite()) return {std::numeric_limits<double>::quiet_NaN(), Vector3::Zero()};
  Vector3 q = p.cwiseMax(bounds.min()).cwiseMin(bounds.max()), displacement;
  for (int round = 0; round < rounds; ++round) {
    const Distance there = blend_gradients(*this, q);
    displacement = p - (q - there.phi * there.normal);
    q = p - share_outside(bounds, p, displacement) * displacement;
  }
  const double distance = displacement.norm();
  return {distance, displacement / distance};
}

Distance Grid::in_cell(const Vector3& p) const {
  const Place place = place_of(lattice, p);
  const std::array<double, 8> weights = corner_weights(place.within);
  const std::array<long, 3> strides = lattice.strides();
  const long lowest = lattice.index(place.cell);
  std::array<double, 8> corners;
  Distance result{0, Vector3::Zero()};
  for (int corner = 0; corner < 8; ++corner) {
    corners[corner] = phi[lowest + (corner & 1) * strides[0] + (corner >> 1 & 1) * strides[1] +
                          (corner >> 2) * strides[2]];
    result.phi += weights[corner] * corners[corner];
  }
  for (int axis = 0; axis < 3; ++axis) {
    Vector3 face = place.within;
    face[axis] = 1;  // corners of the far face, weighted as in that face
    const std::array<double, 8> across = corner_weights(face);
    for (int corner = 0; const double phi_here : corners) {
      const double phi_before = corners[corner & ~(1 << axis)];
      result.normal[axis] += across[corner++] * (phi_here - phi_before) / lattice.spacing;
    }
  }
  return result;
}

}  // namespace foldproof
