// Which patches of a repaired mesh are turned, so that they have their inside within.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "reference/bodies/repair.h"
#include "reference/level_set/winding.h"

namespace foldproof {

namespace {

constexpr size_t most_samples = 32;  // of a piece's triangles
constexpr double undecided = 0.02;   // winding number on the surface of a flat piece: 0

/// Patches that are turned as one.
struct Piece {
  std::vector<int> triangles;  // places in OrientedPatches::triangles
  Bounds bounds;
  double side = 0;  // winding number on its own surface: 1/2 if closed and outward, -1/2 if inward
};

/// Points just behind some triangles of a piece, and the areas of these [m^2].
struct Sample {
  Vector3 point;
  double area;
};

std::vector<Sample> samples_of(const PerParticle3& x, const std::vector<Triangle>& all,
                               const std::vector<int>& piece, size_t most) {
  std::vector<Sample> samples;
  const size_t stride = (piece.size() + most - 1) / most;
  for (size_t i = 0; i < piece.size(); i += stride) {
    const Triangle& t = all[size_t(piece[i])];
    const Vector3 a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]), n = (b - a).cross(c - a);
    samples.push_back({(a + b + c) / 3 - 1e-6 * n / std::sqrt(n.norm()), n.norm() / 2});
  }
  return samples;
}

/// The winding number of a piece, by a tree if it is a large part of the mesh.
class PieceWinding {
 public:
  PieceWinding(const PerParticle3& x, const std::vector<Triangle>& all, const Piece& piece)
      : x_(x) {
    for (const int t : piece.triangles) triangles_.push_back(all[size_t(t)]);
    if (triangles_.size() < std::max<size_t>(200, all.size() / 20)) return;
    mesh_ = make_mesh_distance(x, triangles_);
    dipoles_ = make_dipoles(*mesh_);
  }

  double at(const Vector3& p) const {
    return mesh_ ? winding_number(*mesh_, dipoles_, p, 2) : winding_number(x_, triangles_, p);
  }

  /// Its mean over the samples, by area.
  double mean(const std::vector<Sample>& samples) const {
    double sum = 0, area = 0;
    for (const Sample& sample : samples) {
      sum += sample.area * at(sample.point);
      area += sample.area;
    }
    return sum / area;
  }

 private:
  const PerParticle3& x_;
  std::vector<Triangle> triangles_;
  std::optional<MeshDistance> mesh_;
  std::vector<Dipole> dipoles_;
};

std::vector<Piece> pieces_of_patches(const PerParticle3& x, const OrientedPatches& of) {
  const std::vector<Bounds> bounds = triangle_bounds(x, of.triangles);
  const auto measure = [&](Piece& piece) {
    piece.side = PieceWinding(x, of.triangles, piece)
                     .mean(samples_of(x, of.triangles, piece.triangles, most_samples)) -
                 0.5;
  };
  std::vector<Piece> pieces;
  Piece flat{{}, {}};  // all flat patches, of which none has an inside alone
  for (const std::vector<int>& patch : of.patches) {
    Piece piece{patch, {}};
    for (const int t : patch) piece.bounds.extend(bounds[size_t(t)]);
    measure(piece);
    if (std::abs(piece.side) > undecided) {
      pieces.push_back(std::move(piece));
      continue;
    }
    flat.triangles.insert(flat.triangles.end(), patch.begin(), patch.end());
    flat.bounds.extend(piece.bounds);
  }
  if (!flat.triangles.empty()) {
    measure(flat);
    pieces.push_back(std::move(flat));
  }
  // a piece comes after those that may enclose it
  std::ranges::stable_sort(pieces, std::greater<>(),
                           [](const Piece& piece) { return piece.bounds.diagonal().norm(); });
  return pieces;
}

}  // namespace

OrientedPatches outward_patches(const TriangleSoup& soup) {
  OrientedPatches of = oriented_patches(soup);
  const std::vector<Piece> pieces = pieces_of_patches(soup.rest, of);
  std::vector<int> turn(pieces.size(), 1);       // -1: turned
  std::vector<double> around(pieces.size(), 0);  // winding number of those that enclose it
  for (size_t k = 0; k < pieces.size(); ++k) {
    const double own = std::abs(pieces[k].side) < undecided ? 0 : pieces[k].side < 0 ? -1 : 1;
    const bool is_turned = around[k] + turn[k] * own < -0.5;
    std::optional<PieceWinding> winding;
    std::vector<size_t> within;
    std::vector<double> values;
    for (size_t j = k + 1; j < pieces.size(); ++j) {
      if (!pieces[k].bounds.contains(pieces[j].bounds.center())) continue;
      if (!winding) winding.emplace(soup.rest, of.triangles, pieces[k]);
      const double value =
          std::round(winding->mean(samples_of(soup.rest, of.triangles, pieces[j].triangles, 8)));
      if (value == 0) continue;
      if (is_turned) turn[j] = -turn[j];
      within.push_back(j);
      values.push_back(value);
    }
    if (is_turned) turn[k] = -turn[k];
    for (size_t i = 0; i < within.size(); ++i) around[within[i]] += turn[k] * values[i];
    if (turn[k] > 0) continue;
    for (const int t : pieces[k].triangles)
      std::swap(of.triangles[size_t(t)][1], of.triangles[size_t(t)][2]);
  }
  return of;
}

}  // namespace foldproof
