#include "convergence/level_sets/level_set_resolution.h"
#include "reference/level_set/narrow_band.h"
#include "reference/mesh/shapes.h"
#include "verification/processor_time.h"
#include "verification/specimens/random.h"
#include <cmath>
#include <string>

namespace foldproof {

namespace {

constexpr int points = 4000;

/// Adds what a grid of a mesh holds, how long it took, and how far it errs at random points within
/// three cells of the surface.
void add_cost(const MeshDistance& mesh, int cells, Table& costs) {
  const Bounds& bounds = mesh.tree.nodes[0].bounds;
  const Lattice lattice = lattice_about(bounds, cells, 3);
  const double start = processor_seconds();
  const Seeds seeds = narrow_band(mesh, lattice, 3);
  const double band = processor_seconds() - start;
  const double middle = processor_seconds();
  const Grid grid = march(lattice, seeds, MarchingOrder::second);
  const double marching = processor_seconds() - middle;
  Random random(113);
  Worst error;
  for (int i = 0; i < points; ++i) {
    const Vector3 on_surface =
        mesh.corners[size_t(random.uniform(0, double(mesh.corners.size())))][0];
    const Vector3 p = on_surface + random.vectors(1, 1.7 * lattice.spacing).col(0);
    error.observe(std::abs(grid.at(p).phi - mesh.at(p).phi));
  }
  costs.row(cells, lattice.size(), 8e-6 * double(lattice.size()), seeds.nodes.size(), band,
            marching, error.value());
}

}  // namespace

void add_grid_costs(const std::vector<int>& cells, StudyResult& result) {
  const TriangleMesh statue = make_statue(1, 4);
  const MeshDistance mesh = make_mesh_distance(statue.rest, statue.triangles);
  Table costs{
      {"cells along the longest side", "1"},    {"nodes", "1"}, {"grid", "MB"},
      {"nodes in a band of three cells", "1"},  {"band", "s"},  {"second-order marching", "s"},
      {"largest error within three cells", "m"}};
  for (const int n : cells) add_cost(mesh, n, costs);
  result.tables.push_back({"cost",
                           "Grids about a statue of " + std::to_string(statue.triangles.size()) +
                               " triangles, 1 m high",
                           costs});
  Figure figure{"error-against-memory",
                "Error of a grid about a statue against its memory",
                {"memory", "MB", Scale::log},
                {"largest error of phi", "m", Scale::log},
                "At random points within three cells of the surface, against the exact distance to "
                "the mesh. Edges of the mesh are kinks of phi, where trilinear values err by O(h), "
                "and memory grows with h^-3."};
  figure.curves = {
      curve_of("regular grid, exact band", costs, "grid", "largest error within three cells")};
  result.figures.push_back(std::move(figure));
}

}  // namespace foldproof
