#include "reference/bodies/mesh_inspection.h"

#include <algorithm>

#include "reference/bodies/closed_mesh.h"
#include "reference/bodies/ray_parity.h"
#include "reference/bodies/repair.h"
#include "reference/bodies/thin_parts.h"

namespace foldproof {

namespace {

void look_for_solid(const TriangleSoup& soup, MeshInspection& found) {
  try {
    const TriangleMesh mesh = make_closed_mesh(soup);
    found.pieces = count_of_pieces(mesh);
    found.volume = enclosed_volume(mesh.rest, mesh.triangles);
  } catch (const InputError& error) {
    found.rejection = error.what();
  }
}

void count_nodes(const TriangleSoup& soup, const Grid& grid, MeshInspection& found) {
  const auto parity = ray_parity(soup.rest, soup.triangles, grid.lattice);
  const Disagreement differing = disagreement(grid, parity, 1e-6 * grid.lattice.spacing);
  found.nodes = grid.lattice.size();
  found.against_sign = long(differing.with_sign.size());
  found.among_rays = long(differing.among_rays.size());
}

}  // namespace

MeshInspection inspect_mesh(const TriangleSoup& soup, int cells) {
  MeshInspection found;
  found.vertices = long(soup.rest.cols());
  found.triangles = long(soup.triangles.size());
  found.bounds = bounds_of(soup.rest);
  look_for_solid(soup, found);
  const GridMethod method{cells, 4, 3, MarchingOrder::second};
  const Repair repair = found.rejection.empty() ? Repair::refuse : Repair::winding;
  try {
    const auto grid = make_level_set(soup, method, repair);
    count_nodes(soup, *grid, found);
    const auto thin = find_thin_parts(
        soup.rest, repair == Repair::refuse ? soup.triangles : outward_patches(soup).triangles,
        *grid);
    if (thin) found.thin_parts = describe(*thin, *grid, found.bounds.sizes().maxCoeff(), repair);
  } catch (const InputError& error) {
    found.repair_failure = error.what();
  }
  return found;
}

}  // namespace foldproof
