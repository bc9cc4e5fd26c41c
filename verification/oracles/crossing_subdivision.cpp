#include "verification/oracles/crossing_subdivision.h"

#include <algorithm>
#include <vector>

namespace foldproof::oracles {

namespace {

/// Corners, in order, of a flat convex polygon that holds the origin iff the features meet.
using Corners = std::vector<Exact>;

/// The polygon at the start and at the end of a time interval.
struct Stretch {
  Corners from, to;
};

Corners corners_of(Features features, const Quad<Whole>& x) {
  if (features == Features::edge_and_edge)
    return {x[2] - x[0], x[3] - x[0], x[3] - x[1], x[2] - x[1]};
  return {x[1] - x[0], x[2] - x[0], x[3] - x[0]};
}

/// Twice the polygon halfway.
Corners doubled_middle(const Stretch& s) {
  Corners middle;
  for (std::size_t i = 0; i < s.from.size(); ++i) middle.push_back(s.from[i] + s.to[i]);
  return middle;
}

Corners double_corners(const Corners& corners) {
  Corners result;
  for (const Exact& d : corners) result.push_back(d + d);
  return result;
}

Exact normal_of(const Corners& c) { return cross(c[1] - c[0], c[2] - c[0]); }

bool all_beyond(const Corners& corners, const Exact& direction) {
  return std::all_of(corners.begin(), corners.end(),
                     [&](const Exact& d) { return dot(d, direction).sign() > 0; });
}

bool parted_along(const Stretch& s, const Exact& u) {
  return (all_beyond(s.from, u) && all_beyond(s.to, u)) ||
         (all_beyond(s.from, -u) && all_beyond(s.to, -u));
}

/// Directions that may separate the origin from the polygon: normal to it, away from its corners,
/// and normal to its sides.
std::vector<Exact> directions(const Corners& middle) {
  const Exact n = normal_of(middle);
  std::vector<Exact> all{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, n};
  for (std::size_t i = 0; i < middle.size(); ++i) {
    const Exact side = middle[(i + 1) % middle.size()] - middle[i];
    all.push_back(middle[i]);
    all.push_back(cross(n, side));
    all.push_back(cross(side, cross(side, middle[i])));
  }
  return all;
}

bool is_parted(const Stretch& s) {
  for (const Exact& u : directions(doubled_middle(s)))
    if (parted_along(s, u)) return true;
  return false;
}

/// Does (d_i x d_{i+1}) . u, quadratic in time, keep the sign `side`? By its three Bernstein
/// coefficients.
bool keeps_turning(const Stretch& s, std::size_t i, const Exact& u, int side) {
  const std::size_t k = (i + 1) % s.from.size();
  const auto turn = [&](const Exact& p, const Exact& q) { return dot(cross(p, q), u); };
  return side * turn(s.from[i], s.from[k]).sign() > 0 && side * turn(s.to[i], s.to[k]).sign() > 0 &&
         side * Whole(turn(s.from[i], s.to[k]) + turn(s.to[i], s.from[k])).sign() > 0;
}

bool passes_through(const Stretch& s) {
  const auto height = [](const Corners& c) { return dot(normal_of(c), c[0]).sign(); };
  if (height(s.from) * height(s.to) >= 0) return false;
  const Exact u = normal_of(doubled_middle(s));
  for (const int side : {-1, 1}) {
    bool stays = true;
    for (std::size_t i = 0; i < s.from.size() && stays; ++i) stays = keeps_turning(s, i, u, side);
    if (stays) return true;
  }
  return false;
}

MeetDecision decide(const Stretch& s, int halvings) {
  if (is_parted(s)) return MeetDecision::apart;
  if (passes_through(s)) return MeetDecision::meet;
  if (halvings == 0) return MeetDecision::unclear;
  const Corners middle = doubled_middle(s);
  const MeetDecision first = decide({double_corners(s.from), middle}, halvings - 1);
  if (first == MeetDecision::meet) return first;
  const MeetDecision second = decide({middle, double_corners(s.to)}, halvings - 1);
  if (second == MeetDecision::meet) return second;
  return first == MeetDecision::apart ? second : first;
}

}  // namespace

MeetDecision decide_by_subdivision(Features features, const ExactMotion& motion, int halvings) {
  Quad<Whole> end;
  for (std::size_t i = 0; i < 4; ++i) end[i] = motion.start[i] + motion.displacement[i];
  return decide({corners_of(features, motion.start), corners_of(features, end)}, halvings);
}

}  // namespace foldproof::oracles
