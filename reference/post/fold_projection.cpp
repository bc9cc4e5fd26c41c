#include "reference/post/fold_projection.h"

#include <algorithm>
#include <cmath>

namespace foldproof {

namespace {

/// The current place of a point.
struct Place {
  Vector3 x;   // m
  double phi;  // there [m]
  ProjectionOutcome fate;
};

/// The union of the objects at one time.
struct Union {
  ObjectsOverSpan objects;
  long queries = 0;

  Nearest at(const Vector3& p) {
    ++queries;
    return nearest_of(objects.at(p));
  }
};

/// Moves p, where the objects return `here`, until phi is f or slightly more.
Place move_point(Union& solids, const FoldProjection& projection, Vector3 p, ObjectPoint here,
                 double f) {
  const double aim = f + projection.tolerance / 2;
  Place best{p, here.phi, ProjectionOutcome::unfinished};
  for (int move = 0; move < projection.max_moves; ++move) {
    p += (aim - here.phi) * here.normal;
    here = solids.at(p).first;
    if (f <= here.phi && here.phi <= f + projection.tolerance)
      return {p, here.phi, ProjectionOutcome::moved};
    if (std::abs(here.phi - aim) < std::abs(best.phi - aim))
      best = {p, here.phi, ProjectionOutcome::unfinished};
  }
  return best;
}

/// Projects p, given its nearest objects.
Place project_point(Union& solids, const FoldProjection& projection, const DepthMap& map,
                    const Vector3& p, const Nearest& nearest) {
  const double phi = nearest.first.phi, f = map.at(projection.band, phi);
  if (nearest.pinched() && projection.pinched == PinchedPoints::left_alone)
    return {p, phi, ProjectionOutcome::pinched};
  if (!(f > phi)) return {p, phi, ProjectionOutcome::untouched};
  return move_point(solids, projection, p, nearest.first, f);
}

void check_projection(const FoldProjection& projection) {
  check_band(projection.band);
  if (projection.tolerance > 0 && std::isfinite(projection.tolerance) && projection.max_moves > 0)
    return;
  throw InputError(
      "a projection needs a tolerance above 0 and a move or more for a point, but has " +
      std::to_string(projection.tolerance) + " m and " + std::to_string(projection.max_moves));
}

}  // namespace

int ProjectedCloth::count(ProjectionOutcome fate) const {
  return int(std::count(outcomes.begin(), outcomes.end(), fate));
}

ProjectedCloth project_folds(std::span<const Object> objects, const PerParticle3& x, double time,
                             const FoldProjection& projection) {
  check_projection(projection);
  const DepthMap& map = depth_map_named(projection.map);
  Union solids{{objects, {time, time, 0}}};
  ProjectedCloth cloth{x, PerParticle(x.cols()), PerParticle(x.cols()), {}};
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Nearest nearest = solids.at(x.col(i));
    const Place place = project_point(solids, projection, map, x.col(i), nearest);
    cloth.before[i] = nearest.first.phi;
    cloth.x.col(i) = place.x;
    cloth.after[i] = place.phi;
    cloth.outcomes.push_back(place.fate);
  }
  cloth.object_queries = solids.queries;
  return cloth;
}

}  // namespace foldproof
