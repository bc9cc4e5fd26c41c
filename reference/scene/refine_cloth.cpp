#include "reference/scene/refine_cloth.h"

#include "reference/mesh/pattern.h"
#include "reference/mesh/subdivision.h"

namespace foldproof {

namespace {

constexpr long most_refinements = 8;

std::vector<double> rest_angles_of_halves(const Scene& scene, const TriangleMesh& finer) {
  const int old = scene.mesh.particles();
  std::vector<double> of_edge(scene.mesh.edges.size(), 0.0);
  for (size_t h = 0; h < scene.rest_angles.size(); ++h)
    of_edge[size_t(scene.mesh.hinges[h].edge)] = scene.rest_angles[h];
  std::vector<double> angles;
  for (const Hinge& hinge : finer.hinges) {
    const Edge& edge = finer.edges[size_t(hinge.edge)];  // a < b: an old particle comes first
    angles.push_back(edge.a < old ? of_edge[size_t(edge.b - old)] : 0.0);
  }
  return angles;
}

}  // namespace

int refinements_of(const KeyTable& cloth) {
  const long wanted = cloth.integer_or("refine", 0);
  if (!(wanted >= 0 && wanted <= most_refinements))
    throw InputError(cloth.where("refine") + ": 'refine' must lie in 0 .. " +
                     std::to_string(most_refinements));
  return int(wanted);
}

void refine_cloth(Scene& scene) {
  const Subdivision quarters = subdivision(scene.mesh, SubdivisionRule::midpoint, 1);
  TriangleMesh finer = make_triangle_mesh(quarters.of(scene.mesh.rest), quarters.triangles);
  finer.pattern = divided_pattern(scene.mesh, finer.triangles);
  if (scene.bending) scene.rest_angles = rest_angles_of_halves(scene, finer);
  std::vector<int> of_quarters;
  for (const int fabric : scene.fabrics.of_triangle)
    of_quarters.insert(of_quarters.end(), 4, fabric);
  scene.fabrics.of_triangle = std::move(of_quarters);
  if (!scene.copy_of.empty())
    for (int i = scene.mesh.particles(); i < finer.particles(); ++i) scene.copy_of.push_back(i);
  scene.mesh = std::move(finer);
  scene.x = quarters.of(scene.x);
  scene.v = quarters.of(scene.v);
}

}  // namespace foldproof
