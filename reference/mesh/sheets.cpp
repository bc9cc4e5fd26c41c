#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include "reference/mesh/delaunay.h"
#include "reference/mesh/shapes.h"

namespace foldproof {
namespace {

const double row_ratio = std::sqrt(0.75);  // height of an equilateral triangle over its edge

[[noreturn]] void reject(const std::string& name, double value, const std::string& remedy) {
  reject_argument("make_sheet: " + name, value, remedy);
}

bool has_offset_rows(SheetPattern pattern) {
  return pattern == SheetPattern::equilateral || pattern == SheetPattern::jittered;
}

void reject_bad_arguments(const Sheet& sheet) {
  if (!(sheet.width > 0) || !std::isfinite(sheet.width))
    reject("width", sheet.width, "give a positive length in m");
  const bool height_follows = sheet.height == 0 && has_offset_rows(sheet.pattern);
  if ((!(sheet.height > 0) && !height_follows) || !std::isfinite(sheet.height)) {
    reject("height", sheet.height,
           "give a positive length in m (or 0 for equilateral and jittered)");
  }
  if (sheet.columns < 1) reject("columns", sheet.columns, "give at least 1");
  if (sheet.rows < 1) reject("rows", sheet.rows, "give at least 1");
  if (double(sheet.columns) * sheet.rows > 1e8) {
    reject("columns * rows", double(sheet.columns) * sheet.rows, "give at most 1e8 cells");
  }
  if (!(sheet.jitter >= 0 && sheet.jitter < 0.5))
    reject("jitter", sheet.jitter, "give a fraction in [0, 0.5)");
}

void reject_bad_grading(const Sheet& sheet) {
  if (!(sheet.grading > 0) || !std::isfinite(sheet.grading))
    reject("grading", sheet.grading,
           "give a positive ratio of the last cell's width to the first one's");
  const bool is_of_squares =
      !has_offset_rows(sheet.pattern) && sheet.pattern != SheetPattern::random_delaunay;
  if (sheet.grading == 1) return;
  if (!is_of_squares)
    reject("grading", sheet.grading,
           "leave it at 1, or choose one_diagonal, alternating, union_jack or criss_cross");
  if (sheet.columns < 2 || sheet.rows < 2)
    reject("grading", sheet.grading, "leave it at 1, or give two columns and rows");
}

double row_height(const Sheet& sheet) {
  return sheet.height > 0 ? sheet.height / sheet.rows : row_ratio * sheet.width / sheet.columns;
}

/// Uniform in [0, 1), from the 53 leading bits of the generator: the standard fixes the generator,
/// but not the distributions.
double uniform(std::mt19937_64& random) { return double(random() >> 11) * 0x1p-53; }

// --- squares ---

/// Where line `i` of `cells` cells lies, as a fraction of the side: i/cells, or with q =
/// grading^(1/(cells - 1)) (q^i - 1)/(q^cells - 1), so that each cell is q times as wide as
/// the one before.
double line_at(double i, int cells, double grading) {
  if (grading == 1) return i / cells;
  const double log_factor = std::log(grading) / (cells - 1);
  return std::expm1(i * log_factor) / std::expm1(cells * log_factor);
}

/// The grid's point at column i and row j, whole or half.
Vector3 grid_point(const Sheet& sheet, double i, double j) {
  return {sheet.width * line_at(i, sheet.columns, sheet.grading),
          sheet.height * line_at(j, sheet.rows, sheet.grading), 0};
}

/// Vertices of the grid, `stride` apart from row to row; the caller fills in those between.
void place_grid(const Sheet& sheet, int stride, PerParticle3& x) {
  for (int j = 0; j <= sheet.rows; ++j) {
    for (int i = 0; i <= sheet.columns; ++i) x.col(j * stride + i) = grid_point(sheet, i, j);
  }
}

bool diagonal_rises(SheetPattern pattern, int column, int row) {
  if (pattern == SheetPattern::alternating) return row % 2 == 0;
  if (pattern == SheetPattern::union_jack) return (column + row) % 2 == 0;
  return true;
}

TriangleMesh split_squares(const Sheet& sheet) {
  const int stride = sheet.columns + 1;
  PerParticle3 x(3, stride * (sheet.rows + 1));
  place_grid(sheet, stride, x);
  std::vector<Triangle> triangles;
  triangles.reserve(size_t(2) * sheet.columns * sheet.rows);
  for (int j = 0; j < sheet.rows; ++j) {
    for (int i = 0; i < sheet.columns; ++i) {
      // d -- c
      // |    |
      // a -- b
      const int a = j * stride + i, b = a + 1, c = b + stride, d = a + stride;
      const bool rises = diagonal_rises(sheet.pattern, i, j);
      triangles.push_back(rises ? Triangle{a, b, c} : Triangle{a, b, d});
      triangles.push_back(rises ? Triangle{a, c, d} : Triangle{b, c, d});
    }
  }
  return make_triangle_mesh(std::move(x), std::move(triangles));
}

TriangleMesh cross_squares(const Sheet& sheet) {
  const int stride = 2 * sheet.columns + 1;  // a row of corners, then the centres above it
  PerParticle3 x(3, stride * sheet.rows + sheet.columns + 1);
  place_grid(sheet, stride, x);
  std::vector<Triangle> triangles;
  triangles.reserve(size_t(4) * sheet.columns * sheet.rows);
  for (int j = 0; j < sheet.rows; ++j) {
    for (int i = 0; i < sheet.columns; ++i) {
      const int a = j * stride + i, b = a + 1, c = b + stride, d = a + stride,
                centre = a + sheet.columns + 1;
      x.col(centre) = grid_point(sheet, i + 0.5, j + 0.5);
      for (const auto& [from, to] :
           {std::pair{a, b}, std::pair{b, c}, std::pair{c, d}, std::pair{d, a}}) {
        triangles.push_back({from, to, centre});
      }
    }
  }
  return make_triangle_mesh(std::move(x), std::move(triangles));
}

// --- rows offset by half an edge ---

/// Number of the first vertex of row j: even rows have columns + 1 vertices, odd ones columns + 2.
int row_start(const Sheet& sheet, int j) { return j * (sheet.columns + 1) + j / 2; }

PerParticle3 place_offset_rows(const Sheet& sheet) {
  PerParticle3 x(3, row_start(sheet, sheet.rows + 1));
  const double height = sheet.height > 0 ? sheet.height : sheet.rows * row_height(sheet);
  for (int j = 0; j <= sheet.rows; ++j) {
    const int count = row_start(sheet, j + 1) - row_start(sheet, j);
    for (int i = 0; i < count; ++i) {
      const double column = j % 2 == 0 ? i : std::clamp(i - 0.5, 0.0, double(sheet.columns));
      x.col(row_start(sheet, j) + i) =
          Vector3(sheet.width * (column / sheet.columns), height * (double(j) / sheet.rows), 0);
    }
  }
  return x;
}

// Two columns: triangles with one vertex in the even row (halves at both ends) alternate with
// triangles that have one vertex in the odd row.
//
//  odd  o0 o1 -- o2 o3      even  e0 ---- e1 ---- e2
//       | /  \  /  \ |            | \    /  \    / |
//  even e0 -- e1 -- e2      odd   o0 o1 ---- o2   o3
void add_strip(const Sheet& sheet, int row, std::vector<Triangle>& triangles) {
  const bool even_below = row % 2 == 0;
  const int e = row_start(sheet, even_below ? row : row + 1);
  const int o = row_start(sheet, even_below ? row + 1 : row);
  for (int k = 0; k <= sheet.columns; ++k) {
    const Triangle one_even =
        even_below ? Triangle{e + k, o + k + 1, o + k} : Triangle{o + k, o + k + 1, e + k};
    triangles.push_back(one_even);
    if (k == sheet.columns) break;
    const Triangle one_odd =
        even_below ? Triangle{e + k, e + k + 1, o + k + 1} : Triangle{o + k + 1, e + k + 1, e + k};
    triangles.push_back(one_odd);
  }
}

TriangleMesh offset_rows(const Sheet& sheet) {
  std::vector<Triangle> triangles;
  triangles.reserve(size_t(sheet.rows) * (2 * sheet.columns + 1));
  for (int row = 0; row < sheet.rows; ++row) add_strip(sheet, row, triangles);
  return make_triangle_mesh(place_offset_rows(sheet), std::move(triangles));
}

TriangleMesh jittered_rows(const Sheet& sheet) {
  PerParticle3 x = place_offset_rows(sheet);
  const double reach = sheet.jitter * sheet.width / sheet.columns;  // m, along x
  const double y_scale = row_height(sheet) / (row_ratio * sheet.width / sheet.columns);
  std::mt19937_64 random(sheet.seed);
  for (int j = 1; j < sheet.rows; ++j) {
    for (int v = row_start(sheet, j) + 1; v < row_start(sheet, j + 1) - 1; ++v) {
      const double distance = reach * std::sqrt(uniform(random)), angle = 2 * pi * uniform(random);
      x.col(v) += distance * Vector3(std::cos(angle), y_scale * std::sin(angle), 0);
    }
  }
  std::vector<Triangle> triangles = delaunay(x.topRows<2>());
  return make_triangle_mesh(std::move(x), std::move(triangles));
}

// --- random points ---

/// Points with a least distance between them, found through square bins that hold at most
/// one point each.
struct Scatter {
  double least_distance;  // m
  double bin;             // side of a bin [m]: least_distance / sqrt(2)
  int bin_columns, bin_rows;
  std::vector<int> in_bin;                 // the point in each bin, or -1
  std::vector<Eigen::Vector2d> positions;  // m
};

Scatter empty_scatter(const Sheet& sheet) {
  const double least_distance =
      0.8 * std::min(sheet.width / sheet.columns, sheet.height / sheet.rows);
  const double bin = least_distance / std::sqrt(2.0);
  const int bin_columns = int(sheet.width / bin) + 1, bin_rows = int(sheet.height / bin) + 1;
  return {least_distance,
          bin,
          bin_columns,
          bin_rows,
          std::vector<int>(size_t(bin_columns) * bin_rows, -1),
          {}};
}

void add_if_clear(const Eigen::Vector2d& p, Scatter& scatter) {
  const int column = int(p.x() / scatter.bin), row = int(p.y() / scatter.bin);
  for (int j = std::max(row - 2, 0); j <= std::min(row + 2, scatter.bin_rows - 1); ++j) {
    for (int i = std::max(column - 2, 0); i <= std::min(column + 2, scatter.bin_columns - 1); ++i) {
      const int other = scatter.in_bin[j * scatter.bin_columns + i];
      if (other >= 0 && (scatter.positions[other] - p).norm() < scatter.least_distance) return;
    }
  }
  scatter.in_bin[row * scatter.bin_columns + column] = int(scatter.positions.size());
  scatter.positions.push_back(p);
}

void add_border(const Sheet& sheet, Scatter& scatter) {
  for (int i = 0; i <= sheet.columns; ++i) {
    for (double y : {0.0, sheet.height})
      add_if_clear({sheet.width * (double(i) / sheet.columns), y}, scatter);
  }
  for (int j = 1; j < sheet.rows; ++j) {
    for (double x : {0.0, sheet.width})
      add_if_clear({x, sheet.height * (double(j) / sheet.rows)}, scatter);
  }
}

/// Throws one dart into every empty bin, in random order, 20 times over; little space is left then.
void add_interior(const Sheet& sheet, Scatter& scatter) {
  std::mt19937_64 random(sheet.seed);
  std::vector<int> bins(scatter.in_bin.size());
  std::iota(bins.begin(), bins.end(), 0);
  for (size_t k = bins.size() - 1; k > 0; --k) std::swap(bins[k], bins[random() % (k + 1)]);
  const double margin = 0.5 * scatter.least_distance;  // from the border [m]
  for (int round = 0; round < 20; ++round) {
    for (int b : bins) {
      if (scatter.in_bin[b] >= 0) continue;
      const double x = (b % scatter.bin_columns + uniform(random)) * scatter.bin;
      const double y = (b / scatter.bin_columns + uniform(random)) * scatter.bin;
      const bool inside =
          x > margin && x < sheet.width - margin && y > margin && y < sheet.height - margin;
      if (inside) add_if_clear({x, y}, scatter);
    }
  }
}

TriangleMesh make_random_sheet(const Sheet& sheet) {
  const double aspect = sheet.width / sheet.columns / (sheet.height / sheet.rows);
  if (!(aspect > 0.25 && aspect < 4)) {
    reject("cell width over cell height", aspect,
           "choose columns and rows that bring it between 1/4 and 4");
  }
  Scatter scatter = empty_scatter(sheet);
  add_border(sheet, scatter);
  add_interior(sheet, scatter);

  std::ranges::sort(scatter.positions, {}, [&sheet](const Eigen::Vector2d& p) {
    return std::array{std::floor(p.y() / sheet.height * sheet.rows), p.x(), p.y()};
  });
  PerParticle3 x = PerParticle3::Zero(3, scatter.positions.size());
  for (size_t i = 0; i < scatter.positions.size(); ++i) x.col(i).head<2>() = scatter.positions[i];
  std::vector<Triangle> triangles = delaunay(x.topRows<2>());
  return make_triangle_mesh(std::move(x), std::move(triangles));
}

}  // namespace

TriangleMesh make_sheet(const Sheet& sheet) {
  reject_bad_arguments(sheet);
  reject_bad_grading(sheet);
  switch (sheet.pattern) {
    case SheetPattern::one_diagonal:
    case SheetPattern::alternating:
    case SheetPattern::union_jack:
      return split_squares(sheet);
    case SheetPattern::criss_cross:
      return cross_squares(sheet);
    case SheetPattern::equilateral:
      return offset_rows(sheet);
    case SheetPattern::jittered:
      return jittered_rows(sheet);
    case SheetPattern::random_delaunay:
      return make_random_sheet(sheet);
  }
  reject("pattern", int(sheet.pattern), "give one of SheetPattern");
}

}  // namespace foldproof
