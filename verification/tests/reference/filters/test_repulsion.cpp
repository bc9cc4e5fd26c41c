// Repulsion of close layers: which pairs bear load.
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
