// Checks of the exact signed distance to triangle meshes.
#include "reference/level_set/mesh_distance.h"
#include "verification/oracles/triangle_distance.h"
#include "verification/specimens/check.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/ugly_solids.h"

namespace foldproof {

namespace {

struct NamedMesh {
  std::string name;
  MeshDistance mesh;
};

MeshDistance distance_of(const TriangleSoup& soup) {
  return make_mesh_distance(soup.rest, soup.triangles);
}

std::vector<NamedMesh> meshes() {
  std::vector<NamedMesh> all{
      {"statue", make_mesh_distance(small_statue().rest, small_statue().triangles)}};
  for (const UglySolid& solid : ugly_solids()) all.push_back({solid.name, distance_of(solid.soup)});
  return all;
}

Vector3 anywhere(Random& random, const MeshDistance& mesh) {
  const Bounds& bounds = mesh.tree.nodes[0].bounds;
  Vector3 p;
  for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(-0.2, 1.2);
  return bounds.min() + p.cwiseProduct(bounds.sizes());
}

/// Within `reach` of a random point on a random vertex, edge or face.
Vector3 near_surface(Random& random, const MeshDistance& mesh, double reach) {
  const Corners3& corners = mesh.corners[size_t(random.uniform(0, double(mesh.corners.size())))];
  double weights[3];
  for (double& weight : weights) weight = std::max(random.uniform(-0.5, 1), 0.0);
  const double sum = weights[0] + weights[1] + weights[2];
  if (sum == 0) return corners[0] + random.vectors(1, reach).col(0);
  return (weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2]) / sum +
         random.vectors(1, reach).col(0);
}

/// Every other point near the surface.
Vector3 point(Random& random, const MeshDistance& mesh, int i) {
  return i % 2 == 0 ? anywhere(random, mesh)
                    : near_surface(random, mesh, 0.02 * mesh.tree.nodes[0].bounds.sizes().norm());
}

/// Roundings of the terms of a distance: coordinates of p and of the mesh [m].
double scale_of(const MeshDistance& mesh, const Vector3& p) {
  return epsilon * (p.norm() + mesh.x.colwise().norm().maxCoeff());
}

Finding distance_is_exact() {
  Table measured = roundings_of("(|p| + |x|)");
  for (const NamedMesh& named : meshes()) {
    Random random(61);
    Worst worst, uncertainty;
    for (int i = 0; i < 300; ++i) {
      const Vector3 p = point(random, named.mesh, i);
      const oracles::Estimate truth =
          oracles::distance_to_triangles(named.mesh.x, named.mesh.triangles, p);
      worst.observe(std::abs(std::abs(named.mesh.at(p).phi) - truth.value) /
                    scale_of(named.mesh, p));
      uncertainty.observe(truth.uncertainty / scale_of(named.mesh, p));
    }
    measured.row(named.name, oracles::Estimate{worst.value(), uncertainty.value()});
  }
  return judge_worst(
      measured, 16,
      "the foot is a corner and two products of a weight and an edge, each with a handful of "
      "roundings of the coordinates; an error of the weights moves it along the surface");
}

Finding normal_leads_to_the_surface() {
  Table measured = roundings_of("(|p| + |x|)");
  for (const NamedMesh& named : meshes()) {
    Random random(67);
    Worst foot, length;
    for (int i = 0; i < 300; ++i) {
      const Vector3 p = point(random, named.mesh, i);
      const Distance distance = named.mesh.at(p);
      const Vector3 on_surface = p - distance.phi * distance.normal;
      foot.observe(
          oracles::distance_to_triangles(named.mesh.x, named.mesh.triangles, on_surface).value /
          scale_of(named.mesh, p));
      length.observe(std::abs(distance.normal.norm() - 1) / epsilon);
    }
    measured.row(named.name + ", foot", foot.value());
    measured.row(named.name + ", length of N", length.value());
  }
  return judge_worst(measured, 16,
                     "N is the vector to the nearest point over its length, so the foot is that "
                     "point up to as many roundings as the distance has");
}

Finding sign_is_right() {
  constexpr int points = 336000;  // on each of three meshes: a million in all
  Table measured("case; wrong signs [1]; points off the surface [1]");
  for (const UglySolid& solid : ugly_solids()) {
    const MeshDistance mesh = distance_of(solid.soup);
    Random random(71);
    long wrong = 0, counted = 0;
    for (int i = 0; i < points; ++i) {
      const Vector3 p =
          (i % 2 == 0 ? anywhere(random, mesh) : near_surface(random, mesh, 0.5)) * double(units);
      const Vector3 rounded = p.array().round().matrix() / double(units);
      const int inside = inside_exactly(solid, rounded);
      if (inside == 0) continue;
      ++counted;
      const double phi = mesh.at(rounded).phi;
      if (!(inside > 0 ? phi < 0 : phi > 0)) ++wrong;
    }
    measured.row(solid.name, wrong, counted);
  }
  return judge_worst(measured, "wrong signs", 0,
                     "the pseudonormal's sign is a theorem on closed surfaces, and no point is "
                     "closer to them than rounding");
}

Finding bound_is_kept() {
  Table measured{{"case", ""}, {"answers that differ from those of a search without a bound", "1"}};
  for (const NamedMesh& named : meshes()) {
    Random random(73);
    int wrong = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vector3 p = point(random, named.mesh, i);
      const double distance = std::abs(named.mesh.at(p).phi),
                   bound = distance * random.uniform(0.5, 1.5);
      const NearestFeature nearest = nearest_feature(named.mesh, p, bound);
      const bool agrees =
          nearest.triangle < 0
              ? distance >= bound * (1 - 4 * epsilon)
              : std::abs(std::sqrt(nearest.squared_distance) - distance) <= 4 * epsilon * distance;
      if (!agrees) ++wrong;
    }
    measured.row(named.name, wrong);
  }
  return judge_worst(measured, 0,
                     "the bound only shortens the search; nothing that it skips is nearer");
}

}  // namespace

std::vector<Check> mesh_distance_checks() {
  return {{"level-set.mesh-distance-is-exact",
           "The distance to a mesh is that of brute force in extended precision, to rounding.",
           "BMF03 section 5.1", distance_is_exact},
          {"level-set.mesh-sign-is-correct",
           "The sign of the distance is right at a million points about thin rays, a fin and "
           "nested shells.",
           "Baerentzen and Aanaes 2005", sign_is_right},
          {"level-set.mesh-normal-leads-to-the-surface",
           "N is a unit vector, and p - phi N lies on the mesh.", "BMF03 section 5.1",
           normal_leads_to_the_surface},
          {"level-set.bounded-search-finds-the-same-feature",
           "A search with a bound finds the nearest feature if it is within the bound, and none "
           "otherwise.",
           "ours", bound_is_kept}};
}

}  // namespace foldproof
