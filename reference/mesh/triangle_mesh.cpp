#include "reference/mesh/triangle_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "reference/mesh/mesh_locations.h"

namespace foldproof {
namespace {

/// A side of a triangle. Half edge 3 t + k runs from corner k of triangle t to the next one. In the
/// list of particle a, the smaller of its two particles, it is held as (b, half), b the larger; the
/// lists of all particles are stored one after another.
struct Side {
  int b;     // the larger particle
  int half;  // 3 t + k
  bool operator<(const Side& other) const { return b != other.b ? b < other.b : half < other.half; }
};

struct SideLists {
  // N + 1; the sides of particle a are start[a] .. start[a + 1] - 1, sorted by (b, half)
  std::vector<int> start;
  std::vector<Side> sides;  // 3 M
};

int tail(const std::vector<Triangle>& triangles, int half) { return triangles[half / 3][half % 3]; }
int tip(const std::vector<Triangle>& triangles, int half) {
  return triangles[half / 3][(half + 1) % 3];
}
int opposite(const std::vector<Triangle>& triangles, int half) {
  return triangles[half / 3][(half + 2) % 3];
}

// --- refusals that need no edges ---

void reject_bad_sizes(const PerParticle3& rest, const std::vector<Triangle>& triangles,
                      const MeshOrigin& origin) {
  if (triangles.empty())
    throw InputError(mesh_location(origin) + "no triangles; give at least one");
  if (triangles.size() > size_t(std::numeric_limits<int>::max() / 3)) {
    throw InputError(mesh_location(origin) + std::to_string(triangles.size()) +
                     " triangles are too many to count; split the mesh");
  }
  if (origin.vertex_lines.empty() && origin.triangle_lines.empty()) return;
  if (origin.vertex_lines.size() != size_t(rest.cols()) ||
      origin.triangle_lines.size() != triangles.size()) {
    throw std::logic_error(
        "make_triangle_mesh: origin must hold one line for each vertex and each triangle");
  }
}

void reject_bad_coordinates(const PerParticle3& rest, const MeshOrigin& origin) {
  for (int v = 0; v < int(rest.cols()); ++v) {
    if (!rest.col(v).allFinite())
      throw InputError(vertex_location(origin, v) +
                       "a coordinate is not finite; give numbers in m");
  }
}

void reject_bad_indices(int particles, const std::vector<Triangle>& triangles,
                        const MeshOrigin& origin) {
  for (int t = 0; t < int(triangles.size()); ++t) {
    for (int v : triangles[t]) {
      if (v >= 0 && v < particles) continue;
      throw InputError(triangle_location(origin, t) + "vertex index " + std::to_string(v) +
                       " is out of range; the " + std::to_string(particles) +
                       " vertices are counted from 0");
    }
  }
}

void reject_unused_vertices(int particles, const std::vector<Triangle>& triangles,
                            const MeshOrigin& origin) {
  std::vector<char> used(particles, 0);
  for (const Triangle& triangle : triangles) {
    for (int v : triangle) used[v] = 1;
  }
  const long unused = std::count(used.begin(), used.end(), 0);
  if (unused == 0) return;
  const int first = int(std::find(used.begin(), used.end(), 0) - used.begin());
  throw InputError(vertex_location(origin, first) + "in no triangle, the first of " +
                   std::to_string(unused) +
                   " unused vertices (they would have no mass); remove them, or, if they coincide "
                   "with others, join these by seams of [cloth], or --seams");
}

void reject_zero_areas(const PerParticle3& rest, const std::vector<Triangle>& triangles,
                       const MeshOrigin& origin) {
  for (int t = 0; t < int(triangles.size()); ++t) {
    if (has_area(rest, triangles[t])) continue;
    throw InputError(
        triangle_location(origin, t) + "no area: " + vertex_name(origin, triangles[t][0]) + ", " +
        vertex_name(origin, triangles[t][1]) + " and " + vertex_name(origin, triangles[t][2]) +
        " lie on a line (area at most 1e-12 of the longest side squared); remove or repair the "
        "triangle");
  }
}

// --- edges ---

/// A counting sort by the smaller particle, then a sort of each particle's few sides: linear in the
/// number of triangles.
SideLists list_sides(int particles, const std::vector<Triangle>& triangles) {
  const int halves = 3 * int(triangles.size());
  SideLists lists{std::vector<int>(particles + 1, 0), std::vector<Side>(halves)};
  std::vector<int>& start = lists.start;
  for (int half = 0; half < halves; ++half)
    ++start[std::min(tail(triangles, half), tip(triangles, half)) + 1];
  for (int a = 0; a < particles; ++a) start[a + 1] += start[a];

  std::vector<int> next(start.begin(), start.end() - 1);
  for (int half = 0; half < halves; ++half) {
    const auto [a, b] = std::minmax({tail(triangles, half), tip(triangles, half)});
    lists.sides[next[a]++] = {b, half};
  }
  for (int a = 0; a < particles; ++a) {
    std::sort(lists.sides.begin() + start[a], lists.sides.begin() + start[a + 1]);
  }
  return lists;
}

[[noreturn]] void reject_third_triangle(int a, const Side* first, const MeshOrigin& origin) {
  throw InputError(triangle_location(origin, first[2].half / 3) + edge_name(origin, a, first->b) +
                   " has three triangles or more (" + triangle_name(origin, first[0].half / 3) +
                   ", " + triangle_name(origin, first[1].half / 3) +
                   " and this one); a manifold has one or two. Remove one: repair = \"split\" "
                   "parts fans at a vertex, and cannot tell which two of these stay joined");
}

[[noreturn]] void reject_orientation(int a, const Side* first, const MeshOrigin& origin) {
  throw InputError(triangle_location(origin, first[1].half / 3) +
                   "opposite orientation to its neighbour, " +
                   triangle_name(origin, first[0].half / 3) + ": both run along " +
                   edge_name(origin, a, first->b) +
                   " the same way; reverse the order of one triangle's vertices");
}

/// Triangles at one edge whose third corners are the same, too.
void reject_repeated_triangle(const Side* first, int count, const MeshOrigin& origin,
                              const TriangleMesh& mesh) {
  for (int i = 1; i < std::min(count, 3); ++i)
    for (int k = 0; k < i; ++k)
      if (opposite(mesh.triangles, first[i].half) == opposite(mesh.triangles, first[k].half))
        throw InputError(triangle_location(origin, first[i].half / 3) +
                         "a face given twice: it has the same three corners as " +
                         triangle_name(origin, first[k].half / 3) + "; remove one");
}

/// Appends the edge from a that is common to the `count` sides at `first`, and its hinge if it has
/// two triangles.
void add_edge(int a, const Side* first, int count, const MeshOrigin& origin, TriangleMesh& mesh) {
  reject_repeated_triangle(first, count, origin, mesh);
  if (count > 2) reject_third_triangle(a, first, origin);
  if (count == 1) {
    mesh.edges.push_back({a, first->b, {first->half / 3, -1}});
    return;
  }
  // forward runs from a to b: its triangle holds x1
  int forward = first[0].half, backward = first[1].half;
  if (tail(mesh.triangles, forward) != a) std::swap(forward, backward);
  if (tail(mesh.triangles, forward) != a || tail(mesh.triangles, backward) == a)
    reject_orientation(a, first, origin);
  const int x1 = opposite(mesh.triangles, forward), x2 = opposite(mesh.triangles, backward);
  mesh.hinges.push_back({{x1, x2, a, first->b}, int(mesh.edges.size())});
  mesh.edges.push_back({a, first->b, {forward / 3, backward / 3}});
}

void find_edges(const SideLists& lists, const MeshOrigin& origin, TriangleMesh& mesh) {
  mesh.edges.reserve(lists.sides.size() / 2 + lists.sides.size() / 32);
  mesh.hinges.reserve(lists.sides.size() / 2);
  for (int a = 0; a < mesh.particles(); ++a) {
    int i = lists.start[a];
    while (i < lists.start[a + 1]) {
      int count = 1;
      while (i + count < lists.start[a + 1] && lists.sides[i + count].b == lists.sides[i].b)
        ++count;
      add_edge(a, &lists.sides[i], count, origin, mesh);
      i += count;
    }
  }
}

// --- vertices ---

int root(std::vector<int>& parent, int corner) {
  while (parent[corner] != corner) corner = parent[corner] = parent[parent[corner]];
  return corner;
}

/// The corner of triangle t that is the particle v.
int corner_of(const std::vector<Triangle>& triangles, int t, int v) {
  return 3 * t + (triangles[t][0] == v ? 0 : triangles[t][1] == v ? 1 : 2);
}

void reject_several_fans(const TriangleMesh& mesh, const MeshOrigin& origin) {
  const std::vector<int> fans = fans_of(mesh);
  std::vector<int> fan(mesh.particles(), -1);  // the first corner of each vertex's fan
  for (int corner = 0; corner < int(fans.size()); ++corner) {
    int& known = fan[tail(mesh.triangles, corner)];
    if (known < 0) known = fans[corner];
    if (known == fans[corner]) continue;
    throw InputError(vertex_location(origin, tail(mesh.triangles, corner)) +
                     "its triangles form more than one fan (" + triangle_name(origin, known / 3) +
                     " and " + triangle_name(origin, corner / 3) +
                     " meet in this vertex only); give each fan a vertex of its own, or, for "
                     "cloth, set repair = \"split\"");
  }
}

}  // namespace

TriangleMesh make_mesh_of_fans(PerParticle3 rest, std::vector<Triangle> triangles,
                               const MeshOrigin& origin) {
  const int particles = int(rest.cols());
  reject_bad_sizes(rest, triangles, origin);
  reject_bad_coordinates(rest, origin);
  reject_bad_indices(particles, triangles, origin);
  reject_unused_vertices(particles, triangles, origin);
  reject_zero_areas(rest, triangles, origin);

  TriangleMesh mesh{std::move(rest), std::move(triangles), {}, {}};
  find_edges(list_sides(particles, mesh.triangles), origin, mesh);
  return mesh;
}

/// Joins corners across all hinges.
std::vector<int> fans_of(const TriangleMesh& mesh) {
  std::vector<int> parent(3 * mesh.triangles.size());
  for (int corner = 0; corner < int(parent.size()); ++corner) parent[corner] = corner;
  for (const Edge& edge : mesh.edges) {
    if (edge.triangles[1] < 0) continue;
    for (int v : {edge.a, edge.b}) {
      const int left = root(parent, corner_of(mesh.triangles, edge.triangles[0], v));
      const int right = root(parent, corner_of(mesh.triangles, edge.triangles[1], v));
      parent[std::max(left, right)] = std::min(left, right);
    }
  }
  for (int corner = 0; corner < int(parent.size()); ++corner) parent[corner] = root(parent, corner);
  return parent;
}

TriangleMesh make_triangle_mesh(PerParticle3 rest, std::vector<Triangle> triangles,
                                const MeshOrigin& origin) {
  TriangleMesh mesh = make_mesh_of_fans(std::move(rest), std::move(triangles), origin);
  reject_several_fans(mesh, origin);
  return mesh;
}

// Independent of scale: the sides are divided by their largest component first, so that squares
// neither overflow nor vanish.
bool has_area(const PerParticle3& rest, const Triangle& triangle) {
  Vector3 side1 = rest.col(triangle[1]) - rest.col(triangle[0]);
  Vector3 side2 = rest.col(triangle[2]) - rest.col(triangle[0]);
  const double scale = std::max(side1.cwiseAbs().maxCoeff(), side2.cwiseAbs().maxCoeff());
  side1 /= scale;
  side2 /= scale;
  const double longest_squared =
      std::max({side1.squaredNorm(), side2.squaredNorm(), (side2 - side1).squaredNorm()});
  return 0.5 * side1.cross(side2).norm() > 1e-12 * longest_squared;
}

Eigen::VectorXd triangle_areas(const std::vector<Triangle>& triangles, const PerParticle3& x) {
  Eigen::VectorXd areas(triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t) {
    const Vector3 side1 = x.col(triangles[t][1]) - x.col(triangles[t][0]);
    const Vector3 side2 = x.col(triangles[t][2]) - x.col(triangles[t][0]);
    areas[t] = 0.5 * side1.cross(side2).norm();
  }
  return areas;
}

double smallest_height(const std::vector<Triangle>& triangles, const PerParticle3& x) {
  const Eigen::VectorXd areas = triangle_areas(triangles, x);
  double least = std::numeric_limits<double>::infinity();
  for (size_t t = 0; t < triangles.size(); ++t)
    for (size_t k = 0; k < 3; ++k) {
      const Vector3 side = x.col(triangles[t][k]) - x.col(triangles[t][(k + 1) % 3]);
      least = std::min(least, 2 * areas[Eigen::Index(t)] / side.norm());
    }
  return least;
}

Eigen::VectorXd rest_areas(const TriangleMesh& mesh) {
  if (mesh.pattern.empty()) return triangle_areas(mesh.triangles, mesh.rest);
  Eigen::VectorXd areas(mesh.pattern.size());
  for (size_t t = 0; t < mesh.pattern.size(); ++t) {
    const auto& [a, b, c] = mesh.pattern[t];
    const Eigen::Vector2d side1 = b - a, side2 = c - a;
    areas[Eigen::Index(t)] = 0.5 * std::abs(side1.x() * side2.y() - side1.y() * side2.x());
  }
  return areas;
}

PerParticle lumped_masses(const TriangleMesh& mesh, double density) {
  return lumped_masses(mesh, std::vector<double>(mesh.triangles.size(), density));
}

PerParticle lumped_masses(const TriangleMesh& mesh, const std::vector<double>& densities) {
  for (const double density : densities)
    if (!(density > 0) || !std::isfinite(density)) {
      std::ostringstream message;
      message << "lumped_masses: density is " << density << " kg/m^2; give a positive, finite one";
      throw InputError(message.str());
    }
  const Eigen::VectorXd areas = rest_areas(mesh);
  PerParticle masses = PerParticle::Zero(mesh.particles());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int v : mesh.triangles[t]) masses[v] += densities[t] * areas[t] / 3;
  }
  return masses;
}

