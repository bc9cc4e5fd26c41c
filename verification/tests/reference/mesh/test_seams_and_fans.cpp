// Vertices that are merged, and vertices that are split.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "reference/mesh/seams.h"
#include "reference/mesh/shapes.h"
#include "reference/mesh/split_fans.h"

using namespace foldproof;

namespace {

PerParticle3 matrix_of(const std::vector<Vector3>& places) {
  PerParticle3 x(3, Eigen::Index(places.size()));
  for (size_t v = 0; v < places.size(); ++v) x.col(Eigen::Index(v)) = places[v];
  return x;
}

std::string refusal_of(const TriangleSoup& soup, double distance) {
  try {
    close_seams(soup, distance);
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

const std::vector<Vector3> far_apart{{40, 3, -7}, {20, 4, 90}, {-30, 50, 2}};

/// Whether a vertex at p merges with one at q.
bool merges(const Vector3& p, const Vector3& q, double distance) {
  std::vector<Vector3> places{p, far_apart[0], far_apart[1], q};
  return close_seams({matrix_of(places), {{0, 1, 2}}, {}}, distance).rest.cols() == 3;
}

}  // namespace

TEST_CASE("vertices merge with the first one that stays, and the others are renumbered in order") {
  // 0 and 2 are near; 4 is near 2, not 0, and stays; 5 is near 4 and, nearer to it, to 6
  TriangleSoup panels{matrix_of({{0.1, 0.2, -0.3},
                                 {7, 0, 0},
                                 {0.3, 0.2, -0.3},
                                 {0, 7, 0},
                                 {0.5, 0.2, -0.3},
                                 {0.7, 0.2, -0.3},
                                 {0.74, 0.2, -0.3},
                                 {0, 0, 7}}),
                      {{0, 1, 3}, {7, 2, 1}, {3, 4, 7}, {5, 1, 3}, {1, 6, 7}},
                      {"panels.obj", {2, 3, 5, 7, 11, 13, 17, 19}, {23, 29, 31, 37, 41}}};
  const TriangleSoup sewn = close_seams(panels, 0.25);
  CHECK(sewn.rest ==
        matrix_of({{0.1, 0.2, -0.3}, {7, 0, 0}, {0, 7, 0}, {0.5, 0.2, -0.3}, {0, 0, 7}}));
  CHECK(sewn.triangles ==
        std::vector<Triangle>{{0, 1, 2}, {4, 0, 1}, {2, 3, 4}, {3, 1, 2}, {1, 3, 4}});
  CHECK(sewn.origin.file == "panels.obj");
  CHECK(sewn.origin.vertex_lines == std::vector<int>{2, 3, 7, 11, 19});
  CHECK(sewn.origin.triangle_lines == panels.origin.triangle_lines);
  panels.origin = {};
  CHECK(close_seams(panels, 0.25).origin.vertex_lines.empty());
  CHECK(close_seams(panels, 0.03).rest == panels.rest);
}

TEST_CASE("vertices merge at the distance itself, not beyond, in every direction") {
  for (const double distance : {0.25, 4.0})
    for (const Vector3& place :
         {Vector3(0, 0, 0), Vector3(-3, 5.75, 1.5), Vector3(0.75, -0.25, -9)})
      for (const double x : {-1.0, 0.0, 1.0})
        for (const double y : {-1.0, 0.0, 1.0})
          for (const double z : {-1.0, 0.0, 1.0}) {
            const Vector3 way = distance * Vector3(x, y, z);
            CHECK(merges(place, place + way, distance) == (way.norm() <= distance));
            CHECK(merges(place, place + 0.55 * way, distance));  // at most 0.96 of the distance
          }
  CHECK(merges({3, 4, 1}, {6, 8, 1}, 5));
  CHECK_FALSE(merges({3, 4, 1}, {6, 8, 1}, std::nextafter(5, 0)));
}

TEST_CASE("of two vertices within the distance the first counts, not the nearer one") {
  for (const double sign : {-1.0, 1.0}) {
    const PerParticle3 x = matrix_of({{sign * 0.9, 0.5, 0.5},
                                      {-sign * 0.2, 0.5, 0.5},
                                      {sign * 0.1, 0.5, 0.5},
                                      far_apart[0],
                                      far_apart[1]});
    const TriangleSoup sewn = close_seams({x, {{2, 3, 4}}, {}}, 1);
    CHECK(sewn.rest.cols() == 4);
    CHECK(sewn.triangles[0] == Triangle{0, 2, 3});
  }
}

TEST_CASE("a triangle that a seam would fold up is refused, whichever two corners merge") {
  const PerParticle3 x = matrix_of({{0, 0, 0}, {5, 0, 0}, {0, 5, 0}, {0, 0, 5}, {0.1, 0, 0}});
  for (const Triangle& bad : {Triangle{0, 4, 1}, {1, 4, 0}, {4, 2, 0}, {4, 0, 3}}) {
    CHECK(refusal_of({x, {{0, 1, 2}, {4, 2, 3}, bad}, {}}, 0.2) ==
          "mesh: triangle 2: two corners of this triangle are so near that a seam would join them; "
          "give a smaller distance");
    CHECK(refusal_of({x, {bad}, {"a.obj", {1, 2, 3, 4, 5}, {9}}}, 0.2).starts_with("a.obj:9: two"));
    CHECK(refusal_of({x, {bad}, {}}, 0.05) == "not refused");
  }
}

TEST_CASE("seams refuse distances and coordinates that are not finite numbers, with their place") {
  PerParticle3 x = matrix_of(far_apart);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -0.3, infinity, std::nan("")})
    CHECK(refusal_of({x, {{0, 1, 2}}, {}}, bad) == "mesh: seams need a distance > 0 m");
  CHECK(refusal_of({x, {{0, 1, 2}}, {}}, 1e-300) == "not refused");
  CHECK(refusal_of({x, {{0, 1, 2}}, {"a.obj", {1, 2, 3}, {4}}}, 0) ==
        "a.obj: seams need a distance > 0 m");
  for (const double bad : {infinity, std::nan("")}) {
    x(1, 2) = bad;
    CHECK(refusal_of({x, {{0, 1, 2}}, {"a.obj", {3, 5, 7}, {9}}}, 0.1) ==
          "a.obj:7: a coordinate is not finite; give numbers in m");
  }
}

