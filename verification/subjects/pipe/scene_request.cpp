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

}  // namespace

void add_scene(const PortableScene& scene, const Settings& typed, Request& request) {
  const PortableMaterial& m = scene.material;
  json settings = json::object();
  for (const auto& [key, value] : typed) settings[key] = value;
  request.header["scene"] = {{"name", scene.name},
                             {"dt", scene.dt},
                             {"gravity", list_of(scene.gravity)},
                             {"material",
                              {{"density", m.density},
                               {"young", m.young},
                               {"bending_rigidity", m.bending_rigidity},
                               {"stretch_damping", m.stretch_damping},
                               {"bending_damping", m.bending_damping},
                               {"rest_length_scale", m.rest_length_scale}}},
                             {"own_masses", scene.own_masses},
                             {"settings", settings}};
  for (const PortablePlane& plane : scene.planes)
    request.header["scene"]["planes"].push_back({{"point", list_of(plane.point)},
                                                 {"normal", list_of(plane.normal)},
                                                 {"friction", plane.friction}});
  for (const PortableBox& box : scene.boxes)
    request.header["scene"]["boxes"].push_back({{"centre", list_of(box.centre)},
                                                {"half_extents", list_of(box.half_extents)},
                                                {"friction", box.friction}});
  for (const PortableSphere& sphere : scene.spheres)
    request.header["scene"]["spheres"].push_back({{"centre", list_of(sphere.centre)},
                                                  {"radius", sphere.radius},
                                                  {"friction", sphere.friction}});
  for (const PortableCapsule& capsule : scene.capsules)
    request.header["scene"]["capsules"].push_back({{"a", list_of(capsule.a)},
                                                   {"b", list_of(capsule.b)},
                                                   {"radius", capsule.radius},
                                                   {"friction", capsule.friction}});
  if (scene.thickness > 0) request.header["scene"]["thickness"] = scene.thickness;
  if (!scene.extension.empty()) request.header["scene"]["extension"] = json::parse(scene.extension);
  std::vector<std::array<int, 2>> edges;
  for (const Edge& edge : scene.mesh.edges) edges.push_back({edge.a, edge.b});
  std::vector<std::array<int, 4>> hinges;
  for (const Hinge& hinge : scene.mesh.hinges) hinges.push_back(hinge.particles);
  std::vector<double> angles = scene.rest_angles;
  angles.resize(hinges.size(), 0);
  const Eigen::VectorXd stiffness = edge_stiffness(scene),
                        lengths = m.rest_length_scale * rest_lengths(scene.mesh);
  const auto span_of = [](const auto& v) { return std::span(v.data(), size_t(v.size())); };
  request.add("triangles", flat(scene.mesh.triangles), 3);
  request.add("rest", scene.mesh.rest);
  request.add("x", scene.x);
  request.add("v", scene.v);
  request.add("mass", span_of(scene.mass));
  request.add("held", scene.held, 1);
  request.add("edges", flat(edges), 2);
  request.add("edge_stiffness", span_of(stiffness));
  request.add("rest_lengths", span_of(lengths));
  request.add("hinges", flat(hinges), 4);
  request.add("hinge_weights", hinge_weights(scene.mesh));
  request.add("rest_angles", angles);
}

}  // namespace foldproof
