// Repulsion of close layers: impulses of a pair, friction, and which pairs bear load.
#include <catch2/catch.hpp>

#include "reference/filters/repulsion.h"

using namespace foldproof;

namespace {

const FeaturePair vertex_over_triangle{PairKind::vertex_triangle, {0, 1, 2, 3}};

/// How many of the pairs repel each other weakly at rest, in a step of 0.5.
long count_repelled(const std::vector<FeaturePair>& pairs, const PerParticle3& x,
                    double thickness = 0.5, int threads = 1) {
  PerParticle3 v = PerParticle3::Zero(3, x.cols());
  return repel(pairs, x, {thickness, 1e-3, 0, 8, true}, 0.5, PerParticle::Constant(x.cols(), 0.3),
               v, threads);
}

PerParticle3 columns(std::initializer_list<Vector3> of) {
  PerParticle3 x(3, Eigen::Index(of.size()));
  Eigen::Index i = 0;
  for (const Vector3& column : of) x.col(i++) = column;
  return x;
}

}  // namespace

TEST_CASE("a pair's impulses change its relative velocity as asked, shared by weights and masses") {
  const FeaturePair pair{PairKind::edge_edge, {4, 1, 2, 0}};
  const Eigen::Vector4d w(0.25, 0.75, -0.4, -0.6);
  const PerParticle inverse_mass = (PerParticle(5) << 0.5, 0, 0.3, 9, 0.2).finished();
  const Vector3 change(0.3, -0.7, 1.1);
  PerParticle3 v(3, 5);
  v << 1, 2, 3, 4, 5, 6, 7, 8, 9, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5;
  const PerParticle3 before = v;
  push_apart(pair, w, change, inverse_mass, v);
  const double compliance = 0.0625 * 0.2 + 0.16 * 0.3 + 0.36 * 0.5;
  CHECK((v.col(4) - before.col(4) - 0.25 * 0.2 / compliance * change).norm() < 1e-14);
  CHECK(v.col(1) == before.col(1));
  CHECK((v.col(2) - before.col(2) + 0.4 * 0.3 / compliance * change).norm() < 1e-14);
  CHECK((v.col(0) - before.col(0) + 0.6 * 0.5 / compliance * change).norm() < 1e-14);
  CHECK(v.col(3) == before.col(3));

  v = before;
  push_apart(pair, w, change, PerParticle::Zero(5), v);
  CHECK(v == before);
  // nor is there an impulse where the only free particle has no weight
  push_apart(pair, {1, 0, -0.4, -0.6}, change, (PerParticle(5) << 0, 0.3, 0, 9, 0).finished(), v);
  CHECK(v == before);
}

TEST_CASE("repulsion stops an approach and takes away a tenth of the overlap in a step at most") {
  // a vertex 0.006 above the point of a triangle with the weights 0.2, 0.3 and 0.5
  const Eigen::Vector4d weights(1, -0.2, -0.3, -0.5);
  PerParticle3 x = columns({{0, 0, 0}, {0.1, 0.2, 0.5}, {1.1, 0.3, 0.5}, {0.2, 1.4, 0.5}});
  x.col(0) = Vector3(0, 0, 0.006) - x.rightCols(3) * weights.tail(3);
  const PerParticle masses = (PerParticle(4) << 0.3, 0.7, 0.2, 0.4).finished();  // inverse ones
  const auto check = [&](const Vector3& relative, double stiffness, double friction,
                         const Vector3& after, const PerParticle& inverse_mass, long pairs) {
    PerParticle3 v(3, 4);
    v.rightCols(3) << 0.3, -0.1, 0.6, 0.2, 0.9, -0.4, -0.7, 0.5, 0.1;
    v.col(0) = relative - v.rightCols(3) * weights.tail(3);
    const SelfCollisionSettings settings{0.01, stiffness, friction, 8, true};
    CHECK(repel({vertex_over_triangle}, x, settings, 0.02, inverse_mass, v, 1) == pairs);
    CHECK((v * weights - after).norm() < 1e-12);
  };
  // the overlap is 0.004, so a tenth of it over the step is 0.02; the compliance is
  // 0.3 + 0.04 * 0.7 + 0.09 * 0.2 + 0.25 * 0.4
  constexpr double soft = 0.02 * 90 * 0.004 * 0.446;
  check({0.2, -0.1, -0.3}, 1e9, 0, {0.2, -0.1, 0.02}, masses, 1);
  check({0.2, -0.1, -0.3}, 90, 0, {0.2, -0.1, soft}, masses, 1);
  // parting, but slowly; fast enough; with friction against the push; prescribed
  check({0.2, -0.1, 0.015}, 1e9, 0, {0.2, -0.1, 0.02}, masses, 1);
  check({0.2, -0.1, 0.015}, 90, 0, {0.2, -0.1, 0.015 + soft}, masses, 1);
  check({0.2, -0.1, 0.021}, 1e9, 0.7, {0.2, -0.1, 0.021}, masses, 0);
  check({0.3, -0.4, -0.08}, 1e9, 0.6, {0.3 * 0.88, -0.4 * 0.88, 0.02}, masses, 1);
  check({0.2, -0.1, -0.3}, 1e9, 0.7, {0.2, -0.1, -0.3}, PerParticle::Zero(4), 0);
}

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
