// Depths of whole triangles: closed forms against the search, the search against known depths, and
// the bounds that follow from the bodies against random triangles.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "reference/bodies/level_set_provider.h"
#include "reference/scene/scene.h"
#include "verification/cases/face_bound.h"
#include "verification/cases/face_depth.h"
#include "verification/cases/quantities.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

Approx exactly(double value) { return Approx(value).epsilon(1e-10).margin(1e-14); }

Vector3 random_point(std::mt19937& bits, double reach) {
  std::uniform_real_distribution<double> within(-reach, reach);
  return {within(bits), within(bits), within(bits)};
}

FaceCorners random_face(std::mt19937& bits, double reach) {
  return {random_point(bits, reach), random_point(bits, reach), random_point(bits, reach)};
}

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

double faces_outside(const Scene& scene, const std::vector<Object>& objects) {
  return value_at(*find_quantity("faces_outside"), scene, objects, start_state(scene));
}

}  // namespace

TEMPLATE_TEST_CASE("closed forms of the deepest point are what a search finds", "", Sphere, Capsule,
                   Box, HalfSpace) {
  TestType solid{};
  if constexpr (std::same_as<TestType, Sphere>) solid = {0.7};
  if constexpr (std::same_as<TestType, Capsule>) solid = {0.4, 0.6};
  if constexpr (std::same_as<TestType, Box>) solid = {{0.5, 0.7, 0.3}};
  std::mt19937 bits(11);
  const auto depth = [&](const Vector3& p) { return -solid.at(p).phi; };
  int inside = 0;
  for (int k = 0; k < 3000; ++k) {
    const std::vector<FaceCorners> faces = {random_face(bits, 1.3)};
    const double exact = std::max(0., deepest_point(solid, faces[0]));
    const double found = deepest_of({depth, 1, 1e-4}, faces, 0);
    inside += exact > 0;
    CHECK(found >= exact - 1e-14);
    CHECK(found <= exact + 1.0001e-4);
  }
  CHECK(inside > 300);
}

TEST_CASE("a body whose axis pierces the face is as deep in it as its radius") {
  const FaceCorners face = {Vector3(2, 0.3, 0.1), Vector3(-2, 1.5, 0.2), Vector3(-0.5, -2, 0.3)};
  CHECK(deepest_point(Capsule{0.4, 0.6}, face) == 0.4);
  const FaceCorners cut = {Vector3(3, 0.1, 0), Vector3(-2, 2, 0), Vector3(-2, -2, 0)};
  CHECK(deepest_point(Box{{0.5, 0.7, 0.3}}, cut) == Approx(0.3).epsilon(1e-15));
}

TEST_CASE("depth of faces: in an object that is turned and moved, and at least what is known") {
  RigidObject body{Box{{0.5, 0.7, 0.3}}, {}, {}};
  body.place.rotation = Eigen::AngleAxisd(0.7, Vector3(1, 2, -1).normalized());
  body.place.translation = Vector3(0.3, -0.2, 0.9);
  FaceCorners face = {Vector3(0.6, 0.1, 0.1), Vector3(-0.4, 0.3, 0.2), Vector3(0.2, -0.9, 0.1)};
  const double deepest = deepest_point(Box{{0.5, 0.7, 0.3}}, face);
  for (Vector3& corner : face) corner = body.place.rotation * corner + body.place.translation;
  const std::vector<FaceCorners> faces = {face,
                                          {Vector3(9, 9, 9), Vector3(9, 8, 9), Vector3(8, 9, 9)}};
  CHECK(deepest > 0.1);
  CHECK(deepest_in_object({"box", body, 0.3}, 0.4, faces, 0.011, 1e-4) == exactly(deepest));
  CHECK(deepest_in_object({"box", body, 0.3}, 0.4, faces, 0.77, 1e-4) == 0.77);
}

TEST_CASE("the enclosing circle is about the longest side unless all angles are acute") {
  const Vector3 o(0, 0, 0), x(4, 0, 0);
  CHECK(enclosing_radius(o, x, {1, 0.5, 0}) == 2);
  CHECK(enclosing_radius(o, x, {0, 3, 0}) == 2.5);
  CHECK(enclosing_radius(o, x, {2, 2 * std::sqrt(3.), 0}) == Approx(4 / std::sqrt(3.)));
}

