#include "reference/mesh/self_intersection.h"

#include <algorithm>
#include <array>
#include <functional>

#include "reference/mesh/exact_sign.h"

namespace foldproof {

namespace {

using Vector2 = Eigen::Vector2d;
using Corners = std::array<Vector3, 3>;

constexpr int leaf_size = 4;

Vector2 drop_axis(const Vector3& x, int axis) { return {x[(axis + 1) % 3], x[(axis + 2) % 3]}; }

/// An axis along which the triangle projects to nonzero area.
int open_axis(const Corners& t) {
  for (int axis = 0; axis < 3; ++axis)
    if (side_of_line(drop_axis(t[0], axis), drop_axis(t[1], axis), drop_axis(t[2], axis)) != 0)
      return axis;
  return 0;
}

/// Do the boxes of two segments overlap? Decides where all four ends lie on a line.
bool boxes_meet(const Vector2& a, const Vector2& b, const Vector2& p, const Vector2& q) {
  return (a.cwiseMin(b).array() <= p.cwiseMax(q).array()).all() &&
         (p.cwiseMin(q).array() <= a.cwiseMax(b).array()).all();
}

bool segments_meet(const Vector2& a, const Vector2& b, const Vector2& p, const Vector2& q) {
  return side_of_line(a, b, p) * side_of_line(a, b, q) <= 0 &&
         side_of_line(p, q, a) * side_of_line(p, q, b) <= 0 && boxes_meet(a, b, p, q);
}

/// All three of one sign, zeros on either side.
bool agree(int a, int b, int c) {
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// The segment p q lies in the triangle's plane.
bool meet_in_plane(const Corners& t, const Vector3& p, const Vector3& q) {
  const int axis = open_axis(t);
  const Vector2 a = drop_axis(t[0], axis), b = drop_axis(t[1], axis), c = drop_axis(t[2], axis);
  const Vector2 u = drop_axis(p, axis), v = drop_axis(q, axis);
  if (agree(side_of_line(a, b, u), side_of_line(b, c, u), side_of_line(c, a, u))) return true;
  return segments_meet(a, b, u, v) || segments_meet(b, c, u, v) || segments_meet(c, a, u, v);
}

/// Does the segment p q meet the triangle? Its ends lie on two sides of the plane, its line on one
/// side of all three edges.
bool meets(const Corners& t, const Vector3& p, const Vector3& q) {
  const int side_p = side_of_plane(t[0], t[1], t[2], p),
            side_q = side_of_plane(t[0], t[1], t[2], q);
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) return meet_in_plane(t, p, q);
  return agree(side_of_plane(p, q, t[0], t[1]), side_of_plane(p, q, t[1], t[2]),
               side_of_plane(p, q, t[2], t[0]));
}

Corners corners_of(const PerParticle3& x, const Triangle& t) {
  return {x.col(t[0]), x.col(t[1]), x.col(t[2])};
}

bool has_corner(const Triangle& t, int v) { return std::find(t.begin(), t.end(), v) != t.end(); }

/// Triangles with a common edge overlap only when they are folded flat onto each other.
bool folded_flat(const PerParticle3& x, const Triangle& s, const Triangle& t) {
  int apex = 0;
  while (has_corner(s, t[apex])) ++apex;
  const Vector3 far = x.col(t[apex]);
  const Corners corners = corners_of(x, s);
  if (side_of_plane(corners[0], corners[1], corners[2], far) != 0) return false;
  int other = 0;
  while (has_corner(t, s[other])) ++other;
  const int axis = open_axis(corners);
  const Vector2 a = drop_axis(corners[(other + 1) % 3], axis),
                b = drop_axis(corners[(other + 2) % 3], axis);
  return side_of_line(a, b, drop_axis(corners[other], axis)) ==
         side_of_line(a, b, drop_axis(far, axis));
}

/// Does an edge of s that does not end in a vertex of t meet t?
bool edges_meet(const PerParticle3& x, const Triangle& s, const Triangle& t) {
  const Corners corners = corners_of(x, t);
  for (int k = 0; k < 3; ++k) {
    const int a = s[k], b = s[(k + 1) % 3];
    if (has_corner(t, a) || has_corner(t, b)) continue;
    if (meets(corners, x.col(a), x.col(b))) return true;
  }
  return false;
}

/// Is there a side of s (3 x 3 [m], z = 0) across which s and t overlap by at most `least` [m]?
bool side_parts(const Eigen::Matrix3d& s, const Eigen::Matrix3d& t, double least) {
  for (int k = 0; k < 3; ++k) {
    const Vector3 normal = (s.col((k + 1) % 3) - s.col(k)).cross(Vector3::UnitZ()).normalized();
    const Eigen::RowVector3d of_s = normal.transpose() * s, of_t = normal.transpose() * t;
    if (of_s.maxCoeff() - of_t.minCoeff() <= least || of_t.maxCoeff() - of_s.minCoeff() <= least)
      return true;
  }
  return false;
}

/// Appends the pairs of triangle s with later triangles that meet it.
void add_pairs_of(int s, const std::vector<Bounds>& boxes, const BoxTree& tree,
                  const std::function<bool(int)>& meets_s,
                  std::vector<std::pair<int, int>>& pairs) {
  std::vector<int> found, waiting{0};
  while (!waiting.empty()) {
    const int at = waiting.back();
    waiting.pop_back();
    const BoxNode& node = tree.nodes[at];
    if (!node.bounds.intersects(boxes[s])) continue;
    if (node.right >= 0) {
      waiting.insert(waiting.end(), {at + 1, node.right});
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const int t = tree.order[i];
      if (t > s && boxes[t].intersects(boxes[s]) && meets_s(t)) found.push_back(t);
    }
  }
  std::sort(found.begin(), found.end());
  for (const int t : found) pairs.emplace_back(s, t);
}

}  // namespace

// If two triangles meet in more than their common vertices, their intersection ends where it leaves
// one of them through an edge; with one vertex shared, through the edge opposite it.
bool intersect(const PerParticle3& x, const Triangle& s, const Triangle& t) {
  const long shared = std::count_if(s.begin(), s.end(), [&](int v) { return has_corner(t, v); });
  if (shared == 2) return folded_flat(x, s, t);
  return edges_meet(x, s, t) || edges_meet(x, t, s);
}

std::vector<std::pair<int, int>> self_intersections(const PerParticle3& x,
                                                    const std::vector<Triangle>& triangles) {
  const std::vector<Bounds> boxes = triangle_bounds(x, triangles);
  const BoxTree tree = make_box_tree(boxes, leaf_size);
  std::vector<std::pair<int, int>> pairs;
  for (int s = 0; s < int(triangles.size()); ++s)
    add_pairs_of(
        s, boxes, tree, [&](int t) { return intersect(x, triangles[s], triangles[t]); }, pairs);
  return pairs;
}

std::size_t overlaps_in_plane(const PerParticle3& x, const std::vector<Triangle>& triangles,
                              const Vector3& first, const Vector3& second, double least) {
  PerParticle3 flat = PerParticle3::Zero(3, x.cols());
  flat.row(0) = first.transpose() * x;
  flat.row(1) = second.transpose() * x;
  const std::vector<Bounds> boxes = triangle_bounds(flat, triangles);
  const BoxTree tree = make_box_tree(boxes, leaf_size);
  const auto corners = [&](int t) -> Eigen::Matrix3d { return flat(Eigen::all, triangles[t]); };
  std::vector<std::pair<int, int>> pairs;
  for (int s = 0; s < int(triangles.size()); ++s) {
    const auto overlaps_s = [&](int t) {
      return !side_parts(corners(s), corners(t), least) &&
             !side_parts(corners(t), corners(s), least);
    };
    add_pairs_of(s, boxes, tree, overlaps_s, pairs);
  }
  return pairs.size();
}

}  // namespace foldproof
