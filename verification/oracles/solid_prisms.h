// Solids with an exact integer inside test: nested prisms over polygons.
#pragma once

#include <array>
#include <vector>

namespace foldproof::oracles {

using Whole2 = std::array<long, 2>;
using Whole3 = std::array<long, 3>;

/// A polygon without self-intersections, counter-clockwise, and the heights between which it
/// stands; in units that the user chooses.
struct WholePrism {
  std::vector<Whole2> polygon;
  long low, high;
};

/// +1 inside, -1 outside, 0 on the surface. Exact while coordinates stay below 2^30.
int inside_prism(const WholePrism& prism, const Whole3& p);

/// +1 where p is inside an odd number of the prisms, -1 where inside an even number; 0
/// on any surface.
int inside_nested(const std::vector<WholePrism>& prisms, const Whole3& p);

}  // namespace foldproof::oracles