TEST_CASE(
    "vertices of several fans are split, numbered by their first triangles, and pulled apart") {
  // 2 has three fans: triangle 0; triangles 1 and 4; triangle 2. 1 has two: triangles 0 and 3.
  const PerParticle3 x = matrix_of({{0.3, 1.2, 0.1},
                                    {1.7, 0.4, -0.2},
                                    {0.9, -0.6, 0.5},
                                    {-1.1, -1.3, 0.7},
                                    {0.2, -2.2, -0.4},
                                    {2.6, -1.9, 0.9},
                                    {3.3, -0.7, 1.6},
                                    {3.1, 1.8, -1.5},
                                    {2.2, 2.7, 0.8},
                                    {1.2, -2.9, 1.1}});
  const TriangleSoup soup{x,
                          {{0, 1, 2}, {2, 3, 4}, {5, 6, 2}, {7, 8, 1}, {4, 9, 2}},
                          {"fans.obj", {2, 3, 5, 7, 11, 13, 17, 19, 23, 29}, {31, 37, 41, 43, 47}}};
  const SplitMesh split = split_fans(soup);
  CHECK(split.copy_of == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 2, 2, 1});
  CHECK(split.mesh.triangles ==
        std::vector<Triangle>{{0, 1, 2}, {10, 3, 4}, {5, 6, 11}, {7, 8, 12}, {4, 9, 10}});
  const auto pulled = [&](int v, const std::vector<std::array<int, 2>>& sides) {
    Vector3 middle = Vector3::Zero();
    for (const auto& [a, b] : sides) middle += 0.5 * (x.col(a) + x.col(b)) / double(sides.size());
    return Vector3(0.999 * x.col(v) + 0.001 * middle);
  };
  PerParticle3 expected(3, 13);
  expected << x, Vector3::Zero(), Vector3::Zero(), Vector3::Zero();
  expected.col(1) = pulled(1, {{0, 2}});
  expected.col(2) = pulled(2, {{0, 1}});
  expected.col(10) = pulled(2, {{3, 4}, {4, 9}});
  expected.col(11) = pulled(2, {{5, 6}});
  expected.col(12) = pulled(1, {{7, 8}});
  CHECK((split.mesh.rest - expected).cwiseAbs().maxCoeff() < 1e-15);
  for (const int v : {0, 3, 4, 5, 6, 7, 8, 9}) CHECK(split.mesh.rest.col(v) == x.col(v));
}

TEST_CASE("a mesh without touching fans is left as it is, with or without a file") {
  const PerParticle3 x =
      matrix_of({{0.3, 1.2, 0.1}, {1.7, 0.4, -0.2}, {0.9, -0.6, 0.5}, {3, 2, 1}});
  for (const MeshOrigin& origin : {MeshOrigin{}, MeshOrigin{"a.obj", {1, 2, 3, 4}, {5, 6}}}) {
    const SplitMesh split = split_fans({x, {{0, 1, 2}, {2, 1, 3}}, origin});
    CHECK(split.mesh.rest == x);
    CHECK(split.copy_of == std::vector<int>{0, 1, 2, 3});
    CHECK(split.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}});
  }
  CHECK(split_share == 1e-3);
}

TEST_CASE("seams need a distance") {
  const TriangleMesh sheet = make_sheet({SheetPattern::one_diagonal, 1, 1, 1, 1});
  for (const double distance : {0.0, -1.0, double(INFINITY)})
    CHECK_THROWS_WITH(close_seams({sheet.rest, sheet.triangles, {}}, distance),
                      Catch::Contains("seams need a distance > 0 m"));
}
