#include "verification/subjects/served/scene_message.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "reference/scene/field_recipe.h"
#include "verification/verdict.h"

namespace foldproof {

namespace {

using foldproof_solver::Json;
using foldproof_solver::Numbers;
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

PerParticle3 as_columns(std::span<const double> rows) {
  return Eigen::Map<const PerParticle3>(rows.data(), 3, Eigen::Index(rows.size() / 3));
}

std::vector<Triangle> triangles_of(const std::vector<int>& corners) {
  std::vector<Triangle> triangles;
  for (size_t t = 0; t + 2 < corners.size(); t += 3)
    triangles.push_back({corners[t], corners[t + 1], corners[t + 2]});
  return triangles;
}

/// Places of points at times; no frames where there are none.
MeshSequence frames_of(const Message& message, const std::string& name, const char* what) {
  MeshSequence frames;
  const auto times = message.numbers.find(name + "_times");
  if (times == message.numbers.end()) return frames;
  frames.times = times->second;
  const std::span<const double> all = message.numbers.at(name + what);
  const size_t wide = all.size() / frames.times.size();
  for (size_t k = 0; k < frames.times.size(); ++k)
    frames.positions.push_back(as_columns(all.subspan(k * wide, wide)));
  return frames;
}

RigidMotion motion_of(const Json& obstacle, const Message& message) {
  if (!obstacle.contains("motion")) return Motion{};
  const std::string name = "motion_" + std::to_string(obstacle["motion"].get<int>());
  const Numbers& poses = message.numbers.at(name + "_poses");
  std::vector<Keyframe> keys;
  for (const double time : message.numbers.at(name + "_times")) {
    const double* const p = &poses[7 * keys.size()];
    keys.push_back(
        {time,
         {Eigen::Quaterniond(p[3], p[4], p[5], p[6]).normalized(), Vector3(p[0], p[1], p[2])}});
  }
  return make_keyframes(std::move(keys));
}

struct Placed {
  Solid solid;
  Pose pose = {};
};

Eigen::Quaterniond from_z_to(const Vector3& direction) {
  return Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), direction);
}

/// A half space whose solid is below the plane.
Placed plane_of(const Json& plane, const Message&) {
  return {HalfSpace{}, {from_z_to(vector_of(plane.at("normal"))), vector_of(plane.at("point"))}};
}

/// Its edges along the axes.
Placed box_of(const Json& box, const Message&) {
  return {Box{vector_of(box.at("half_extents"))},
          {Eigen::Quaterniond::Identity(), vector_of(box.at("centre"))}};
}

Placed sphere_of(const Json& sphere, const Message&) {
  return {Sphere{sphere.at("radius")},
          {Eigen::Quaterniond::Identity(), vector_of(sphere.at("centre"))}};
}

Placed capsule_of(const Json& capsule, const Message&) {
  const Vector3 a = vector_of(capsule.at("a")), b = vector_of(capsule.at("b"));
  return {Capsule{capsule.at("radius"), (b - a).norm() / 2}, {from_z_to(b - a), (a + b) / 2}};
}

/// A closed mesh by its exact distance.
Placed body_of(const Json& body, const Message& message) {
  const std::string name = "body_" + std::to_string(body.at("mesh").get<int>());
  return {MeshSolid{std::make_shared<const MeshDistance>(
      make_mesh_distance(as_columns(message.numbers.at(name + "_vertices")),
                         triangles_of(message.integers.at(name + "_triangles"))))}};
}

/// The body of a mesh that deforms: a field for each frame, of 64 cells along its longest side.
std::optional<Body> deforming_body(const Json& obstacle, const Message& message) {
  if (!obstacle.contains("mesh")) return {};
  const std::string name = "body_" + std::to_string(obstacle["mesh"].get<int>());
  MeshSequence frames = frames_of(message, name, "_frames");
  if (frames.times.empty()) return {};
  frames.triangles = triangles_of(message.integers.at(name + "_triangles"));
  Bounds all;
  for (const PerParticle3& x : frames.positions) all.extend(bounds_of(x));
  const double cell = bounds_of(frames.positions.front()).sizes().maxCoeff() / 64;
  return DeformingObject{std::make_shared<const DeformingBody>(
      make_deforming_body(frames, octree_about(all, cell, cell / 10), BetweenFrames::carried))};
}

