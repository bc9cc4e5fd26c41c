#include "verification/cases/face_depth.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <queue>

#include "reference/mesh/nearest_point.h"

namespace foldproof {

namespace {

double distance_to_face(const FaceCorners& face, const Vector3& p) {
  return std::sqrt(nearest_on_triangle(face, p).squared_distance);
}

/// Between the segments from a to b and from c to d: the best of the ends' feet, and of the two
/// feet where the lines are nearest if both lie within.
double segment_distance(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const auto to_segment = [](const Vector3& p, const Vector3& from, const Vector3& to) {
    const Vector3 along = to - from;
    const double squared = along.squaredNorm();
    const double share = squared > 0 ? std::clamp((p - from).dot(along) / squared, 0., 1.) : 0;
    return (p - from - share * along).norm();
  };
  double least = std::min(std::min(to_segment(a, c, d), to_segment(b, c, d)),
                          std::min(to_segment(c, a, b), to_segment(d, a, b)));
  const Vector3 u = b - a, w = d - c, r = c - a, n = u.cross(w);
  const double squared = n.squaredNorm();
  if (!(squared > 0)) return least;
  const double s = r.cross(w).dot(n) / squared, t = r.cross(u).dot(n) / squared;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1) least = std::min(least, std::abs(r.dot(n)) / n.norm());
  return least;
}

/// Does the segment from a to b pass through the face? A miss by rounding at the face's edge is
/// made good by the distance to that edge.
bool passes_through(const Vector3& a, const Vector3& b, const FaceCorners& face) {
  const Vector3 n = (face[1] - face[0]).cross(face[2] - face[0]);
  const double above = n.dot(a - face[0]), below = n.dot(b - face[0]);
  if (!(above * below < 0)) return false;
  const Vector3 p = a + above / (above - below) * (b - a);
  for (int k = 0; k < 3; ++k) {
    const Vector3 &from = face[std::size_t(k)], &to = face[std::size_t((k + 1) % 3)];
    if (n.dot((to - from).cross(p - from)) < 0) return false;
  }
  return true;
}

/// The depth of a point below each of a box's six faces [m].
using BoxDepths = Eigen::Matrix<double, 6, 1>;

BoxDepths depths_in(const Box& box, const Vector3& p) {
  BoxDepths depths;
  depths << box.half_extents - p, box.half_extents + p;
  return depths;
}

/// The depths at the corners of a face, a column each.
using CornerDepths = Eigen::Matrix<double, 6, 3>;

/// Where on an edge two of the linear functions are equal, the least of all six there.
double deepest_on_edge(const BoxDepths& at_start, const BoxDepths& at_end) {
  double deepest = std::max(at_start.minCoeff(), at_end.minCoeff());
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j) {
      const double before = at_start[i] - at_start[j], after = at_end[i] - at_end[j];
      if (!(before * after < 0)) continue;
      const double share = before / (before - after);
      deepest = std::max(deepest, ((1 - share) * at_start + share * at_end).minCoeff());
    }
  return deepest;
}

/// Where three of the linear functions are equal inside the face, the least of all six there;
/// minus infinity where there is no such place.
double deepest_within(const CornerDepths& depths) {
  double deepest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j)
      for (int k = 0; k < j; ++k) {
        Eigen::Matrix3d equal;
        equal << depths.row(i) - depths.row(j), depths.row(j) - depths.row(k),
            Eigen::RowVector3d::Ones();
        const Vector3 weights = equal.partialPivLu().solve(Vector3::UnitZ());
        if (weights.minCoeff() >= 0 && weights.allFinite())
          deepest = std::max(deepest, (depths * weights).minCoeff());
      }
  return deepest;
}

struct Part {
  double bound;  // no point of it is deeper [m]
  FaceCorners corners;
};

struct ShallowerPart {
  bool operator()(const Part& a, const Part& b) const { return a.bound < b.bound; }
};

/// A part with the bound from its middle, whose depth raises `deepest`.
Part measured_part(const DepthSearch& search, const FaceCorners& corners, double& deepest) {
  const Vector3 middle = (corners[0] + corners[1] + corners[2]) / 3;
  const double depth = search.depth(middle);
  deepest = std::max(deepest, depth);
  double reach = 0;  // m
  for (const Vector3& corner : corners) reach = std::max(reach, (corner - middle).norm());
  return {depth + search.slope * reach, corners};
}

