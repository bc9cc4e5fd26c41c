// Objects of a case: shapes, places, names, and how cloth meets them.
#include <catch2/catch.hpp>

#include "reference/bodies/closed_mesh.h"
#include "reference/scene/field_recipe.h"
#include "reference/scene/object_surface.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

/// An object whose keys begin on line 7.
SceneObject object(const std::string& keys) {
  return scene_with("[[object]]\n" + keys).objects.at(0);
}

const RigidObject& rigid(const SceneObject& part) {
  return std::get<RigidObject>(part.object.body);
}

template <class Shape>
Shape solid(const SceneObject& part) {
  return std::get<Shape>(rigid(part).solid);
}

double area_of(const ObjectSurface& surface) {
  return triangle_areas(surface.triangles, surface.vertices).sum();
}

/// Whether each triangle's normal points away from the place that `inside` gives for its middle.
template <class Inside>
bool points_outward(const ObjectSurface& surface, const Inside& inside) {
  for (const Triangle& t : surface.triangles) {
    const Vector3 a = surface.vertices.col(t[0]), b = surface.vertices.col(t[1]),
                  c = surface.vertices.col(t[2]), middle = (a + b + c) / 3;
    if (!((b - a).cross(c - a).dot(middle - inside(middle)) > 0)) return false;
  }
  return true;
}

double longest_edge(const ObjectSurface& surface) {
  double longest = 0;
  for (const Triangle& t : surface.triangles)
    for (size_t k = 0; k < 3; ++k)
      longest = std::max(
          longest, (surface.vertices.col(t[k]) - surface.vertices.col(t[(k + 1) % 3])).norm());
  return longest;
}

}  // namespace

TEST_CASE("a square is drawn about the origin, facing up", "[scene]") {
  const ObjectSurface square = square_surface(3);
  CHECK(square.vertices.rowwise().minCoeff() == Vector3(-1.5, -1.5, 0));
  CHECK(square.vertices.rowwise().maxCoeff() == Vector3(1.5, 1.5, 0));
  CHECK(square.triangles.size() == 2);
  CHECK(area_of(square) == 9);
  CHECK(make_triangle_mesh(square.vertices, square.triangles).hinges.size() == 1);
  CHECK(points_outward(square, [](const Vector3& p) { return p - Vector3::UnitZ(); }));
}

TEST_CASE("a box is drawn by twelve triangles outward", "[scene]") {
  const ObjectSurface box = box_surface({0.5, 0.75, 1.25});
  CHECK(box.triangles.size() == 12);
  CHECK(area_of(box) == Approx(8 * (0.5 * 0.75 + 0.75 * 1.25 + 1.25 * 0.5)).epsilon(1e-14));
  CHECK(enclosed_volume(box.vertices, box.triangles) ==
        Approx(8 * 0.5 * 0.75 * 1.25).epsilon(1e-14));
  CHECK(points_outward(box, [](const Vector3&) { return Vector3(0, 0, 0); }));
  const TriangleMesh mesh = make_triangle_mesh(box.vertices, box.triangles);
  CHECK(euler_characteristic(mesh) == 2);
  CHECK(mesh.hinges.size() == 18);
  for (int k = 0; k < 8; ++k)
    CHECK(box.vertices.col(k) ==
          Vector3(k & 1 ? 0.5 : -0.5, k & 2 ? 0.75 : -0.75, k & 4 ? 1.25 : -1.25));
}

TEST_CASE("a sphere is drawn by 5120 triangles", "[scene]") {
  const ObjectSurface sphere = sphere_surface(0.7);
  CHECK(sphere.triangles.size() == 5120);
  CHECK(sphere.vertices.colwise().norm().maxCoeff() == Approx(0.7).epsilon(1e-14));
  CHECK(sphere.vertices.colwise().norm().minCoeff() == Approx(0.7).epsilon(1e-14));
  CHECK(points_outward(sphere, [](const Vector3&) { return Vector3(0, 0, 0); }));
}

