// Motion of objects, and that nothing passes through them.
#include "verification/specimens/check.h"
#include "verification/specimens/contact_scenes.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

RigidMotion swing() {
  Motion motion;
  motion.velocity = {0.4, -0.2, 0.9};
  motion.amplitude = {0.2, 0.5, -0.3};
  motion.frequency = 0.8;
  motion.phase = 0.4;
  motion.center = {0.3, -0.7, 0.2};
  motion.angular_velocity = {1.1, -0.6, 2.3};
  return motion;
}

RigidMotion keyframed_motion() {
  const auto pose = [](double angle, const Vector3& axis, const Vector3& place) {
    return Pose{Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized())), place};
  };
  return make_keyframes({{0.3, pose(0.2, {1, 2, 3}, {0.1, 0.2, 0.3})},
                         {0.9, pose(2.9, {-1, 0.4, 0.3}, {-0.3, 0.5, 0.1})},
                         {2.1, pose(-1.7, {0.2, 1, -2}, {0.6, -0.2, 0.4})}});
}

/// The velocity of a body's point against the central difference of its positions, each h away.
Finding velocity_finding() {
  Table measured{{"case", ""}, {"difference over that of the places' derivative", "1"}};
  const double small = 1e-4;
  Random random(3);
  for (const auto& [name, motion] : {std::pair<const char*, RigidMotion>{"closed form", swing()},
                                     {"keyframes", keyframed_motion()}}) {
    Worst worst;
    for (int k = 0; k < 60; ++k) {
      const double t = random.uniform(0.35, 2);
      if (std::abs(t - 0.9) < 2 * small) continue;
      const Vector3 X = random.vectors(1, 0.8);
      const Vector3 x = to_world(pose_at(motion, t), X);
      const Vector3 difference =
          (to_world(pose_at(motion, t + small), X) - to_world(pose_at(motion, t - small), X)) /
          (2 * small);
      worst.observe((velocity_at(motion, x, t) - difference).norm() / (1 + difference.norm()));
    }
    measured.row(name, worst.value());
  }
  return judge_worst(measured, 1e-6,
                     "a central difference over 1e-4 s errs by omega^3 X (1e-4)^2/6, some 1e-7, "
                     "and by rounding of some 1e-12");
}

/// At the keys themselves, and at rest before and after them.
Finding keyframe_finding() {
  Table measured = roundings_of("length");
  const RigidMotion motion = keyframed_motion();
  const std::vector<Keyframe>& keys = std::get<Keyframes>(motion).keys;
  const Vector3 X(0.3, -0.5, 0.7);
  Worst at_keys, between, outside;
  for (const Keyframe& key : keys)
    at_keys.observe((to_world(pose_at(motion, key.time), X) - to_world(key.pose, X)).norm());
  for (size_t k = 0; k + 1 < keys.size(); ++k) {  // half way: half the turn
    const Pose half = pose_at(motion, (keys[k].time + keys[k + 1].time) / 2);
    const Eigen::Quaterniond whole = keys[k + 1].pose.rotation * keys[k].pose.rotation.conjugate();
    const Eigen::Quaterniond first = half.rotation * keys[k].pose.rotation.conjugate();
    between.observe(std::min((whole.coeffs() - (first * first).coeffs()).norm(),
                             (whole.coeffs() + (first * first).coeffs()).norm()));
  }
  for (const double t : {-1.0, 0.1, 2.2, 9.0}) {
    const Keyframe& key = t < 1 ? keys.front() : keys.back();
    outside.observe((to_world(pose_at(motion, t), X) - to_world(key.pose, X)).norm());
    outside.observe(velocity_at(motion, X, t).norm());
  }
  measured.row("at its keyframes", at_keys.value() / epsilon);
  measured.row("half way between", between.value() / epsilon);
  measured.row("before and after", outside.value() / epsilon);
  return judge_worst(measured, 40, "a dozen products of unit quaternions and lengths below 1 m");
}

/// Without friction.
SceneObject moving(const SceneObject& part, const Vector3& velocity, const Vector3& turning) {
  return with_motion(part, Motion{.velocity = velocity, .angular_velocity = turning}, 0);
}

double depth(const std::vector<SceneObject>& objects, const Vector3& p, double time) {
  double deepest = -INFINITY;
  for (const SceneObject& part : objects)
    deepest =
        std::max(deepest, -std::get<RigidObject>(part.object.body).at(p, {time, time, 0}).phi);
  return deepest;
}

