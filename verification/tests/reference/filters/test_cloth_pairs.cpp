// The broad phase: which pairs it finds, in which order, at which cost, and what a
// search ahead finds.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "reference/filters/cloth_pairs.h"
#include "reference/filters/pair_search.h"

using namespace foldproof;

namespace {

/// A jittered sheet of columns x rows cells in the plane.
TriangleMesh sheet(int columns, int rows, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.2, 0.2);
  PerParticle3 rest(3, (columns + 1) * (rows + 1));
  std::vector<Triangle> triangles;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const int p = j * (columns + 1) + i;
      rest.col(p) << i + jitter(random), j + jitter(random), 0;
      if (i == columns || j == rows) continue;
      triangles.push_back({p, p + 1, p + columns + 2});
      triangles.push_back({p, p + columns + 2, p + columns + 1});
    }
  return make_triangle_mesh(rest, triangles);
}

/// The sheet crumpled: every particle displaced at random.
PerParticle3 crumpled(const PerParticle3& x, double by, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-by, by);
  return 0.5 * x + PerParticle3::NullaryExpr(3, x.cols(), [&] { return shift(random); });
}

using Key = std::array<int, 5>;
Key key_of(const FeaturePair& pair) {
  const auto& p = pair.particles;
  if (pair.kind == PairKind::vertex_triangle) return {0, p[0], p[1], p[2], p[3]};
  const auto e = std::minmax(p[0], p[1]), f = std::minmax(p[2], p[3]);
  return e < f ? Key{1, e.first, e.second, f.first, f.second}
               : Key{1, f.first, f.second, e.first, e.second};
}
std::vector<Key> keys_of(const std::vector<FeaturePair>& pairs) {
  std::vector<Key> keys;
  for (const FeaturePair& pair : pairs) keys.push_back(key_of(pair));
  return keys;
}

/// The box over the ways of some particles, widened by half the margin.
Bounds box_of(const PerParticle3& x, const PerParticle3& end, double margin,
              std::initializer_list<int> particles) {
  Bounds box;
  for (const int i : particles) {
    box.extend(Vector3(x.col(i).cwiseMin(end.col(i)) - Vector3::Constant(margin / 2)));
    box.extend(Vector3(x.col(i).cwiseMax(end.col(i)) + Vector3::Constant(margin / 2)));
  }
  return box;
}

/// All pairs whose boxes overlap, by asking each.
std::set<Key> pairs_by_force(const TriangleMesh& mesh, const PerParticle3& x,
                             const PerParticle3& end, double margin,
                             const std::vector<char>& moved) {
  std::set<Key> keys;
  const auto add = [&](const FeaturePair& pair) {
    if (moved.empty() || std::any_of(pair.particles.begin(), pair.particles.end(),
                                     [&](int i) { return moved[size_t(i)]; }))
      keys.insert(key_of(pair));
  };
  for (int i = 0; i < mesh.particles(); ++i)
    for (const Triangle& t : mesh.triangles)
      if (std::find(t.begin(), t.end(), i) == t.end() &&
          box_of(x, end, margin, {i}).intersects(box_of(x, end, margin, {t[0], t[1], t[2]})))
        add({PairKind::vertex_triangle, {i, t[0], t[1], t[2]}});
  for (const Edge& e : mesh.edges)
    for (const Edge& f : mesh.edges)
      if (e.a != f.a && e.a != f.b && e.b != f.a && e.b != f.b &&
          box_of(x, end, margin, {e.a, e.b}).intersects(box_of(x, end, margin, {f.a, f.b})))
        add({PairKind::edge_edge, {e.a, e.b, f.a, f.b}});
  return keys;
}

/// The order in which the tree's triangles are compared, and the number of box tests: below a node
/// the left, then the right, then the two against each other, the one with more triangles opened
/// first. Only what moved and overlaps is opened.
struct Traversal {
  const ClothTree& cloth;
  const PerParticle3 &x, &end;
  double margin;
  const std::vector<char>& moved;
  long box_tests = 0;
  std::vector<std::pair<int, int>> compared = {};

