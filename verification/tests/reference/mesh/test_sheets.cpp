// Sheets: every vertex and triangle as it is described, and what is refused.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "reference/mesh/delaunay.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

const double infinity = std::numeric_limits<double>::infinity();

std::string refusal_of(const Sheet& sheet) {
  try {
    make_sheet(sheet);
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

Sheet sheet_of(SheetPattern pattern, int columns, int rows) {
  return {pattern, 1.3, 0.9, columns, rows, 0, 7};
}

/// The 53 leading bits of a number of the generator, over 2^53.
double uniform(std::mt19937_64& random) { return std::ldexp(double(random() >> 11), -53); }

/// Random points by darts, where the distance to every other point is asked for.
PerParticle3 darts(const Sheet& sheet) {
  const double width = sheet.width / sheet.columns, height = sheet.height / sheet.rows;
  const double least = 0.8 * std::min(width, height), bin = least / std::sqrt(2.0);
  using Point = Eigen::Vector2d;
  std::vector<Point> points;
  for (int i = 0; i <= sheet.columns; ++i)
    for (const double y : {0.0, sheet.height})
      points.push_back({sheet.width * (double(i) / sheet.columns), y});
  for (int j = 1; j < sheet.rows; ++j)
    for (const double x : {0.0, sheet.width})
      points.push_back({x, sheet.height * (double(j) / sheet.rows)});

  std::mt19937_64 random(sheet.seed);
  const int columns = int(sheet.width / bin) + 1, rows = int(sheet.height / bin) + 1;
  std::vector<int> bins(size_t(columns * rows));
  std::iota(bins.begin(), bins.end(), 0);
  for (size_t k = bins.size() - 1; k > 0; --k) std::swap(bins[k], bins[random() % (k + 1)]);
  for (int round = 0; round < 20; ++round)
    for (const int b : bins) {
      const int column = b % columns, row = b / columns;
      if (std::ranges::any_of(points, [&](const Point& p) {
            return int(p.x() / bin) == column && int(p.y() / bin) == row;
          }))
        continue;
      const double x = (column + uniform(random)) * bin, y = (row + uniform(random)) * bin;
      const double to_border = std::min({x, y, sheet.width - x, sheet.height - y});
      const bool is_clear = std::ranges::all_of(
          points, [&](const Point& p) { return (p - Point(x, y)).norm() >= least; });
      if (to_border > least / 2 && is_clear) points.push_back({x, y});
    }
  std::ranges::sort(points, {}, [&](const Point& p) {
    return std::array{std::floor(p.y() / sheet.height * sheet.rows), p.x(), p.y()};
  });
  PerParticle3 x = PerParticle3::Zero(3, Eigen::Index(points.size()));
  for (size_t i = 0; i < points.size(); ++i) x.col(Eigen::Index(i)).head<2>() = points[i];
  return x;
}

}  // namespace

TEST_CASE("sheets of two columns and rows have the triangles drawn by hand") {
  const auto triangles = [](SheetPattern pattern) {
    return make_sheet(sheet_of(pattern, 2, 2)).triangles;
  };
  // 6 7 8 3 4 5 0 1 2
  CHECK(
      triangles(SheetPattern::one_diagonal) ==
      std::vector<Triangle>{
          {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {3, 4, 7}, {3, 7, 6}, {4, 5, 8}, {4, 8, 7}});
  CHECK(
      triangles(SheetPattern::alternating) ==
      std::vector<Triangle>{
          {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {3, 4, 6}, {4, 7, 6}, {4, 5, 7}, {5, 8, 7}});
  CHECK(
      triangles(SheetPattern::union_jack) ==
      std::vector<Triangle>{
          {0, 1, 4}, {0, 4, 3}, {1, 2, 4}, {2, 5, 4}, {3, 4, 6}, {4, 7, 6}, {4, 5, 8}, {4, 8, 7}});
  // 10   11   12
  //    8    9
  // 5    6    7
  //    3    4
  // 0    1    2
  CHECK(triangles(SheetPattern::criss_cross) == std::vector<Triangle>{{0, 1, 3},
                                                                      {1, 6, 3},
                                                                      {6, 5, 3},
                                                                      {5, 0, 3},
                                                                      {1, 2, 4},
                                                                      {2, 7, 4},
                                                                      {7, 6, 4},
                                                                      {6, 1, 4},
                                                                      {5, 6, 8},
                                                                      {6, 11, 8},
                                                                      {11, 10, 8},
                                                                      {10, 5, 8},
                                                                      {6, 7, 9},
                                                                      {7, 12, 9},
                                                                      {12, 11, 9},
                                                                      {11, 6, 9}});
  // 7    8    9
  // 3  4    5  6
  // 0    1    2
  CHECK(triangles(SheetPattern::equilateral) == std::vector<Triangle>{{0, 4, 3},
                                                                      {0, 1, 4},
                                                                      {1, 5, 4},
                                                                      {1, 2, 5},
                                                                      {2, 6, 5},
                                                                      {3, 4, 7},
                                                                      {4, 8, 7},
                                                                      {4, 5, 8},
                                                                      {5, 9, 8},
                                                                      {5, 6, 9}});
}

TEST_CASE("vertices of squares lie on a grid, graded or not, and centres half way along it") {
  const auto line = [](double i, int cells, double grading) {
    if (grading == 1) return i / cells;
    const double q = std::pow(grading, 1.0 / (cells - 1));
    return (std::pow(q, i) - 1) / (std::pow(q, cells) - 1);
  };
  for (const double grading : {1.0, 4.0, 0.3}) {
    Sheet sheet = sheet_of(SheetPattern::union_jack, 2, 3);
    sheet.grading = grading;
    const PerParticle3 squares = make_sheet(sheet).rest;
    sheet.pattern = SheetPattern::criss_cross;
    const PerParticle3 crosses = make_sheet(sheet).rest;
    REQUIRE(squares.cols() == 3 * 4);
    REQUIRE(crosses.cols() == 3 * 4 + 2 * 3);
    const auto point = [&](double i, double j) {
      return Vector3(1.3 * line(i, 2, grading), 0.9 * line(j, 3, grading), 0);
    };
    for (int j = 0; j <= 3; ++j)
      for (int i = 0; i <= 2; ++i) {
        CHECK((squares.col(3 * j + i) - point(i, j)).norm() < 1e-15);
        CHECK((crosses.col(5 * j + i) - point(i, j)).norm() < 1e-15);
        if (i < 2 && j < 3)
          CHECK((crosses.col(5 * j + 3 + i) - point(i + 0.5, j + 0.5)).norm() < 1e-15);
      }
  }
  // cells of 1 and 4 parts, of 1, 2 and 4
  const PerParticle3 x = make_sheet({SheetPattern::one_diagonal, 5, 7, 2, 3, 0, 0, 4}).rest;
  CHECK((x.col(4) - Vector3(1, 1, 0)).norm() < 1e-14);
  CHECK((x.col(7) - Vector3(1, 3, 0)).norm() < 1e-14);
  CHECK((x.col(11) - Vector3(5, 7, 0)).norm() < 1e-14);
}

TEST_CASE("vertices of equilateral sheets lie in rows offset by half an edge") {
  for (const double height : {0.0, 0.7}) {
    Sheet sheet = sheet_of(SheetPattern::equilateral, 3, 3);
    sheet.height = height;
    const double row = height > 0 ? 0.7 / 3 : std::sqrt(3.0) / 2 * 1.3 / 3;
    const std::vector<std::vector<double>> columns{
        {0, 1, 2, 3}, {0, 0.5, 1.5, 2.5, 3}, {0, 1, 2, 3}, {0, 0.5, 1.5, 2.5, 3}};
    const TriangleMesh mesh = make_sheet(sheet);
    REQUIRE(mesh.particles() == 18);
    CHECK(mesh.triangles.size() == 3 * 7);
    int v = 0;
    for (size_t j = 0; j < 4; ++j)
      for (const double column : columns[j])
        CHECK((mesh.rest.col(v++) - Vector3(1.3 * column / 3, double(j) * row, 0)).norm() < 1e-15);
  }
}

TEST_CASE("jitter is uniform in a disc that is scaled like y, from the seed") {
  for (const double height : {0.0, 0.7}) {
    Sheet sheet = sheet_of(SheetPattern::equilateral, 4, 5);
    sheet.height = height;
    sheet.jitter = 0.31, sheet.seed = 91;
    PerParticle3 x = make_sheet(sheet).rest;
    const double y_scale = height > 0 ? 0.7 / 5 / (std::sqrt(3.0) / 2 * 1.3 / 4) : 1;
    std::mt19937_64 random(91);
    int v = 5;
    for (int j = 1; j < 5; ++j)
      for (int i = 0, count = j % 2 == 1 ? 6 : 5; i < count; ++i, ++v) {
        if (i == 0 || i == count - 1) continue;
        const double distance = 0.31 * 1.3 / 4 * std::sqrt(uniform(random));
        const double angle = 2 * pi * uniform(random);
        x(0, v) += distance * std::cos(angle);
        x(1, v) += distance * std::sin(angle) * y_scale;
      }
    sheet.pattern = SheetPattern::jittered;
    const TriangleMesh mesh = make_sheet(sheet);
    CHECK((mesh.rest - x).cwiseAbs().maxCoeff() < 1e-15);
    CHECK(mesh.triangles == delaunay(mesh.rest.topRows<2>()));
  }
}

TEST_CASE("random sheets are those of darts that are thrown into empty bins") {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const std::array<Sheet, 3> sheets{
        Sheet{SheetPattern::random_delaunay, 1.3, 0.9, 7, 5, 0, seed},
        Sheet{SheetPattern::random_delaunay, 0.7, 2.9, 3, 4, 0, seed},
        Sheet{SheetPattern::random_delaunay, 2.9, 0.7, 4, 3, 0, seed}};
    const Sheet& sheet = sheets[seed % 3];
    const TriangleMesh mesh = make_sheet(sheet);
    const PerParticle3 x = darts(sheet);
    REQUIRE(mesh.particles() == x.cols());
    CHECK(mesh.rest == x);
    CHECK(mesh.triangles == delaunay(x.topRows<2>()));
  }
}

TEST_CASE("a sheet has a width, a height, columns and rows") {
  const auto with = [](auto Sheet::*key, auto value, SheetPattern pattern) {
    Sheet sheet = sheet_of(pattern, 3, 2);
    sheet.*key = value;
    return refusal_of(sheet);
  };
  const SheetPattern squares = SheetPattern::one_diagonal;
  CHECK(with(&Sheet::width, 0, squares) == "make_sheet: width is 0; give a positive length in m");
  CHECK(with(&Sheet::width, infinity, squares).starts_with("make_sheet: width is inf"));
  CHECK(with(&Sheet::width, 1e-9, squares) == "not refused");
  for (const double height : {0.0, -0.1, infinity, std::nan("")})
    CHECK(with(&Sheet::height, height, squares).starts_with("make_sheet: height is "));
  CHECK(with(&Sheet::height, 0, SheetPattern::criss_cross) ==
        "make_sheet: height is 0; give a positive length in m (or 0 for equilateral and jittered)");
  CHECK(with(&Sheet::height, 0, SheetPattern::random_delaunay).starts_with("make_sheet: height"));
  for (const SheetPattern pattern : {SheetPattern::equilateral, SheetPattern::jittered}) {
    CHECK(with(&Sheet::height, 0, pattern) == "not refused");
    CHECK(with(&Sheet::height, -1, pattern).starts_with("make_sheet: height is -1"));
    CHECK(with(&Sheet::height, infinity, pattern).starts_with("make_sheet: height is inf"));
  }
  CHECK(with(&Sheet::columns, 0, squares) == "make_sheet: columns is 0; give at least 1");
  CHECK(with(&Sheet::rows, 0, squares) == "make_sheet: rows is 0; give at least 1");
  CHECK(with(&Sheet::columns, 1, squares) == "not refused");
  CHECK(with(&Sheet::rows, 1, squares) == "not refused");
  Sheet large = sheet_of(squares, 10001, 10000);
  CHECK(refusal_of(large) == "make_sheet: columns * rows is 1.0001e+08; give at most 1e8 cells");
  large.columns = 10000, large.jitter = -0.1;  // which is looked at next
  CHECK(refusal_of(large) == "make_sheet: jitter is -0.1; give a fraction in [0, 0.5)");
  CHECK(with(&Sheet::jitter, 0.5, squares).starts_with("make_sheet: jitter is 0.5"));
  CHECK(with(&Sheet::jitter, 0.0, SheetPattern::jittered) == "not refused");
  CHECK(with(&Sheet::jitter, 0.4999, SheetPattern::jittered) == "not refused");
}

TEST_CASE("grading is positive, and of squares of two columns and rows at least") {
  const auto with = [](double grading, SheetPattern pattern, int columns, int rows) {
    Sheet sheet = sheet_of(pattern, columns, rows);
    sheet.grading = grading;
    return refusal_of(sheet);
  };
  const SheetPattern squares = SheetPattern::alternating;
  CHECK(with(0, squares, 3, 2) ==
        "make_sheet: grading is 0; give a positive ratio of the last cell's width to the first "
        "one's");
  for (const double bad : {-1.0, infinity, std::nan("")})
    CHECK(with(bad, squares, 3, 2).starts_with("make_sheet: grading is "));
  for (const SheetPattern pattern :
       {SheetPattern::equilateral, SheetPattern::jittered, SheetPattern::random_delaunay}) {
    CHECK(with(1.5, pattern, 3, 2) ==
          "make_sheet: grading is 1.5; leave it at 1, or choose one_diagonal, alternating, "
          "union_jack or criss_cross");
    CHECK(with(1, pattern, 3, 2) == "not refused");
  }
  for (const auto& [columns, rows] : {std::pair{1, 2}, {2, 1}, {1, 1}}) {
    CHECK(with(1.5, squares, columns, rows) ==
          "make_sheet: grading is 1.5; leave it at 1, or give two columns and rows");
    CHECK(with(1, squares, columns, rows) == "not refused");
  }
  CHECK(with(1.5, squares, 2, 2) == "not refused");
}

TEST_CASE("cells of random sheets are between four times as wide as high and as high as wide") {
  const auto with = [](double width, int columns, int rows) {
    return refusal_of({SheetPattern::random_delaunay, width, 1, columns, rows, 0, 3});
  };
  CHECK(with(1, 4, 1) ==
        "make_sheet: cell width over cell height is 0.25; choose columns and rows that bring it "
        "between 1/4 and 4");
  CHECK(with(1.01, 4, 1) == "not refused");
  CHECK(with(4, 1, 1).starts_with("make_sheet: cell width over cell height is 4;"));
  CHECK(with(3.99, 1, 1) == "not refused");
  CHECK(with(4, 2, 2).starts_with("make_sheet: cell width over cell height is 4;"));
  CHECK(with(1.99, 1, 2) == "not refused");
}

TEST_CASE("a sheet is of one diagonal, even and without jitter unless it is told otherwise") {
  const Sheet sheet;
  CHECK(sheet.pattern == SheetPattern::one_diagonal);
  CHECK(sheet.width == 0);
  CHECK(sheet.height == 0);
  CHECK(sheet.columns == 0);
  CHECK(sheet.rows == 0);
  CHECK(sheet.jitter == 0);
  CHECK(sheet.seed == 0);
  CHECK(sheet.grading == 1);
}
