#include "reference/bodies/repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "reference/bodies/closed_mesh.h"
#include "reference/level_set/winding.h"
#include "reference/fast/loops.h"
#include "reference/mesh/mesh_locations.h"

namespace foldproof {

namespace {

constexpr double far = 2;  // distance in radii beyond which a patch counts as one triangle

double area_of(const PerParticle3& x, const Triangle& t) {
  return 0.5 * (x.col(t[1]) - x.col(t[0])).cross(x.col(t[2]) - x.col(t[0])).norm();
}

/// The same limit as in make_triangle_mesh: below it the normal is rounding error.
bool has_area(const PerParticle3& x, const Triangle& t) {
  double longest = 0;
  for (int k = 0; k < 3; ++k)
    longest = std::max(longest, (x.col(t[(k + 1) % 3]) - x.col(t[k])).squaredNorm());
  return area_of(x, t) > 1e-12 * longest;
}

/// A neighbour across an edge, and whether the two run along the edge the same way.
struct Neighbour {
  int triangle;
  bool opposed;
};

std::vector<std::vector<Neighbour>> neighbours_of(const std::vector<Triangle>& triangles) {
  struct Side {
    int triangle;
    bool rising;  // from the smaller number to the larger
  };
  std::map<std::pair<int, int>, std::vector<Side>> sides;
  for (int t = 0; t < int(triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      sides[std::minmax(a, b)].push_back({t, a < b});
    }
  }
  std::vector<std::vector<Neighbour>> neighbours(triangles.size());
  for (const auto& [edge, both] : sides) {
    if (both.size() != 2) continue;
    const bool opposed = both[0].rising == both[1].rising;
    neighbours[both[0].triangle].push_back({both[1].triangle, opposed});
    neighbours[both[1].triangle].push_back({both[0].triangle, opposed});
  }
  return neighbours;
}

/// Walks over the patch of `first` and marks each triangle: 1 if oriented against it, else 0.
std::vector<int> collect_patch(int first, const std::vector<std::vector<Neighbour>>& neighbours,
                               std::vector<int>& flip_state) {
  std::vector<int> patch{first};
  flip_state[first] = 0;
  for (size_t i = 0; i < patch.size(); ++i) {
    for (const Neighbour& next : neighbours[patch[i]]) {
      if (flip_state[next.triangle] >= 0) continue;
      flip_state[next.triangle] = next.opposed ? 1 - flip_state[patch[i]] : flip_state[patch[i]];
      patch.push_back(next.triangle);
    }
  }
  return patch;
}

/// 1/2 minus the winding number: negative inside.
std::vector<float> sides_of(const MeshDistance& mesh, const Lattice& lattice, const Team& team) {
  const std::vector<Dipole> dipoles = make_dipoles(mesh);
  std::vector<float> side(size_t(lattice.size()));
  for_each_index(team, lattice.size(), [&](Eigen::Index index) {
    const Vector3 p = lattice.position(lattice.node(index));
    side[size_t(index)] = float(0.5 - winding_number(mesh, dipoles, p, far));
  });
  return side;
}

/// Gives each seed within one cell of a triangle its exact distance to it.
void measure(const MeshDistance& mesh, const Lattice& lattice, Seeds& seeds, const Team& team) {
  for_each_item(team, seeds.nodes, [&](long node, size_t i) {
    const Vector3 p = lattice.position(lattice.node(node));
    const NearestFeature nearest = nearest_feature(mesh, p, lattice.spacing);
    double& phi = seeds.phi[i];
    if (nearest.triangle >= 0) phi = std::copysign(std::sqrt(nearest.squared_distance), phi);
  });
}

}  // namespace

std::vector<Triangle> orient_triangles(const TriangleSoup& soup) {
  std::vector<Triangle> triangles;
  std::copy_if(soup.triangles.begin(), soup.triangles.end(), std::back_inserter(triangles),
               [&](const Triangle& t) { return has_area(soup.rest, t); });
  const std::vector<std::vector<Neighbour>> neighbours = neighbours_of(triangles);
  std::vector<int> flip_state(triangles.size(), -1);
  for (int first = 0; first < int(triangles.size()); ++first) {
    if (flip_state[first] >= 0) continue;
    const std::vector<int> patch = collect_patch(first, neighbours, flip_state);
    double area[2] = {0, 0};
    for (const int t : patch) area[flip_state[t]] += area_of(soup.rest, triangles[t]);
    const int minority = area[1] > area[0] ? 0 : 1;
    for (const int t : patch)
      if (flip_state[t] == minority) std::swap(triangles[t][1], triangles[t][2]);
  }
  return triangles;
}

std::shared_ptr<const Grid> make_repaired_grid(const TriangleSoup& soup, const GridMethod& method,
                                               const Team& team) {
  const MeshDistance mesh = make_mesh_distance(soup.rest, orient_triangles(soup));
  const Lattice lattice = lattice_about(mesh.tree.nodes[0].bounds, method.cells, method.margin);
  Seeds seeds = seeds_from_sides(lattice, sides_of(mesh, lattice, team));
  if (seeds.nodes.empty())
    throw InputError(
        mesh_location(soup.origin) + "repair finds no inside: the winding number of its " +
        std::to_string(soup.triangles.size()) +
        " triangles is below 1/2 at every node; turn them outward, or give a finer grid");
  measure(mesh, lattice, seeds, team);
  return std::make_shared<const Grid>(march(lattice, seeds, method.order));
}

std::shared_ptr<const Grid> make_level_set(const TriangleSoup& soup, const GridMethod& method,
                                           Repair repair, const Team& team) {
  if (repair == Repair::winding) return make_repaired_grid(soup, method, team);
  const TriangleMesh mesh = make_closed_mesh(soup);
  return make_grid(make_mesh_distance(mesh.rest, mesh.triangles), method, team);
}

}  // namespace foldproof
