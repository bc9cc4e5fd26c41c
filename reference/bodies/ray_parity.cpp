#include "reference/bodies/ray_parity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace foldproof {

namespace {

using Vector2 = Eigen::Vector2d;
using Corners = std::array<Vector3, 3>;

/// The three axes as seen by rays along one of them.
struct View {
  int along, u, v;
};

Vector2 project_along(const Vector3& x, const View& view) { return {x[view.u], x[view.v]}; }

/// Does the edge pass p on its right? Half open in v: the lower end counts, the upper one does not.
/// Both triangles of an edge pass the same numbers in the same order, so both get the same answer.
bool passes(Vector2 a, Vector2 b, const Vector2& p) {
  if (a.y() > b.y()) std::swap(a, b);
  if (!(a.y() <= p.y() && p.y() < b.y())) return false;
  return (b - a).x() * (p - a).y() - (b - a).y() * (p - a).x() > 0;
}

bool covers(const Corners& t, const View& view, const Vector2& p) {
  const Vector2 a = project_along(t[0], view), b = project_along(t[1], view),
                c = project_along(t[2], view);
  return (passes(a, b, p) != passes(b, c, p)) != passes(c, a, p);
}

/// Where the ray through p meets the triangle's plane, clamped to the triangle's extent: for a
/// triangle seen edge on, the intersection is only rounding error.
double crossing(const Corners& t, const View& view, const Vector2& p) {
  const Vector3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const Vector2 step = p - project_along(t[0], view);
  const double w = t[0][view.along] -
                   (step.x() * normal[view.u] + step.y() * normal[view.v]) / normal[view.along];
  const auto [low, high] = std::minmax({t[0][view.along], t[1][view.along], t[2][view.along]});
  return w >= low ? std::min(w, high) : low;
}

/// First and last node along the axis within [low, high].
std::pair<int, int> nodes_within(const Lattice& lattice, int axis, double low, double high) {
  const double first = std::ceil((low - lattice.origin[axis]) / lattice.spacing - 1e-6);
  const double last = std::floor((high - lattice.origin[axis]) / lattice.spacing + 1e-6);
  return {int(std::max(first, 0.0)), int(std::min(last, double(lattice.nodes[axis] - 1)))};
}

/// Flips the bit of the first node beyond each crossing of the triangle with a ray of the lattice.
void flip_beyond(const Corners& t, const View& view, const Lattice& lattice,
                 std::vector<std::uint8_t>& bits) {
  const Vector3 low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
  const auto [u0, u1] = nodes_within(lattice, view.u, low[view.u], high[view.u]);
  const auto [v0, v1] = nodes_within(lattice, view.v, low[view.v], high[view.v]);
  Node node;
  for (node[view.v] = v0; node[view.v] <= v1; ++node[view.v]) {
    for (node[view.u] = u0; node[view.u] <= u1; ++node[view.u]) {
      node[view.along] = 0;
      const Vector3 start = lattice.position(node);
      if (!covers(t, view, project_along(start, view))) continue;
      const double cells =
          (crossing(t, view, project_along(start, view)) - start[view.along]) / lattice.spacing;
      node[view.along] = int(std::max(std::floor(cells) + 1, 0.0));
      if (node[view.along] < lattice.nodes[view.along]) bits[lattice.index(node)] ^= 1;
    }
  }
}

/// Adds the running parity along the axis to the votes.
void add_votes(const View& view, const Lattice& lattice, const std::vector<std::uint8_t>& bits,
               std::vector<std::uint8_t>& votes) {
  Node node;
  for (node[view.v] = 0; node[view.v] < lattice.nodes[view.v]; ++node[view.v]) {
    for (node[view.u] = 0; node[view.u] < lattice.nodes[view.u]; ++node[view.u]) {
      std::uint8_t inside = 0;
      for (node[view.along] = 0; node[view.along] < lattice.nodes[view.along]; ++node[view.along]) {
        const long index = lattice.index(node);
        inside ^= bits[index];
        votes[index] += inside;
      }
    }
  }
}

}  // namespace

std::vector<std::uint8_t> ray_parity(const PerParticle3& x, const std::vector<Triangle>& triangles,
                                     const Lattice& lattice) {
  std::vector<std::uint8_t> votes(lattice.size(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    const View view{axis, (axis + 1) % 3, (axis + 2) % 3};
    std::vector<std::uint8_t> bits(lattice.size(), 0);
    for (const Triangle& t : triangles)
      flip_beyond({x.col(t[0]), x.col(t[1]), x.col(t[2])}, view, lattice, bits);
    add_votes(view, lattice, bits, votes);
  }
  return votes;
}

Disagreement disagreement(const Grid& grid, const std::vector<std::uint8_t>& parity, double skin) {
  Disagreement found;
  for (long index = 0; index < grid.lattice.size(); ++index) {
    if (!(std::abs(grid.phi[index]) > skin)) continue;
    if ((parity[index] >= 2) != (grid.phi[index] < 0)) found.with_sign.push_back(index);
    if (parity[index] == 1 || parity[index] == 2) found.among_rays.push_back(index);
  }
  return found;
}

}  // namespace foldproof
