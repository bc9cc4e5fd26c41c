#include "reference/scene/read_objects.h"

#include <Eigen/Geometry>
#include <memory>
#include <utility>

#include "reference/level_set/closed_mesh.h"
#include "reference/level_set/repair.h"
#include "reference/mesh/obj.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/key_values.h"
#include "reference/scene/object_surface.h"
#include "reference/scene/shapes_of.h"

namespace foldproof {

namespace {

/// A solid in its own frame, with its surface.
struct Shape {
  Solid solid;
  ObjectSurface surface;
};

Shape read_half_space(const KeyTable& keys) {
  return {HalfSpace{}, square_surface(positive_or(keys, "drawn_width", 2))};
}

Shape read_sphere(const KeyTable& keys) {
  const double radius = positive(keys, "radius");
  return {Sphere{radius}, sphere_surface(radius)};
}

Shape read_box(const KeyTable& keys) {
  const Vector3 size = keys.vector("size");
  if (!(size.minCoeff() > 0)) throw InputError(keys.where("size") + ": 'size' must be > 0 along each axis");
  return {Box{size / 2}, box_surface(size / 2)};
}

Shape read_capsule(const KeyTable& keys) {
  const double radius = positive(keys, "radius"), length = positive(keys, "length");
  return {Capsule{radius, length / 2}, capsule_surface(radius, length / 2)};
}

Shape read_torus(const KeyTable& keys) {
  const double ring = positive(keys, "ring_radius"), tube = positive(keys, "tube_radius");
  if (!(tube < ring))
    throw InputError(keys.where("tube_radius") + ": 'tube_radius' must be smaller than 'ring_radius'");
  return {Torus{ring, tube}, torus_surface(ring, tube)};
}

/// A mesh as a solid: its exact distance, or a grid of it.
Shape solid_of(const KeyTable& keys, TriangleSoup soup) {
  enum class Field { exact, grid };
  fit(keys, soup.rest);
  const auto field = choice<Field>(keys, "field", {{"grid", Field::grid}, {"exact", Field::exact}});
  const auto repair =
      choice<Repair>(keys, "repair", {{"refuse", Repair::refuse}, {"winding", Repair::winding}});
  ObjectSurface surface{soup.rest, soup.triangles};
  if (field == Field::grid) {
    const GridMethod method{int(count_or(keys, "cells", 64)), 4, 3, MarchingOrder::second};
    return {GridSolid{make_level_set(soup, method, repair)}, std::move(surface)};
  }
  if (repair != Repair::refuse) throw InputError(keys.where("repair") + ": 'repair' needs field = \"grid\"");
  const TriangleMesh mesh = make_closed_mesh(std::move(soup));
  return {MeshSolid{std::make_shared<const MeshDistance>(make_mesh_distance(mesh.rest, mesh.triangles))},
          std::move(surface)};
}

Shape read_statue(const KeyTable& keys) {
  const double height = positive(keys, "height");
  TriangleMesh statue = make_statue(height, int(count_or(keys, "subdivisions", 4)));
  return solid_of(keys, {std::move(statue.rest), std::move(statue.triangles), {}});
}

Shape read_shape(const KeyTable& keys) {
  return choice<Shape (*)(const KeyTable&)>(keys, "shape",
                                            {{"sphere", read_sphere},
                                             {"half_space", read_half_space},
                                             {"box", read_box},
                                             {"capsule", read_capsule},
                                             {"torus", read_torus},
                                             {"statue", read_statue}})(keys);
}

Pose read_pose(const KeyTable& keys) {
  return {Eigen::Quaterniond(read_turn(keys)), keys.vector_or("move", Vector3::Zero())};
}

RigidMotion read_rigid_motion(const KeyTable& keys) {
  if (!keys.has("keyframe")) return read_motion(keys);
  std::vector<Keyframe> frames;
  for (const auto& frame : keys.tables("keyframe"))
    frames.push_back({frame->number("time"), read_pose(*frame)});
  try {
    return make_keyframes(std::move(frames));
  } catch (const InputError& error) {
    throw InputError(keys.where("keyframe") + ": " + error.what());
  }
}

SceneObject read_object(const KeyTable& keys, const std::string& folder, size_t number) {
  if (keys.has("shape") == keys.has("mesh"))
    throw InputError(keys.where("mesh") +
                     ": [[object]] needs either 'shape' or 'mesh' (an OBJ file), and not both");
  SceneObject part;
  part.shape = keys.has("shape") ? keys.text("shape") : "mesh";
  Shape shape =
      keys.has("shape") ? read_shape(keys) : solid_of(keys, read_obj_soup(mesh_file(keys, folder, "object")));
  const Pose place = read_pose(keys);
  part.object.name = keys.text_or("name", part.shape + " " + std::to_string(number + 1));
  part.object.friction = not_negative_or(keys, "friction", 0);
  part.vertices.resize(3, shape.surface.vertices.cols());
  for (Eigen::Index i = 0; i < part.vertices.cols(); ++i)
    part.vertices.col(i) = placed(place, shape.surface.vertices.col(i));
  part.triangles = std::move(shape.surface.triangles);
  part.object.body = RigidObject{std::move(shape.solid), place, read_rigid_motion(keys)};
  return part;
}

void read_collision(const KeyTable& keys, CollisionSettings& collision) {
  collision.forecast_time = positive_or(keys, "forecast_time", 0);
  collision.points = choice<PointKind>(
      keys, "points",
      {{"particles", PointKind::particles}, {"edges", PointKind::edges}, {"faces", PointKind::faces}});
  std::vector<std::pair<std::string, std::string>> names;
  for (const Response& response : responses()) names.emplace_back(response.name, response.name);
  collision.response = choice<std::string>(keys, "response", names);
}

}  // namespace

void read_objects(const KeyTable& keys, const std::string& folder, Scene& scene) {
  for (const auto& object : keys.tables("object"))
    scene.objects.push_back(read_object(*object, folder, scene.objects.size()));
  const auto collision = keys.table("collision");
  if (!collision) return;
  if (scene.objects.empty()) throw InputError(collision->where() + ": [collision] needs an [[object]]");
  read_collision(*collision, scene.collision);
}

}  // namespace foldproof
