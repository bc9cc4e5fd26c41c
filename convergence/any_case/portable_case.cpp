#include "convergence/any_case/portable_case.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "reference/scene/field_recipe.h"
#include "verification/cases/expectations.h"

namespace foldproof {

namespace {

constexpr double stated_every = 1e-3;  // s

[[noreturn]] void refuse(const std::string& part) {
  throw InputError("the protocol of other solvers cannot say " + part);
}

void require_portable(const Scene& scene) {
  if (!scene.sticky.empty()) refuse("what cloth sticks to");
  if (!scene.mesh.pattern.empty()) refuse("a flat pattern; remove pattern");
  if (!scene.stretch_directions.is_uniform() || !scene.bending_directions.is_uniform())
    refuse("directions; remove warp, weft and bias");
}

/// Those of the run at which motions are stated.
std::vector<double> stated_times(const Motion& motion, double end) {
  const double count = std::ceil(end / stated_every);
  std::vector<double> times;
  for (double k = 0; k <= count; ++k) times.push_back(end * k / count);
  for (const double event : {motion.from, motion.until})
    if (event > 0 && event < end) times.push_back(event);
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

bool is_still(const Motion& motion) {
  return motion.velocity.isZero(0) && motion.amplitude.isZero(0) &&
         motion.angular_velocity.isZero(0);
}

PortableMotion motion_of(const RigidMotion& motion, double end) {
  if (const auto* keyframes = std::get_if<Keyframes>(&motion)) return *keyframes;
  const Motion& smooth = std::get<Motion>(motion);
  PortableMotion stated;
  if (!is_still(smooth))
    for (const double time : stated_times(smooth, end))
      stated.keys.push_back({time, pose_at(motion, time)});
  return stated;
}

/// Whether what is inside its mesh is counted by windings.
bool is_repaired(const SceneObject& part) {
  if (part.animation) return part.animation->inside == Inside::winding;
  if (!part.field) return false;
  if (const auto* grid = std::get_if<GridRecipe>(&part.field->of))
    return grid->repair == Repair::winding;
  const auto* octree = std::get_if<OctreeRecipe>(&part.field->of);
  return octree && octree->inside == Inside::winding;
}

/// Adds an object's shape, placed but not yet moved.
class AddObject {
 public:
  AddObject(const SceneObject& part, double end, PortableScene& portable)
      : part_(part), end_(end), portable_(portable) {
    if (is_repaired(part)) refuse("object '" + part.object.name + "', whose mesh is not closed");
    body_ = std::get_if<RigidObject>(&part.object.body);
    if (body_)
      std::visit(*this, body_->solid);
    else
      add_deforming();
  }

  void operator()(const HalfSpace&) const {
    portable_.planes.push_back({body_->place.translation, up(), friction(), motion()});
  }
  void operator()(const Sphere& sphere) const {
    portable_.spheres.push_back({body_->place.translation, sphere.radius, friction(), motion()});
  }
  void operator()(const Capsule& capsule) const {
    const Vector3 half = capsule.half_length * up(), &centre = body_->place.translation;
    portable_.capsules.push_back(
        {centre - half, centre + half, capsule.radius, friction(), motion()});
  }
  /// A turned one moves there from the origin, where its edges are along the axes.
  void operator()(const Box& box) const {
    if (body_->place.rotation.isApprox(Eigen::Quaterniond::Identity())) {
      portable_.boxes.push_back({body_->place.translation, box.half_extents, friction(), motion()});
      return;
    }
    PortableMotion turned = motion();
    if (turned.keys.empty()) turned.keys.push_back({0, pose_at(body_->motion, 0)});
    for (Keyframe& key : turned.keys) key.pose = after(key.pose, body_->place);
    portable_.boxes.push_back({Vector3::Zero(), box.half_extents, friction(), turned});
  }
  void operator()(const Torus&) const { refuse("object '" + part_.object.name + "', a torus"); }
  template <class Mesh>
  void operator()(const Mesh&) const {
    portable_.bodies.push_back({part_.vertices, part_.triangles, friction(), motion()});
  }

 private:
  void add_deforming() const {
    const MeshSequence& of = *part_.animation;
    portable_.bodies.push_back(
        {of.positions.front(), of.triangles, friction(), {}, of.times, of.positions});
  }
  Vector3 up() const { return body_->place.rotation * Vector3::UnitZ(); }
  double friction() const { return part_.object.friction; }
  PortableMotion motion() const { return motion_of(body_->motion, end_); }

  const SceneObject& part_;
  double end_;
  PortableScene& portable_;
  const RigidObject* body_ = nullptr;
};

void add_held(const Scene& scene, PortableScene& portable) {
  for (const PrescribedParticle& p : scene.prescribed) portable.held.push_back(p.particle);
  if (!is_driven(scene)) return;
  PortablePath& path = portable.moving_held;
  for (const PrescribedParticle& p : scene.prescribed)
    for (const double time : stated_times(p.motion, scene.schedule.end)) path.times.push_back(time);
  std::ranges::sort(path.times);
  path.times.erase(std::unique(path.times.begin(), path.times.end()), path.times.end());
  for (const double time : path.times) {
    PerParticle3 x(3, Eigen::Index(scene.prescribed.size()));
    for (size_t k = 0; k < scene.prescribed.size(); ++k)
      x.col(Eigen::Index(k)) =
          position_at(scene.prescribed[k].motion, scene.prescribed[k].start, time);
    path.x.push_back(std::move(x));
  }
}

PortableMaterial material_of(const Scene& scene, const ClothFabric& fabric) {
  PortableMaterial material{fabric.density, 0, 0, 0, 0, 1};
  if (scene.stretch) {
    material.young = fabric.stretch.stiffness;
    material.stretch_damping = fabric.stretch.damping;
    material.rest_length_scale = scene.stretch->rest_length_scale;
  }
  if (scene.bending) {
    material.bending_rigidity = fabric.bending.stiffness / 4;
    material.bending_damping = fabric.bending.damping;
  }
  if (scene.membrane) {
    const MembraneMaterial& m = fabric.membrane;
    material.membrane = {m.warp, m.weft, m.shear, m.poisson, m.damping};
  }
  if (!std::isnan(fabric.friction)) material.friction = fabric.friction;
  return material;
}

/// Of each triangle, as it lies in the rest shape.
std::vector<Vector3> warps_of(const Scene& scene) {
  const std::vector<FlatTriangle> flat = flat_corners(scene.mesh, "[membrane]");
  const std::vector<ClothFabric> fabrics = fabrics_of(scene);
  std::vector<Vector3> warps;
  for (size_t t = 0; t < flat.size(); ++t) {
    const Triangle& corners = scene.mesh.triangles[t];
    Eigen::Matrix2d from;
    from << flat[t][1] - flat[t][0], flat[t][2] - flat[t][0];
    Eigen::Matrix<double, 3, 2> to;
    for (int k = 0; k < 2; ++k)
      to.col(k) = scene.mesh.rest.col(corners[size_t(k + 1)]) - scene.mesh.rest.col(corners[0]);
    const size_t of = scene.fabrics.empty() ? 0 : size_t(scene.fabrics.of_triangle[t]);
    const double angle = fabrics[of].membrane.direction;
    warps.push_back(to * from.inverse() * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return warps;
}

void add_materials(const Scene& scene, PortableScene& portable) {
  const std::vector<ClothFabric> fabrics = fabrics_of(scene);
  portable.material = material_of(scene, fabrics.front());
  if (scene.membrane) portable.warp = warps_of(scene);
  if (scene.fabrics.empty()) return;
  for (const ClothFabric& fabric : fabrics) {
    if (!fabric.stretch_directions.is_uniform() || !fabric.bending_directions.is_uniform())
      refuse("directions of fabric '" + fabric.name + "'");
    if (scene.self_collision && (fabric.thickness != fabrics.front().thickness ||
                                 fabric.layer_friction != fabrics.front().layer_friction))
      refuse("layers of fabric '" + fabric.name + "' that differ from the others'");
    if (scene.strain_limits && fabric.limits != fabrics.front().limits)
      refuse("strain limits of fabric '" + fabric.name + "' that differ from the others'");
    portable.materials.push_back(material_of(scene, fabric));
  }
  portable.material_of_triangle = scene.fabrics.of_triangle;
}

}  // namespace

PortableScene portable_case(const Scene& scene) {
  require_portable(scene);
  PortableScene portable;
  portable.name = scene.name;
  portable.mesh = scene.mesh;
  const State start = start_state(scene);
  portable.x = start.x, portable.v = start.v;
  portable.mass = masses_of(scene);
  if (scene.gravity) portable.gravity = *scene.gravity;
  add_materials(scene, portable);
  add_held(scene, portable);
  portable.rest_angles = scene.rest_angles;
  for (const SceneObject& part : scene.objects) AddObject(part, scene.schedule.end, portable);
  if (scene.self_collision) {
    portable.thickness = scene.self_collision->thickness;
    portable.layer_friction = scene.self_collision->friction;
  }
  if (scene.strain_limits)
    portable.strain_limits = {scene.strain_limits->extension, scene.strain_limits->compression};
  if (scene.air)
    portable.air = {scene.air->density, scene.air->wind, scene.air->normal_drag,
                    scene.air->tangential_drag};
  return portable;
}

}  // namespace foldproof