/// Points outside move at random, step after step, by `displacement` [m] relative to the first
/// object: the greatest depth that any of them reaches in it [m].
double deepest_shot(const Subject& subject, std::vector<SceneObject> objects, double displacement) {
  const double h = 0.01;
  Scene scene = loose_particles(15);
  scene.objects = objects;
  Random random(71);
  State s{0, random.vectors(scene.x.cols(), 0.8), scene.v};
  for (Eigen::Index i = 0; i < s.x.cols(); ++i)
    while (!(depth(objects, s.x.col(i), 0) < 0)) s.x.col(i) = random.vectors(1, 0.8);
  Stepper stepper(subject, scene, "C");
  Worst deepest;
  for (int n = 0; n < 60; ++n) {
    const PerParticle3 directions = random.vectors(s.x.cols(), 1);
    for (Eigen::Index i = 0; i < s.x.cols(); ++i) {
      const auto& body = std::get<RigidObject>(objects[0].object.body);
      const Vector3 with = body.at(s.x.col(i), {s.time, s.time + h, h}).velocity;
      s.v.col(i) = with + displacement / h * Vector3(directions.col(i)).normalized();
    }
    s = stepper.step(s, h);
    for (Eigen::Index i = 0; i < s.x.cols(); ++i)
      deepest.observe(depth(objects, s.x.col(i), s.time));
  }
  return deepest.value();
}

const Pose at_rest;

/// A convex object that does not turn lies behind its tangent planes, which the forecast uses.
Finding convex_finding(const Subject& subject) {
  const Vector3 drift(0.7, -0.4, 1.1);
  const Pose above{Eigen::Quaterniond::Identity(), {0, 0, 0.03}};
  const Box thin{{0.6, 0.5, 0.01}};
  const SceneObject board = moving(object_at("board", thin, at_rest), drift, Vector3::Zero());
  const SceneObject second = moving(object_at("second board", thin, above), drift, Vector3::Zero());
  const SceneObject ball = moving(object_at("ball", Sphere{0.3}, at_rest), drift, Vector3::Zero());
  Table measured{{"case", ""}, {"depth", "m"}};
  for (const double displacement : {0.005, 0.05, 0.7}) {
    const std::string words =
        ", shots of " + std::to_string(displacement).substr(0, 5) + " m a step";
    measured.row("ball" + words, deepest_shot(subject, {ball}, displacement));
    measured.row("board 0.02 m thick" + words, deepest_shot(subject, {board}, displacement));
  }
  measured.row("two boards, 0.01 m apart, shots of 0.7 m",
               deepest_shot(subject, {board, second}, 0.7));
  return judge_worst(measured, 1e-12,
                     "rounding of positions of up to a metre in a moving frame, over 60 steps");
}

/// To pass through at the deepest place, a point outside must move by half the object's thickness
/// in a step, relative to it.
Finding limit_finding(const Subject& subject) {
  const Vector3 drift(0.3, 0.2, -0.4), turning(2.1, -1.3, 0.8);
  const SceneObject ring = moving(object_at("ring", Torus{0.5, 0.1}, at_rest), drift, turning);
  const SceneObject board =
      moving(object_at("board", Box{{0.6, 0.5, 0.03}}, at_rest), drift, turning);
  Table measured{{"case", ""}, {"depth over half the thickness", "1"}};
  for (const double part : {0.3, 0.9}) {
    const std::string words =
        ", turning, at " + std::to_string(part).substr(0, 3) + " of the limit";
    measured.row("ring" + words, deepest_shot(subject, {ring}, part * 0.1) / 0.1);
    measured.row("board" + words, deepest_shot(subject, {board}, part * 0.03) / 0.03);
  }
  return judge_worst(measured, 0.9,
                     "a point that was outside has moved by at most 0.9 of half the thickness, and "
                     "one that was inside is moving out; at 1, where the object is deepest, it "
                     "would be pushed out on the other side",
                     "the limit: a point must not move, seen from the object, by more than half "
                     "its thickness in a step");
}

/// Particles on a plane, a step of weight and of velocity after another: where they are.
PerParticle3 slid(const Subject& subject, const Scene& scene, State state, int steps) {
  constexpr double h = 0.01;
  for (int step = 0; step < steps; ++step) {
    state.v.row(2).array() -= 9.81 * h;
    state.v = corrected_by_objects(subject, scene, {0, h, h}, state);
    state.x += h * state.v;
  }
  return state.x;
}

/// On a floor of boxes side by side, in all directions over sides and corners.
Finding seams_finding(const Subject& subject) {
  constexpr double height = 0.37;  // m: tops are there but for roundings
  Scene scene = loose_particles(15);
  for (int k = 0; k < 100; ++k) {
    const double half = 0.02 + 0.0031 * (k % 7);
    const Vector3 middle(0.1 * (k % 10), 0.1 * (k / 10), height - half);
    scene.objects.push_back(
        object_at("tile", Box{{0.05, 0.05, half}}, {Eigen::Quaterniond::Identity(), middle}));
  }
  Random random(43);
  State state = resting_state(scene.x);
  constexpr int steps = 12;
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    state.x.col(i) = Vector3(random.uniform(0.41, 0.44), random.uniform(0.41, 0.44), height);
    state.v.col(i) = random.uniform(1, 3) * rotate(Vector3::UnitX(), {0, 0, random.uniform(0, 6)});
  }
  const PerParticle3 after = slid(subject, scene, state, steps);
  Worst worst;
  for (Eigen::Index i = 0; i < state.x.cols(); ++i)
    worst.observe((Vector3(after.col(i) - state.x.col(i)) - steps * 0.01 * state.v.col(i)).norm());
  return {{worst.value(), 100 * epsilon, 0, "m", "a rounding of places within 1 m in each step"},
          Table{{"particles", "1"}}.with_row(double(state.x.cols()))};
}