Eigen::VectorXd rest_lengths(const TriangleMesh& mesh) {
  Eigen::VectorXd lengths(mesh.edges.size());
  if (mesh.pattern.empty()) {
    for (size_t e = 0; e < mesh.edges.size(); ++e) {
      lengths[e] = (mesh.rest.col(mesh.edges[e].b) - mesh.rest.col(mesh.edges[e].a)).norm();
    }
    return lengths;
  }
  const std::vector<std::array<EdgeSide, 2>> sides = edge_sides(mesh);
  for (size_t e = 0; e < sides.size(); ++e) {
    const auto& [one, other] = sides[e];
    // of each: stiffness A/L^2, tension A/L at the length 0
    const double k1 = one.area / (one.length * one.length),
                 k2 = other.triangle < 0 ? 0 : other.area / (other.length * other.length);
    lengths[e] = one.length == other.length || other.triangle < 0
                     ? one.length
                     : (k1 * one.length + k2 * other.length) / (k1 + k2);
  }
  return lengths;
}

Eigen::VectorXd edge_areas(const TriangleMesh& mesh) {
  const Eigen::VectorXd triangle = rest_areas(mesh);
  Eigen::VectorXd areas(mesh.edges.size());
  for (size_t e = 0; e < mesh.edges.size(); ++e) {
    const std::array<int, 2>& sides = mesh.edges[e].triangles;
    areas[e] = triangle[sides[0]] + (sides[1] < 0 ? 0 : triangle[sides[1]]);
  }
  return areas;
}

std::vector<std::array<EdgeSide, 2>> edge_sides(const TriangleMesh& mesh) {
  const Eigen::VectorXd areas = rest_areas(mesh);
  const auto side_of = [&](const Edge& edge, int t) -> EdgeSide {
    if (t < 0) return {-1, 0, 0};
    if (mesh.pattern.empty())
      return {t, (mesh.rest.col(edge.b) - mesh.rest.col(edge.a)).norm(), areas[t]};
    const FlatTriangle& flat = mesh.pattern[size_t(t)];
    const int a = corner_of(mesh.triangles, t, edge.a) - 3 * t,
              b = corner_of(mesh.triangles, t, edge.b) - 3 * t;
    return {t, (flat[size_t(b)] - flat[size_t(a)]).norm(), areas[t]};
  };
  std::vector<std::array<EdgeSide, 2>> sides;
  sides.reserve(mesh.edges.size());
  for (const Edge& edge : mesh.edges)
    sides.push_back({side_of(edge, edge.triangles[0]), side_of(edge, edge.triangles[1])});
  return sides;
}

int euler_characteristic(const TriangleMesh& mesh) {
  return mesh.particles() - int(mesh.edges.size()) + int(mesh.triangles.size());
}

}  // namespace foldproof
