// The broad phase: which pairs it finds, in which order, and at which cost.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "reference/filters/cloth_pairs.h"
#include "reference/filters/pair_search.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

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

/// The pairs among `wanted` in the order in which the tree's triangles are compared, and the number
/// of box tests: below a node the left, then the right, then the two against each other, the one
/// with more triangles opened first. Only what moved and overlaps is opened.
struct Traversal {
  const ClothTree& cloth;
  const PerParticle3 &x, &end;
  double margin;
  const std::vector<char>& moved;
  const std::set<Key>& wanted;
  long box_tests = 0;
  std::vector<Key> found = {};

  /// Of some triangles.
  Bounds bounds(const std::vector<int>& some) const {
    Bounds all;
    for (const int t : some)
      for (const int i : cloth.triangles[size_t(t)]) all.extend(box_of(x, end, margin, {i}));
    return all;
  }
  bool any_moved(const std::vector<int>& some) const {
    return moved.empty() || std::any_of(some.begin(), some.end(), [&](int t) {
             const Triangle& corners = cloth.triangles[size_t(t)];
             return std::any_of(corners.begin(), corners.end(),
                                [&](int i) { return moved[size_t(i)]; });
           });
  }
  std::vector<int> items(const BoxNode& node) const {
    const auto first = cloth.tree.order.begin() + node.first;
    return {first, first + node.count};
  }
  void take(const FeaturePair& pair) {
    if (wanted.count(key_of(pair))) found.push_back(key_of(pair));
  }
  /// The pairs of features that the two triangles own.
  void compare(int s, int t) {
    if (!any_moved({s, t})) return;
    ++box_tests;
    if (!bounds({s}).intersects(bounds({t}))) return;
    const Triangle &at_s = cloth.triangles[size_t(s)], &at_t = cloth.triangles[size_t(t)];
    const OwnedFeatures &own_s = cloth.own[size_t(s)], &own_t = cloth.own[size_t(t)];
    for (size_t k = 0; k < 3; ++k) {
      if (own_s.corner[k]) take({PairKind::vertex_triangle, {at_s[k], at_t[0], at_t[1], at_t[2]}});
      if (own_t.corner[k]) take({PairKind::vertex_triangle, {at_t[k], at_s[0], at_s[1], at_s[2]}});
    }
    for (size_t k = 0; k < 3; ++k)
      for (size_t l = 0; l < 3; ++l)
        if (own_s.side[k] && own_t.side[l])
          take({PairKind::edge_edge, {at_s[k], at_s[(k + 1) % 3], at_t[l], at_t[(l + 1) % 3]}});
  }
  void within(int n) {
    const BoxNode& node = cloth.tree.nodes[size_t(n)];
    const std::vector<int> all = items(node);
    if (!any_moved(all)) return;
    if (node.right >= 0) return within(n + 1), within(node.right), between(n + 1, node.right);
    for (size_t i = 0; i < all.size(); ++i)
      for (size_t j = i + 1; j < all.size(); ++j) compare(all[i], all[j]);
  }
  void between(int a, int b) {
    ++box_tests;
    const BoxNode &at_a = cloth.tree.nodes[size_t(a)], &at_b = cloth.tree.nodes[size_t(b)];
    const std::vector<int> in_a = items(at_a), in_b = items(at_b);
    if (!any_moved(in_a) && !any_moved(in_b)) return;
    if (!bounds(in_a).intersects(bounds(in_b))) return;
    if (at_a.right < 0 && at_b.right < 0) {
      for (const int s : in_a)
        for (const int t : in_b) compare(s, t);
    } else if (at_b.right < 0 || (at_a.right >= 0 && in_a.size() >= in_b.size())) {
      between(a + 1, b);
      between(at_a.right, b);
    } else {
      between(a, b + 1);
      between(a, at_b.right);
    }
  }
};

std::vector<char> some_moved(int particles, int every) {
  std::vector<char> moved(size_t(particles), 0);
  for (size_t i = 2; i < moved.size(); i += size_t(every)) moved[i] = 1;
  return moved;
}

}  // namespace

TEST_CASE("a search finds the pairs whose boxes overlap, each once, in the tree's order") {
  for (const auto& [columns, rows, by] :
       {std::tuple(4, 3, 0.3), std::tuple(7, 2, 0.15), std::tuple(5, 6, 0.5),
        std::tuple(2, 1, 0.5)}) {  // the last tree is one leaf
    const TriangleMesh mesh =
        make_sheet({SheetPattern::one_diagonal, 1. * columns, 1. * rows, columns, rows});
    ClothTree cloth = make_cloth_tree(mesh);
    const PerParticle3 x = crumpled(mesh.rest, by, 3), end = x + 0.1 * crumpled(mesh.rest, 1.3, 8);
    for (const std::vector<char>& moved :
         {std::vector<char>{}, some_moved(mesh.particles(), 11), some_moved(mesh.particles(), 3)})
      for (const double margin : {0.0, 0.07}) {
        const std::set<Key> wanted = pairs_by_force(mesh, x, end, margin, moved);
        Traversal traversal{cloth, x, end, margin, moved, wanted};
        traversal.within(0);
        CHECK(traversal.found.size() == wanted.size());
        for (const int threads : {1, 3}) {
          cloth.team = threads;
          const PairSearch found = counted_near_pairs(cloth, x, end, margin, moved);
          CHECK(keys_of(found.pairs) == traversal.found);
          CHECK(found.box_tests == traversal.box_tests);
        }
      }
  }
}