TEST_CASE("a capsule is drawn by even rings of 64, with pinholes at its poles", "[scene]") {
  const double r = 0.4, half = 0.9;
  const ObjectSurface capsule = capsule_surface(r, half);
  const PerParticle3& x = capsule.vertices;
  CHECK(x.cols() == 34 * 64);
  CHECK(capsule.triangles.size() == 33 * 64 * 2);
  const auto on_axis = [&](const Vector3& p) {
    return Vector3(0, 0, std::clamp(p.z(), -half, half));
  };
  CHECK(points_outward(capsule, on_axis));
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Vector3 p = x.col(i);
    const double from_axis = std::hypot(p.x(), p.y());
    if (from_axis < 1.001e-3 * r) {
      CHECK(from_axis == Approx(1e-3 * r).epsilon(1e-12));
      CHECK(std::abs(p.z()) == Approx(half + r).epsilon(1e-14));
    } else {
      CHECK((p - on_axis(p)).norm() == Approx(r).epsilon(1e-14));
    }
  }
  // rings of equal latitudes: edges no longer than the diagonal of the two spacings, or the side
  const double along = 2 * r * std::sin(pi / 64), around = 2 * r * std::sin(pi / 64);
  CHECK(longest_edge(capsule) <= std::hypot(2 * half, around) * (1 + 1e-12));
  for (int k = 0; k < 33; ++k) {
    const double step = (x.col(64 * (k + 1)) - x.col(64 * k)).norm();
    CHECK(step == Approx(k == 16 ? 2 * half : along).epsilon(k == 0 || k == 32 ? 0.02 : 1e-9));
  }
  const TriangleMesh mesh = make_triangle_mesh(x, capsule.triangles);
  CHECK(euler_characteristic(mesh) == 0);  // a tube between two pinholes
}

TEST_CASE("a torus is drawn by 64 even rings of 64", "[scene]") {
  const double R = 0.9, r = 0.25;
  const ObjectSurface torus = torus_surface(R, r);
  CHECK(torus.vertices.cols() == 64 * 64);
  CHECK(torus.triangles.size() == 64 * 64 * 2);
  const auto on_ring = [&](const Vector3& p) {
    return Vector3(Vector3(p.x(), p.y(), 0).normalized() * R);
  };
  for (Eigen::Index i = 0; i < torus.vertices.cols(); ++i) {
    const Vector3 p = torus.vertices.col(i);
    CHECK((p - on_ring(p)).norm() == Approx(r).epsilon(1e-13));
  }
  CHECK(points_outward(torus, on_ring));
  CHECK(longest_edge(torus) <=
        std::hypot(2 * (R + r) * std::sin(pi / 64), 2 * r * std::sin(pi / 64)) * (1 + 1e-12));
  const TriangleMesh mesh = make_triangle_mesh(torus.vertices, torus.triangles);
  CHECK(euler_characteristic(mesh) == 0);
  CHECK(mesh.hinges.size() == mesh.edges.size());
  CHECK(enclosed_volume(torus.vertices, torus.triangles) ==
        Approx(2 * pi * pi * R * r * r).epsilon(0.005));
}

TEST_CASE("shapes have the lengths of their keys, in the solid and in the picture", "[scene]") {
  const SceneObject sphere = object("shape = \"sphere\"\nradius = 0.7\n");
  CHECK(solid<Sphere>(sphere).radius == 0.7);
  CHECK(sphere.vertices == sphere_surface(0.7).vertices);
  CHECK(sphere.triangles == sphere_surface(0.7).triangles);
  CHECK(sphere.shape == "sphere");
  CHECK_FALSE(sphere.field);
  CHECK_FALSE(sphere.animation);
  const SceneObject box = object("shape = \"box\"\nsize = [1, 1.5, 2.5]\n");
  CHECK(solid<Box>(box).half_extents == Vector3(0.5, 0.75, 1.25));
  CHECK(box.vertices == box_surface({0.5, 0.75, 1.25}).vertices);
  const SceneObject capsule = object("shape = \"capsule\"\nradius = 0.4\nlength = 1.8\n");
  CHECK(solid<Capsule>(capsule).radius == 0.4);
  CHECK(solid<Capsule>(capsule).half_length == 0.9);
  CHECK(capsule.vertices == capsule_surface(0.4, 0.9).vertices);
  const SceneObject torus = object("shape = \"torus\"\nring_radius = 0.9\ntube_radius = 0.25\n");
  CHECK(solid<Torus>(torus).ring_radius == 0.9);
  CHECK(solid<Torus>(torus).tube_radius == 0.25);
  CHECK(torus.vertices == torus_surface(0.9, 0.25).vertices);
  const SceneObject plane = object("shape = \"half_space\"\n");
  CHECK(std::holds_alternative<HalfSpace>(rigid(plane).solid));
  CHECK(plane.vertices == square_surface(2).vertices);
  CHECK(object("shape = \"half_space\"\ndrawn_width = 3.5\n").vertices ==
        square_surface(3.5).vertices);
}

