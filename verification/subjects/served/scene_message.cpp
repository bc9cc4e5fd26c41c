#include "verification/subjects/served/scene_message.h"

#include <limits>
#include <utility>

#include "verification/verdict.h"

namespace foldproof {

namespace {

using foldproof_solver::Json;
using Message = foldproof_solver::Scene;

constexpr double forever = std::numeric_limits<double>::infinity();

Json list_of(const Vector3& v) { return {v[0], v[1], v[2]}; }

Vector3 vector_of(const Json& list) {
  return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}

Json to_json(const PrescribedParticle& p) {
  const Motion& m = p.motion;
  Json all = {{"particle", p.particle},
              {"start", list_of(p.start)},
              {"velocity", list_of(m.velocity)},
              {"amplitude", list_of(m.amplitude)},
              {"frequency", m.frequency},
              {"phase", m.phase},
              {"center", list_of(m.center)},
              {"angular_velocity", list_of(m.angular_velocity)},
              {"from", m.from}};
  if (m.until < forever) all["until"] = m.until;  // JSON has no infinity
  return all;
}

PrescribedParticle prescribed_of(const Json& all) {
  Motion m;
  m.velocity = vector_of(all.at("velocity"));
  m.amplitude = vector_of(all.at("amplitude"));
  m.frequency = all.at("frequency");
  m.phase = all.at("phase");
  m.center = vector_of(all.at("center"));
  m.angular_velocity = vector_of(all.at("angular_velocity"));
  m.from = all.at("from");
  m.until = all.value("until", forever);
  return {all.at("particle"), vector_of(all.at("start")), m};
}

Json to_json(const StretchMaterial& m) {
  return {{"stiffness", m.stiffness},
          {"damping", m.damping},
          {"rest_length_scale", m.rest_length_scale}};
}

StretchMaterial stretch_of(const Json& m) {
  return {m.at("stiffness"), m.at("damping"), m.at("rest_length_scale")};
}

Json to_json(const BendingMaterial& m) {
  return {{"stiffness", m.stiffness},
          {"damping", m.damping},
          {"current_weighting", m.weighting == Weighting::current},
          {"area_damping", m.damping_factor == DampingFactor::edge_squared_over_area},
          {"law", m.law}};
}

BendingMaterial bending_of(const Json& m) {
  return {m.at("stiffness"), m.at("damping"),
          m.at("current_weighting") ? Weighting::current : Weighting::rest,
          m.at("area_damping") ? DampingFactor::edge_squared_over_area : DampingFactor::edge,
          bending_law(m.at("law").get<std::string>()).name};
}

Json to_json(const SolverSettings& s) {
  return {{"tolerance", s.tolerance},
          {"max_iterations", s.max_iterations},
          {"of_initial_residual", s.scale == ResidualScale::initial_residual}};
}

SolverSettings solver_of(const Json& s) {
  return {s.at("tolerance"), s.at("max_iterations"),
          s.at("of_initial_residual") ? ResidualScale::initial_residual : ResidualScale::momentum};
}

void require_portable(const Scene& scene) {
  if (!scene.objects.empty()) throw NotOffered{"objects over the pipe"};
  if (scene.strain_limits) throw NotOffered{"strain limits over the pipe"};
  if (scene.self_collision) throw NotOffered{"self-collision over the pipe"};
  if (!scene.sticky.empty()) throw NotOffered{"sticking over the pipe"};
  if (scene.air) throw NotOffered{"air over the pipe"};
  if (scene.membrane) throw NotOffered{"a membrane over the pipe"};
  if (!scene.fabrics.empty()) throw NotOffered{"several fabrics over the pipe"};
  if (!scene.mesh.pattern.empty()) throw NotOffered{"a flat pattern over the pipe"};
}

void read_extension(const Json& extension, Scene& scene) {
  scene.integrator = extension.at("integrator");
  scene.solver = solver_of(extension.at("solver"));
  scene.density = extension.at("density");
  if (extension.contains("gravity")) scene.gravity = vector_of(extension["gravity"]);
  if (extension.contains("stretch")) scene.stretch = stretch_of(extension["stretch"]);
  if (extension.contains("bending")) scene.bending = bending_of(extension["bending"]);
  for (const Json& p : extension.at("prescribed")) scene.prescribed.push_back(prescribed_of(p));
}

/// A body that stands still; its friction is the obstacle's.
template <class Shape>
SceneObject standing(const char* name, const Shape& shape, const Pose& pose, const Json& obstacle) {
  SceneObject part;
  part.object = Object{name, RigidObject{shape, pose, Motion{}}, obstacle.at("friction")};
  return part;
}

Eigen::Quaterniond from_z_to(const Vector3& direction) {
  return Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), direction);
}

