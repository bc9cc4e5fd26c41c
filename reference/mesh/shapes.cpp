#include "reference/mesh/shapes.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace foldproof {
namespace {

void reject_bad_length(const std::string& name, double value) {
  if (!(value > 0) || !std::isfinite(value))
    reject_argument(name, value, "give a positive length in m");
}

void reject_bad_count(const std::string& name, int value, int least, int most) {
  if (value >= least && value <= most) return;
  reject_argument(name, value, "give " + std::to_string(least) + " to " + std::to_string(most));
}

void reject_bad_angle(const std::string& name, double value) {
  if (!(std::abs(value) < pi)) reject_argument(name, value, "give an angle between -pi and pi rad");
}

// --- disc ---

/// Number of the first vertex of ring k: 1 for the centre, then 6, 12, 18, ...
int ring_start(int k) { return k == 0 ? 0 : 1 + 3 * k * (k - 1); }

/// Vertex i of ring k; i wraps around.
int on_ring(int k, int i) { return k == 0 ? 0 : ring_start(k) + i % (6 * k); }

/// The triangles between ring k - 1 and ring k, in six sectors: k with two vertices on ring k,
/// k - 1 with one.
void add_ring(int k, std::vector<Triangle>& triangles) {
  for (int sector = 0; sector < 6; ++sector) {
    const int inner = sector * (k - 1), outer = sector * k;
    for (int i = 0; i < k; ++i) {
      triangles.push_back(
          {on_ring(k - 1, inner + i), on_ring(k, outer + i), on_ring(k, outer + i + 1)});
      if (i == k - 1) break;
      triangles.push_back(
          {on_ring(k - 1, inner + i), on_ring(k, outer + i + 1), on_ring(k - 1, inner + i + 1)});
    }
  }
}

// --- pleats ---

/// The x of the grid's columns: from the leading vertices with the same y as the first.
std::vector<double> grid_columns(const TriangleMesh& sheet) {
  std::vector<double> columns;
  for (int v = 0; v < sheet.particles() && sheet.rest(1, v) == sheet.rest(1, 0); ++v) {
    columns.push_back(sheet.rest(0, v));
  }
  return columns;
}

/// The x at which each panel begins, and the x at which the last one ends.
std::vector<double> fold_lines(const TriangleMesh& sheet, int columns_per_pleat) {
  if (sheet.particles() == 0 || sheet.rest.row(2) != Eigen::RowVectorXd::Zero(sheet.particles())) {
    throw InputError(
        "pleated: the sheet is empty or leaves the plane z = 0; give one from make_sheet");
  }
  const std::vector<double> columns = grid_columns(sheet);
  std::vector<double> lines;
  for (size_t k = 0; k + 1 < columns.size(); k += size_t(columns_per_pleat))
    lines.push_back(columns[k]);
  lines.push_back(columns.back());
  return lines;
}

void reject_crossing(const TriangleMesh& sheet, const std::vector<double>& lines) {
  for (size_t t = 0; t < sheet.triangles.size(); ++t) {
    const auto [a, b, c] = sheet.triangles[t];
    const auto [left, right] = std::minmax({sheet.rest(0, a), sheet.rest(0, b), sheet.rest(0, c)});
    const std::vector<double>::const_iterator line =
        std::upper_bound(lines.begin(), lines.end(), left);
    if (line != lines.begin() && line != lines.end() && *line >= right) continue;
    throw InputError("pleated: triangle " + std::to_string(t) +
                     " crosses a fold line; give a sheet whose triangles" +
                     " keep to grid columns (one_diagonal, alternating, union_jack, criss_cross)");
  }
}

}  // namespace

void reject_argument(const std::string& name, double value, const std::string& remedy) {
  std::ostringstream message;
  message << name << " is " << value << "; " << remedy;
  throw InputError(message.str());
}

TriangleMesh make_disc(double radius, int rings) {
  reject_bad_length("make_disc: radius", radius);
  reject_bad_count("make_disc: rings", rings, 1, 10000);
  PerParticle3 x = PerParticle3::Zero(3, ring_start(rings + 1));
  std::vector<Triangle> triangles;
  triangles.reserve(size_t(6) * rings * rings);
  for (int k = 1; k <= rings; ++k) {
    const double distance = radius * (double(k) / rings);
    for (int i = 0; i < 6 * k; ++i) {
      const double angle = pi / 3 * i / k;
      x.col(on_ring(k, i)) = distance * Vector3(std::cos(angle), std::sin(angle), 0);
    }
    add_ring(k, triangles);
  }
  return make_triangle_mesh(std::move(x), std::move(triangles));
}

TriangleMesh make_cylinder(double radius, double height, int around, int along) {
  reject_bad_length("make_cylinder: radius", radius);
  reject_bad_length("make_cylinder: height", height);
  reject_bad_count("make_cylinder: around", around, 3, 10000);
  reject_bad_count("make_cylinder: along", along, 1, 10000);
  PerParticle3 x(3, around * (along + 1));
  std::vector<Triangle> triangles;
  triangles.reserve(size_t(2) * around * along);
  for (int j = 0; j <= along; ++j) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * pi * i / around;  // from +z towards +x: counter-clockwise about +y
      x.col(j * around + i) =
          Vector3(radius * std::sin(angle), height * (double(j) / along), radius * std::cos(angle));
      if (j == along) continue;
      // d -- c
      // |    |   seen from outside
      // a -- b
      const int a = j * around + i, b = j * around + (i + 1) % around, c = b + around,
                d = a + around;
      triangles.push_back({a, b, c});
      triangles.push_back({a, c, d});
    }
  }
  return make_triangle_mesh(std::move(x), std::move(triangles));
}

TriangleMesh make_hinge(double length, double angle) {
  reject_bad_length("make_hinge: length", length);
  reject_bad_angle("make_hinge: angle", angle);
  PerParticle3 x(3, 4);
  x.col(0) = length * Vector3(0.4, 0.9, 0);
  x.col(1) = length * Vector3(0.7, -0.6 * std::cos(angle), -0.6 * std::sin(angle));
  x.col(2) = Vector3::Zero();
  x.col(3) = Vector3(length, 0, 0);
  return make_triangle_mesh(std::move(x), {{0, 2, 3}, {1, 3, 2}});
}

PerParticle3 pleated_positions(const TriangleMesh& sheet, int columns_per_pleat, double angle) {
  reject_bad_count("pleated: columns_per_pleat", columns_per_pleat, 1, 1000000);
  reject_bad_angle("pleated: angle", angle);
  const std::vector<double> lines = fold_lines(sheet, columns_per_pleat);
  reject_crossing(sheet, lines);

  // panel k starts at starts[k] and goes on along (cos, 0, +-sin): up if k is even,
  // down if it is odd
  const auto direction = [angle](size_t k) {
    return Vector3(std::cos(angle / 2), 0, std::sin(k % 2 == 0 ? angle / 2 : -angle / 2));
  };
  std::vector<Vector3> starts{Vector3::Zero()};
  for (size_t k = 1; k < lines.size(); ++k) {
    starts.push_back(starts[k - 1] + (lines[k] - lines[k - 1]) * direction(k - 1));
  }

  PerParticle3 x(3, sheet.particles());
  for (int v = 0; v < sheet.particles(); ++v) {
    const auto line = std::upper_bound(lines.begin(), lines.end() - 1, sheet.rest(0, v));
    const size_t k = size_t(line - lines.begin()) - 1;
    x.col(v) =
        starts[k] + (sheet.rest(0, v) - lines[k]) * direction(k) + Vector3(0, sheet.rest(1, v), 0);
  }
  return x;
}

}  // namespace foldproof