TEST_CASE("lengths of shapes are positive, and a tube is thinner than its ring", "[scene]") {
  CHECK_THROWS_WITH(object("shape = \"sphere\"\nradius = 0\n"),
                    "some.toml:8: 'radius' must be > 0");
  CHECK_THROWS_WITH(object("shape = \"half_space\"\ndrawn_width = 0\n"),
                    "some.toml:8: 'drawn_width' must be > 0");
  for (const char* size : {"[0, 1, 1]", "[1, 0, 1]", "[1, 1, 0]", "[1, 1, -1]"})
    CHECK_THROWS_WITH(object("shape = \"box\"\nsize = " + std::string(size) + "\n"),
                      "some.toml:8: 'size' must be > 0 along each axis");
  CHECK_THROWS_WITH(object("shape = \"capsule\"\nradius = 0\nlength = 1\n"),
                    "some.toml:8: 'radius' must be > 0");
  CHECK_THROWS_WITH(object("shape = \"capsule\"\nradius = 1\nlength = 0\n"),
                    "some.toml:9: 'length' must be > 0");
  CHECK_THROWS_WITH(object("shape = \"torus\"\nring_radius = 0.5\ntube_radius = 0.5\n"),
                    "some.toml:9: 'tube_radius' must be smaller than 'ring_radius'");
  CHECK_NOTHROW(object("shape = \"torus\"\nring_radius = 0.5\ntube_radius = 0.4999\n"));
  CHECK_THROWS_WITH(object("shape = \"torus\"\nring_radius = 0\ntube_radius = 0.5\n"),
                    "some.toml:8: 'ring_radius' must be > 0");
  CHECK_THROWS_WITH(object("shape = \"torus\"\nring_radius = 1\ntube_radius = 0\n"),
                    "some.toml:9: 'tube_radius' must be > 0");
  CHECK_THROWS_WITH(
      object("shape = \"cube\"\n"),
      "some.toml:7: unknown shape 'cube'; known: sphere, half_space, box, capsule, torus, statue");
}

TEST_CASE("objects are named after shape and number, and have no friction by default", "[scene]") {
  const Scene scene = scene_with(
      "[[object]]\nshape = \"half_space\"\n[[object]]\nshape = \"sphere\"\nradius = 2\n"
      "name = \"ball\"\nfriction = 0.35\n[[object]]\nshape = \"half_space\"\n");
  REQUIRE(scene.objects.size() == 3);
  CHECK(scene.objects[0].object.name == "half_space 1");
  CHECK(scene.objects[1].object.name == "ball");
  CHECK(scene.objects[2].object.name == "half_space 3");
  CHECK(scene.objects[0].object.friction == 0);
  CHECK(scene.objects[1].object.friction == 0.35);
  CHECK_THROWS_WITH(object("shape = \"half_space\"\nfriction = -1e-9\n"),
                    "some.toml:8: 'friction' must not be negative");
  const std::string one =
      ": [[object]] needs either 'shape' or 'mesh' (an OBJ file) or 'frames' (a folder of such "
      "files), and not both";
  CHECK_THROWS_WITH(object(""), "some.toml:6" + one);
  CHECK_THROWS_WITH(object("mesh = \"a\"\nframes = \"b\"\n"), "some.toml:7" + one);
  CHECK_THROWS_WITH(object("shape = \"box\"\nframes = \"b\"\n"), "some.toml:6" + one);
  CHECK_THROWS_WITH(object("mesh = \"a\"\nshape = \"box\"\n"), "some.toml:7" + one);
}

