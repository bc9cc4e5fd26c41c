#include "reference/mesh/subdivision.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace foldproof {

namespace {

using Weights = std::vector<Eigen::Triplet<double>>;

/// The corner of the triangle that is not on the edge.
int across(const Triangle& triangle, const Edge& edge) {
  for (int corner : triangle)
    if (corner != edge.a && corner != edge.b) return corner;
  throw InputError("a triangle with two equal corners has none across an edge");
}

//       c          Loop: 3/8 of a and b, 1/8 of c and d; on the border, and for midpoints, half of
//     /   \.       a and b.
//   a --+-- b
//     \   /
//       d
void add_edge_points(const TriangleMesh& mesh, SubdivisionRule rule, Weights& weights) {
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const Edge& edge = mesh.edges[e];
    const int row = mesh.particles() + int(e);
    const bool is_smooth = rule == SubdivisionRule::loop && edge.triangles[1] >= 0;
    for (int end : {edge.a, edge.b}) weights.emplace_back(row, end, is_smooth ? 3.0 / 8 : 0.5);
    if (!is_smooth) continue;
    for (int t : edge.triangles)
      weights.emplace_back(row, across(mesh.triangles[size_t(t)], edge), 1.0 / 8);
  }
}

/// Neighbours of each particle, and those along the border.
struct Neighbours {
  std::vector<std::vector<int>> all, on_border;
};

Neighbours neighbours_of(const TriangleMesh& mesh) {
  Neighbours found{std::vector<std::vector<int>>(size_t(mesh.particles())),
                   std::vector<std::vector<int>>(size_t(mesh.particles()))};
  for (const Edge& edge : mesh.edges) {
    for (const auto& [from, to] : {std::pair{edge.a, edge.b}, std::pair{edge.b, edge.a}}) {
      found.all[size_t(from)].push_back(to);
      if (edge.triangles[1] < 0) found.on_border[size_t(from)].push_back(to);
    }
  }
  return found;
}

/// Loop's weight for each of the n neighbours of an inner particle; 1/16 for n = 6.
double share_of_neighbour(std::size_t n) {
  const double slope = 3.0 / 8 + std::cos(2 * pi / double(n)) / 4;
  return (5.0 / 8 - slope * slope) / double(n);
}

/// Inside: an equal weight for each neighbour, the rest for the vertex itself. On the border: 1/8
/// for each neighbour along it.
void add_old_points(const TriangleMesh& mesh, SubdivisionRule rule, Weights& weights) {
  const Neighbours neighbours = neighbours_of(mesh);
  for (int i = 0; i < mesh.particles(); ++i) {
    const std::vector<int>& border = neighbours.on_border[size_t(i)];
    const std::vector<int>& around = border.empty() ? neighbours.all[size_t(i)] : border;
    const double share = rule == SubdivisionRule::midpoint ? 0
                         : border.empty()                  ? share_of_neighbour(around.size())
                                                           : 1.0 / 8;
    weights.emplace_back(i, i, 1 - share * double(around.size()));
    if (share == 0) continue;
    for (int other : around) weights.emplace_back(i, other, share);
  }
}

std::vector<Triangle> quarter_triangles(const TriangleMesh& mesh) {
  const auto middle = [&](int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const auto before = [](const Edge& edge, const std::pair<int, int>& ends) {
      return std::pair{edge.a, edge.b} < ends;
    };
    const auto edge =
        std::lower_bound(mesh.edges.begin(), mesh.edges.end(), std::pair{low, high}, before);
    return mesh.particles() + int(edge - mesh.edges.begin());
  };
  std::vector<Triangle> quarters;
  for (const auto& [a, b, c] : mesh.triangles) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Triangle& part : {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
      quarters.push_back(part);
  }
  return quarters;
}

Subdivision one_level(const TriangleMesh& mesh, SubdivisionRule rule) {
  Weights weights;
  add_old_points(mesh, rule, weights);
  add_edge_points(mesh, rule, weights);
  Subdivision finer{quarter_triangles(mesh), {}};
  finer.weights.resize(mesh.particles() + Eigen::Index(mesh.edges.size()), mesh.particles());
  finer.weights.setFromTriplets(weights.begin(), weights.end());
  return finer;
}

}  // namespace

Subdivision subdivision(const TriangleMesh& mesh, SubdivisionRule rule, int levels) {
  if (levels < 0 || levels > 8)
    throw InputError("subdivision has 0 to 8 levels, not " + std::to_string(levels) +
                     "; each makes four triangles of one");
  Subdivision all{mesh.triangles, {}};
  all.weights.resize(mesh.particles(), mesh.particles());
  all.weights.setIdentity();
  TriangleMesh current = mesh;
  for (int level = 0; level < levels; ++level) {
    const Subdivision next = one_level(current, rule);
    all = {next.triangles, next.weights * all.weights};
    current = make_triangle_mesh(all.of(mesh.rest), all.triangles);
  }
  return all;
}

}  // namespace foldproof