  Bounds box(int t) const {
    const Triangle& corners = cloth.triangles[size_t(t)];
    return box_of(x, end, margin, {corners[0], corners[1], corners[2]});
  }
  bool has_moved(int t) const {
    const Triangle& corners = cloth.triangles[size_t(t)];
    return moved.empty() ||
           std::any_of(corners.begin(), corners.end(), [&](int i) { return moved[size_t(i)]; });
  }
  std::vector<int> items(const BoxNode& node) const {
    const auto first = cloth.tree.order.begin() + node.first;
    return {first, first + node.count};
  }
  bool any_moved(const BoxNode& node) const {
    const std::vector<int> all = items(node);
    return std::any_of(all.begin(), all.end(), [&](int t) { return has_moved(t); });
  }
  Bounds bounds(const BoxNode& node) const {
    Bounds all;
    for (const int t : items(node)) all.extend(box(t));
    return all;
  }
  void compare(int s, int t) {
    if (!has_moved(s) && !has_moved(t)) return;
    ++box_tests;
    if (box(s).intersects(box(t))) compared.emplace_back(s, t);
  }
  void within(int n) {
    const BoxNode& node = cloth.tree.nodes[size_t(n)];
    if (!any_moved(node)) return;
    const std::vector<int> all = items(node);
    if (node.right < 0) {
      for (size_t i = 0; i < all.size(); ++i)
        for (size_t j = i + 1; j < all.size(); ++j) compare(all[i], all[j]);
      return;
    }
    within(n + 1);
    within(node.right);
    between(n + 1, node.right);
  }
  void between(int a, int b) {
    ++box_tests;
    const BoxNode &at_a = cloth.tree.nodes[size_t(a)], &at_b = cloth.tree.nodes[size_t(b)];
    if (!any_moved(at_a) && !any_moved(at_b)) return;
    if (!bounds(at_a).intersects(bounds(at_b))) return;
    const bool leaf_a = at_a.right < 0, leaf_b = at_b.right < 0;
    if (leaf_a && leaf_b) {
      for (const int s : items(at_a))
        for (const int t : items(at_b)) compare(s, t);
    } else if (leaf_b || (!leaf_a && at_a.count >= at_b.count)) {
      between(a + 1, b);
      between(at_a.right, b);
    } else {
      between(a, b + 1);
      between(a, at_b.right);
    }
  }
};

/// The pairs of features that the compared triangles own, in order.
std::vector<Key> pairs_in_order(const Traversal& of, const std::set<Key>& wanted) {
  std::vector<Key> keys;
  const auto take = [&](const FeaturePair& pair) {
    if (wanted.count(key_of(pair))) keys.push_back(key_of(pair));
  };
  for (const auto& [s, t] : of.compared) {
    const Triangle &at_s = of.cloth.triangles[size_t(s)], &at_t = of.cloth.triangles[size_t(t)];
    const OwnedFeatures &own_s = of.cloth.own[size_t(s)], &own_t = of.cloth.own[size_t(t)];
    for (size_t k = 0; k < 3; ++k) {
      if (own_s.corner[k]) take({PairKind::vertex_triangle, {at_s[k], at_t[0], at_t[1], at_t[2]}});
      if (own_t.corner[k]) take({PairKind::vertex_triangle, {at_t[k], at_s[0], at_s[1], at_s[2]}});
    }
    for (size_t k = 0; k < 3; ++k)
      for (size_t l = 0; l < 3; ++l)
        if (own_s.side[k] && own_t.side[l])
          take({PairKind::edge_edge, {at_s[k], at_s[(k + 1) % 3], at_t[l], at_t[(l + 1) % 3]}});
  }
  return keys;
}

std::vector<char> some_moved(int particles, int every) {
  std::vector<char> moved(size_t(particles), 0);
  for (size_t i = 2; i < moved.size(); i += size_t(every)) moved[i] = 1;
  return moved;
}

}  // namespace

TEST_CASE("each vertex and each edge is owned by the first of its triangles") {
  const TriangleMesh mesh = sheet(4, 3, 5);
  const ClothTree cloth = make_cloth_tree(mesh);
  CHECK(cloth.team.threads() == 1);
  CHECK(cloth.triangles == mesh.triangles);
  CHECK(cloth.mean_edge == Approx(rest_lengths(mesh).mean()).epsilon(1e-14));
  std::vector<int> first_of(size_t(mesh.particles()), -1);
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (size_t k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      int& first = first_of[size_t(a)];
      CHECK(cloth.own[t].corner[k] == (first < 0));
      if (first < 0) first = int(t);
      const auto edge = std::find_if(mesh.edges.begin(), mesh.edges.end(), [&](const Edge& e) {
        return e.a == std::min(a, b) && e.b == std::max(a, b);
      });
      CHECK(cloth.own[t].side[k] == (edge->triangles[0] == int(t)));
    }
}

