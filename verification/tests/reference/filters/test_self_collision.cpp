// Self-collision: pairs of features, repulsion, and rims.
#include <catch2/catch.hpp>

#include "reference/filters/approach.h"
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

const FeaturePair vertex_over_triangle{PairKind::vertex_triangle, {0, 1, 2, 3}};

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

TEST_CASE("pairs repel below the thickness and apart, two edges if they are nearest inside both") {
  const auto vertex = [](double height, double thickness) {
    return count_repelled({vertex_over_triangle},
                          columns({{0.5, 0.5, height}, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}}),
                          thickness);
  };
  CHECK(vertex(0.25, 0.2500001) == 1);
  CHECK(vertex(0.25, 0.25) == 0);
  CHECK(vertex(0, 0.25) == 0);
  const auto edges = [](double x, double y) {
    return count_repelled({{PairKind::edge_edge, {0, 1, 2, 3}}},
                          columns({{-1, 0, 0}, {2, 0, 0}, {x, y, 0.25}, {x, 2, 0.25}}));
  };
  CHECK(edges(0.5, -1) == 1);
  CHECK(edges(0.5, 0.125) == 0);
  CHECK(edges(2.125, -1) == 0);
}

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

TEST_CASE("neither an edge nor another vertex takes away the load that a vertex bears at a rim") {
  // vertex 0 stands beyond the rim of 1-2-3, 0.25 away; its edge 0-4 crosses the edge 5-6 0.125
  // above; vertex 7 is nearer to the triangle
  PerParticle3 x(3, 8);
  x << 1, 0, 2, 1, 1, 0, 2, 0.5, -0.25, 0, 0, 2, -2.25, -1.25, -1.25, -0.0625, 0, 0, 0, 0, 0, 0.125,
      0.125, 0;
  const FeaturePair rim{PairKind::vertex_triangle, {0, 1, 2, 3}},
      edges{PairKind::edge_edge, {0, 4, 5, 6}}, nearer{PairKind::vertex_triangle, {7, 1, 2, 3}},
      far{PairKind::vertex_triangle, {4, 1, 2, 3}}, at_an_end{PairKind::edge_edge, {0, 4, 1, 2}};
  CHECK(count_repelled({far, at_an_end, edges, far, rim, at_an_end, nearer}, x, 0.5, 3) == 3);
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

TEST_CASE("of points that are equally near, those at the first end stay") {
  const auto edges = [](double a, double b, double c, double d) {
    return Eigen::Vector4d(
        nearness(PairKind::edge_edge, columns({a, 0, 0}, {b, 0, 0}, {c, 0, 2}, {d, 0, 2})).weights);
  };
  CHECK(edges(0, 4, 1, 3) == Eigen::Vector4d(0.75, 0.25, -1, 0));
  CHECK(edges(1, 3, 0, 4) == Eigen::Vector4d(1, 0, -0.75, -0.25));
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

TEST_CASE("an approach is reported halfway between the distance kept and one half more") {
  for (const PairKind kind : {PairKind::vertex_triangle, PairKind::edge_edge}) {
    // the first feature sinks by `way` against the second in a parallel plane, `height` below it,
    // and both drift: one plane parts them
    const auto approach = [&](double height, double way) {
      const bool is_vertex = kind == PairKind::vertex_triangle;
      const Corners4 x =
          is_vertex ? columns({0.5, 0.25, height}, {0, 0, 0}, {2, 0, 0}, {0, 2, 0})
                    : columns({-1, 0.5, height}, {2, 0.5, height}, {0.5, -1, 0}, {0.5, 2, 0});
      Corners4 displacement = Corners4::Zero();
      displacement.leftCols(is_vertex ? 1 : 2).row(2).setConstant(-way);
      return first_approach(kind, x.colwise() + Vector3(0.5, -0.75, 3),
                            displacement.colwise() + Vector3(-0.25, 2, 4), 0.125);
    };
    // far: kept 0.125, reported within 0.1875, the plane's gap 0.15625
    const std::optional<Approach> met = approach(0.875, 0.75);
    REQUIRE(met);
    CHECK(met->time == 0.71875 / 0.75);
    CHECK(met->at.distance == Approx(0.15625).epsilon(1e-14));
    CHECK(met->at.normal == Vector3(0, 0, 1));
    for (const double way : {0.71875, 0.5, 0.0, -3.0})  // the first ends there
      CHECK_FALSE(approach(0.875, way));
    // between one and two such distances half of the rest may be used up; nearer, half is kept
    for (const auto& [height, reached] : {std::pair(0.15625, 0.1328125), std::pair(0.125, 0.078125),
                                          std::pair(0.0625, 0.0390625), std::pair(0.0, 0.0)}) {
      const std::optional<Approach> near = approach(height, 1);
      REQUIRE(near);
      CHECK(near->time == Approx(height - reached).epsilon(1e-14));
      if (height > 0) CHECK_FALSE(approach(height, 0.02));
    }
    CHECK(approach(0, 0));  // touching features have nothing left to keep
  }
}
