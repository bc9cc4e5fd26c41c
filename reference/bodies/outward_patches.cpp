// Which patches of a repaired mesh are turned, so that they have their inside within.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "reference/bodies/repair.h"
#include "reference/level_set/winding.h"

namespace foldproof {

namespace {

constexpr size_t own_samples = 32, other_samples = 3;
constexpr double flat = 0.02;  // winding number on the surface of a piece without an inside

/// The winding number of the triangles `of`: its mean by area over points just behind some of the
/// triangles `on`.
double mean_winding_number(const PerParticle3& x, const std::vector<Triangle>& of,
                           const std::vector<Triangle>& on, size_t samples) {
  double sum = 0, area = 0;
  for (size_t i = 0; i < on.size(); i += (on.size() + samples - 1) / samples) {
    const Vector3 a = x.col(on[i][0]), b = x.col(on[i][1]), c = x.col(on[i][2]);
    const Vector3 n = (b - a).cross(c - a);
    sum += n.norm() * winding_number(x, of, (a + b + c) / 3 - 1e-6 * n / std::sqrt(n.norm()));
    area += n.norm();
  }
  return sum / area;
}

/// Patches that are turned as one.
struct Piece {
  std::vector<int> places;  // in OrientedPatches::triangles
  std::vector<Triangle> triangles;
  Bounds bounds;
  double side;  // winding number on its own surface: 1/2 if closed and outward, -1/2 if inward
};

Piece make_piece(const PerParticle3& x, const std::vector<Triangle>& all, std::vector<int> places) {
  Piece piece{std::move(places), {}, {}, 0};
  for (const int t : piece.places) {
    piece.triangles.push_back(all[size_t(t)]);
    for (const int v : piece.triangles.back()) piece.bounds.extend(Vector3(x.col(v)));
  }
  piece.side = mean_winding_number(x, piece.triangles, piece.triangles, own_samples) - 0.5;
  return piece;
}

/// A piece comes after those that may enclose it. All flat patches are one piece.
std::vector<Piece> pieces_of_patches(const PerParticle3& x, const OrientedPatches& of) {
  std::vector<Piece> pieces;
  std::vector<int> rest;
  for (const std::vector<int>& patch : of.patches) {
    Piece piece = make_piece(x, of.triangles, patch);
    if (std::abs(piece.side) > flat)
      pieces.push_back(std::move(piece));
    else
      rest.insert(rest.end(), patch.begin(), patch.end());
  }
  if (!rest.empty()) pieces.push_back(make_piece(x, of.triangles, std::move(rest)));
  std::ranges::stable_sort(pieces, std::greater<>(),
                           [](const Piece& piece) { return piece.bounds.diagonal().norm(); });
  return pieces;
}

}  // namespace

OrientedPatches outward_patches(const TriangleSoup& soup) {
  OrientedPatches all = oriented_patches(soup);
  const std::vector<Piece> pieces = pieces_of_patches(soup.rest, all);
  std::vector<double> turn(pieces.size(), 1);    // -1: turned
  std::vector<double> around(pieces.size(), 0);  // winding number of those that enclose it
  for (size_t k = 0; k < pieces.size(); ++k) {
    const Piece& piece = pieces[k];
    const double own = std::abs(piece.side) > flat ? std::copysign(1, piece.side) : 0;
    const bool is_turned = around[k] + turn[k] * own < -0.5;
    if (is_turned) turn[k] = -turn[k];
    for (size_t j = k + 1; j < pieces.size(); ++j) {
      if (!piece.bounds.contains(pieces[j].bounds.center())) continue;
      const double value = std::round(
          mean_winding_number(soup.rest, piece.triangles, pieces[j].triangles, other_samples));
      if (is_turned && value != 0) turn[j] = -turn[j];
      around[j] += turn[k] * value;
    }
    if (turn[k] > 0) continue;
    for (const int t : piece.places)
      std::swap(all.triangles[size_t(t)][1], all.triangles[size_t(t)][2]);
  }
  return all;
}

}  // namespace foldproof
