#include "verification/subjects/pipe/scene_request.h"

#include <array>
#include <span>

namespace foldproof {

namespace {

using nlohmann::json;

template <class Rows>
std::vector<int> flat(const Rows& rows) {
  std::vector<int> numbers;
  for (const auto& row : rows) numbers.insert(numbers.end(), row.begin(), row.end());
  return numbers;
}

std::vector<double> hinge_weights(const TriangleMesh& mesh) {
  const Eigen::VectorXd lengths = rest_lengths(mesh), areas = edge_areas(mesh);
  std::vector<double> weights;
  for (const Hinge& hinge : mesh.hinges)
    weights.push_back(lengths[hinge.edge] * lengths[hinge.edge] / (2 * areas[hinge.edge]));
  return weights;
}

json list_of(const Vector3& v) { return {v[0], v[1], v[2]}; }

template <class Values>
auto span_of(const Values& v) {
  return std::span(v.data(), size_t(v.size()));
}

json material_json(const PortableMaterial& m) {
  json all = {{"density", m.density},
              {"young", m.young},
              {"bending_rigidity", m.bending_rigidity},
              {"stretch_damping", m.stretch_damping},
              {"bending_damping", m.bending_damping},
              {"rest_length_scale", m.rest_length_scale}};
  if (m.friction) all["friction"] = *m.friction;
  if (const auto& membrane = m.membrane)
    all["membrane"] = {{"warp", membrane->warp},
                       {"weft", membrane->weft},
                       {"shear", membrane->shear},
                       {"poisson", membrane->poisson},
                       {"damping", membrane->damping}};
  return all;
}

/// The obstacles of a kind in the message, and their motions as arrays: of the k-th that moves,
/// `motion_k_times` [T] and `motion_k_poses` [T, 7], x, y, z and the quaternion w, x, y, z.
class Obstacles {
 public:
  explicit Obstacles(Request& request) : request_(request) {}

  template <class Obstacle, class Described>
  void add(const char* kind, const std::vector<Obstacle>& all, Described described) {
    for (const Obstacle& one : all) {
      json said = described(one);
      said["friction"] = one.friction;
      if (!one.motion.keys.empty()) said["motion"] = add_motion(one.motion);
      request_.header["scene"][kind].push_back(std::move(said));
    }
  }

 private:
  int add_motion(const PortableMotion& motion) {
    std::vector<double> times, poses;
    for (const Keyframe& key : motion.keys) {
      times.push_back(key.time);
      const Vector3& at = key.pose.translation;
      const Eigen::Quaterniond& turn = key.pose.rotation;
      poses.insert(poses.end(), {at[0], at[1], at[2], turn.w(), turn.x(), turn.y(), turn.z()});
    }
    const std::string name = "motion_" + std::to_string(motions_);
    request_.add((name + "_times").c_str(), times);
    request_.add((name + "_poses").c_str(), poses, {long(times.size()), 7});
    return motions_++;
  }

