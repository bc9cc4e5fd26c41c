// Sheets: every vertex and triangle as it is described, and what is refused.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "reference/mesh/delaunay.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

/// The 53 leading bits of a number of the generator, over 2^53.
double uniform(std::mt19937_64& random) { return std::ldexp(double(random() >> 11), -53); }

}  // namespace

TEST_CASE("sheets of two columns and rows have the triangles drawn by hand") {
  const std::vector<Triangle> rising{{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4},
                                     {3, 4, 7}, {3, 7, 6}, {4, 5, 8}, {4, 8, 7}};
  const std::vector<Triangle> in_turn{{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4},
                                      {3, 4, 6}, {4, 7, 6}, {4, 5, 7}, {5, 8, 7}};
  const std::vector<Triangle> chequered{{0, 1, 4}, {0, 4, 3}, {1, 2, 4}, {2, 5, 4},
                                        {3, 4, 6}, {4, 7, 6}, {4, 5, 8}, {4, 8, 7}};
  // 10   11   12
  //    8    9
  // 5    6    7
  //    3    4
  // 0    1    2
  const std::vector<Triangle> crossed{{0, 1, 3}, {1, 6, 3},  {6, 5, 3},   {5, 0, 3},
                                      {1, 2, 4}, {2, 7, 4},  {7, 6, 4},   {6, 1, 4},
                                      {5, 6, 8}, {6, 11, 8}, {11, 10, 8}, {10, 5, 8},
                                      {6, 7, 9}, {7, 12, 9}, {12, 11, 9}, {11, 6, 9}};
  const std::vector<Triangle> offset{{0, 4, 3}, {0, 1, 4}, {1, 5, 4}, {1, 2, 5}, {2, 6, 5},
                                     {3, 4, 7}, {4, 8, 7}, {4, 5, 8}, {5, 9, 8}, {5, 6, 9}};
  const std::array all{rising, in_turn, chequered, crossed, offset};
  for (int pattern = 0; pattern < 5; ++pattern) {
    const TriangleMesh sheet = make_sheet({SheetPattern(pattern), 1.3, 0.9, 2, 2});
    CHECK(sheet.triangles == all[size_t(pattern)]);
    CHECK(sheet.rest.rowwise().minCoeff() == Vector3(0, 0, 0));
    CHECK(sheet.rest.rowwise().maxCoeff() == Vector3(1.3, 0.9, 0));
  }
}

TEST_CASE("vertices of squares lie on a grid, graded or not, and centres half way along it") {
  // cells of 1 and 4 parts, of 1, 2 and 4
  const PerParticle3 graded = make_sheet({SheetPattern::criss_cross, 5, 7, 2, 3, 0, 0, 4}).rest;
  PerParticle3 x = PerParticle3::Zero(3, 18);
  const double third = 1.0 / 3, root = std::sqrt(2);
  x.row(0) << 0, 1, 5, third, 7 * third, 0, 1, 5, third, 7 * third, 0, 1, 5, third, 7 * third, 0, 1,
      5;
  x.row(1) << 0, 0, 0, root - 1, root - 1, 1, 1, 1, 2 * root - 1, 2 * root - 1, 3, 3, 3,
      4 * root - 1, 4 * root - 1, 7, 7, 7;
  CHECK((graded - x).cwiseAbs().maxCoeff() < 1e-14);
  const PerParticle3 even = make_sheet({SheetPattern::union_jack, 2, 3, 2, 3}).rest;
  for (int v = 0; v < 12; ++v) CHECK((even.col(v) - Vector3(v % 3, v / 3, 0)).norm() < 1e-14);
}

TEST_CASE("rows are offset by half an edge; jitter is uniform in a disc that is scaled like y") {
  for (const double height : {0.0, 0.7}) {
    Sheet sheet{SheetPattern::equilateral, 1.3, height, 4, 5, 0.31, 91};
    const double regular = std::sqrt(3.0) / 2 * 1.3 / 4, row = height > 0 ? height / 5 : regular;
    PerParticle3 x = PerParticle3::Zero(3, 33);
    for (int j = 0, v = 0; j <= 5; ++j)
      for (int i = 0; i < 5 + j % 2; ++i)
        x.col(v++).head<2>() << 1.3 / 4 * std::clamp(i - j % 2 * 0.5, 0.0, 4.0), j * row;
    CHECK((make_sheet(sheet).rest - x).cwiseAbs().maxCoeff() < 1e-15);
    std::mt19937_64 random(91);
    for (int v = 6; v < 26; ++v) {
      if (x(0, v) == 0 || x(0, v) == 1.3) continue;
      const double distance = 0.31 * 1.3 / 4 * std::sqrt(uniform(random));
      const double angle = 2 * pi * uniform(random);
      x(0, v) += distance * std::cos(angle);
      x(1, v) += distance * std::sin(angle) * row / regular;
    }
    sheet.pattern = SheetPattern::jittered;
    const TriangleMesh mesh = make_sheet(sheet);
    CHECK((mesh.rest - x).cwiseAbs().maxCoeff() < 1e-15);
    CHECK(mesh.triangles == delaunay(mesh.rest.topRows<2>()));
  }
}

TEST_CASE("arguments of a sheet are refused from their limits on, by name and value") {
  using enum SheetPattern;
  const double infinity = std::numeric_limits<double>::infinity();
  for (const auto& [sheet, said] : std::vector<std::pair<Sheet, std::string>>{
           {{one_diagonal, 0, 1, 3, 2}, "width is 0;"},
           {{criss_cross, 1, 0, 3, 2}, "height is 0;"},
           {{jittered, 1, infinity, 3, 2}, "height is inf;"},
           {{one_diagonal, 1, 1, 0, 2}, "columns is 0;"},
           {{one_diagonal, 1, 1, 3, 0}, "rows is 0;"},
           {{one_diagonal, 1, 1, 10001, 10000}, "columns * rows is 1.0001e+08;"},
           {{one_diagonal, 1, 1, 10000, 10000, -0.1},
            "jitter is -0.1;"},  // which is looked at next
           {{jittered, 1, 1, 3, 2, 0.5}, "jitter is 0.5;"},
           {{SheetPattern(99), 1, 1, 3, 2}, "pattern is 99"},
           {{one_diagonal, 1, 1, 3, 2, 0, 0, 0}, "grading is 0; give a positive"},
           {{alternating, 1, 1, 1, 2, 0, 0, 1.5}, "grading is 1.5; leave it at 1, or give two"},
           {{alternating, 1, 1, 2, 1, 0, 0, 1.5}, "grading is 1.5; leave it at 1, or give two"},
           {{equilateral, 1, 1, 3, 2, 0, 0, 1.5}, "grading is 1.5; leave it at 1, or choose"},
           {{random_delaunay, 1, 1, 2, 2, 0, 0, 1.5}, "grading is 1.5; leave it at 1, or choose"},
           {{random_delaunay, 4, 1, 1, 1}, "cell width over cell height is 4;"},
           {{random_delaunay, 1, 1, 4, 1}, "cell width over cell height is 0.25;"}})
    CHECK_THROWS_WITH(make_sheet(sheet), Catch::StartsWith("make_sheet: " + said));
  for (const Sheet& good : {Sheet{one_diagonal, 1e-9, 1, 1, 1},
                            {jittered, 1, 0, 1, 1, 0.4999},
                            {alternating, 1, 1, 2, 2, 0, 0, 1.5},
                            {random_delaunay, 3.99, 1, 1, 1},
                            {random_delaunay, 1.01, 1, 4, 1}})
    CHECK_NOTHROW(make_sheet(good));
}
