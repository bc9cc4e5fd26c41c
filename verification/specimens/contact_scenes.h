// Free particles around objects whose distance, normal and velocity are known in closed form.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "reference/scene/scene.h"
#include "verification/subject.h"

namespace foldproof {

/// Exact data of an object at a point over a span.
struct KnownPoint {
  double phi;        // at the span's start [m]
  Vector3 normal;    // outward, at the span's start
  Vector3 velocity;  // mean over the span, or at its only time [m/s]
};

/// One moving object, and particles on both sides of its surface that move at random.
struct Contact {
  std::string name;
  Scene scene;  // nothing but particles and the object
  State state;
  Span span;
  double tau;  // forecast time [s]
  double friction;
  std::function<KnownPoint(const Vector3& p, const Span& span)> known;
};

/// A ball on a bent path that turns as it goes, and a slope that rises and turns; each with
/// forecast times of the step, shorter and longer. One particle in twenty has no tangential
/// velocity relative to the object, and one in twenty rests on it.
std::vector<Contact> known_contacts();

/// Two balls that overlap, both moving, and particles inside both.
struct Pinch {
  Scene scene;
  State state;
  Span span;
  double tau;
  std::function<KnownPoint(const Vector3&p, const Span&span)> first, second;
  double friction_first, friction_second;
};
Pinch known_pinch();

/// The velocities of `state` as corrected by the subject, 3 x N [m/s].
PerParticle3 corrected_by_objects(const Subject& subject, const Scene& scene, const Span& span,
                                  const State& state);

/// Free particles, at rest in a plane sheet of n x n; nothing holds them together.
Scene loose_particles(int n);

/// The object at rest in this pose, ready for a scene.
SceneObject object_at(const std::string& name, const Solid& solid, const Pose& pose);

/// The object with a motion and a coefficient of friction.
SceneObject with_motion(SceneObject part, const Motion& motion, double friction);

/// A rotation about an axis [rad], by Rodrigues' formula.
Vector3 rotate(const Vector3& x, const Vector3& turn);

}  // namespace foldproof
