// Depths of whole triangles: closed forms against the search, the search against dense sampling,
// and the derived bound against random triangles.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "reference/scene/scene.h"
#include "verification/cases/face_bound.h"
#include "verification/cases/face_depth.h"
#include "verification/cases/quantities.h"

using namespace foldproof;

namespace {

Vector3 random_point(std::mt19937& bits, double reach) {
  std::uniform_real_distribution<double> within(-reach, reach);
  return {within(bits), within(bits), within(bits)};
}

FaceCorners random_face(std::mt19937& bits, double reach) {
  return {random_point(bits, reach), random_point(bits, reach), random_point(bits, reach)};
}

/// The deepest of many points of the face [m]; `finer` per side.
double sampled_depth(const Solid& solid, const FaceCorners& face, int finer) {
  double deepest = -1e9;
  for (int i = 0; i <= finer; ++i)
    for (int j = 0; i + j <= finer; ++j) {
      const double a = double(i) / finer, b = double(j) / finer;
      deepest = std::max(
          deepest, -distance_to(solid, a * face[0] + b * face[1] + (1 - a - b) * face[2]).phi);
    }
  return deepest;
}

Scene scene_with(const Solid& solid) {
  TriangleMesh mesh = make_triangle_mesh(
      (PerParticle3(3, 4) << 0, 0.3, 0, 0.3, 0, 0, 0.3, 0.3, 0.1, 0.1, 0.1, 0.1).finished(),
      {{0, 1, 2}, {1, 3, 2}});
  Scene scene = scene_at_rest(std::move(mesh), 0.2);
  SceneObject part;
  part.object = {"solid", RigidObject{solid, {}, {}}, 0.3};
  scene.objects.push_back(part);
  return scene;
}

double faces_outside(const Scene& scene) {
  return value_at(*find_quantity("faces_outside"), scene,
                  build_objects(scene, computing_provider()), start_state(scene));
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
    CHECK(exact >= sampled_depth(solid, faces[0], 20) - 1e-14);
  }
  CHECK(inside > 300);
}

TEST_CASE("a body whose axis pierces the face is as deep in it as its radius") {
  const FaceCorners face = {Vector3(2, 0.3, 0.1), Vector3(-2, 1.5, 0.2), Vector3(-0.5, -2, 0.3)};
  CHECK(deepest_point(Capsule{0.4, 0.6}, face) == 0.4);
  const FaceCorners cut = {Vector3(3, 0.1, 0), Vector3(-2, 2, 0), Vector3(-2, -2, 0)};
  CHECK(deepest_point(Box{{0.5, 0.7, 0.3}}, cut) == Approx(0.3).epsilon(1e-15));
}

TEST_CASE("the search keeps a depth that is known, and its bound holds for a tilted field") {
  std::mt19937 bits(5);
  const auto shallow = [](const Vector3& p) { return 0.5 * p.x() - 0.25 * p.y(); };
  for (int k = 0; k < 200; ++k) {
    const std::vector<FaceCorners> faces = {random_face(bits, 1)};
    const double exact =
        std::max({shallow(faces[0][0]), shallow(faces[0][1]), shallow(faces[0][2])});
    const double found = deepest_of({shallow, 1, 1e-3}, faces, -2);
    CHECK(found >= exact);
    CHECK(found <= exact + 1.0001e-3);
    CHECK(deepest_of({shallow, 1, 1e-3}, faces, 3) == 3);
  }
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

TEST_CASE("the enclosing circle is about the longest side unless all angles are acute") {
  const Vector3 o(0, 0, 0), x(4, 0, 0);
  CHECK(enclosing_radius(o, x, {1, 0.5, 0}) == 2);
  CHECK(enclosing_radius(o, x, {0, 3, 0}) == 2.5);
  CHECK(enclosing_radius(o, x, {2, 2 * std::sqrt(3.), 0}) == Approx(4 / std::sqrt(3.)));
}

TEST_CASE("faces_outside: a face passes through a ball that no particle enters") {
  Scene scene = scene_with(Sphere{0.15});
  const Solid moved = Sphere{0.15};
  std::get<RigidObject>(scene.objects[0].object.body).place.translation = {0.15, 0.15, 0.1};
  CHECK(faces_outside(scene) == Approx(0.15).epsilon(1e-14));
  CHECK(value_at(*find_quantity("stays_outside"), scene, build_objects(scene, computing_provider()),
                 start_state(scene)) == 0);
  scene.prescribed.push_back({1, scene.x.col(1), {}});  // a corner of both triangles
  CHECK(faces_outside(scene) == 0);
  scene.prescribed.clear();
  scene.x(0, 0) = NAN;
  CHECK(std::isnan(faces_outside(scene)));
}

TEST_CASE("faces_outside is expected of cases with objects, by what their bodies are") {
  const Scene round = scene_with(Sphere{1}), flat = scene_with(HalfSpace{}),
              edged = scene_with(Box{{1, 2, 3}});
  const std::vector<Expectation> depth = {{"stays_outside", 0.01, "w"}};
  const double r = 1.25 * 0.3 / std::sqrt(2.);
  CHECK(expected_faces_outside(flat, depth)->bound == 0.01);
  CHECK(expected_faces_outside(round, depth)->bound == Approx(1 - std::sqrt(0.9801 - r * r)));
  CHECK(expected_faces_outside(edged, depth)->bound == Approx(0.01 + r));
  CHECK(expected_faces_outside(flat, {})->bound == Approx(r / 10));
  CHECK(!expected_faces_outside(flat, {{"lies_inside", 0.01, "w"}}));
  Scene bare = flat;
  bare.objects.clear();
  CHECK(!expected_faces_outside(bare, depth));
}