void read_obstacles(const Message& message, Scene& scene) {
  using Read = Placed (*)(const Json&, const Message&);
  constexpr std::pair<const char*, Read> kinds[] = {{"planes", plane_of},
                                                    {"boxes", box_of},
                                                    {"spheres", sphere_of},
                                                    {"capsules", capsule_of},
                                                    {"bodies", body_of}};
  for (const auto& [kind, read] : kinds)
    for (const Json& obstacle : message.header.at("scene").value(kind, Json::array())) {
      SceneObject part;
      if (auto body = deforming_body(obstacle, message)) {
        part.object = Object{kind, *std::move(body), obstacle.at("friction")};
        scene.objects.push_back(std::move(part));
        continue;
      }
      Placed placed = read(obstacle, message);
      part.object = Object{
          kind, RigidObject{std::move(placed.solid), placed.pose, motion_of(obstacle, message)},
          obstacle.at("friction")};
      scene.objects.push_back(std::move(part));
    }
}

StretchMaterial portable_stretch(const Json& m) {
  return {m.at("young"), m.at("stretch_damping"), m.at("rest_length_scale")};
}

BendingMaterial portable_bending(const Json& m) {
  return {4 * m.at("bending_rigidity").get<double>(), m.at("bending_damping")};
}

MembraneMaterial portable_membrane(const Json& m) {
  const Json& of = m.at("membrane");
  return {of.at("warp"), of.at("weft"), of.at("shear"), of.at("poisson"), of.at("damping")};
}

void read_materials(const Message& message, const Json& materials, Scene& scene) {
  for (const Json& m : materials) {
    ClothFabric fabric;
    fabric.density = m.at("density");
    fabric.stretch = portable_stretch(m);
    fabric.bending = portable_bending(m);
    fabric.friction = m.value("friction", fabric.friction);
    if (m.contains("membrane")) fabric.membrane = portable_membrane(m);
    scene.fabrics.fabrics.push_back(std::move(fabric));
  }
  scene.fabrics.of_triangle = message.integers.at("material_of_triangle");
}

void read_filters(const Json& constants, Scene& scene) {
  if (const double thickness = constants.value("thickness", 0.0); thickness > 0)
    scene.self_collision = SelfCollisionSettings{
        .thickness = thickness, .friction = constants.value("layer_friction", 0.0)};
  if (constants.contains("strain_limits")) {
    scene.strain_limits.emplace();
    scene.strain_limits->extension = constants["strain_limits"].at("extension");
    scene.strain_limits->compression = constants["strain_limits"].at("compression");
  }
}

void read_material(const Message& message, Scene& scene) {
  const Json& constants = message.header.at("scene");
  const Json& m = constants.at("material");
  const Json materials = constants.value("materials", Json::array({m}));
  const auto bends = [](const Json& one) {
    return one.at("bending_rigidity") > 0 || one.at("bending_damping") > 0;
  };
  scene.density = m.at("density");
  scene.gravity = vector_of(constants.at("gravity"));
  const auto has_springs = [](const Json& one) {
    return one.at("young") > 0 || one.at("stretch_damping") > 0;
  };
  if (m.contains("membrane")) scene.membrane = portable_membrane(m);
  if (!scene.membrane || std::any_of(materials.begin(), materials.end(), has_springs))
    scene.stretch = portable_stretch(m);
  if (std::any_of(materials.begin(), materials.end(), bends)) scene.bending = portable_bending(m);
  if (constants.contains("materials")) read_materials(message, materials, scene);
  if (constants.contains("air")) {
    const Json& air = constants["air"];
    scene.air = Air{air.at("density"), vector_of(air.at("wind")), air.at("normal_drag"),
                    air.at("tangential_drag")};
  }
  read_obstacles(message, scene);
  read_filters(constants, scene);
  for (const int i : message.integers.at("held"))
    scene.prescribed.push_back({i, Vector3(scene.x.col(i)), Motion{}});
}

/// Where warps are given, each triangle is cut from a pattern whose first axis is its warp.
TriangleMesh mesh_of(const Message& message) {
  TriangleMesh mesh = make_triangle_mesh(as_columns(message.numbers.at("rest")),
                                         triangles_of(message.integers.at("triangles")));
  const auto warps = message.numbers.find("warp");
  if (warps == message.numbers.end()) return mesh;
  const PerParticle3 warp = as_columns(warps->second);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [i, j, k] = mesh.triangles[t];
    const Vector3 one = mesh.rest.col(j) - mesh.rest.col(i),
                  other = mesh.rest.col(k) - mesh.rest.col(i);
    const Vector3 along = warp.col(Eigen::Index(t)), across = one.cross(other).cross(along);
    const auto flat = [&, unit = across.normalized().eval()](const Vector3& d) {
      return Eigen::Vector2d(d.dot(along), d.dot(unit));
    };
    mesh.pattern.push_back({Eigen::Vector2d::Zero(), flat(one), flat(other)});
  }
  return mesh;
}

}  // namespace

MeshSequence held_path(const Message& message) { return frames_of(message, "held", "_x"); }

PerParticle3 as_columns(const Numbers& rows) { return as_columns(std::span(rows)); }

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
