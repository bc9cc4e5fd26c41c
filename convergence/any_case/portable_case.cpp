#include "convergence/any_case/portable_case.h"

#include <variant>

#include "reference/mesh/triangle_mesh.h"
#include "verification/cases/expectations.h"

namespace foldproof {

namespace {

[[noreturn]] void refuse(const std::string& part) {
  throw InputError("the protocol of other solvers cannot say " + part);
}

void require_portable(const Scene& scene) {
  if (is_driven(scene)) refuse("held particles that move");
  if (scene.strain_limits) refuse("strain limits; remove [strain_limits]");
  if (!scene.sticky.empty()) refuse("what cloth sticks to");
}

/// Throws InputError unless it is rigid and stands still.
const RigidObject& still_body(const Object& object) {
  const auto* rigid = std::get_if<RigidObject>(&object.body);
  const auto* motion = rigid ? std::get_if<Motion>(&rigid->motion) : nullptr;
  if (!motion || motion->velocity.norm() > 0 || motion->amplitude.norm() > 0 ||
      motion->angular_velocity.norm() > 0)
    refuse("object '" + object.name + "', which moves or deforms");
  return *rigid;
}

void add_object(const Object& object, PortableScene& portable) {
  const RigidObject& body = still_body(object);
  const Pose& place = body.place;
  if (std::holds_alternative<HalfSpace>(body.solid)) {
    portable.planes.push_back(
        {place.translation, place.rotation * Vector3::UnitZ(), object.friction});
    return;
  }
  if (const auto* sphere = std::get_if<Sphere>(&body.solid)) {
    portable.spheres.push_back({place.translation, sphere->radius, object.friction});
    return;
  }
  if (const auto* capsule = std::get_if<Capsule>(&body.solid)) {
    const Vector3 half = capsule->half_length * (place.rotation * Vector3::UnitZ());
    portable.capsules.push_back(
        {place.translation - half, place.translation + half, capsule->radius, object.friction});
    return;
  }
  const auto* box = std::get_if<Box>(&body.solid);
  if (!box) refuse("object '" + object.name + "', which is no plane, box, sphere or capsule");
  if (!place.rotation.isApprox(Eigen::Quaterniond::Identity()))
    refuse("object '" + object.name + "', a box whose edges are not along the axes");
  portable.boxes.push_back({place.translation, box->half_extents, object.friction});
}

PortableMaterial material_of(const Scene& scene) {
  PortableMaterial material{scene.density, 0, 0, 0, 0, 1};
  if (scene.stretch) {
    material.young = scene.stretch->stiffness;
    material.stretch_damping = scene.stretch->damping;
    material.rest_length_scale = scene.stretch->rest_length_scale;
  }
  if (scene.bending) {
    material.bending_rigidity = scene.bending->stiffness / 4;
    material.bending_damping = scene.bending->damping;
  }
  return material;
}

}  // namespace

PortableScene portable_case(const Scene& scene) {
  require_portable(scene);
  PortableScene portable;
  portable.name = scene.name;
  portable.mesh = scene.mesh;
  portable.x = scene.x, portable.v = scene.v;
  portable.mass = lumped_masses(scene.mesh, scene.density);
  for (const PrescribedParticle& p : scene.prescribed) portable.held.push_back(p.particle);
  if (scene.gravity) portable.gravity = *scene.gravity;
  portable.material = material_of(scene);
  portable.rest_angles = scene.rest_angles;
  for (const SceneObject& part : scene.objects) add_object(part.object, portable);
  if (scene.self_collision) portable.thickness = scene.self_collision->thickness;
  return portable;
}

}  // namespace foldproof
