#include "reference/mesh/pattern.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "reference/mesh/mesh_locations.h"

namespace foldproof {

namespace {

/// The two axes of the plane that the vertices lie in, to a millionth of their extent.
std::array<int, 2> axes_of(const TriangleSoup& flat) {
  const Vector3 size = flat.rest.rowwise().maxCoeff() - flat.rest.rowwise().minCoeff();
  int thin = 2;
  for (const int axis : {0, 1})
    if (size[axis] < size[thin]) thin = axis;
  if (!(size[thin] <= 1e-6 * size.maxCoeff()))
    throw InputError(mesh_location(flat.origin) +
                     "the pattern is not flat; lay all panels into one plane, such as z = 0");
  return {(thin + 1) % 3, (thin + 2) % 3};
}

int corner_in(const Triangle& triangle, int particle) {
  return int(std::ranges::find(triangle, particle) - triangle.begin());
}

double length_in(const TriangleMesh& mesh, int t, const Edge& edge) {
  const FlatTriangle& flat = mesh.pattern[size_t(t)];
  const Triangle& triangle = mesh.triangles[size_t(t)];
  return (flat[size_t(corner_in(triangle, edge.b))] - flat[size_t(corner_in(triangle, edge.a))])
      .norm();
}

/// Whether both triangles of an edge have it at the same place of the pattern.
bool is_seam(const TriangleMesh& mesh, const Edge& edge) {
  if (edge.triangles[1] < 0) return false;
  const auto place_of = [&](int side, int particle) {
    const auto t = size_t(edge.triangles[size_t(side)]);
    return mesh.pattern[t][size_t(corner_in(mesh.triangles[t], particle))];
  };
  return place_of(0, edge.a) != place_of(1, edge.a) || place_of(0, edge.b) != place_of(1, edge.b);
}

void reject_no_area(const FlatTriangle& corners, int t, const MeshOrigin& origin) {
  const Eigen::Vector2d a = corners[1] - corners[0], b = corners[2] - corners[0];
  if (!(std::abs(a.x() * b.y() - a.y() * b.x()) >
        1e-12 * std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()})))
    throw InputError(triangle_location(origin, t) + "no area in the pattern");
}

}  // namespace

std::vector<FlatTriangle> pattern_of(const TriangleSoup& flat, double scale,
                                     const TriangleMesh& cloth) {
  if (flat.triangles.size() != cloth.triangles.size())
    throw InputError(mesh_location(flat.origin) + "the pattern has " +
                     std::to_string(flat.triangles.size()) + " triangles and the cloth " +
                     std::to_string(cloth.triangles.size()) + "; both need the same faces");
  const auto [first, second] = axes_of(flat);
  std::vector<int> particle_of(size_t(flat.rest.cols()), -1);
  std::vector<FlatTriangle> pattern;
  for (size_t t = 0; t < flat.triangles.size(); ++t) {
    FlatTriangle corners;
    for (size_t k = 0; k < 3; ++k) {
      const int vertex = flat.triangles[t][k];
      int& particle = particle_of[size_t(vertex)];
      if (particle < 0) particle = cloth.triangles[t][k];
      if (particle != cloth.triangles[t][k])
        throw InputError(triangle_location(flat.origin, int(t)) +
                         "no triangle of the cloth has its place in the list and its neighbours; "
                         "export pattern and cloth with the same faces in the same order, as "
                         "triangles");
      corners[k] = scale * Eigen::Vector2d(flat.rest(first, vertex), flat.rest(second, vertex));
    }
    reject_no_area(corners, int(t), flat.origin);
    pattern.push_back(corners);
  }
  return pattern;
}

std::vector<FlatTriangle> pattern_of_textures(std::vector<FlatTriangle> textures, double scale,
                                              const MeshOrigin& origin) {
  if (textures.empty())
    throw InputError(mesh_location(origin) +
                     "not every corner of its faces has texture coordinates (f a/b); the pattern "
                     "\"vt\" is made of them");
  for (size_t t = 0; t < textures.size(); ++t) {
    for (Eigen::Vector2d& corner : textures[t]) corner *= scale;
    reject_no_area(textures[t], int(t), origin);
  }
  return textures;
}

