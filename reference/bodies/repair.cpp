#include "reference/bodies/repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
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

/// A neighbour across an edge, and whether the two run along the edge the same way.
struct Neighbour {
  int triangle;
  bool opposed;
};

/// For each vertex the first one at its place: doubled vertices, of a seam, are one here.
std::vector<int> welded(const PerParticle3& x) {
  std::map<std::array<double, 3>, int> first;
  std::vector<int> vertex(size_t(x.cols()));
  for (int v = 0; v < int(x.cols()); ++v)
    vertex[size_t(v)] = first.try_emplace({x(0, v), x(1, v), x(2, v)}, v).first->second;
  return vertex;
}

std::vector<std::vector<Neighbour>> neighbours_of(const PerParticle3& x,
                                                  const std::vector<Triangle>& triangles) {
  const std::vector<int> vertex = welded(x);
  struct Side {
    int triangle;
    bool rising;  // from the smaller number to the larger
  };
  std::map<std::pair<int, int>, std::vector<Side>> sides;
  for (int t = 0; t < int(triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = vertex[triangles[t][k]], b = vertex[triangles[t][(k + 1) % 3]];
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

[[noreturn]] void reject_without_inside(const TriangleSoup& soup, const OrientedPatches& of) {
  const auto largest = std::ranges::max_element(
      of.patches, {}, [](const std::vector<int>& patch) { return patch.size(); });
  throw InputError(triangle_location(soup.origin, of.numbers[size_t(largest->front())]) +
                   "repair finds no inside: the winding number of the piece of " +
                   std::to_string(largest->size()) + " triangles that begins here, one of " +
                   std::to_string(of.patches.size()) +
                   ", is below 1/2 at every node; close it, or give a finer grid");
}

}  // namespace

OrientedPatches oriented_patches(const TriangleSoup& soup) {
  OrientedPatches all;
  for (int t = 0; t < int(soup.triangles.size()); ++t) {
    if (!has_area(soup.rest, soup.triangles[t])) continue;
    all.triangles.push_back(soup.triangles[t]);
    all.numbers.push_back(t);
  }
  std::vector<Triangle>& triangles = all.triangles;
  const std::vector<std::vector<Neighbour>> neighbours = neighbours_of(soup.rest, triangles);
  std::vector<int> flip_state(triangles.size(), -1);
  for (int first = 0; first < int(triangles.size()); ++first) {
    if (flip_state[first] >= 0) continue;
    all.patches.push_back(collect_patch(first, neighbours, flip_state));
    const std::vector<int>& patch = all.patches.back();
    double area[2] = {0, 0};
    for (const int t : patch) area[flip_state[t]] += area_of(soup.rest, triangles[t]);
    const int minority = area[1] > area[0] ? 0 : 1;
    for (const int t : patch)
      if (flip_state[t] == minority) std::swap(triangles[t][1], triangles[t][2]);
  }
  return all;
}

std::vector<Triangle> orient_triangles(const TriangleSoup& soup) {
  return oriented_patches(soup).triangles;
}

std::shared_ptr<const Grid> make_repaired_grid(const TriangleSoup& soup, const GridMethod& method,
                                               const Team& team) {
  const OrientedPatches outward = outward_patches(soup);
  const MeshDistance mesh = make_mesh_distance(soup.rest, outward.triangles);
  const Lattice lattice = lattice_about(mesh.tree.nodes[0].bounds, method.cells, method.margin);
  Seeds seeds = seeds_from_sides(lattice, sides_of(mesh, lattice, team));
  if (seeds.nodes.empty()) reject_without_inside(soup, outward);
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
