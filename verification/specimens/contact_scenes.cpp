#include "verification/specimens/contact_scenes.h"

#include <Eigen/Geometry>
#include <cmath>

#include "reference/mesh/shapes.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

constexpr double step = 0.013;  // s

/// Position, after `h` [s], of the body's point that is at p at time t.
Vector3 carry(const Motion& motion, const Vector3& p, double t, double h) {
  const Vector3 arm = p - motion.center - motion.velocity * t;
  return motion.center + rotate(arm, motion.angular_velocity * h) + motion.velocity * (t + h);
}

Vector3 mean_velocity(const Motion& motion, const Vector3& p, const Span& span) {
  const double h = span.end - span.start;
  if (h > 0) return (carry(motion, p, span.start, h) - p) / h;
  return motion.velocity +
         motion.angular_velocity.cross(p - motion.center - motion.velocity * span.start);
}

Motion bent_path() {
  Motion motion;
  motion.velocity = {0.7, -0.4, 0.3};
  motion.center = {0.31, -0.22, 0.17};
  motion.angular_velocity = {1.7, 2.3, -2.9};
  return motion;
}

std::function<KnownPoint(const Vector3&, const Span&)> known_ball(const Vector3& centre,
                                                                  double radius,
                                                                  const Motion& motion) {
  return [=](const Vector3& p, const Span& span) {
    const Vector3 away = p - carry(motion, centre, 0, span.start);
    return KnownPoint{away.norm() - radius, away.normalized(), mean_velocity(motion, p, span)};
  };
}

std::function<KnownPoint(const Vector3&, const Span&)> known_slope(const Vector3& origin,
                                                                   const Vector3& normal,
                                                                   const Motion& motion) {
  return [=](const Vector3& p, const Span& span) {
    const Vector3 n = rotate(normal, motion.angular_velocity * span.start);
    const Vector3 through = carry(motion, origin, 0, span.start);
    return KnownPoint{n.dot(p - through), n, mean_velocity(motion, p, span)};
  };
}

/// Puts the particle at a depth in [-0.04, 0.04] m below the surface point nearest to it, with a
/// random velocity.
void scatter(Contact& contact, Eigen::Index i, Random& random) {
  Vector3 p = contact.state.x.col(i);
  const KnownPoint far = contact.known(p, contact.span);
  p += (random.uniform(-0.04, 0.04) - far.phi) * far.normal;
  Vector3 v = random.vectors(1, 3);
  if (i % 20 < 2) {  // no sliding, or no motion at all
    const KnownPoint here = contact.known(p, contact.span);
    v = here.velocity;
    if (i % 20 == 0) v -= random.uniform(1, 5) * here.normal;
  }
  contact.state.x.col(i) = p;
  contact.state.v.col(i) = v;
}

Contact contact_of(const std::string& name, const SceneObject& part, double tau,
                   const std::function<KnownPoint(const Vector3&, const Span&)>& known) {
  Contact contact{name, loose_particles(20),  {},   {0.61, 0.61 + step, step},
                  tau,  part.object.friction, known};
  contact.scene.objects.push_back(part);
  contact.scene.collision.forecast_time = tau;
  Random random(17);
  contact.state = {0.61, random.vectors(contact.scene.x.cols(), 1), contact.scene.v};
  for (Eigen::Index i = 0; i < contact.state.x.cols(); ++i) scatter(contact, i, random);
  return contact;
}

/// Inside both balls, whose normals are more than 120 degrees apart.
bool is_held_between(const Pinch& pinch, const Vector3& p) {
  const KnownPoint a = pinch.first(p, pinch.span), b = pinch.second(p, pinch.span);
  return a.phi < -1e-3 && b.phi < -1e-3 && a.normal.dot(b.normal) < -0.5 - 1e-3;
}

}  // namespace

Vector3 rotate(const Vector3& x, const Vector3& turn) {
  const double angle = turn.norm();
  if (angle == 0) return x;
  const Vector3 axis = turn / angle;
  return std::cos(angle) * x + std::sin(angle) * axis.cross(x) +
         2 * std::sin(angle / 2) * std::sin(angle / 2) * axis.dot(x) * axis;
}

SceneObject object_at(const std::string& name, const Solid& solid, const Pose& pose) {
  SceneObject part;
  part.object.name = part.shape = name;
  part.object.body = RigidObject{solid, pose, Motion{}};
  return part;
}

SceneObject with_motion(SceneObject part, const Motion& motion, double friction) {
  std::get<RigidObject>(part.object.body).motion = motion;
  part.object.friction = friction;
  return part;
}

Scene loose_particles(int n) {
  return scene_at_rest(make_sheet({SheetPattern::one_diagonal, 1, 1, n - 1, n - 1}), 0.37);
}

std::vector<Contact> known_contacts() {
  std::vector<Contact> all;
  Motion rising;
  rising.velocity = {0.2, 0.9, -0.3};
  rising.angular_velocity = {0.4, -1.1, 0.6};
  const Vector3 centre(0.12, 0.33, -0.21), origin(-0.2, 0.1, 0.05);
  const Eigen::AngleAxisd tilt(0.73, Vector3(0.3, -0.8, 0.5).normalized());
  for (const double times : {1.0, 2.7, 0.6}) {
    const std::string words = times == 1 ? "the step" : times > 1 ? "2.7 steps" : "0.6 steps";
    all.push_back(contact_of(
        "ball, forecast time " + words,
        with_motion(object_at("ball", Sphere{0.43}, {Eigen::Quaterniond::Identity(), centre}),
                    bent_path(), 0.37),
        times * step, known_ball(centre, 0.43, bent_path())));
    all.push_back(
        contact_of("slope, forecast time " + words,
                   with_motion(object_at("slope", HalfSpace{}, {Eigen::Quaterniond(tilt), origin}),
                               rising, 0.81),
                   times * step, known_slope(origin, tilt * Vector3::UnitZ(), rising)));
  }
  return all;
}

Pinch known_pinch() {
  Motion other;
  other.velocity = {-0.5, 0.8, 0.1};
  other.angular_velocity = {-1.3, 0.7, 2.1};
  const Vector3 left(-0.3, 0.02, 0.05), right(0.28, -0.03, 0.01);
  Pinch pinch{loose_particles(20),
              {},
              {0, step, step},
              step,
              known_ball(left, 0.4, bent_path()),
              known_ball(right, 0.35, other),
              0.21,
              0.34};
  pinch.scene.objects.push_back(with_motion(
      object_at("left", Sphere{0.4}, {Eigen::Quaterniond::Identity(), left}), bent_path(), 0.21));
  pinch.scene.objects.push_back(with_motion(
      object_at("right", Sphere{0.35}, {Eigen::Quaterniond::Identity(), right}), other, 0.34));
  Random random(23);
  pinch.state = {0, pinch.scene.x, random.vectors(pinch.scene.x.cols(), 2)};
  for (Eigen::Index i = 0; i < pinch.state.x.cols(); ++i) {
    Vector3 p = Vector3::Constant(9);
    while (!is_held_between(pinch, p)) p = random.vectors(1, 0.4);
    pinch.state.x.col(i) = p;
  }
  return pinch;
}

PerParticle3 corrected_by_objects(const Subject& subject, const Scene& scene, const Span& span,
                                  const State& state) {
  const std::unique_ptr<PreparedScene> prepared =
      require_offered(subject.prepare, "prepare")(scene);
  return require_offered(subject.avoid_objects, "avoid_objects")(*prepared, span, state, state.v);
}

}  // namespace foldproof