  Request& request_;
  int motions_ = 0;
};

/// Places of points at times: `NAME_times` [T] and `NAME_WHAT` [T, N, 3].
void add_frames(const std::string& name, const char* what, const std::vector<double>& times,
                const std::vector<PerParticle3>& places, Request& request) {
  std::vector<double> all;
  for (const PerParticle3& x : places) all.insert(all.end(), x.data(), x.data() + x.size());
  request.add((name + "_times").c_str(), times);
  request.add((name + what).c_str(), all, {long(times.size()), long(places.front().cols()), 3});
}

void add_obstacles(const PortableScene& scene, Request& request) {
  Obstacles obstacles(request);
  obstacles.add("planes", scene.planes, [](const PortablePlane& plane) {
    return json{{"point", list_of(plane.point)}, {"normal", list_of(plane.normal)}};
  });
  obstacles.add("boxes", scene.boxes, [](const PortableBox& box) {
    return json{{"centre", list_of(box.centre)}, {"half_extents", list_of(box.half_extents)}};
  });
  obstacles.add("spheres", scene.spheres, [](const PortableSphere& sphere) {
    return json{{"centre", list_of(sphere.centre)}, {"radius", sphere.radius}};
  });
  obstacles.add("capsules", scene.capsules, [](const PortableCapsule& capsule) {
    return json{{"a", list_of(capsule.a)}, {"b", list_of(capsule.b)}, {"radius", capsule.radius}};
  });
  int bodies = 0;
  obstacles.add("bodies", scene.bodies, [&](const PortableBody& body) {
    const std::string name = "body_" + std::to_string(bodies);
    request.add((name + "_vertices").c_str(), body.vertices);
    request.add((name + "_triangles").c_str(), flat(body.triangles), 3);
    if (!body.times.empty()) add_frames(name, "_frames", body.times, body.frames, request);
    return json{{"mesh", bodies++}};
  });
}

void add_materials(const PortableScene& scene, Request& request) {
  for (const PortableMaterial& m : scene.materials)
    request.header["scene"]["materials"].push_back(material_json(m));
  const PortableElements elements = elements_of(scene);
  request.add("material_of_triangle", scene.material_of_triangle, 1);
  request.add("edge_damping", span_of(elements.edge_damping));
  request.add("hinge_rigidity", span_of(elements.hinge_rigidity));
  request.add("hinge_damping", span_of(elements.hinge_damping));
}

/// What only protocol 2 has.
void add_more(const PortableScene& scene, Request& request) {
  json& constants = request.header["scene"];
  if (scene.layer_friction > 0) constants["layer_friction"] = scene.layer_friction;
  if (const auto& limits = scene.strain_limits)
    constants["strain_limits"] = {{"extension", limits->extension},
                                  {"compression", limits->compression}};
  if (const auto& air = scene.air)
    constants["air"] = {{"density", air->density},
                        {"wind", list_of(air->wind)},
                        {"normal_drag", air->normal_drag},
                        {"tangential_drag", air->tangential_drag}};
  if (!scene.materials.empty()) add_materials(scene, request);
  if (!scene.warp.empty()) {
    PerParticle3 warp(3, Eigen::Index(scene.warp.size()));
    for (size_t t = 0; t < scene.warp.size(); ++t) warp.col(Eigen::Index(t)) = scene.warp[t];
    request.add("warp", warp);
  }
  if (!scene.moving_held.times.empty())
    add_frames("held", "_x", scene.moving_held.times, scene.moving_held.x, request);
}

void add_cloth(const PortableScene& scene, Request& request) {
  std::vector<std::array<int, 2>> edges;
  for (const Edge& edge : scene.mesh.edges) edges.push_back({edge.a, edge.b});
  std::vector<std::array<int, 4>> hinges;
  for (const Hinge& hinge : scene.mesh.hinges) hinges.push_back(hinge.particles);
  std::vector<double> angles = scene.rest_angles;
  angles.resize(hinges.size(), 0);
  const Eigen::VectorXd lengths = scene.material.rest_length_scale * rest_lengths(scene.mesh);
  request.add("triangles", flat(scene.mesh.triangles), 3);
  request.add("rest", scene.mesh.rest);
  request.add("x", scene.x);
  request.add("v", scene.v);
  request.add("mass", span_of(scene.mass));
  request.add("held", scene.held, 1);
  request.add("edges", flat(edges), 2);
  request.add("edge_stiffness", span_of(edge_stiffness(scene)));
  request.add("rest_lengths", span_of(lengths));
  request.add("hinges", flat(hinges), 4);
  request.add("hinge_weights", hinge_weights(scene.mesh));
  request.add("rest_angles", angles);
}

}  // namespace

void add_scene(const PortableScene& scene, const Settings& set, Request& request) {
  json settings = json::object();
  for (const auto& [key, value] : set.typed) settings[key] = value;
  request.header["scene"] = {{"name", scene.name},
                             {"dt", scene.dt},
                             {"gravity", list_of(scene.gravity)},
                             {"material", material_json(scene.material)},
                             {"own_masses", scene.own_masses},
                             {"settings", settings}};
  json& constants = request.header["scene"];
  if (!set.tunables.empty()) constants["tunables"] = set.tunables;
  if (scene.thickness > 0) constants["thickness"] = scene.thickness;
  if (!scene.extension.empty()) constants["extension"] = json::parse(scene.extension);
  add_cloth(scene, request);
  add_obstacles(scene, request);
  add_more(scene, request);
}

}  // namespace foldproof
