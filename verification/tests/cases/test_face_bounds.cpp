// Bounds on the depth of faces by what the bodies are, and depths of faces at their limits.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"
#include "verification/cases/face_bound.h"
#include "verification/cases/face_depth.h"
#include "verification/cases/quantities.h"

using namespace foldproof;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

Approx exactly(double value) { return Approx(value).epsilon(1e-10).margin(1e-14); }

/// A triangle of sides 3, 4 and 5 dm and a smaller one; its circle has a radius of 0.25 m.
Scene scene_with(const std::vector<Solid>& solids) {
  Scene scene = scene_at_rest(
      make_triangle_mesh(
          (PerParticle3(3, 4) << 0, 0.3, 0, 0.3, 0, 0, 0.4, 0.2, 0, 0, 0, 0).finished(),
          {{0, 1, 2}, {1, 3, 2}}),
      0.2);
  for (const Solid& solid : solids) {
    scene.objects.emplace_back();
    scene.objects.back().object = {"solid", RigidObject{solid, {}, {}}, 0.3};
  }
  return scene;
}

double bound_of(const std::vector<Solid>& solids, const std::vector<Expectation>& stated) {
  return expected_faces_outside(scene_with(solids), stated)->bound;
}

}  // namespace

TEST_CASE("bounds of faces: the chord of round bodies, and no more than the way to a corner") {
  const double r = 1.25 * 0.25, d = 0.03;
  const std::vector<Expectation> stated = {{"takes_steps", 9, ""}, {"stays_outside", d, "w"}};
  const auto chord = [&](double R) { return R - std::sqrt((R - d) * (R - d) - r * r); };
  for (const double R : {d + r + 1e-6, 0.6, 0.9, 2.5}) {
    CHECK(bound_of({Sphere{R}}, stated) == exactly(chord(R)));
    CHECK(bound_of({Capsule{R, 3}}, stated) == exactly(chord(R)));
    CHECK(bound_of({Torus{7, R}}, stated) == exactly(chord(R)));
    CHECK(bound_of({HalfSpace{}, Sphere{R}, HalfSpace{}}, stated) == exactly(chord(R)));
  }
  for (const double R : {0.02, 0.2, d + r - 1e-6})  // a chord would be deeper
    CHECK(bound_of({Sphere{R}}, stated) == exactly(d + r));
  CHECK(bound_of({HalfSpace{}}, stated) == d);
  CHECK(bound_of({Sphere{0.05}}, {{"stays_outside", 0.9, "w"}}) == exactly(0.9 + r));
  CHECK(bound_of({Box{{1, 2, 3}}}, stated) == exactly(d + r));
  CHECK(bound_of({Sphere{2.5}, Sphere{0.9}}, stated) == exactly(chord(0.9)));
  CHECK(bound_of({Sphere{0.9}, Sphere{2.5}}, stated) == exactly(chord(0.9)));
  CHECK(bound_of({HalfSpace{}}, {{"lies_inside", 1, ""}, {"stays_outside", d, "w"}}) == d);
}

TEST_CASE("bounds of faces: their reason names the depth, the circle and the stretch") {
  const std::vector<Expectation> stated = {{"stays_outside", 0.03, "w"}};
  CHECK(expected_faces_outside(scene_with({HalfSpace{}}), stated)->key == "faces_outside");
  CHECK_THAT(expected_faces_outside(scene_with({HalfSpace{}}), stated)->why,
             StartsWith("corners are at most 0.03 m deep, as expected of particles") &&
                 Contains("r = 0.312 m when stretched by 0.25."));
  Scene limited = scene_with({Box{{1, 2, 3}}});
  limited.strain_limits = StrainLimits{0.12, 0.3};
  CHECK(largest_enclosing_radius(limited) == exactly(1.12 * 0.25));
  CHECK(usual_particle_depth(limited) == exactly(0.028));
  CHECK(expected_faces_outside(limited, {})->bound == exactly(1.1 * 1.12 * 0.25));
  CHECK_THAT(expected_faces_outside(limited, {})->why,
             StartsWith("corners may be 0.028 m deep, r/10") &&
                 Contains("r = 0.28 m when stretched by 0.12."));
}

