#include "verification/oracles/exact_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "verification/oracles/whole_points.h"
#include "verification/seeds.h"

namespace foldproof::oracles {

namespace {

int exact_orientation(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const int k = common_exponent({a, b, c, d});
  const Exact origin = exact(a, k);
  return sign_of(dot(cross(exact(b, k) - origin, exact(c, k) - origin), exact(d, k) - origin));
}

/// Sign of the area of (a, b, c) seen along an axis.
int turn(const Vector3& a, const Vector3& b, const Vector3& c, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3, k = common_exponent({a, b, c});
  const auto along = [&](const Vector3& to, int coordinate) {
    return Whole(whole(to[coordinate], k) - whole(a[coordinate], k));
  };
  return sign_of(along(b, u) * along(c, v) - along(b, v) * along(c, u));
}

/// An axis along which the triangle has an area; throws std::runtime_error if it is a line.
int axis_of(const Corners3& t) {
  for (int axis = 0; axis < 3; ++axis)
    if (turn(t[0], t[1], t[2], axis) != 0) return axis;
  throw std::runtime_error("a triangle without area has no inside");
}

/// Is p in the closed triangle? Both lie in one plane.
bool holds(const Corners3& t, const Vector3& p, int axis) {
  bool left = false, right = false;
  for (int k = 0; k < 3; ++k) {
    const int side = turn(t[k], t[(k + 1) % 3], p, axis);
    left |= side > 0;
    right |= side < 0;
  }
  return !(left && right);
}

/// Do the closed segments p q and a b have a point in common? All lie in one plane. At least one of
/// p, q, a, b is off the line of the other two, or only an end can be common, which `holds` has
/// tested.
bool segments_cross(const Vector3& p, const Vector3& q, const Vector3& a, const Vector3& b,
                    int axis) {
  const int pa = turn(p, q, a, axis), pb = turn(p, q, b, axis);
  const int ap = turn(a, b, p, axis), aq = turn(a, b, q, axis);
  if (pa == 0 && pb == 0) return false;
  return pa * pb <= 0 && ap * aq <= 0;
}

/// The same for a segment in the triangle's plane. A segment along an edge has an end in the
/// triangle, or crosses the two other edges at that edge's ends.
bool coplanar_segment_meets(const Vector3& p, const Vector3& q, const Corners3& t) {
  const int axis = axis_of(t);
  if (holds(t, p, axis) || holds(t, q, axis)) return true;
  for (int k = 0; k < 3; ++k)
    if (segments_cross(p, q, t[k], t[(k + 1) % 3], axis)) return true;
  return false;
}

/// How a line from p to q passes a triangle whose plane it crosses: the signs of its three volumes
/// with the edges.
struct Passage {
  bool misses, touches_edge;
};

Passage passage(const Vector3& p, const Vector3& q, const Corners3& t) {
  const int s[3] = {orientation(p, q, t[0], t[1]), orientation(p, q, t[1], t[2]),
                    orientation(p, q, t[2], t[0])};
  const auto [least, most] = std::minmax({s[0], s[1], s[2]});
  return {least < 0 && most > 0, s[0] * s[1] * s[2] == 0};
}

bool segment_meets(const Vector3& p, const Vector3& q, const Corners3& t) {
  const int from = orientation(t[0], t[1], t[2], p), to = orientation(t[0], t[1], t[2], q);
  if (from * to > 0) return false;
  if (from == 0 && to == 0) return coplanar_segment_meets(p, q, t);
  return !passage(p, q, t).misses;
}

bool an_edge_meets(const Corners3& s, const Corners3& t) {
  return segment_meets(s[0], s[1], t) || segment_meets(s[1], s[2], t) ||
         segment_meets(s[2], s[0], t);
}

struct Bounds {
  Vector3 low, high;  // m
};

Bounds bounds_of(const Corners3& t) {
  return {t[0].cwiseMin(t[1]).cwiseMin(t[2]), t[0].cwiseMax(t[1]).cwiseMax(t[2])};
}

bool boxes_meet(const Bounds& a, const Bounds& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

std::vector<Bounds> all_bounds(const TriangleSoup& soup) {
  std::vector<Bounds> bounds;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    bounds.push_back(bounds_of(corners(soup, t)));
  return bounds;
}

/// A point far outside the surface, a new one each time, placed so that the box of the segment from
/// p is slim.
Vector3 far_point(const TriangleSoup& surface, const Vector3& p, std::mt19937_64& bits) {
  const Vector3 high = surface.x.rowwise().maxCoeff(), low = surface.x.rowwise().minCoeff();
  const double size = (high - low).maxCoeff();
  const auto random = [&] { return double(bits() >> 11) * 0x1p-53; };
  return {std::max(high.x(), p.x()) + size * (1 + random()), p.y() + 0.05 * size * (random() - 0.5),
          p.z() + 0.05 * size * (random() - 0.5)};
}

/// Result for one segment from p.
enum class Crossings { even, odd, on_surface, unclear };

Crossings crossings(const TriangleSoup& surface, const std::vector<Bounds>& bounds,
                    const Vector3& p, const Vector3& far) {
  const Bounds box{p.cwiseMin(far), p.cwiseMax(far)};
  bool is_odd = false;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    if (!boxes_meet(box, bounds[k])) continue;
    const Corners3 t = corners(surface, k);
    const int from = orientation(t[0], t[1], t[2], p), to = orientation(t[0], t[1], t[2], far);
    if (from == 0 && holds(t, p, axis_of(t))) return Crossings::on_surface;
    if (from == 0 && to == 0) return Crossings::unclear;
    if (from * to >= 0) continue;
    const Passage through = passage(p, far, t);
    if (through.misses) continue;
    if (through.touches_edge) return Crossings::unclear;
    is_odd = !is_odd;
  }
  return is_odd ? Crossings::odd : Crossings::even;
}

Side side_within(const TriangleSoup& surface, const std::vector<Bounds>& bounds, const Vector3& p) {
  std::mt19937_64 bits(shifted_seed(4711));
  for (int trial = 0; trial < 100; ++trial) {
    const Crossings seen = crossings(surface, bounds, p, far_point(surface, p, bits));
    if (seen == Crossings::on_surface) return Side::on_surface;
    if (seen != Crossings::unclear) return seen == Crossings::odd ? Side::inside : Side::outside;
  }
  throw std::runtime_error("no segment from the point misses all edges of the surface");
}

/// Are all points of the segment a b, apart from its ends, farther than r from the origin?
bool edge_clears(const Exact& a, const Exact& b, const Whole& squared_radius) {
  const Exact along = b - a;
  const Whole length2 = dot(along, along), at = -dot(a, along);
  if (at <= 0 || at >= length2) return true;  // the nearest point is an end
  return dot(a, a) * length2 - at * at > squared_radius * length2;
}

/// Are all points of the triangle, apart from its edges, farther than r from the origin?
bool face_clears(const std::array<Exact, 3>& t, const Whole& squared_radius) {
  const Exact n = cross(t[1] - t[0], t[2] - t[0]);
  // the origin's foot is outside an edge: the nearest point is on the border
  for (int k = 0; k < 3; ++k)
    if (dot(cross(n, t[(k + 1) % 3] - t[k]), t[k]) >= 0) return true;
  const Whole height = dot(n, t[0]);
  return height * height > squared_radius * dot(n, n);
}

}  // namespace

Corners3 corners(const TriangleSoup& soup, std::size_t triangle) {
  const std::array<int, 3>& t = soup.triangles[triangle];
  return {soup.x.col(t[0]), soup.x.col(t[1]), soup.x.col(t[2])};
}

TriangleSoup box_between(const Vector3& low, const Vector3& high) {
  TriangleSoup box{PerParticle3(3, 8),
                   {{0, 2, 3},
                    {0, 3, 1},
                    {4, 5, 7},
                    {4, 7, 6},
                    {0, 1, 5},
                    {0, 5, 4},
                    {2, 6, 7},
                    {2, 7, 3},
                    {0, 4, 6},
                    {0, 6, 2},
                    {1, 3, 7},
                    {1, 7, 5}}};
  for (int corner = 0; corner < 8; ++corner)  // bit k: on the high side of axis k
    for (int k = 0; k < 3; ++k) box.x(k, corner) = corner >> k & 1 ? high[k] : low[k];
  return box;
}

// The determinant in double has the right sign beyond the bound of Shewchuk (1997), (7 + 56 e) e
// times the same sum of absolute values, e half the spacing of doubles at 1. The least normal
// number covers underflow.
int orientation(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const Vector3 p = b - a, q = c - a, r = d - a;
  const double xy = p.x() * q.y(), yx = p.y() * q.x(), yz = p.y() * q.z();
  const double zy = p.z() * q.y(), zx = p.z() * q.x(), xz = p.x() * q.z();
  const double volume = (yz - zy) * r.x() + (zx - xz) * r.y() + (xy - yx) * r.z();
  const double size = (std::abs(yz) + std::abs(zy)) * std::abs(r.x()) +
                      (std::abs(zx) + std::abs(xz)) * std::abs(r.y()) +
                      (std::abs(xy) + std::abs(yx)) * std::abs(r.z());
  const double bound = 8 * (0.5 * std::numeric_limits<double>::epsilon()) * size + 1e-290;
  if (volume > bound) return 1;
  if (volume < -bound) return -1;
  return exact_orientation(a, b, c, d);
}

bool triangles_meet(const Corners3& s, const Corners3& t) {
  return an_edge_meets(s, t) || an_edge_meets(t, s);
}

Side side_of(const TriangleSoup& surface, const Vector3& p) {
  return side_within(surface, all_bounds(surface), p);
}

bool clears_ball(const Corners3& t, const Vector3& centre, double radius) {
  const Vector3 radii(radius, 0, 0);
  const int k = common_exponent({t[0], t[1], t[2], centre, radii});
  const Whole r = whole(radius, k), squared_radius = r * r;
  std::array<Exact, 3> e;
  for (std::size_t i = 0; i < 3; ++i) e[i] = exact(t[i], k) - exact(centre, k);
  for (std::size_t i = 0; i < 3; ++i) {
    if (dot(e[i], e[i]) <= squared_radius) return false;
    if (!edge_clears(e[i], e[(i + 1) % 3], squared_radius)) return false;
  }
  return face_clears(e, squared_radius);
}

std::vector<int> triangles_in_body(const TriangleSoup& cloth, const TriangleSoup& body) {
  const std::vector<Bounds> bounds = all_bounds(body);
  std::vector<int> found;
  for (std::size_t k = 0; k < cloth.triangles.size(); ++k) {
    const Corners3 s = corners(cloth, k);
    const Bounds box = bounds_of(s);
    bool meets = false;
    for (std::size_t t = 0; t < bounds.size() && !meets; ++t)
      meets = boxes_meet(box, bounds[t]) && triangles_meet(s, corners(body, t));
    if (meets || side_within(body, bounds, s[0]) != Side::outside) found.push_back(int(k));
  }
  return found;
}

std::vector<int> triangles_in_ball(const TriangleSoup& cloth, const Vector3& centre,
                                   double radius) {
  std::vector<int> found;
  for (std::size_t k = 0; k < cloth.triangles.size(); ++k)
    if (!clears_ball(corners(cloth, k), centre, radius)) found.push_back(int(k));
  return found;
}

}  // namespace foldproof::oracles
