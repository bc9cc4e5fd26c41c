// Parts of a body that a grid loses because they are thinner than its cells.
#pragma once

#include <optional>
#include <string>

#include "reference/bodies/repair.h"
#include "reference/level_set/grid.h"

namespace foldproof {

struct ThinParts {
  double lost = 0;  // fraction of the surface's area behind which the grid has no inside [1]
  Vector3 place;    // on the largest such part [m]
  // typical thickness there; 0 where no triangle lies behind [m]
  double thickness = 0;
};

/// Samples the surface, two points for each square of a cell's width, and looks a cell and a half
/// inward for a value of the grid below 0. A point without one is lost if no node inside is within
/// three cells; or if the wall behind is parallel to 15 degrees, and a tenth of all points with
/// little behind them have nothing. So edges and tips are spared, and what is below four squares.
/// x: 3 x N [m]; triangles: with normals outward.
std::optional<ThinParts> find_thin_parts(const PerParticle3& x,
                                         const std::vector<Triangle>& triangles, const Grid& grid);

/// The parts in words, and the fields or the number of cells that would do. longest: side of the
/// body's bounds [m].
std::string describe(const ThinParts& parts, const Grid& grid, double longest, Repair repair);

}  // namespace foldproof
