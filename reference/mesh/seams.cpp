#include "reference/mesh/seams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "reference/mesh/box_tree.h"
#include "reference/mesh/mesh_locations.h"

namespace foldproof {

namespace {

using Cell = std::array<double, 3>;  // whole numbers, as doubles: they may be large

Cell cell_of(const Vector3& x, double size) {
  return {std::floor(x[0] / size), std::floor(x[1] / size), std::floor(x[2] / size)};
}

/// The vertices that stay, in cells as wide as the distance: all near a point lie in 27 cells.
class Kept {
 public:
  Kept(const PerParticle3& x, double distance) : x_(x), distance_(distance) {}

  /// The first staying vertex within the distance of vertex v; -1 if there is none.
  int near(int v) const {
    int first = -1;
    const Cell middle = cell_of(x_.col(v), distance_);
    for (const double i : {-1.0, 0.0, 1.0})
      for (const double j : {-1.0, 0.0, 1.0})
        for (const double k : {-1.0, 0.0, 1.0}) {
          const auto found = in_cell_.find({middle[0] + i, middle[1] + j, middle[2] + k});
          if (found == in_cell_.end()) continue;
          for (const int other : found->second)
            if ((x_.col(v) - x_.col(other)).norm() <= distance_ && (first < 0 || other < first))
              first = other;
        }
    return first;
  }

  void add(int v) { in_cell_[cell_of(x_.col(v), distance_)].push_back(v); }

 private:
  const PerParticle3& x_;
  double distance_;  // m
  std::map<Cell, std::vector<int>> in_cell_;
};

void reject_lost_side(const TriangleSoup& panels, const std::vector<int>& becomes) {
  for (size_t t = 0; t < panels.triangles.size(); ++t) {
    const auto& [a, b, c] = panels.triangles[t];
    if (becomes[size_t(a)] == becomes[size_t(b)] || becomes[size_t(b)] == becomes[size_t(c)] ||
        becomes[size_t(c)] == becomes[size_t(a)])
      throw InputError(triangle_location(panels.origin, int(t)) +
                       "two corners of this triangle are so near that a seam would join them; give "
                       "a smaller distance");
  }
}

}  // namespace

TriangleSoup close_seams(TriangleSoup panels, double distance) {
  if (!(distance > 0) || !std::isfinite(distance))
    throw InputError(mesh_location(panels.origin) + "seams need a distance > 0 m");
  const int count = int(panels.rest.cols());
  Kept kept(panels.rest, distance);
  std::vector<int> becomes, lines, left, numbers;
  std::vector<int> number(panels.rest.cols());  // of a vertex that stays
  for (int v = 0; v < count; ++v) {
    if (!panels.rest.col(v).allFinite())
      throw InputError(vertex_location(panels.origin, v) +
                       "a coordinate is not finite; give numbers in m");
    const int other = kept.near(v);
    becomes.push_back(other < 0 ? v : other);
    if (other >= 0) continue;
    kept.add(v);
    number[size_t(v)] = int(left.size());
    left.push_back(v);
    if (!panels.origin.vertex_lines.empty()) lines.push_back(panels.origin.vertex_lines[size_t(v)]);
    numbers.push_back(number_of(panels.origin, v));
  }
  reject_lost_side(panels, becomes);
  for (Triangle& triangle : panels.triangles)
    for (int& corner : triangle) corner = number[size_t(becomes[size_t(corner)])];
  const PerParticle3 rest = panels.rest(Eigen::all, left);
  panels.rest = rest;
  panels.origin.vertex_lines = std::move(lines);
  panels.origin.vertex_numbers = std::move(numbers);
  return panels;
}

void close_seams_in_motion(std::vector<PerParticle3>& frames, std::vector<Triangle>& triangles,
                           double distance, const std::string& file) {
  TriangleSoup sewn = close_seams({frames.front(), triangles, {file, {}, {}}}, distance);
  triangles = std::move(sewn.triangles);
  for (PerParticle3& x : frames) {
    PerParticle3 kept(3, sewn.rest.cols());
    for (Eigen::Index v = 0; v < kept.cols(); ++v)
      kept.col(v) = x.col(sewn.origin.vertex_numbers[size_t(v)] - 1);
    x = std::move(kept);
  }
}

namespace {

/// Vertices on the border of a mesh that lie near an earlier one there.
struct OpenSeams {
  int places = 0;
  double farthest = 0;  // of a vertex from the one that it is near [m]
};

OpenSeams open_seams(const TriangleMesh& mesh, double coincident) {
  constexpr double near = 0.1;  // of the shortest edge of the border
  std::set<int> border;
  double reach = std::numeric_limits<double>::infinity();
  for (const Edge& edge : mesh.edges)
    if (edge.triangles[1] < 0) {
      border.insert({edge.a, edge.b});
      reach = std::min(reach, near * (mesh.rest.col(edge.a) - mesh.rest.col(edge.b)).norm());
    }
  OpenSeams open;
  Kept kept(mesh.rest, std::max(reach, coincident));
  for (const int v : border)
    if (const int other = kept.near(v); other >= 0) {
      ++open.places;
      open.farthest = std::max(open.farthest, (mesh.rest.col(v) - mesh.rest.col(other)).norm());
    } else {
      kept.add(v);
    }
  return open;
}

}  // namespace

std::string open_seams_in_words(const TriangleMesh& mesh, const std::string& table, double unit) {
  const double coincident = 1e-6 * bounds_of(mesh.rest).sizes().maxCoeff();
  const OpenSeams open = open_seams(mesh, coincident);
  if (open.places == 0) return "";
  const double distance = std::max(coincident, 1.2 * open.farthest) / unit;
  char lie[60] = "coincide", words[240];
  if (open.farthest > coincident)
    std::snprintf(lie, sizeof lie, "of the border are %.2g or less apart", open.farthest / unit);
  std::snprintf(words, sizeof words,
                "at %d places vertices %s, so the %s is cut there; seams = %.2g of %s, or "
                "--seams %.2g, sews it",
                open.places, lie, table == "[cloth]" ? "cloth" : "body", distance, table.c_str(),
                distance);
  return words;
}

}  // namespace foldproof