std::array<FaceCorners, 4> quarters(const FaceCorners& t) {
  const Vector3 ab = (t[0] + t[1]) / 2, bc = (t[1] + t[2]) / 2, ca = (t[2] + t[0]) / 2;
  return {{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}};
}

}  // namespace

double deepest_point(const HalfSpace&, const FaceCorners& face) {
  return -std::min({face[0].z(), face[1].z(), face[2].z()});
}

double deepest_point(const Sphere& solid, const FaceCorners& face) {
  return solid.radius - distance_to_face(face, Vector3::Zero());
}

double deepest_point(const Capsule& solid, const FaceCorners& face) {
  const Vector3 low(0, 0, -solid.half_length), high(0, 0, solid.half_length);
  if (passes_through(low, high, face)) return solid.radius;
  double least = std::min(distance_to_face(face, low), distance_to_face(face, high));
  for (std::size_t k = 0; k < 3; ++k)
    least = std::min(least, segment_distance(low, high, face[k], face[(k + 1) % 3]));
  return solid.radius - least;
}

// The depth in a box is the least of six linear functions, so it is concave on a face and linear on
// each of the cells in which one of them is the least. Its maximum is at a corner of such a cell: a
// corner of the face, a place on an edge where two are equal, or one inside where three are.
double deepest_point(const Box& solid, const FaceCorners& face) {
  CornerDepths depths;
  for (int k = 0; k < 3; ++k) depths.col(k) = depths_in(solid, face[std::size_t(k)]);
  double deepest = deepest_within(depths);
  for (int k = 0; k < 3; ++k)
    deepest = std::max(deepest, deepest_on_edge(depths.col(k), depths.col((k + 1) % 3)));
  return deepest;
}

double deepest_of(const DepthSearch& search, std::span<const FaceCorners> faces, double known) {
  constexpr long most = 1'000'000;  // parts
  double deepest = known;
  std::priority_queue<Part, std::vector<Part>, ShallowerPart> parts;
  for (const FaceCorners& face : faces) {
    const Part part = measured_part(search, face, deepest);
    if (part.bound > deepest + search.tolerance) parts.push(part);
  }
  for (long taken = 0; !parts.empty(); ++taken) {
    const Part widest = parts.top();
    if (!(widest.bound > deepest + search.tolerance)) break;
    if (taken >= most) return widest.bound;
    parts.pop();
    for (const FaceCorners& quarter : quarters(widest.corners)) {
      const Part part = measured_part(search, quarter, deepest);
      if (part.bound > deepest + search.tolerance) parts.push(part);
    }
  }
  return deepest > known ? deepest + search.tolerance : known;
}

namespace {

template <class S>
constexpr bool has_closed_form = std::same_as<S, HalfSpace> || std::same_as<S, Sphere> ||
                                 std::same_as<S, Capsule> || std::same_as<S, Box>;

template <class S>
constexpr double steepest_depth =
    std::same_as<S, GridSolid> || std::same_as<S, OctreeSolid> ? 2 : 1;

/// One kind of solid at a time; faces in the solid's frame.
struct InSolid {
  std::span<const FaceCorners> faces;
  double known, tolerance;  // m

  template <class S>
  double operator()(const S& solid) const {
    if constexpr (has_closed_form<S>) {
      double deepest = known;
      for (const FaceCorners& face : faces) deepest = std::max(deepest, deepest_point(solid, face));
      return deepest;
    } else {
      const auto depth = [&](const Vector3& p) { return -solid.at(p).phi; };
      return deepest_of({depth, steepest_depth<S>, tolerance}, faces, known);
    }
  }
};

}  // namespace

double deepest_in_object(const Object& object, double time, std::span<const FaceCorners> faces,
                         double known, double tolerance) {
  const Span now{time, time, 0};
  if (const auto* deforming = std::get_if<DeformingObject>(&object.body)) {
    const DeformingOverSpan over = deforming->over(now);
    const auto depth = [&](const Vector3& p) { return -over.at(p).phi; };
    return deepest_of({depth, 3, tolerance}, faces, known);
  }
  const RigidObject& rigid = std::get<RigidObject>(object.body);
  const RigidOverSpan over = rigid.over(now);
  std::vector<FaceCorners> local(faces.begin(), faces.end());
  for (FaceCorners& face : local)
    for (Vector3& corner : face) corner = over.inverse_rotation * (corner - over.translation);
  return std::visit(InSolid{local, known, tolerance}, rigid.solid);
}

}  // namespace foldproof