TEST_CASE("bounds of faces: the enclosing circle of any triangle holds it, and is the smallest") {
  std::mt19937 bits(3);
  std::uniform_real_distribution<double> within(-1, 1);
  for (int k = 0; k < 200; ++k) {
    const Vector3 a(within(bits), within(bits), within(bits)),
        b(within(bits), within(bits), within(bits)), c(within(bits), within(bits), within(bits));
    // the smallest that holds all corners, of the circles about two corners and through three
    Eigen::Matrix3d planes;
    planes << (b - a).transpose(), (c - a).transpose(), (b - a).cross(c - a).transpose();
    const Vector3 through =
        a + planes.inverse() * Vector3((b - a).squaredNorm(), (c - a).squaredNorm(), 0) / 2;
    double smallest = 9;
    for (const Vector3& centre :
         {Vector3((a + b) / 2), Vector3((b + c) / 2), Vector3((c + a) / 2), through})
      smallest = std::min(
          smallest, std::max({(a - centre).norm(), (b - centre).norm(), (c - centre).norm()}));
    CHECK(enclosing_radius(a, b, c) == Approx(smallest).epsilon(1e-8));
    CHECK(enclosing_radius(c, a, b) == exactly(enclosing_radius(a, b, c)));
  }
}

TEST_CASE("depth of faces: a half space, by its lowest corner") {
  const Vector3 a(1, 2, -0.3), b(2, -1, 0.7), c(0, 1, 0.2);
  CHECK(deepest_point(HalfSpace{}, {a, b, c}) == 0.3);
  CHECK(deepest_point(HalfSpace{}, {b, a, c}) == 0.3);
  CHECK(deepest_point(HalfSpace{}, {b, c, a}) == 0.3);
  CHECK(deepest_point(HalfSpace{}, {b, c, c}) == -0.2);
}

TEST_CASE("depth of faces: slivers and points are as deep as their segments") {
  const Capsule capsule{0.4, 0.6};
  std::mt19937 bits(8);
  std::uniform_real_distribution<double> within(-1.1, 1.1);
  for (int k = 0; k < 300; ++k) {
    const Vector3 a(within(bits), within(bits), within(bits)),
        b(within(bits), within(bits), within(bits));
    double deepest = -9;
    for (int i = 0; i <= 2000; ++i)
      deepest = std::max(deepest, -capsule.at(a + i / 2000.0 * (b - a)).phi);
    const Vector3 middle = 0.3 * a + 0.7 * b;
    CHECK(deepest_point(capsule, {a, middle, b}) == Approx(deepest).margin(2e-3));
    CHECK(deepest_point(capsule, {a, middle, b}) >= deepest - 1e-12);
    CHECK(deepest_point(capsule, {a, a, a}) == exactly(-capsule.at(a).phi));
  }
}

TEST_CASE("depth of faces: in a box, against dense points of faces of any size") {
  const Box box{{0.5, 0.7, 0.3}};
  std::mt19937 bits(21);
  for (const double reach : {0.4, 0.8, 3.0})
    for (int k = 0; k < 60; ++k) {
      std::uniform_real_distribution<double> within(-reach, reach);
      const auto point = [&] { return Vector3(within(bits), within(bits), within(bits)); };
      const FaceCorners face = {point(), point(), point()};
      double deepest = -9;
      for (int i = 0; i <= 120; ++i)
        for (int j = 0; i + j <= 120; ++j) {
          const Vector3 p =
              face[0] + i / 120.0 * (face[1] - face[0]) + j / 120.0 * (face[2] - face[0]);
          // the least depth below a face, outside the box too
          deepest = std::max(deepest, std::min((box.half_extents - p).minCoeff(),
                                               (box.half_extents + p).minCoeff()));
        }
      const double exact = deepest_point(box, face);
      CHECK(exact >= deepest - 1e-12);
      CHECK(exact <= deepest + 0.03 * reach);
    }
}

TEST_CASE("depth of faces: in an object that is turned, moved and moves") {
  RigidObject body{Box{{0.5, 0.7, 0.3}}, {}, {}};
  body.place.rotation = Eigen::AngleAxisd(0.7, Vector3(1, 2, -1).normalized());
  body.place.translation = Vector3(0.3, -0.2, 0.9);
  const std::vector<FaceCorners> faces = {
      {Vector3(0.9, 0.1, 1), Vector3(-0.4, 0.3, 0.8), Vector3(0.2, -0.9, 1.3)},
      {Vector3(9, 9, 9), Vector3(9, 8, 9), Vector3(8, 9, 9)},
      {Vector3(0.3, -0.1, 1.1), Vector3(0.4, 0.3, 0.9), Vector3(0.2, -0.3, 1.3)}};
  double deepest = 0.011;
  for (FaceCorners face : faces) {
    for (Vector3& corner : face)
      corner = body.place.rotation.inverse() * (corner - body.place.translation);
    deepest = std::max(deepest, deepest_point(Box{{0.5, 0.7, 0.3}}, face));
  }
  const Object object{"box", body, 0.3};
  CHECK(deepest > 0.2);
  CHECK(deepest_in_object(object, 0.4, faces, 0.011, 1e-4) == exactly(deepest));
  CHECK(deepest_in_object(object, 0.4, std::span(faces).subspan(1, 1), 0.011, 1e-4) == 0.011);
  CHECK(deepest_in_object(object, 0.4, faces, 0.77, 1e-4) == 0.77);
}

