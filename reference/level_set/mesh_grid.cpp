#include "reference/level_set/mesh_grid.h"

#include "reference/level_set/narrow_band.h"

namespace foldproof {

std::shared_ptr<const Grid> make_grid(const MeshDistance& mesh, const GridMethod& method,
                                      const Team& team) {
  const Lattice lattice = lattice_about(mesh.tree.nodes[0].bounds, method.cells, method.margin);
  return std::make_shared<const Grid>(
      march(lattice, narrow_band(mesh, lattice, method.band, team), method.order));
}

}  // namespace foldproof
