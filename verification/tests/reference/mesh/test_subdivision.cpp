// Subdivision: weights and triangles by Loop's rules, from the triangles alone.
#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "reference/mesh/shapes.h"
#include "reference/mesh/subdivision.h"

using namespace foldproof;

namespace {

using Pair = std::pair<int, int>;

struct Expected {
  Eigen::MatrixXd weights;
  std::vector<Triangle> triangles;
};

/// One level, by the printed rules: new vertices in the order of their edges' ends.
Expected by_the_rules(const std::vector<Triangle>& triangles, int particles, bool is_loop) {
  std::map<Pair, std::vector<int>> across;  // of each edge, the other corners of its triangles
  for (const Triangle& t : triangles)
    for (size_t k = 0; k < 3; ++k)
      across[std::minmax({t[k], t[(k + 1) % 3]})].push_back(t[(k + 2) % 3]);
  std::vector<std::set<int>> near{size_t(particles)}, rim{size_t(particles)};
  std::map<Pair, int> number;
  for (const auto& [ends, corners] : across) {
    number[ends] = particles + int(number.size());
    for (const auto& [from, to] : {ends, Pair{ends.second, ends.first}}) {
      near[size_t(from)].insert(to);
      if (corners.size() == 1) rim[size_t(from)].insert(to);
    }
  }
  Expected expected{Eigen::MatrixXd::Zero(particles + int(number.size()), particles), {}};
  Eigen::MatrixXd& weights = expected.weights;
  for (int v = 0; v < particles; ++v) {
    weights(v, v) = 1;
    if (!is_loop) continue;
    const std::set<int>& around = rim[size_t(v)].empty() ? near[size_t(v)] : rim[size_t(v)];
    const double n = double(around.size());
    const double share = rim[size_t(v)].empty()
                             ? (0.625 - std::pow(0.375 + 0.25 * std::cos(2 * pi / n), 2)) / n
                             : 0.125;
    weights(v, v) = 1 - n * share;
    for (const int w : around) weights(v, w) = share;
  }
  for (const auto& [ends, row] : number) {
    const std::vector<int>& corners = across[ends];
    const bool is_smooth = is_loop && corners.size() == 2;
    weights(row, ends.first) = weights(row, ends.second) = is_smooth ? 0.375 : 0.5;
    if (is_smooth) weights(row, corners[0]) = weights(row, corners[1]) = 0.125;
  }
  const auto middle = [&](int a, int b) { return number.at(std::minmax({a, b})); };
  for (const auto& [a, b, c] : triangles) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Triangle& t : {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
      expected.triangles.push_back(t);
  }
  return expected;
}

void check_levels(const TriangleMesh& mesh, SubdivisionRule rule) {
  const bool is_loop = rule == SubdivisionRule::loop;
  const Expected once = by_the_rules(mesh.triangles, mesh.particles(), is_loop);
  const Expected twice = by_the_rules(once.triangles, int(once.weights.rows()), is_loop);
  const Subdivision first = subdivision(mesh, rule, 1), second = subdivision(mesh, rule, 2);
  CHECK(first.triangles == once.triangles);
  CHECK((Eigen::MatrixXd(first.weights) - once.weights).cwiseAbs().maxCoeff() < 1e-15);
  CHECK(second.triangles == twice.triangles);
  CHECK((Eigen::MatrixXd(second.weights) - twice.weights * once.weights).cwiseAbs().maxCoeff() <
        1e-15);
  CHECK((second.of(mesh.rest) - mesh.rest * (twice.weights * once.weights).transpose())
            .cwiseAbs()
            .maxCoeff() < 1e-14);
}

}  // namespace

TEST_CASE("one level and two have the weights and triangles of the rules") {
  const TriangleMesh closed = make_icosphere(0.7, 0),
                     open = make_sheet({SheetPattern::union_jack, 1.3, 0.9, 5, 3}),
                     random = make_sheet({SheetPattern::random_delaunay, 1.3, 0.9, 4, 3, 0, 5});
  for (const SubdivisionRule rule : {SubdivisionRule::midpoint, SubdivisionRule::loop})
    for (const TriangleMesh* mesh : {&closed, &open, &random}) check_levels(*mesh, rule);
}

TEST_CASE("no level is the cloth itself, eight the most") {
  const TriangleMesh mesh = make_hinge(0.7, 0.3);
  for (const SubdivisionRule rule : {SubdivisionRule::midpoint, SubdivisionRule::loop}) {
    const Subdivision none = subdivision(mesh, rule, 0);
    CHECK(none.triangles == mesh.triangles);
    CHECK(Eigen::MatrixXd(none.weights) == Eigen::MatrixXd::Identity(4, 4));
    CHECK(none.of(mesh.rest) == mesh.rest);
  }
  PerParticle3 x(3, 3);
  x << 0, 3, 1, 0, 1, 4, 2, 0, 1;
  const TriangleMesh one = make_triangle_mesh(x, {{0, 1, 2}});
  CHECK(subdivision(one, SubdivisionRule::midpoint, 8).triangles.size() == 65536);
  for (const int levels : {-1, 9})
    CHECK_THROWS_WITH(subdivision(one, SubdivisionRule::loop, levels),
                      "subdivision has 0 to 8 levels, not " + std::to_string(levels) +
                          "; each makes four triangles of one");
}