TriangleMesh flat_panels(const TriangleMesh& mesh) {
  if (mesh.pattern.empty()) return mesh;
  // a vertex of the panels for each fan of a particle that is not parted by a seam
  std::vector<int> parent(3 * mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int corner) {
    while (parent[size_t(corner)] != corner) corner = parent[size_t(corner)];
    return corner;
  };
  for (const Edge& edge : mesh.edges) {
    if (edge.triangles[1] < 0 || is_seam(mesh, edge)) continue;
    for (const int particle : {edge.a, edge.b}) {
      const auto corner_of = [&](int t) {
        return 3 * t + corner_in(mesh.triangles[size_t(t)], particle);
      };
      const int one = root(corner_of(edge.triangles[0])),
                other = root(corner_of(edge.triangles[1]));
      parent[size_t(std::max(one, other))] = std::min(one, other);
    }
  }
  std::map<int, int> vertex_of;
  std::vector<Triangle> triangles(mesh.triangles.size());
  std::vector<Eigen::Vector2d> places;
  for (size_t t = 0; t < triangles.size(); ++t)
    for (size_t k = 0; k < 3; ++k) {
      const auto [at, is_new] = vertex_of.try_emplace(root(int(3 * t + k)), int(places.size()));
      if (is_new) places.push_back(mesh.pattern[t][k]);
      triangles[t][k] = at->second;
    }
  PerParticle3 rest = PerParticle3::Zero(3, Eigen::Index(places.size()));
  for (size_t v = 0; v < places.size(); ++v) rest.col(Eigen::Index(v)).head<2>() = places[v];
  return make_triangle_mesh(std::move(rest), std::move(triangles));
}

std::vector<FlatTriangle> divided_pattern(const TriangleMesh& mesh,
                                          const std::vector<Triangle>& quarters) {
  if (mesh.pattern.empty()) return {};
  std::vector<FlatTriangle> divided;
  divided.reserve(quarters.size());
  for (size_t q = 0; q < quarters.size(); ++q) {
    const FlatTriangle& flat = mesh.pattern[q / 4];
    const Triangle& triangle = mesh.triangles[q / 4];
    FlatTriangle corners;
    for (size_t k = 0; k < 3; ++k) {
      const int vertex = quarters[q][k];
      if (vertex < mesh.particles()) {
        corners[k] = flat[size_t(corner_in(triangle, vertex))];
        continue;
      }
      const Edge& edge = mesh.edges[size_t(vertex - mesh.particles())];
      corners[k] =
          (flat[size_t(corner_in(triangle, edge.a))] + flat[size_t(corner_in(triangle, edge.b))]) /
          2;
    }
    divided.push_back(corners);
  }
  return divided;
}

PatternFacts facts_of_pattern(const TriangleMesh& mesh, const PerParticle3& x) {
  PatternFacts facts;
  facts.area = rest_areas(mesh).sum();
  std::vector<int> panel(mesh.triangles.size());
  std::iota(panel.begin(), panel.end(), 0);
  const auto root = [&](int t) {
    while (panel[size_t(t)] != t) t = panel[size_t(t)];
    return t;
  };
  for (const Edge& edge : mesh.edges) {
    if (edge.triangles[1] < 0) continue;
    if (!is_seam(mesh, edge)) {
      const int one = root(edge.triangles[0]), other = root(edge.triangles[1]);
      panel[size_t(std::max(one, other))] = std::min(one, other);
      continue;
    }
    const double one = length_in(mesh, edge.triangles[0], edge),
                 other = length_in(mesh, edge.triangles[1], edge);
    facts.seams += std::max(one, other);
    facts.ease = std::max(facts.ease, 2 * std::abs(one - other) / (one + other));
  }
  for (int t = 0; t < int(panel.size()); ++t) facts.panels += panel[size_t(t)] == t;
  const Eigen::VectorXd rest = rest_lengths(mesh);
  facts.least = std::numeric_limits<double>::infinity();
  for (size_t e = 0; e < mesh.edges.size(); ++e) {
    const double ratio =
        (x.col(mesh.edges[e].b) - x.col(mesh.edges[e].a)).norm() / rest[Eigen::Index(e)];
    facts.least = std::min(facts.least, ratio);
    facts.greatest = std::max(facts.greatest, ratio);
  }
  return facts;
}

}  // namespace foldproof
