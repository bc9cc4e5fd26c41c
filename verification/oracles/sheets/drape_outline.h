// The shadow of a draped disc of cloth: its outline, its drape coefficient and its folds.
#pragma once

#include <array>
#include <vector>

#include "reference/types.h"

namespace foldproof::oracles {

/// Radii of the disc of cloth and of the plate that holds it [m].
struct DrapeRadii {
  double specimen, plate;
};

/// The cloth seen from above: the farthest distance of its edge or of a fold from the axis in each
/// of equally spaced directions [m], at least that of the plate's rim.
using Outline = std::vector<double>;

/// x: 3 x N [m], z up, the axis at x = y = 0.
Outline outline_of(const PerParticle3& x, const std::vector<std::array<int, 3>>& triangles,
                   double plate, int directions);

/// Area of the shadow beyond the plate over that of the flat ring [1].
double drape_coefficient(const Outline& outline, const DrapeRadii& radii);

/// Highest points around the outline that stand out by the prominence [m].
int folds_of(const Outline& outline, double prominence);

}  // namespace foldproof::oracles
