// Cloth moved out of a body that is a triangle mesh, known by exact distances or by a grid; whether
// it is outside is decided without either.
#include <memory>

#include "reference/level_set/mesh_grid.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/exact_geometry.h"
#include "verification/seeds.h"
#include "verification/specimens/check.h"
#include "verification/specimens/projection_specimens.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

/// The statue as a solid with its signed distance.
struct KnownStatue {
  std::string name;
  Solid solid;
  double margin;  // the distance may be too large by this, between nodes and next to edges [m]
};

std::vector<KnownStatue> statues() {
  const TriangleMesh& statue = small_statue();
  const MeshDistance distance = make_mesh_distance(statue.rest, statue.triangles);
  const std::shared_ptr<const Grid> grid = make_grid(distance, {48, 8, 3, MarchingOrder::second});
  return {{"exact distances", MeshSolid{std::make_shared<MeshDistance>(distance)}, 1e-9},
          {"grid of 48 cells", GridSolid{grid}, grid->lattice.spacing}};
}

/// A wavy sheet that cuts a centimetre into the foremost part of the statue.
struct Worn {
  TriangleMesh mesh;
  ProjectionCase specimen;
};

Worn sheet_through(const KnownStatue& statue) {
  Worn worn{make_sheet({SheetPattern::jittered, 0.4, 0.4, 40, 40, 0.25, shifted_seed(97)}), {}};
  const PerParticle3& body = small_statue().rest;
  const Vector3 low = body.rowwise().minCoeff(), high = body.rowwise().maxCoeff(),
                middle = (low + high) / 2;
  PerParticle3 x = worn.mesh.rest;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    x.col(i) += Vector3(middle.x() - 0.2, middle.y() - 0.2, high.z() - 0.01);
    x(2, i) += 0.004 * std::sin(41 * x(0, i)) * std::cos(37 * x(1, i));
  }
  worn.specimen = {statue.name, {{"statue", RigidObject{statue.solid, {}, Motion{}}, 0}}, 0, x};
  return worn;
}

oracles::TriangleSoup statue_surface() { return {small_statue().rest, small_statue().triangles}; }

ProjectedCloth out_of(const Worn& worn, const std::string& map, double eps) {
  FoldProjection projection = projection_by(map);
  projection.band = {eps, eps + 0.01, 0.05};
  projection.tolerance = 1e-10;
  return project_specimen(worn.specimen, projection);
}

double count_inside(const PerParticle3& x) {
  const oracles::TriangleSoup surface = statue_surface();
  double inside = 0;
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    inside += oracles::side_of(surface, x.col(i)) != oracles::Side::outside;
  return inside;
}

Finding no_particle_is_left_inside() {
  Table measured(
      "case; particles left inside [1]; particles inside before [1]; particles without room [1]");
  for (const KnownStatue& statue : statues()) {
    const Worn worn = sheet_through(statue);
    for (const char* map : {"plain", "blend"}) {
      const ProjectedCloth cloth = out_of(worn, map, statue.margin);
      measured.row(statue.name + ", " + map, count_inside(cloth.x), count_inside(worn.specimen.x),
                   cloth.count(ProjectionOutcome::unfinished));
    }
  }
  return judge_worst(
      measured, "particles left inside", 0,
      "decided in whole numbers against the mesh: eps is a nanometre over exact distances, and a "
      "cell of the grid, by which a trilinear value next to an edge of the body may be too large");
}

Finding no_triangle_is_left_inside() {
  Table measured("case; triangles left inside [1]; eps [m]; particles without room [1]");
  const oracles::TriangleSoup surface = statue_surface();
  for (const KnownStatue& statue : statues()) {
    const Worn worn = sheet_through(statue);
    ProjectedCloth cloth = out_of(worn, "plain", 0);
    double enough = 0;
    for (int k = 0; k < 6; ++k) {
      const double needed =
          longest_edge(worn.mesh.triangles, cloth.x) / std::sqrt(3.0) + statue.margin;
      if (enough >= needed) break;
      enough = 1.02 * needed;
      cloth = out_of(worn, "plain", enough);
    }
    const auto inside = oracles::triangles_in_body({cloth.x, worn.mesh.triangles}, surface);
    measured.row(statue.name, inside.size(), enough, cloth.count(ProjectionOutcome::unfinished));
  }
  return judge_worst(measured, "triangles left inside", 0,
                     "no point of a triangle is farther than L/sqrt(3) from all its corners, and "
                     "phi falls by at most the distance moved");
}

}  // namespace

std::vector<Check> projection_mesh_checks() {
  const std::string source = "BMF03 section 5.3";
  return {{"projection.no-particle-is-left-in-a-mesh",
           "No particle of cloth that was projected out of a triangle mesh is inside it.", source,
           no_particle_is_left_inside},
          {"projection.no-triangle-is-left-in-a-mesh",
           "With an eps that suits its edges, no triangle of cloth that was projected out of a "
           "triangle mesh meets that mesh.",
           source, no_triangle_is_left_inside}};
}

}  // namespace foldproof