TEST_CASE("leaves of the tree hold four triangles at most") {
  const ClothTree cloth = make_cloth_tree(sheet(4, 3, 5));
  int largest = 0;
  for (const BoxNode& node : cloth.tree.nodes)
    if (node.right < 0) largest = std::max(largest, node.count);
  CHECK(largest == 3);  // 24, 12, 6, 3
  CHECK(make_cloth_tree(sheet(2, 1, 5)).tree.nodes.size() == 1);
  CHECK(make_cloth_tree(sheet(5, 1, 5)).tree.nodes.size() == 7);  // 10; 5, 5; 2, 3, 2, 3
}

TEST_CASE("a search finds the pairs whose boxes overlap, each once, in the tree's order") {
  for (const auto& [columns, rows, by] :
       {std::tuple(4, 3, 0.3), std::tuple(7, 2, 0.15), std::tuple(5, 6, 0.5)}) {
    const TriangleMesh mesh = sheet(columns, rows, unsigned(columns));
    ClothTree cloth = make_cloth_tree(mesh);
    const PerParticle3 x = crumpled(mesh.rest, by, 3), end = x + 0.1 * crumpled(mesh.rest, 1.3, 8);
    for (const std::vector<char>& moved :
         {std::vector<char>{}, some_moved(mesh.particles(), 11), some_moved(mesh.particles(), 3)})
      for (const double margin : {0.0, 0.07}) {
        const std::set<Key> wanted = pairs_by_force(mesh, x, end, margin, moved);
        Traversal traversal{cloth, x, end, margin, moved};
        traversal.within(0);
        const std::vector<Key> in_order = pairs_in_order(traversal, wanted);
        CHECK(in_order.size() == wanted.size());
        for (const int threads : {1, 3}) {
          cloth.team = threads;
          const PairSearch found = counted_near_pairs(cloth, x, end, margin, moved);
          CHECK(keys_of(found.pairs) == in_order);
          CHECK(found.box_tests == traversal.box_tests);
          CHECK(keys_of(near_pairs(cloth, x, end, margin, moved)) == in_order);
        }
        cloth.team = 1;
      }
  }
}

TEST_CASE("a search of several threads compares the same boxes") {
  const TriangleMesh mesh = sheet(9, 8, 4);
  ClothTree cloth = make_cloth_tree(mesh);
  const PerParticle3 x = crumpled(mesh.rest, 0.2, 3);
  const PairSearch alone = counted_near_pairs(cloth, x, x, 0.02);
  cloth.team = 2;
  const PairSearch together = counted_near_pairs(cloth, x, x, 0.02);
  CHECK(keys_of(together.pairs) == keys_of(alone.pairs));
  CHECK(together.box_tests == alone.box_tests);
}

TEST_CASE("a tree that is one leaf is searched by several threads as by one") {
  const TriangleMesh mesh = sheet(2, 1, 4);
  ClothTree cloth = make_cloth_tree(mesh);
  const PairSearch alone = counted_near_pairs(cloth, mesh.rest, mesh.rest, 0.7);
  CHECK(alone.box_tests == 6);
  CHECK(alone.pairs.size() > 3);
  cloth.team = 3;
  const PairSearch together = counted_near_pairs(cloth, mesh.rest, mesh.rest, 0.7);
  CHECK(keys_of(together.pairs) == keys_of(alone.pairs));
  CHECK(together.box_tests == 6);
}