TEST_CASE("an object lies where it is turned, then moved to", "[scene]") {
  const SceneObject plane = object(
      "shape = \"half_space\"\ndrawn_width = 4\nturn = { axis = [3, 0, 0], angle = 90 }\n"
      "move = [10, 20, 30]\n");
  // (x, y, 0) becomes (x, 0, y)
  const PerParticle3 plain = square_surface(4).vertices;
  for (Eigen::Index i = 0; i < 4; ++i)
    CHECK((plane.vertices.col(i) - Vector3(10 + plain(0, i), 20, 30 + plain(1, i))).norm() < 1e-14);
  CHECK(rigid(plane).place.translation == Vector3(10, 20, 30));
  CHECK((rigid(plane).place.rotation * Vector3::UnitY() - Vector3::UnitZ()).norm() < 1e-15);
  CHECK(rigid(object("shape = \"half_space\"\n")).place.translation == Vector3::Zero());
  CHECK(rigid(object("shape = \"half_space\"\n")).place.rotation.w() == 1);
  CHECK_THROWS_WITH(object("shape = \"sphere\"\nradius = 1.7e308\nmove = [0, 1.7e308, 0]\n"),
                    "some.toml:6: a place of its surface is not finite; give smaller lengths");
}

TEST_CASE("an object moves in closed form, or by keyframes", "[scene]") {
  const SceneObject drifts = object("shape = \"half_space\"\nvelocity = [0.1, 0.2, 0.4]\n");
  CHECK(std::get<Motion>(rigid(drifts).motion).velocity == Vector3(0.1, 0.2, 0.4));
  const std::string keys =
      "shape = \"half_space\"\n[[object.keyframe]]\ntime = 0.25\nmove = [1, 2, 3]\n"
      "[[object.keyframe]]\ntime = ";
  const SceneObject framed = object(keys + "0.75\nturn = { axis = [0, 0, 1], angle = 90 }\n");
  const auto& frames = std::get<Keyframes>(rigid(framed).motion).keys;
  REQUIRE(frames.size() == 2);
  CHECK(frames[0].time == 0.25);
  CHECK(frames[0].pose.translation == Vector3(1, 2, 3));
  CHECK(frames[0].pose.rotation.w() == 1);
  CHECK(frames[1].time == 0.75);
  CHECK(frames[1].pose.translation == Vector3::Zero());
  CHECK((frames[1].pose.rotation * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-15);
  CHECK_THROWS_WITH(object(keys + "0.25\n"), StartsWith("some.toml:8: "));
}

TEST_CASE("collision has its documented defaults and takes each key", "[scene]") {
  const auto collision = [](const std::string& keys) {
    return scene_with("[[object]]\nshape = \"half_space\"\n[collision]\n" + keys).collision;
  };
  CHECK(collision("").forecast_time == 0);
  CHECK(collision("").points == PointKind::particles);
  CHECK(collision("").response == "forecast");
  CHECK(collision("forecast_time = 0.03\n").forecast_time == 0.03);
  CHECK(collision("points = \"particles\"\n").points == PointKind::particles);
  CHECK(collision("points = \"edges\"\n").points == PointKind::edges);
  CHECK(collision("points = \"faces\"\n").points == PointKind::faces);
  for (const Response& response : responses())
    CHECK(collision("response = \"" + std::string(response.name) + "\"\n").response ==
          response.name);
  CHECK_THROWS_WITH(collision("forecast_time = 0\n"), "some.toml:9: 'forecast_time' must be > 0");
  CHECK_THROWS_WITH(collision("points = \"all\"\n"),
                    "some.toml:9: unknown points 'all'; known: particles, edges, faces");
  CHECK_THROWS_WITH(scene_with("[collision]\n"), "some.toml:6: [collision] needs an [[object]]");
}
