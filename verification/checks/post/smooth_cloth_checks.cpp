// Smooth surfaces that do not cross themselves, decided by the oracle without rounding.
#include <fmt/format.h>

#include "reference/mesh/shapes.h"
#include "reference/post/smooth_cloth.h"
#include "verification/oracles/exact_crossings.h"
#include "verification/specimens/check.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/ugly_solids.h"

namespace foldproof {

namespace {

/// Two ridges, one inside the other; the upper one has cells twice as wide, so that Loop's rule
/// flattens its ridge more than the lower one's.
struct NestedRidges {
  std::string words;
  TriangleMesh mesh;
  PerParticle3 x;
};

NestedRidges nested_ridges(double gap, double slope) {
  const TriangleMesh lower = make_sheet({SheetPattern::alternating, 1, 0.6, 8, 5}),
                     upper = make_sheet({SheetPattern::one_diagonal, 1, 0.6, 4, 3});
  const TriangleSoup both = join(soup_of(lower), soup_of(upper), {0, 0, gap});
  PerParticle3 x = both.rest;
  for (Eigen::Index i = 0; i < x.cols(); ++i) x(2, i) -= slope * std::abs(x(0, i) - 0.5);
  return {fmt::format("gap {}, slope {}", gap, slope),
          make_triangle_mesh(both.rest, both.triangles), x};
}

/// In the last two, points must be held back many times, some until they stay on the cloth.
std::vector<NestedRidges> all_ridges() {
  return {nested_ridges(0.015, 0.9), nested_ridges(0.011, 1.3), nested_ridges(0.002, 0.4),
          nested_ridges(3e-4, 0.7), nested_ridges(1e-5, 0.5)};
}

long crossings(const PerParticle3& x, const std::vector<Triangle>& triangles) {
  return long(oracles::exact_crossings(x, triangles).size());
}

Finding never_crosses() {
  Table found(
      "ridges; levels [1]; Loop's crossings [1]; crossings [1]; rounds [1]; mean share of the way "
      "[1]; points that stay on the cloth [1]");
  for (const NestedRidges& ridges : all_ridges())
    for (const int levels : {1, 2}) {
      const ClothSmoother smoother(ridges.mesh, levels);
      const SmoothedCloth cloth = smooth_cloth(smoother, ridges.x);
      const std::vector<Triangle>& triangles = smoother.smooth.triangles;
      found.row(ridges.words, levels, crossings(smoother.smooth.of(ridges.x), triangles),
                crossings(cloth.x, triangles), cloth.rounds, cloth.share.mean(),
                (cloth.share.array() == 0).count());
    }
  // where Loop's surface does not cross, this shows nothing
  const auto& plain = found.numbers("Loop's crossings");
  const bool is_hard = *std::min_element(plain.begin(), plain.end()) > 0;
  const double most = is_hard ? found.worst("crossings") : nan;
  return {{most, 0, 0, "pairs", "the cloth starts without one, and shares of 0 give it back"},
          found,
          "by an oracle that shares no code with the method"};
}

Finding loop_where_free() {
  Table found{{"cloth", ""}, {"numbers that differ", "1"}};
  for (const Specimen& shape : curved_shapes()) {
    const ClothSmoother smoother(shape.scene.mesh, 1);
    const PerParticle3 x = smooth_cloth(smoother, shape.state.x).x,
                       loop = smoother.smooth.of(shape.state.x);
    if (crossings(loop, smoother.smooth.triangles) > 0) continue;
    found.row(shape.name, (x.array() != loop.array()).count());
  }
  return judge_worst(found, "numbers that differ", 0, "nothing is held back without a contact");
}

/// The largest angle between neighbours over the lower ridge [rad].
double sharpest_fold(const std::vector<Triangle>& triangles, const PerParticle3& x) {
  const TriangleMesh mesh = make_triangle_mesh(x, triangles);
  double sharpest = 0;
  for (const Hinge& hinge : mesh.hinges) {
    const Corners c = corners_of(hinge, x);
    const Vector3 n1 = (c[0] - c[2]).cross(c[0] - c[3]), n2 = (c[1] - c[3]).cross(c[1] - c[2]);
    sharpest = std::max(sharpest, std::atan2(n1.cross(n2).norm(), n1.dot(n2)));
  }
  return sharpest;
}

Finding contacts_keep_creases() {
  Table found(
      "ridges; sharpest fold of the cloth [rad]; of Loop's surface [rad]; of the smooth cloth "
      "[rad]; Loop's over the smooth cloth's [1]");
  for (const NestedRidges& ridges : all_ridges()) {
    const ClothSmoother smoother(ridges.mesh, 2);
    const std::vector<Triangle>& triangles = smoother.smooth.triangles;
    const double loop = sharpest_fold(triangles, smoother.smooth.of(ridges.x)),
                 kept = sharpest_fold(triangles, smooth_cloth(smoother, ridges.x).x);
    found.row(ridges.words, sharpest_fold(ridges.mesh.triangles, ridges.x), loop, kept,
              loop / kept);
  }
  return judge_worst(found, 1 / 1.5, "a fold half as sharp again is one that is seen",
                     "two levels; where layers touch, points stay on the cloth's own triangles");
}

}  // namespace

std::vector<Check> smooth_cloth_checks() {
  const char* source = "Bridson, Fedkiw, Anderson 2002";
  return {
      {"smoothing.never-makes-a-crossing",
       "Two ridges that Loop's rule would push through each other are smoothed without a crossing.",
       source, never_crosses},
      {"smoothing.is-loops-rule-where-nothing-is-near",
       "Cloth that Loop's rule leaves without a crossing is smoothed by that rule, bit for bit.",
       source, loop_where_free},
      {"smoothing.contacts-keep-creases",
       "Where layers touch, a smoothed cloth keeps folds that are sharper than those of Loop's "
       "surface, by half at least.",
       source, contacts_keep_creases}};
}

}  // namespace foldproof