TEST_CASE("what did not move is not searched") {
  // four patches of four triangles, far apart in a row: leaves of their own
  PerParticle3 rest(3, 20);
  std::vector<Triangle> triangles;
  for (int patch = 0; patch < 4; ++patch) {
    const int p = 5 * patch;
    const double x = 10 * patch;
    rest.col(p) << x, 0, 0;
    rest.col(p + 1) << x + 1.2, 0.1, 0;
    rest.col(p + 2) << x + 1.1, 1.3, 0;
    rest.col(p + 3) << x - 0.1, 1.1, 0;
    rest.col(p + 4) << x + 0.5, 0.6, 0;
    for (int k = 0; k < 4; ++k) triangles.push_back({p + k, p + (k + 1) % 4, p + 4});
  }
  const TriangleMesh mesh = make_triangle_mesh(rest, triangles);
  const ClothTree cloth = make_cloth_tree(mesh);
  const auto box_tests = [&](const std::vector<char>& moved) {
    return counted_near_pairs(cloth, rest, rest, 0.01, moved).box_tests;
  };
  // six pairs in each patch, and three pairs of nodes
  CHECK(box_tests({}) == 27);
  CHECK(box_tests(std::vector<char>(20, 1)) == 27);
  // a corner of the first patch has two of its four triangles: five of its pairs; its node against
  // the next patch, and one half against the other
  std::vector<char> moved(20, 0);
  moved[0] = 1;
  CHECK(box_tests(moved) == 7);
  std::fill(moved.begin(), moved.end(), 0);
  moved[19] = 1;  // the middle of the last patch
  CHECK(box_tests(moved) == 8);
  std::fill(moved.begin(), moved.end(), 0);
  CHECK(box_tests(moved) == 0);
}

TEST_CASE("a pair has moved if any of its particles has, or if nothing says what has") {
  const FeaturePair pair{PairKind::edge_edge, {4, 1, 2, 0}};
  CHECK(has_moved_particle(pair, {}));
  CHECK(has_moved_particle(pair, {1, 0, 0, 0, 0}));
  CHECK(has_moved_particle(pair, {0, 0, 0, 0, 1}));
  CHECK_FALSE(has_moved_particle(pair, {0, 0, 0, 1, 0}));
}

TEST_CASE("a search ahead holds until a particle's box leaves the one that it was made with") {
  const TriangleMesh mesh = sheet(3, 2, 5);
  ClothTree cloth = make_cloth_tree(mesh);
  PerParticle3 rest = (mesh.rest * 64).array().round() / 64;  // sums below are exact
  for (const int threads : {1, 2}) {
    cloth.team = threads;
    const PairsAhead ahead = pairs_ahead(cloth, rest, 0.5);
    CHECK(ahead.team.threads() == threads);
    CHECK(int(ahead.boxes.size()) == mesh.particles());
    CHECK(ahead.boxes[3].min() == rest.col(3) - Vector3::Constant(0.25));
    CHECK(ahead.boxes[3].max() == rest.col(3) + Vector3::Constant(0.25));
    CHECK(keys_of(ahead.pairs) == keys_of(near_pairs(cloth, rest, rest, 0.5)));
    CHECK(is_inside(ahead, rest, 0.5));
    CHECK_FALSE(is_inside(ahead, rest, 0.53125));
    for (const Eigen::Index particle : {Eigen::Index(0), rest.cols() - 1})
      for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
          PerParticle3 x = rest;
          x(axis, particle) += side * 0.125;
          CHECK(is_inside(ahead, x, 0.25));
          CHECK(pairs_among(ahead, x, rest, 0.25));
          CHECK(pairs_among(ahead, rest, x, 0.25));
          x(axis, particle) += side * 0.015625;
          CHECK_FALSE(is_inside(ahead, x, 0.25));
          CHECK_FALSE(pairs_among(ahead, x, rest, 0.25));
          CHECK_FALSE(pairs_among(ahead, rest, x, 0.25));
        }
  }
}

TEST_CASE("a search ahead answers as a new search does, in its order") {
  const TriangleMesh mesh = sheet(5, 4, 5);
  ClothTree cloth = make_cloth_tree(mesh);
  const PerParticle3 x = crumpled(mesh.rest, 0.3, 3),
                     now = x + 0.02 * crumpled(mesh.rest, 1, 9).array().sin().matrix(),
                     end = x - 0.03 * crumpled(mesh.rest, 1, 4).array().sin().matrix();
  for (const int threads : {1, 3}) {
    cloth.team = threads;
    const PairsAhead ahead = pairs_ahead(cloth, x, 0.2);
    for (const std::vector<char>& moved : {std::vector<char>{}, some_moved(mesh.particles(), 7)}) {
      const auto pairs = pairs_among(ahead, now, end, 0.05, moved);
      REQUIRE(pairs);
      const std::vector<Key> wanted = keys_of(near_pairs(cloth, now, end, 0.05, moved));
      CHECK(keys_of(*pairs) == wanted);
      CHECK(wanted.size() < ahead.pairs.size());
      CHECK(wanted.size() > 5);
    }
  }
}