TEST_CASE("corners outside a round body bound the depth between them") {
  std::mt19937 bits(23);
  double closest = 0;
  for (int k = 0; k < 20000; ++k) {
    FaceCorners face;
    const Vector3 middle = 0.9 * random_point(bits, 1).normalized();
    for (Vector3& corner : face) {
      corner = middle + 0.5 * random_point(bits, 1);
      corner *= std::max(1., 0.97 / corner.norm());  // at most 0.03 deep in the unit ball
    }
    const double r = enclosing_radius(face[0], face[1], face[2]);
    const double squared = 0.97 * 0.97 - r * r;
    const double bound = squared > 0 ? 1 - std::sqrt(squared) : 0.03 + r;
    const double depth = deepest_point(Sphere{1}, face);
    CHECK(depth <= bound + 1e-14);
    closest = std::max(closest, depth / bound);
  }
  CHECK(closest > 0.9);
}

TEST_CASE("bounds of faces: the chord of round bodies, and no more than the way to a corner") {
  const double r = 1.25 * 0.25, d = 0.03;
  const std::vector<Expectation> stated = {{"takes_steps", 9, ""}, {"stays_outside", d, "w"}};
  const auto chord = [&](double R) { return R - std::sqrt((R - d) * (R - d) - r * r); };
  for (const double R : {d + r + 1e-6, 0.6, 0.9, 2.5})
    for (const std::vector<Solid>& solids : std::vector<std::vector<Solid>>{
             {Sphere{R}}, {Capsule{R, 3}}, {Torus{7, R}}, {HalfSpace{}, Sphere{R}, HalfSpace{}}})
      CHECK(bound_of(solids, stated) == exactly(chord(R)));
  for (const double R : {0.02, 0.2, d + r - 1e-6})  // a chord would be deeper
    CHECK(bound_of({Sphere{R}}, stated) == exactly(d + r));
  CHECK(bound_of({Sphere{0.05}}, {{"stays_outside", 0.9, "w"}}) == exactly(0.9 + r));
  CHECK(bound_of({Sphere{2.5}, Sphere{0.9}}, stated) == exactly(chord(0.9)));
  CHECK(bound_of({Sphere{0.9}, Sphere{2.5}}, stated) == exactly(chord(0.9)));
}

TEST_CASE("faces_outside is expected of cases with objects, by what their bodies are") {
  const double r = 1.25 * 0.25;
  const std::vector<Expectation> depth = {{"stays_outside", 0.01, "w"}};
  CHECK(bound_of({HalfSpace{}}, depth) == 0.01);
  CHECK(bound_of({HalfSpace{}}, {{"lies_inside", 1, ""}, depth[0]}) == 0.01);
  CHECK(bound_of({Sphere{1}}, depth) == exactly(1 - std::sqrt(0.9801 - r * r)));
  CHECK(bound_of({Box{{1, 2, 3}}}, depth) == exactly(0.01 + r));
  CHECK(bound_of({HalfSpace{}}, {}) == exactly(r / 10));
  CHECK(!expected_faces_outside(scene_with({HalfSpace{}}), {{"lies_inside", 0.01, "w"}}));
  CHECK(!expected_faces_outside(scene_with({}), depth));
  Scene limited = scene_with({Box{{1, 2, 3}}});
  limited.strain_limits = StrainLimits{0.12, 0.3};
  CHECK(largest_enclosing_radius(limited) == exactly(1.12 * 0.25));
  CHECK(usual_particle_depth(limited) == exactly(0.028));
  CHECK(expected_faces_outside(limited, {})->bound == exactly(1.1 * 1.12 * 0.25));
  CHECK(expected_faces_outside(limited, {})->key == "faces_outside");
  CHECK_THAT(expected_faces_outside(limited, {})->why, Contains("stretched by 0.12."));
}

TEST_CASE("faces_outside: a face passes through a ball that no particle enters") {
  Scene scene = scene_with({Sphere{0.14}});
  std::get<RigidObject>(scene.objects[0].object.body).place.translation = {0.15, 0.2, 0};
  const std::vector<Object> objects = build_objects(scene, computing_provider());
  CHECK(faces_outside(scene, objects) == Approx(0.14).epsilon(1e-14));
  CHECK(value_at(*find_quantity("stays_outside"), scene, objects, start_state(scene)) == 0);
  scene.prescribed.push_back({1, scene.x.col(1), {}});  // a corner of both triangles
  CHECK(faces_outside(scene, objects) == 0);
  scene.prescribed.clear();
  scene.x(0, 0) = NAN;
  CHECK(std::isnan(faces_outside(scene, objects)));
}
