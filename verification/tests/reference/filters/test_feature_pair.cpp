// Nearest points of two features where several are equally near, and when they approach.
#include <catch2/catch.hpp>

#include "reference/filters/approach.h"
#include "reference/filters/feature_pair.h"

using namespace foldproof;

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
