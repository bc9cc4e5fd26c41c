// Solids with a closed form, and objects made of them: distances worked out by hand, motion by way
// of the body's own frame.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <vector>

#include "reference/level_set/object.h"

using namespace foldproof;

namespace {

void check_distance(const Distance& found, double phi, const Vector3& normal) {
  CHECK(found.phi == Approx(phi).margin(1e-15));
  CHECK((found.normal - normal).norm() < 1e-15);
}

/// Turns, drifts and swings about a centre off the origin.
RigidMotion turning() {
  Motion motion;
  motion.velocity = {0.3, -0.7, 0.2};
  motion.amplitude = {0.05, 0.11, -0.08};
  motion.frequency = 0.9;
  motion.phase = 0.4;
  motion.center = {0.6, -0.2, 1.1};
  motion.angular_velocity = {0.8, -1.3, 0.5};
  return motion;
}

RigidObject turning_box() {
  const Eigen::Quaterniond tilt(Eigen::AngleAxisd(0.9, Vector3(0.36, 0.48, -0.8)));
  return {Box{{0.3, 0.5, 0.9}}, {tilt, {-0.4, 0.25, 0.7}}, turning()};
}

ObjectPoint answer(double phi, int part) {
  ObjectPoint point;
  point.phi = phi;
  point.part = part;
  return point;
}

}  // namespace

TEST_CASE("a half space answers with the height above its plane") {
  check_distance(HalfSpace{}.at({0.3, -0.8, -1.7}), -1.7, {0, 0, 1});
}

TEST_CASE("a sphere's distance counts from its surface, and its centre has a normal too") {
  check_distance(Sphere{0.45}.at({0.2, 0.3, -0.6}), 0.25, Vector3(2, 3, -6) / 7);
  check_distance(Sphere{0.45}.at({0.02, 0.03, -0.06}), -0.38, Vector3(2, 3, -6) / 7);
  check_distance(Sphere{0.45}.at({0, 0, 0}), -0.45, {0, 0, 1});
}

TEST_CASE("inside a box the nearest of its six faces decides") {
  const Box box{{0.3, 0.5, 0.9}};
  for (const double side : {-1.0, 1.0}) {
    check_distance(box.at({side * 0.25, 0.1, -0.4}), -0.05, {side, 0, 0});
    check_distance(box.at({-0.1, side * 0.45, 0.2}), -0.05, {0, side, 0});
    check_distance(box.at({0.1, 0.2, side * 0.8}), -0.1, {0, 0, side});
  }
}

TEST_CASE("on a box's face the distance is zero and the normal is the face's") {
  const Box box{{0.25, 0.5, 0.75}};
  check_distance(box.at({-0.25, 0.1, 0.3}), 0, {-1, 0, 0});
  check_distance(box.at({0.1, 0.5, 0.3}), 0, {0, 1, 0});
  check_distance(box.at({0.1, -0.2, -0.75}), 0, {0, 0, -1});
}

TEST_CASE("outside of a box the nearest point lies on a face, an edge or a corner") {
  const Box box{{0.3, 0.5, 0.9}};
  check_distance(box.at({0.2, -1.7, 0.4}), 1.2, {0, -1, 0});
  check_distance(box.at({0.6, -0.9, 0.1}), 0.5, {0.6, -0.8, 0});
  check_distance(box.at({-0.5, 0.8, -1.5}), 0.7, Vector3(-2, 3, -6) / 7);
}

TEST_CASE("a capsule rounds its segment off, between the ends and beyond each") {
  const Capsule capsule{0.2, 0.5};
  check_distance(capsule.at({0.3, -0.4, 0.1}), 0.3, {0.6, -0.8, 0});
  check_distance(capsule.at({0.3, 0, 0.9}), 0.3, {0.6, 0, 0.8});
  check_distance(capsule.at({0, -0.3, -0.9}), 0.3, {0, -0.6, -0.8});
  check_distance(capsule.at({0, 0, -0.4}), -0.2, {1, 0, 0});
}

TEST_CASE("a torus rounds its circle off, and answers on its axis and on the circle") {
  const Torus torus{0.9, 0.25};
  check_distance(torus.at({0.72, 0.96, 0.4}), 0.25, {0.36, 0.48, 0.8});
  check_distance(torus.at({0, 0, 1.2}), 1.25, {-0.6, 0, 0.8});
  check_distance(torus.at({-0.54, 0.72, 0}), -0.25, {-0.6, 0.8, 0});
}

