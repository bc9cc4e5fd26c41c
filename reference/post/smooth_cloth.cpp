#include "reference/post/smooth_cloth.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "reference/mesh/self_intersection.h"

namespace foldproof {

namespace {

constexpr double least_share = 1.0 / 1024;  // below it a point stays on the cloth

/// Reduces the shares of the triangle's points; true if any was not yet 0.
bool hold_back(const Triangle& triangle, std::vector<char>& is_held_back, PerParticle& share) {
  bool lessened = false;
  for (const int i : triangle) {
    if (share[i] == 0) continue;
    lessened = true;
    if (is_held_back[std::size_t(i)]) continue;  // once per round
    is_held_back[std::size_t(i)] = 1;
    share[i] = share[i] / 2 < least_share ? 0 : share[i] / 2;
  }
  return lessened;
}

}  // namespace

ClothSmoother::ClothSmoother(const TriangleMesh& mesh, int levels)
    : flat(subdivision(mesh, SubdivisionRule::midpoint, levels)),
      smooth(subdivision(mesh, SubdivisionRule::loop, levels)) {}

SmoothedCloth smooth_cloth(const ClothSmoother& smoother, const PerParticle3& x) {
  const PerParticle3 flat = smoother.flat.of(x), smooth = smoother.smooth.of(x);
  const std::vector<Triangle>& triangles = smoother.smooth.triangles;
  SmoothedCloth cloth{smooth, PerParticle::Ones(flat.cols())};
  for (bool lessened = true; lessened;) {
    const auto pairs = self_intersections(cloth.x, triangles);
    ++cloth.rounds;
    cloth.pairs_left = long(pairs.size());
    std::vector<char> is_held_back(std::size_t(flat.cols()), 0);
    lessened = false;
    for (const auto& [s, t] : pairs)
      for (const int k : {s, t})
        lessened |= hold_back(triangles[std::size_t(k)], is_held_back, cloth.share);
    for (Eigen::Index i = 0; i < flat.cols(); ++i)
      if (is_held_back[std::size_t(i)])
        cloth.x.col(i) = flat.col(i) + cloth.share[i] * (smooth.col(i) - flat.col(i));
  }
  return cloth;
}

}  // namespace foldproof