/// A half space whose solid is below the plane.
SceneObject plane_of(const Json& plane) {
  const Pose pose{from_z_to(vector_of(plane.at("normal"))), vector_of(plane.at("point"))};
  return standing("plane", HalfSpace{}, pose, plane);
}

/// Its edges along the axes.
SceneObject box_of(const Json& box) {
  const Pose pose{Eigen::Quaterniond::Identity(), vector_of(box.at("centre"))};
  return standing("box", Box{vector_of(box.at("half_extents"))}, pose, box);
}

SceneObject sphere_of(const Json& sphere) {
  const Pose pose{Eigen::Quaterniond::Identity(), vector_of(sphere.at("centre"))};
  return standing("sphere", Sphere{sphere.at("radius")}, pose, sphere);
}

SceneObject capsule_of(const Json& capsule) {
  const Vector3 a = vector_of(capsule.at("a")), b = vector_of(capsule.at("b"));
  const Pose pose{from_z_to(b - a), (a + b) / 2};
  return standing("capsule", Capsule{capsule.at("radius"), (b - a).norm() / 2}, pose, capsule);
}

void read_obstacles(const Json& constants, Scene& scene) {
  using Read = SceneObject (*)(const Json&);
  constexpr std::pair<const char*, Read> kinds[] = {
      {"planes", plane_of}, {"boxes", box_of}, {"spheres", sphere_of}, {"capsules", capsule_of}};
  for (const auto& [key, read] : kinds)
    for (const Json& obstacle : constants.value(key, Json::array()))
      scene.objects.push_back(read(obstacle));
}

void read_material(const Message& message, Scene& scene) {
  const Json& constants = message.header.at("scene");
  const Json& m = constants.at("material");
  scene.density = m.at("density");
  scene.gravity = vector_of(constants.at("gravity"));
  scene.stretch =
      StretchMaterial{m.at("young"), m.at("stretch_damping"), m.at("rest_length_scale")};
  if (m.at("bending_rigidity") > 0 || m.at("bending_damping") > 0)
    scene.bending =
        BendingMaterial{4 * m.at("bending_rigidity").get<double>(), m.at("bending_damping")};
  read_obstacles(constants, scene);
  if (const double thickness = constants.value("thickness", 0.0); thickness > 0)
    scene.self_collision = SelfCollisionSettings{.thickness = thickness};
  for (const int i : message.integers.at("held"))
    scene.prescribed.push_back({i, Vector3(scene.x.col(i)), Motion{}});
}

TriangleMesh mesh_of(const Message& message) {
  const std::vector<int>& corners = message.integers.at("triangles");
  std::vector<Triangle> triangles;
  for (size_t t = 0; t + 2 < corners.size(); t += 3)
    triangles.push_back({corners[t], corners[t + 1], corners[t + 2]});
  return make_triangle_mesh(as_columns(message.numbers.at("rest")), std::move(triangles));
}

}  // namespace

PerParticle3 as_columns(const foldproof_solver::Numbers& rows) {
  return Eigen::Map<const PerParticle3>(rows.data(), 3, Eigen::Index(rows.size() / 3));
}

PortableScene portable_scene(const Scene& scene) {
  require_portable(scene);
  Json extension = {{"integrator", scene.integrator},
                    {"solver", to_json(scene.solver)},
                    {"density", scene.density},
                    {"prescribed", Json::array()}};
  for (const PrescribedParticle& p : scene.prescribed)
    extension["prescribed"].push_back(to_json(p));
  PortableScene portable;
  portable.name = scene.name;
  portable.mesh = scene.mesh;
  portable.x = scene.x, portable.v = scene.v;
  portable.mass = lumped_masses(scene.mesh, scene.density);
  portable.rest_angles = scene.rest_angles;
  if (scene.gravity) extension["gravity"] = list_of(*scene.gravity);
  if (scene.stretch) extension["stretch"] = to_json(*scene.stretch);
  if (scene.bending) extension["bending"] = to_json(*scene.bending);
  portable.extension = extension.dump();
  return portable;
}

Scene reference_scene(const Message& message) {
  Scene scene = scene_at_rest(mesh_of(message), 0);
  scene.x = as_columns(message.numbers.at("x"));
  scene.v = as_columns(message.numbers.at("v"));
  const Json& constants = message.header.at("scene");
  if (constants.contains("extension"))
    read_extension(constants["extension"], scene);
  else
    read_material(message, scene);
  if (scene.bending) scene.rest_angles = message.numbers.at("rest_angles");
  return scene;
}

}  // namespace foldproof