TEST_CASE("depth of faces: a search adds its tolerance to what it finds, once it finds more") {
  const auto bump = [](const Vector3& p) { return 0.5 - (p - Vector3(0.3, 0.2, 0)).norm(); };
  const FaceCorners large = {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
  const FaceCorners other = {Vector3(3, 0, 0), Vector3(4, 0, 0), Vector3(3, 1, 0)};
  for (const std::vector<FaceCorners>& faces :
       std::vector<std::vector<FaceCorners>>{{large}, {other, large}, {large, other}}) {
    for (const double tolerance : {0.1, 0.01, 1e-3}) {
      const double found = deepest_of({bump, 1, tolerance}, faces, 0);
      CHECK(found >= 0.5);
      CHECK(found <= 0.5 + tolerance);
      CHECK(found > 0.5 - tolerance + tolerance);
    }
    CHECK(deepest_of({bump, 1, 1e-3}, faces, 0.5) == 0.5);
    CHECK(deepest_of({bump, 1, 1e-3}, faces, 0.498) == Approx(0.4995).margin(2.6e-3));
  }
  long asked = 0;
  const auto counted = [&](const Vector3& p) { return ++asked, bump(p); };
  deepest_of({counted, 1, 1e-3}, std::vector<FaceCorners>{large}, 0);
  CHECK(asked < 2000);  // the parts with the widest bounds come first
}

TEST_CASE("depth of faces: of a whole cloth, a search is a thousandth of its longest side off") {
  // the core of a ring passes through the middle of the face, which the search asks first
  for (const Triangle& face : std::vector<Triangle>{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}})
    for (const bool is_alone : {true, false}) {
      PerParticle3 x(3, 6);
      x << 0, 0.5, 0.1, 5, 5.2, 5, 0, 0.1, 0.3, 5, 5, 5.1, 0, 0, 0, 7, 7, 7;
      const PerParticle3 kept = is_alone ? PerParticle3(x.leftCols(3)) : x;
      std::vector<Triangle> triangles = {face};
      if (!is_alone) triangles.push_back({3, 4, 5});  // smaller, and far away
      const Scene scene = scene_at_rest(make_triangle_mesh(kept, triangles), 0.2);
      RigidObject ring{Torus{0.12, 0.03}, {}, {}};
      ring.place.translation = (x.col(0) + x.col(1) + x.col(2)) / 3 - Vector3(0.12, 0, 0);
      const std::vector<Object> objects = {{"ring", ring, 0.1}};
      const double longest = std::hypot(0.5, 0.1);
      CHECK(value_at(*find_quantity("faces_outside"), scene, objects, start_state(scene)) ==
            exactly(0.03 + 1e-3 * longest));
    }
}

TEST_CASE("depth of faces: a search finds the deepest middle of the first parts") {
  // a linear field: of the middles of the quarters, that of the corner with the largest x
  const FaceCorners face = {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
  const auto slope = [](const Vector3& p) { return p.x(); };
  const double found = deepest_of({slope, 1, 0.4}, std::vector<FaceCorners>{face}, 0);
  CHECK(found == exactly(2.0 / 3 + 0.4));
}

TEST_CASE("depth of faces: where a corner is the deepest point, its depth is exact") {
  PerParticle3 x(3, 3);
  x << 0, 0.5, 0.1, 0, 0.1, 0.3, 0, 0, 0;
  const Scene scene = scene_at_rest(make_triangle_mesh(x, {{0, 1, 2}}), 0.2);
  for (const int corner : {0, 1, 2}) {
    RigidObject ring{Torus{0.12, 0.03}, {}, {}};
    const Vector3 middle = (x.col(0) + x.col(1) + x.col(2)) / 3, place = x.col(corner);
    ring.place.translation = place + 0.12 * (place - middle).normalized();
    const std::vector<Object> objects = {{"ring", ring, 0.1}};
    CHECK(value_at(*find_quantity("faces_outside"), scene, objects, start_state(scene)) ==
          exactly(0.03));
  }
}