TEST_CASE("an object answers in the world as its solid does in its own frame") {
  const RigidObject box = turning_box();
  for (const double t : {0.0, 0.7, 1.9}) {
    const Pose pose = pose_at(box.motion, t);
    for (const Vector3& p : {Vector3(0.4, -0.9, 1.7), Vector3(-0.3, 0.2, 0.5)}) {
      const Distance own = distance_to(box.solid, to_body(box.place, to_body(pose, p)));
      for (const double duration : {0.0, 0.3}) {
        const ObjectPoint found = box.at(p, {t, t + duration, 0.1});
        CHECK(found.phi == Approx(own.phi).epsilon(1e-14));
        CHECK((found.normal - pose.rotation * (box.place.rotation * own.normal)).norm() < 1e-14);
      }
    }
  }
}

TEST_CASE("over a span an object's velocity takes a point where the body takes it") {
  const RigidObject box = turning_box();
  const Vector3 p(0.4, -0.9, 1.7);
  for (const double start : {0.0, 0.7}) {
    const double end = start + 0.6;
    const Vector3 moved =
        to_world(pose_at(box.motion, end), to_body(pose_at(box.motion, start), p));
    const ObjectPoint found = box.at(p, {start, end, 0.1});
    CHECK((p + 0.6 * found.velocity - moved).norm() < 1e-14);
  }
}

TEST_CASE("for a span of no length an object's velocity is that of the moment") {
  const RigidObject box = turning_box();
  const Vector3 p(0.4, -0.9, 1.7);
  for (const double t : {0.0, 0.7}) {
    const Vector3 expected = velocity_at(box.motion, p, t);
    CHECK((box.at(p, {t, t, 0.1}).velocity - expected).norm() < 1e-14);
  }
}

TEST_CASE("objects answer in their order, each with its number and its friction") {
  const std::vector<Object> objects{
      {"ball", RigidObject{Sphere{0.4}, {{}, {0.1, 0.2, 0.3}}, Motion{}}, 0.7},
      {"box", turning_box(), 0.2},
      {"floor", RigidObject{HalfSpace{}, {}, Motion{}}, 0.9}};
  const Span span{0.7, 1.3, 0.1};
  ObjectsOverSpan over(objects, span);
  const Vector3 p(0.4, -0.9, 1.7);
  const auto answers = over.at(p);
  REQUIRE(answers.size() == 3);
  for (int i = 0; i < 3; ++i) {
    CHECK(answers[i].part == i);
    CHECK(answers[i].friction == objects[i].friction);
    const ObjectPoint expected = std::get<RigidObject>(objects[i].body).at(p, span);
    CHECK(answers[i].phi == expected.phi);
    CHECK(answers[i].velocity == expected.velocity);
  }
  const Nearest nearest = nearest_objects(objects, p, span);
  std::array<int, 3> sorted{0, 1, 2};
  std::sort(sorted.begin(), sorted.end(),
            [&](int a, int b) { return answers[a].phi < answers[b].phi; });
  CHECK(nearest.first.part == sorted[0]);
  CHECK(nearest.second.part == sorted[1]);
}

TEST_CASE("the two nearest answers are found in any order, and containing objects are counted") {
  const std::vector<double> phi{-0.2, 0.3, -0.5, 0.1};
  std::vector<int> order{0, 1, 2, 3};
  do {
    std::vector<ObjectPoint> points;
    for (const int k : order) points.push_back(answer(phi[k], k));
    const Nearest nearest = nearest_of(points);
    CHECK(nearest.first.part == 2);
    CHECK(nearest.second.part == 0);
    CHECK(nearest.inside == 2);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("of objects equally near, the earlier ones count as nearest") {
  const std::vector<ObjectPoint> points{answer(0.4, 7), answer(0.4, 3), answer(0.4, 5)};
  const Nearest nearest = nearest_of(points);
  CHECK(nearest.first.part == 7);
  CHECK(nearest.second.part == 3);
}

TEST_CASE("a point is pinched inside two objects, not on the surface of one of them") {
  CHECK_FALSE(nearest_of(std::vector{answer(0.2, 0), answer(-0.3, 1)}).pinched());
  CHECK_FALSE(nearest_of(std::vector{answer(0, 0), answer(-0.3, 1)}).pinched());
  CHECK(nearest_of(std::vector{answer(-0.1, 0), answer(-0.3, 1)}).pinched());
  CHECK(nearest_of(std::vector{answer(-0.1, 0), answer(-0.3, 1), answer(-0.2, 2)}).pinched());
}

TEST_CASE("without objects nothing is near, contains the point or rubs") {
  const Nearest nearest = nearest_of({});
  CHECK(nearest.first.part == -1);
  CHECK(nearest.second.part == -1);
  CHECK(std::isinf(nearest.first.phi));
  CHECK(nearest.first.friction == 0);
  CHECK(nearest.inside == 0);
  CHECK(Object{}.friction == 0);
}
