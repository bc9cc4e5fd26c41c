// Self-collision: pairs of features, repulsion, and rims.
#include <catch2/catch.hpp>

#include "reference/filters/feature_pair.h"
#include "reference/filters/repulsion.h"
#include "reference/filters/self_collision.h"

using namespace foldproof;

namespace {

SelfCollision filter_of(const TriangleMesh& mesh, const SelfCollisionSettings& settings,
                        const PerParticle& inverse_mass) {
  PerParticle mass = PerParticle::Constant(inverse_mass.size(), 0.8);
  for (Eigen::Index i = 0; i < mass.size(); ++i)
    if (inverse_mass[i] > 0) mass[i] = 1 / inverse_mass[i];
  return {settings, make_cloth_tree(mesh), mass, inverse_mass};
}

State at_rest(const PerParticle3& x) { return {0.3, x, PerParticle3::Zero(3, x.cols())}; }

const Span step{1, 1.1, 0.1};
}  // namespace

TEST_CASE("a vertex within the thickness of a rim is stopped before it, not pushed back") {
  // it slides over a triangle that is nearer, so that the rim bears no load
  PerParticle3 x(3, 9), v = PerParticle3::Zero(3, 9);
  x << 0, -1, -1, 0.05, 0.05, 4, -3, 1, -3, 0, 0.3, -0.4, -2, 2, 0, -3, 0, 3, 0.04, 2, 2.2, 0.04,
      0.04, 0.04, 0, 0, 0;
  v(0, 0) = 0.5;
  PerParticle w = PerParticle::Zero(9);
  w.head(3).setConstant(0.7);
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}});
  Work work;
  filter_of(mesh, {0.06, 0, 0, 8, true}, w).correct(step, at_rest(x), v, work);
  CHECK(work.crossings == 1);
  CHECK(v.norm() < 1e-13);
}

TEST_CASE("particles are tangled in triangles that cross, and pairs whose particles all are go") {
  const std::vector<Triangle> mesh{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {2, 9, 10}};
  const std::vector<char> tangled = tangled_particles({{0, 2}}, mesh, 12);
  CHECK(tangled == std::vector<char>{1, 1, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0});
  std::vector<FeaturePair> pairs{{PairKind::edge_edge, {0, 1, 6, 7}},
                                 {PairKind::vertex_triangle, {3, 6, 7, 8}},
                                 {PairKind::vertex_triangle, {1, 6, 7, 8}},
                                 {PairKind::edge_edge, {0, 1, 6, 11}}};
  remove_tangled_pairs(tangled, pairs);
  REQUIRE(pairs.size() == 2);
  CHECK(pairs[0].particles == std::array<int, 4>{3, 6, 7, 8});
  CHECK(pairs[1].particles == std::array<int, 4>{0, 1, 6, 11});
}

namespace {

/// How many of the pairs repel each other weakly at rest, in a step of 0.5.
long count_repelled(const std::vector<FeaturePair>& pairs, const PerParticle3& x,
                    double thickness = 0.5, int threads = 1) {
  PerParticle3 v = PerParticle3::Zero(3, x.cols());
  return repel(pairs, x, {thickness, 1e-3, 0, 8, true}, {}, 0.5,
               PerParticle::Constant(x.cols(), 0.3), v, threads);
}

PerParticle3 columns(std::initializer_list<Vector3> of) {
  PerParticle3 x(3, Eigen::Index(of.size()));
  Eigen::Index i = 0;
  for (const Vector3& column : of) x.col(i++) = column;
  return x;
}

}  // namespace

TEST_CASE("a vertex bears load over a rim only if no triangle is nearer") {
  // two sides of a roof with the ridge 1-2
  const FeaturePair side{PairKind::vertex_triangle, {0, 1, 2, 3}},
      other{PairKind::vertex_triangle, {0, 2, 1, 4}};
  const auto bearing = [&](const std::vector<FeaturePair>& pairs, const Vector3& vertex) {
    return count_repelled(pairs, columns({vertex, {0, 0, 0}, {2, 0, 0}, {1, 1, -1}, {1, -1, -1}}));
  };
  // above the ridge: as near to one side as to the other
  CHECK(bearing({side, other}, {0.5, 0, 0.25}) == 2);
  CHECK(bearing({side}, {0.5, 0, 0.25}) == 1);
  // above one side, which is nearer than the other's rim, in either order
  CHECK(bearing({side, other}, {1, 0.25, 0}) == 1);
  CHECK(bearing({other, side}, {1, 0.25, 0}) == 1);
  CHECK(bearing({other}, {1, 0.25, 0}) == 1);
}

namespace {

Corners4 columns(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  Corners4 x;
  x << a, b, c, d;
  return x;
}

}  // namespace

TEST_CASE("an edge without length is touched at its first end") {
  const Vector3 from(0.3, 1.2, -0.7), along(1.1, -0.4, 0.9), point = from - 0.5 * along;
  const Nearness at = nearness(PairKind::edge_edge, columns(from, from + along, point, point));
  CHECK(at.weights == Eigen::Vector4d(1, 0, -1, 0));
  CHECK(at.distance == Approx(0.5 * along.norm()));
}

TEST_CASE("features that touch are at no distance and have no normal") {
  const Nearness vertex = nearness(PairKind::vertex_triangle,
                                   columns({1, 2, 0.5}, {0, 0, 0.5}, {4, 0, 0.5}, {0, 4, 0.5}));
  CHECK(vertex.weights == Eigen::Vector4d(1, -0.25, -0.25, -0.5));
  for (const Nearness& at :
       {vertex, nearness(PairKind::edge_edge, columns({0, 0, 0}, {4, 0, 0}, {1, -1, 0}, {1, 3, 0})),
        nearness(PairKind::edge_edge, Corners4::Constant(0.3))}) {
    CHECK(at.distance == 0);
    CHECK(at.normal == Vector3::Zero());
  }
}
