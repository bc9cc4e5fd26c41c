#include "reference/scene/read_objects.h"

#include <Eigen/Geometry>
#include <memory>
#include <utility>

#include "reference/scene/key_values.h"

namespace foldproof {

namespace {

BodyShape read_half_space(const KeyTable& keys) {
  return {HalfSpace{}, square_surface(positive_or(keys, "drawn_width", 2))};
}

BodyShape read_sphere(const KeyTable& keys) {
  const double radius = positive(keys, "radius");
  return {Sphere{radius}, sphere_surface(radius)};
}

BodyShape read_box(const KeyTable& keys) {
  const Vector3 size = keys.vector("size");
  if (!(size.minCoeff() > 0))
    throw InputError(keys.where("size") + ": 'size' must be > 0 along each axis");
  return {Box{size / 2}, box_surface(size / 2)};
}

BodyShape read_capsule(const KeyTable& keys) {
  const double radius = positive(keys, "radius"), length = positive(keys, "length");
  return {Capsule{radius, length / 2}, capsule_surface(radius, length / 2)};
}

BodyShape read_torus(const KeyTable& keys) {
  const double ring = positive(keys, "ring_radius"), tube = positive(keys, "tube_radius");
  if (!(tube < ring))
    throw InputError(keys.where("tube_radius") +
                     ": 'tube_radius' must be smaller than 'ring_radius'");
  return {Torus{ring, tube}, torus_surface(ring, tube)};
}

BodyShape read_shape(const KeyTable& keys, const CaseContext& context) {
  const auto read = choice<BodyShape (*)(const KeyTable&)>(keys, "shape",
                                                           {{"sphere", read_sphere},
                                                            {"half_space", read_half_space},
                                                            {"box", read_box},
                                                            {"capsule", read_capsule},
                                                            {"torus", read_torus},
                                                            {"statue", nullptr}});
  return read ? read(keys) : read_mesh_body(keys, context);
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

void read_rigid(const KeyTable& keys, const Pose& place, const CaseContext& context,
                SceneObject& part) {
  BodyShape shape = keys.has("mesh") ? read_mesh_body(keys, context) : read_shape(keys, context);
  part.vertices.resize(3, shape.surface.vertices.cols());
  for (Eigen::Index i = 0; i < part.vertices.cols(); ++i)
    part.vertices.col(i) = to_world(place, shape.surface.vertices.col(i));
  part.triangles = std::move(shape.surface.triangles);
  part.scale = shape.scale;
  part.object.body = RigidObject{std::move(shape.solid), place, read_rigid_motion(keys)};
  part.field = std::move(shape.field);
}

void read_deforming(const KeyTable& keys, const Pose& place, const CaseContext& context,
                    SceneObject& part) {
  DeformingShape shape = read_deforming_body(keys, place, context);
  part.vertices = shape.animation->positions.front();
  part.triangles = shape.animation->triangles;
  part.animation = std::move(shape.animation);
  part.scale = shape.scale;
  part.object.body = DeformingObject{};
  part.field = std::move(shape.field);
}

SceneObject read_object(const KeyTable& keys, const CaseContext& context, size_t number) {
  const bool is_shape = keys.has("shape"), is_animation = keys.has("frames"),
             is_mesh = keys.has("mesh") && !is_animation;  // frames without triangles have a mesh
  if (int(is_shape) + int(is_mesh) + int(is_animation) != 1)
    throw InputError(keys.where("mesh") +
                     ": [[object]] needs either 'shape' or 'mesh' (an OBJ file) or 'frames' (a "
                     "folder of such files), and not both");
  SceneObject part;
  part.shape = is_shape ? keys.text("shape") : is_mesh ? "mesh" : "animation";
  part.object.name = keys.text_or("name", part.shape + " " + std::to_string(number + 1));
  part.object.friction = non_negative_or(keys, "friction", 0);
  (is_deforming(keys) ? read_deforming : read_rigid)(keys, read_pose(keys), context, part);
  if (!part.vertices.allFinite())
    throw InputError(keys.where() + ": a place of its surface is not finite; give smaller lengths");
  return part;
}

void read_collision(const KeyTable& keys, CollisionSettings& collision) {
  collision.forecast_time = positive_or(keys, "forecast_time", 0);
  collision.points = choice<PointKind>(keys, "points",
                                       {{"particles", PointKind::particles},
                                        {"edges", PointKind::edges},
                                        {"faces", PointKind::faces}});
  std::vector<std::pair<std::string, std::string>> names;
  for (const Response& response : responses()) names.emplace_back(response.name, response.name);
  collision.response = choice<std::string>(keys, "response", names);
}

}  // namespace

void read_objects(const KeyTable& keys, const CaseContext& context, Scene& scene) {
  for (const auto& object : keys.tables("object"))
    scene.objects.push_back(read_object(*object, context, scene.objects.size()));
  const auto collision = keys.table("collision");
  if (!collision) return;
  if (scene.objects.empty())
    throw InputError(collision->where() + ": [collision] needs an [[object]]");
  read_collision(*collision, scene.collision);
}

}  // namespace foldproof
