#include "verification/oracles/exact_crossings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "verification/oracles/exact_crossing_times.h"
#include "verification/oracles/exact_geometry.h"

namespace foldproof::oracles {

namespace {

using Ends = std::array<int, 2>;
using Corners = std::array<int, 3>;

struct Box {
  Vector3 low, high;  // m
};

bool boxes_meet(const Box& a, const Box& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

/// An edge from p to q, and a triangle; a particle in common is p and the triangle's first corner.
struct Pair {
  Vector3 p, q;  // m
  Corners3 t;    // m
  bool is_shared;
};

// ---- decisions that doubles can make with certainty

/// Sign of the area of a, b, c seen along an axis, or 0 if double is not enough. Shewchuk (1997):
/// (3 + 16 e) e times the same sum of absolute values, e half the spacing of doubles at 1; the
/// least normal number covers underflow.
int sure_turn(const Vector3& a, const Vector3& b, const Vector3& c, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double left = (b[u] - a[u]) * (c[v] - a[v]), right = (b[v] - a[v]) * (c[u] - a[u]);
  const double bound =
      4 * (0.5 * std::numeric_limits<double>::epsilon()) * (std::abs(left) + std::abs(right)) +
      1e-290;
  const double area = left - right;
  return area > bound ? 1 : area < -bound ? -1 : 0;
}

/// Seen along the axis, is the edge surely on the outer side of one of the triangle's sides? A
/// common corner may lie on it.
bool is_beyond_a_side(const Pair& pair, int axis) {
  const Corners3& t = pair.t;
  const int inner = sure_turn(t[0], t[1], t[2], axis);
  if (inner == 0) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto is_outside = [&](const Vector3& point) {
      return sure_turn(t[k], t[(k + 1) % 3], point, axis) == -inner;
    };
    const bool p_is_out = pair.is_shared ? k != 1 : is_outside(pair.p);
    if (p_is_out && is_outside(pair.q)) return true;
  }
  return false;
}

/// Seen along the axis, is the triangle surely on one side of the edge's line?
bool is_beside_the_edge(const Pair& pair, int axis) {
  const int side = sure_turn(pair.p, pair.q, pair.t[1], axis);
  return side != 0 && sure_turn(pair.p, pair.q, pair.t[2], axis) == side &&
         (pair.is_shared || sure_turn(pair.p, pair.q, pair.t[0], axis) == side);
}

bool are_surely_apart(const Pair& pair) {
  for (int axis = 0; axis < 3; ++axis)
    if (is_beyond_a_side(pair, axis) || is_beside_the_edge(pair, axis)) return true;
  return false;
}

// ---- exact decisions

FourPoints four(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  FourPoints x;
  x << a, b, c, d;
  return x;
}

bool is_in_triangle(const Vector3& p, const Corners3& t) {
  return meet(Features::vertex_and_triangle, four(p, t[0], t[1], t[2]));
}

bool segments_meet(const Vector3& p, const Vector3& q, const Vector3& a, const Vector3& b) {
  return meet(Features::edge_and_edge, four(p, q, a, b));
}

/// All in one plane, or on a line. A segment whose ends lie outside crosses two sides, if any.
bool flat_ones_meet(const Pair& pair) {
  const auto& [p, q, t, is_shared] = pair;
  return is_in_triangle(p, t) || is_in_triangle(q, t) || segments_meet(p, q, t[0], t[1]) ||
         segments_meet(p, q, t[1], t[2]);
}

/// Without a particle in common.
bool strangers_meet(const Pair& pair) {
  const auto& [p, q, t, is_shared] = pair;
  const int from = orientation(t[0], t[1], t[2], p), to = orientation(t[0], t[1], t[2], q);
  if (from * to > 0) return false;
  if (from == 0 && to == 0) return flat_ones_meet(pair);
  const int turns[] = {orientation(p, q, t[0], t[1]), orientation(p, q, t[1], t[2]),
                       orientation(p, q, t[2], t[0])};
  const auto [least, most] = std::minmax_element(turns, turns + 3);
  return *least >= 0 || *most <= 0;
}

/// With a corner in common: do they have more in common?
bool neighbours_overlap(const Pair& pair) {
  const auto& [p, q, t, is_shared] = pair;
  if (orientation(t[0], t[1], t[2], q) != 0) return false;
  return is_in_triangle(q, t) || segments_meet(p, q, t[1], t[2]);
}

bool is_counted(const Pair& pair) {
  if (are_surely_apart(pair)) return false;
  return pair.is_shared ? neighbours_overlap(pair) : strangers_meet(pair);
}

// ---- search for near pairs

std::vector<Ends> edges_of(const std::vector<Corners>& triangles) {
  std::vector<Ends> edges;
  for (const Corners& t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

Box box_of(const PerParticle3& x, const Corners& t) {
  const Vector3 a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]);
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

/// Boxes sorted by their start along an axis: a tree whose root is the middle one, with the
/// farthest end in each part of it.
class Sweep {
 public:
  Sweep(std::vector<Box> boxes, int axis)
      : boxes_(std::move(boxes)), axis_(axis), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    std::sort(order_.begin(), order_.end(),
              [&](int i, int k) { return begin_of(i) < begin_of(k); });
    farthest_.resize(order_.size());
    find_farthest(0, order_.size());
  }

  /// Calls visit(i) for every box i that meets the given one.
  template <class Visit>
  void meeting(const Box& box, const Visit& visit) const {
    meeting_in(0, order_.size(), box, visit);
  }

 private:
  double find_farthest(std::size_t first, std::size_t end) {
    if (first == end) return -std::numeric_limits<double>::infinity();
    const std::size_t middle = first + (end - first) / 2;
    return farthest_[middle] =
               std::max({boxes_[std::size_t(order_[middle])].high[axis_],
                         find_farthest(first, middle), find_farthest(middle + 1, end)});
  }

  template <class Visit>
  void meeting_in(std::size_t first, std::size_t end, const Box& box, const Visit& visit) const {
    const std::size_t middle = first + (end - first) / 2;
    if (first == end || farthest_[middle] < box.low[axis_]) return;
    meeting_in(first, middle, box, visit);
    if (begin_of(order_[middle]) > box.high[axis_]) return;
    if (boxes_meet(boxes_[std::size_t(order_[middle])], box)) visit(order_[middle]);
    meeting_in(middle + 1, end, box, visit);
  }

  double begin_of(int i) const { return boxes_[std::size_t(i)].low[axis_]; }

  std::vector<Box> boxes_;
  int axis_;
  std::vector<int> order_;
  std::vector<double> farthest_;
};

Sweep sweep_over(const PerParticle3& x, const std::vector<Corners>& triangles) {
  std::vector<Box> boxes;
  for (const Corners& t : triangles) boxes.push_back(box_of(x, t));
  int longest;
  (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff(&longest);
  return {std::move(boxes), longest};
}

/// The pair with its common particle first; false if the edge is the triangle's own.
bool make_pair(const PerParticle3& x, Ends edge, Corners t, Pair& pair) {
  const auto belongs = [&](int particle) {
    return std::find(t.begin(), t.end(), particle) != t.end();
  };
  if (belongs(edge[1])) std::swap(edge[0], edge[1]);
  if (belongs(edge[1])) return false;
  const auto shared = std::find(t.begin(), t.end(), edge[0]);
  if (shared != t.end()) std::rotate(t.begin(), shared, t.end());
  pair = {
      x.col(edge[0]), x.col(edge[1]), {x.col(t[0]), x.col(t[1]), x.col(t[2])}, shared != t.end()};
  return true;
}

}  // namespace

std::vector<EdgeInTriangle> exact_crossings(const PerParticle3& x,
                                            const std::vector<Corners>& triangles) {
  if (!x.allFinite()) throw std::invalid_argument("positions that are not finite cross nothing");
  if (triangles.empty()) return {};
  const Sweep sweep = sweep_over(x, triangles);
  std::vector<EdgeInTriangle> found;
  for (const Ends& edge : edges_of(triangles)) {
    const Vector3 a = x.col(edge[0]), b = x.col(edge[1]);
    sweep.meeting({a.cwiseMin(b), a.cwiseMax(b)}, [&](int t) {
      Pair pair;
      if (make_pair(x, edge, triangles[std::size_t(t)], pair) && is_counted(pair))
        found.push_back({edge, t});
    });
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace foldproof::oracles
