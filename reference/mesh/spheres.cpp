#include <array>
#include <cmath>
#include <utility>

#include "reference/mesh/shapes.h"

namespace foldproof {
namespace {

/// Three golden rectangles span the icosahedron: vertices (0, +-1, +-g) and their cyclic
/// permutations, with g = (1 + sqrt 5)/2; here normalised.
TriangleMesh icosahedron() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  PerParticle3 x(3, 12);
  x << 0, 0, 0, 0, 1, 1, -1, -1, g, -g, g, -g,  //
      1, 1, -1, -1, g, -g, g, -g, 0, 0, 0, 0,   //
      g, -g, g, -g, 0, 0, 0, 0, 1, 1, -1, -1;
  x.colwise().normalize();
  return make_triangle_mesh(
      x, {{0, 2, 8},  {0, 8, 4},  {0, 4, 6},  {0, 6, 9},  {0, 9, 2},  {2, 5, 8},  {8, 5, 10},
          {8, 10, 4}, {4, 10, 1}, {4, 1, 6},  {6, 1, 11}, {6, 11, 9}, {9, 11, 7}, {9, 7, 2},
          {2, 7, 5},  {3, 10, 5}, {3, 1, 10}, {3, 11, 1}, {3, 7, 11}, {3, 5, 7}});
}

/// The numbers of the vertices of a mesh whose edges are divided: its own, then parts - 1 on each
/// edge, then those inside each triangle.
class DividedNumbers {
 public:
  DividedNumbers(const TriangleMesh& mesh, int parts)
      : mesh_(mesh), parts_(parts), sides_(mesh.triangles.size()) {
    for (int e = 0; e < int(mesh.edges.size()); ++e) {
      const Edge& edge = mesh.edges[e];
      for (int t : edge.triangles) {
        for (int k = 0; t >= 0 && k < 3; ++k) {
          const int from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
          if (std::minmax(from, to) == std::minmax(edge.a, edge.b)) sides_[t][k] = e;
        }
      }
    }
  }

  int count() const { return first_inside() + int(mesh_.triangles.size()) * inside(); }

  /// `steps` parts from the end a of the edge, 0 < steps < parts.
  int on_edge(int edge, int steps) const {
    return mesh_.particles() + edge * (parts_ - 1) + steps - 1;
  }

  /// i parts from the triangle's first corner towards its second, and j towards its third.
  int in_triangle(int t, int i, int j) const {
    const int k = parts_ - i - j;
    if (k == parts_) return mesh_.triangles[t][0];
    if (i == parts_) return mesh_.triangles[t][1];
    if (j == parts_) return mesh_.triangles[t][2];
    if (j == 0) return on_side(t, 0, i);
    if (k == 0) return on_side(t, 1, j);
    if (i == 0) return on_side(t, 2, k);
    const int in_rows_before = (j - 1) * (parts_ - 1) - j * (j - 1) / 2;
    return first_inside() + t * inside() + in_rows_before + i - 1;
  }

 private:
  int inside() const { return (parts_ - 1) * (parts_ - 2) / 2; }
  int first_inside() const { return mesh_.particles() + int(mesh_.edges.size()) * (parts_ - 1); }

  /// `steps` parts from corner k of the triangle towards the next one.
  int on_side(int t, int k, int steps) const {
    const int edge = sides_[t][k];
    return on_edge(edge, mesh_.edges[edge].a == mesh_.triangles[t][k] ? steps : parts_ - steps);
  }

  const TriangleMesh& mesh_;
  int parts_;
  std::vector<std::array<int, 3>> sides_;  // [t][k]: the edge from corner k to the next
};

void require_radius(const char* name, double radius) {
  if (!(radius > 0) || !std::isfinite(radius))
    reject_argument(name, radius, "give a positive length in m");
}

}  // namespace

TriangleMesh divide_edges(const TriangleMesh& mesh, int parts) {
  if (parts < 1) reject_argument("divided: parts", parts, "give 1 or more");
  const DividedNumbers numbers(mesh, parts);
  const auto share = [parts](int steps) { return double(steps) / parts; };
  PerParticle3 x(3, numbers.count());
  x.leftCols(mesh.particles()) = mesh.rest;
  for (int e = 0; e < int(mesh.edges.size()); ++e) {
    const Edge& edge = mesh.edges[e];
    for (int k = 1; k < parts; ++k)
      x.col(numbers.on_edge(e, k)) =
          share(parts - k) * mesh.rest.col(edge.a) + share(k) * mesh.rest.col(edge.b);
  }
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.triangles.size() * size_t(parts) * size_t(parts));
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    for (int j = 1; j < parts; ++j)
      for (int i = 1; i + j < parts; ++i)
        x.col(numbers.in_triangle(t, i, j)) = share(parts - i - j) * mesh.rest.col(a) +
                                              share(i) * mesh.rest.col(b) +
                                              share(j) * mesh.rest.col(c);
    const auto vertex = [&](int i, int j) { return numbers.in_triangle(t, i, j); };
    for (int j = 0; j < parts; ++j)
      for (int i = 0; i + j < parts; ++i)
        triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
    for (int j = 0; j + 1 < parts; ++j)
      for (int i = 0; i + j + 1 < parts; ++i)
        triangles.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
  }
  return make_triangle_mesh(std::move(x), std::move(triangles));
}

TriangleMesh make_icosphere(double radius, int subdivisions) {
  require_radius("make_icosphere: radius", radius);
  if (subdivisions < 0 || subdivisions > 9)
    reject_argument("make_icosphere: subdivisions", subdivisions, "give 0 to 9");
  TriangleMesh mesh = icosahedron();
  for (int level = 0; level < subdivisions; ++level) {
    mesh = divide_edges(mesh, 2);
    mesh.rest.colwise().normalize();
  }
  mesh.rest *= radius;
  return mesh;
}

TriangleMesh make_geodesic_sphere(double radius, int divisions) {
  require_radius("make_geodesic_sphere: radius", radius);
  if (divisions < 1 || divisions > 512)
    reject_argument("make_geodesic_sphere: divisions", divisions, "give 1 to 512");
  TriangleMesh mesh = divide_edges(icosahedron(), divisions);
  mesh.rest.colwise().normalize();
  mesh.rest *= radius;
  return mesh;
}

}  // namespace foldproof
