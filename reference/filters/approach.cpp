#include "reference/filters/approach.h"

#include <algorithm>
#include <limits>

namespace foldproof {

namespace {

// Planes tried before a motion is reported as an approach.
constexpr int max_planes = 1000;

//    first feature
//   ------o------      At time t the features are nearest across the vector N. A plane with that
//         | N          normal parts them as long as every point of the first is beyond every point
//   ------o------      of the second:
//    second feature      (x_i - x_j).N + tau (w_i - w_j).N > 0  for all i of the first, j of the
//                      second, each linear in tau, the time from t on. This is a proof for any N;
//                      the N between nearest points only makes it last long.
//
/// The time for which a plane with normal N keeps the features at least `gap` [m] apart, from
/// positions x at the rates `displacement`. Infinite if they do not close, negative if it does not
/// separate them now.
double separated_for(PairKind kind, const Corners4& x, const Corners4& displacement,
                     const Vector3& N, double gap) {
  const Eigen::RowVector4d height = N.transpose() * x,
                           rate = N.transpose() * displacement;  // m, m per motion
  const int first = kind == PairKind::vertex_triangle ? 1 : 2;   // points of the first feature
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < first; ++i)
    for (int j = first; j < 4; ++j) {
      const double clearance = height[i] - height[j] - gap, closing = rate[j] - rate[i];
      if (!(clearance > 0)) return -1;
      if (closing > 0) least = std::min(least, clearance / closing);
    }
  return least;
}

}  // namespace

std::optional<Approach> first_approach(PairKind kind, const Corners4& x,
                                       const Corners4& displacement, double min_distance) {
  // seen from one of the points, so that large coordinates and common motion cost no digits
  const Corners4 from = x.colwise() - Vector3(x.col(3)),
                 along = displacement.colwise() - Vector3(displacement.col(3));
  double t = 0;
  Nearness at = nearness(kind, from);
  // distances to keep, to report at, and for planes to guarantee (halfway between the two) [m]
  const double kept_distance = at.distance > min_distance ? min_distance : at.distance / 2;
  const double report_distance =
      kept_distance + std::min(at.distance - kept_distance, kept_distance) / 2;
  const double plane_gap = (kept_distance + report_distance) / 2;
  for (int plane = 0; plane < max_planes && at.distance > report_distance; ++plane) {
    const double duration = separated_for(kind, from + t * along, along, at.normal, plane_gap);
    if (!(duration > 0)) break;
    t += duration;
    if (t >= 1) return {};
    at = nearness(kind, from + t * along);
  }
  return Approach{t, at};
}

}  // namespace foldproof
