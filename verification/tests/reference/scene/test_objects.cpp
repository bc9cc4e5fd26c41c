// Objects of a case: shapes, places, names, and how cloth meets them.
#include <catch2/catch.hpp>

#include "reference/scene/object_surface.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;

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

TEST_CASE("shapes have the lengths of their keys, in the solid and in the picture", "[scene]") {
  const SceneObject sphere = object("shape = \"sphere\"\nradius = 0.7\n");
  CHECK(solid<Sphere>(sphere).radius == 0.7);
  CHECK(sphere.vertices == sphere_surface(0.7).vertices);
  CHECK(sphere.triangles == sphere_surface(0.7).triangles);
  CHECK(sphere.shape == "sphere");
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

TEST_CASE("keys of objects are refused beyond their limits, with their place", "[scene]") {
  const std::string torus = "shape = \"torus\"\nring_radius = 0.5\ntube_radius = ",
                    box = "shape = \"box\"\nsize = ",
                    one = ": [[object]] needs either 'shape' or 'mesh' (an OBJ file) or 'frames'";
  CHECK_NOTHROW(object(torus + "0.4999\n"));
  check_refused(object,
                {{torus + "0.5\n", "some.toml:9: 'tube_radius' must be smaller than 'ring_radius'"},
                 {torus + "0\n", "some.toml:9: 'tube_radius' must be > 0"},
                 {"shape = \"half_space\"\ndrawn_width = 0\n", "'drawn_width' must be > 0"},
                 {box + "[0, 1, 1]\n", "some.toml:8: 'size' must be > 0"},
                 {box + "[1, 1, 0]\n", "some.toml:8: 'size' must be > 0"},
                 {"shape = \"capsule\"\nradius = 1\nlength = 0\n", "'length' must be > 0"},
                 {"shape = \"sphere\"\nradius = 1.7e308\nmove = [0, 1.7e308, 0]\n",
                  "some.toml:6: a place of its surface is not finite"},
                 {"mesh = \"a\"\nframes = \"b\"\n", "some.toml:7" + one},
                 {"shape = \"box\"\nframes = \"b\"\n", "some.toml:6" + one}});
}