/// Of a point on the plane z = 0 that came along x, from a round solid about the origin: what went
/// around it is beside it since [m].
double gap_to_round(const Vector3& p, double radius) {
  return (p.x() > 0 ? std::abs(p.y()) : p.head<2>().norm()) - radius;
}

/// On a plane, towards a wall of 0.2 mm, a corner of two walls, a rod of 1 mm and a ball of 2 cm
/// sunk to its equator.
Finding standing_finding(const Subject& subject) {
  Table measured{{"what stands on the plane", ""}, {"deepest or past it", "m"}};
  Random random(47);
  const double wall = 1e-4, rod = 1e-3, ball = 0.02, thick = 0.05;  // m
  const auto at = [](double x, double y) {
    return Pose{Eigen::Quaterniond::Identity(), {x, y, 0}};
  };
  const auto last_gap = [&](const std::vector<SceneObject>& objects, const Vector3& towards,
                            double aside, const std::function<double(const Vector3&)>& gap) {
    Scene scene = loose_particles(10);
    scene.objects = objects;
    scene.objects.push_back(object_at("floor", HalfSpace{}, {}));
    State state = resting_state(scene.x);
    for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
      state.x.col(i) = Vector3(random.uniform(-0.2, -0.05), random.uniform(-aside, aside), 0);
      state.v.col(i) = random.uniform(1, 3) * towards;
    }
    Worst deepest;
    for (const int steps : {5, 8, 20}) {
      const PerParticle3 after = slid(subject, scene, state, steps);
      for (Eigen::Index i = 0; i < after.cols(); ++i) deepest.observe(-gap(after.col(i)));
    }
    return deepest.value();
  };
  const auto from_wall = [&](const Vector3& p) { return -wall - p.x(); };
  const SceneObject thin = object_at("wall", Box{{wall, 3, 0.1}}, {});
  measured.row("wall", last_gap({thin}, {1, 0, 0}, 0.1, from_wall));
  measured.row("wall, at a slant", last_gap({thin}, {0.6, 0.8, 0}, 0.1, from_wall));
  measured.row("two walls that overlap",
               last_gap({object_at("first", Box{{thick, 0.5, 0.1}}, at(thick, -0.437)),
                         object_at("second", Box{{1, thick, 0.1}}, at(0, 0.06 + thick))},
                        {0.7, 0.7, 0}, 0.05,
                        [](const Vector3& p) { return std::min(-p.x(), 0.06 - p.y()); }));
  measured.row("rod", last_gap({object_at("rod", Capsule{rod, 0.1}, {})}, {1, 0, 0}, 1.1 * rod,
                               [&](const Vector3& p) { return gap_to_round(p, rod); }));
  measured.row("ball", last_gap({object_at("ball", Sphere{ball}, {})}, {1, 0, 0}, 1.2 * ball,
                                [&](const Vector3& p) { return gap_to_round(p, ball); }));
  return judge_worst(measured, 1000 * epsilon, "roundings of places within 1 m in twenty steps");
}

}  // namespace

std::vector<Check> object_checks() {
  return {
      {"contact.object-velocity-is-the-derivative-of-its-position",
       "An object's velocity is the derivative of its place.", "kinematics", velocity_finding},
      {"contact.keyframes-are-followed",
       "A keyframed object is at each keyframe at its time, has turned by half halfway between "
       "two, and rests before the first and after the last.",
       "kinematics", keyframe_finding},
      {"contact.convex-objects-are-never-entered",
       "No particle enters a convex object that does not turn, whatever its speed, and none passes "
       "a thin board.",
       "BMF03 section 5.2", convex_finding},
      {"contact.nothing-tunnels-below-the-limit",
       "At 0.9 of half an object's thickness a step, nothing passes through an object that turns "
       "or is concave.",
       "BMF03 section 5.2", limit_finding},
      {"contact.seams-of-objects-hold-nothing-back",
       "A particle slides over a smooth floor of boxes side by side as if it were one.",
       "BMF03 section 5.2; our own: hidden sides", seams_finding},
      {"contact.what-stands-on-a-plane-is-not-passed",
       "What slides on a plane is stopped by thin walls, corners, rods and balls that stand on it.",
       "BMF03 section 5.2", standing_finding},
  };
}

}  // namespace foldproof
