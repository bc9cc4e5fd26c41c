// The broad phase: which pairs it finds, and in which order.
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

std::vector<char> some_moved(int particles, int every) {
  std::vector<char> moved(size_t(particles), 0);
  for (size_t i = 2; i < moved.size(); i += size_t(every)) moved[i] = 1;
  return moved;
}

}  // namespace

TEST_CASE("a search finds the pairs whose boxes overlap, each once, in one order on any threads") {
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
        const std::vector<Key> found = keys_of(near_pairs(cloth, x, end, margin, moved));
        CHECK(found.size() == wanted.size());
        CHECK(std::set<Key>(found.begin(), found.end()) == wanted);
        cloth.team = 3;
        CHECK(keys_of(near_pairs(cloth, x, end, margin, moved)) == found);
        cloth.team = 1;
      }
  }
}
