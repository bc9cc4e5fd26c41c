// Objects: solids placed and moving in the world, and their answers to queries from cloth points.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "reference/level_set/deforming.h"
#include "reference/level_set/solid.h"
#include "reference/motion/pose.h"
#include "reference/types.h"

namespace foldproof {

/// The time span over which a velocity moves the cloth; start == end for a velocity that only ends
/// a step.
struct Span {
  double start, end;  // s
  double step;        // length of the step that the span belongs to [s]
};

/// Answer of an object to a query at a point of the world.
struct ObjectPoint {
  double phi = std::numeric_limits<double>::infinity();  // at the span's start, negative inside [m]
  Vector3 normal = Vector3::Zero();                      // N, outward, at the span's start [1]
  // v of the object there [m/s]: the mean over the span, so that a point with this velocity moves
  // exactly with the object; for a span of zero length, the velocity at that time
  Vector3 velocity = Vector3::Zero();
  int part = -1;        // index of the object; -1: none
  double friction = 0;  // mu, of that object [1]
};

/// A rigid object during a span: its poses and velocity, shared by all points and computed once.
struct RigidOverSpan {
  const Solid* solid;
  Eigen::Matrix3d rotation;  // at the span's start x = rotation X + translation; X in the solid
  Eigen::Matrix3d inverse_rotation;
  Vector3 translation;   // m
  Eigen::Matrix3d spin;  // the object's point at p has the velocity drift + spin (p - pivot) [1/s]
  Vector3 drift, pivot;  // m/s, m

  ObjectPoint at(const Vector3& p) const;
  Vector3 velocity_at(const Vector3& p) const { return drift + spin * (p - pivot); }  // m/s
};

/// A solid in rigid motion: first placed, then moved.
struct RigidObject {
  Solid solid;
  Pose place;
  RigidMotion motion;

  RigidOverSpan over(const Span& span) const;  // this object must outlive it
  ObjectPoint at(const Vector3& p, const Span& span) const { return over(span).at(p); }
};

struct DeformingOverSpan {
  const DeformingBody* body;
  Span span;

  ObjectPoint at(const Vector3& p) const;
};

/// A body deformed by its animation; copies share it.
struct DeformingObject {
  std::shared_ptr<const DeformingBody> body;

  DeformingOverSpan over(const Span& span) const { return {body.get(), span}; }
  ObjectPoint at(const Vector3& p, const Span& span) const { return over(span).at(p); }
};

using Body = std::variant<RigidObject, DeformingObject>;

struct Object {
  std::string name;
  Body body;
  double friction = 0;  // mu, Coulomb's coefficient between it and cloth [1]
};

/// Whether the way out of one object leads deeper into the other: their normals are more than 120
/// degrees apart, and the way out of both is twice as long as that out of one, or longer.
bool face_each_other(const ObjectPoint& a, const ObjectPoint& b);

/// The two objects that a point is deepest in or nearest to, and the number of objects that contain
/// it. The union's phi is the first's.
struct Nearest {
  ObjectPoint first, second;
  int inside = 0;

  /// Inside two or more (BMF03 section 5.1).
  bool pinched() const { return inside >= 2; }
  /// Pinched by two that close on it as an armpit does, and not only in a corner.
  bool held_between() const { return pinched() && face_each_other(first, second); }
};

/// The two nearest of the objects' answers at one point, given in any order.
Nearest nearest_of(std::span<const ObjectPoint> points);

/// Objects during a span, for queries at many points. The objects must outlive it.
class ObjectsOverSpan {
 public:
  ObjectsOverSpan(std::span<const Object> objects, const Span& span);

  /// Each object's answer at p, in order; overwritten by the next call.
  std::span<ObjectPoint> at(const Vector3& p);

 private:
  std::vector<std::variant<RigidOverSpan, DeformingOverSpan>> bodies_;
  std::vector<double> friction_;
  std::vector<ObjectPoint> answers_;
};

Nearest nearest_objects(std::span<const Object> objects, const Vector3& p, const Span& span);

}  // namespace foldproof
