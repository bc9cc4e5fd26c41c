// Objects: solids that stand and move in the world, and what a cloth point is told about them.
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

/// The times between which a velocity moves the cloth; start == end for a velocity that only ends a step.
struct Span {
  double start, end;  // s
  double step;        // of the step that it belongs to [s]
};

/// What an object says about a point of the world.
struct ObjectPoint {
  double phi = std::numeric_limits<double>::infinity();  // at the span's start, negative inside [m]
  Vector3 normal = Vector3::Zero();                      // N, outward, at the span's start [1]
  Vector3 velocity = Vector3::Zero();  // v, of the object there: its mean over the span, so that a point that
      // takes it rides along exactly; at the span's time if that is all [m/s]
  int part = -1;  // which of the objects; -1: there is none
};

/// A solid in rigid motion: first put in its place, then moved.
struct RigidObject {
  Solid solid;
  Pose place;
  RigidMotion motion;

  ObjectPoint at(const Vector3& p, const Span& span) const;
};

/// A body that deforms as its animation says; copies share it.
struct DeformingObject {
  std::shared_ptr<const DeformingBody> body;

  ObjectPoint at(const Vector3& p, const Span& span) const;
};

using Body = std::variant<RigidObject, DeformingObject>;

struct Object {
  std::string name;
  Body body;
  double friction = 0;  // mu, Coulomb's coefficient between it and cloth [1]
};

/// The two objects that a point is deepest in or nearest to, and how many it is inside of: inside two or more
/// it is pinched (BMF03 section 5.1). The union's phi is the first's.
struct Nearest {
  ObjectPoint first, second;
  int inside = 0;

  bool pinched() const { return inside >= 2; }
};

/// What the objects say about one point, in any order.
Nearest nearest_of(std::span<const ObjectPoint> points);

Nearest nearest_objects(std::span<const Object> objects, const Vector3& p, const Span& span);

}  // namespace foldproof
