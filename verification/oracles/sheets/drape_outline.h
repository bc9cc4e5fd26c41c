// The shadow of a draped disc of cloth: how far it reaches, its drape coefficient and its folds.
#pragma once

#include <array>
#include <vector>

#include "reference/types.h"

namespace foldproof::oracles {

/// Radii of the disc of cloth and of the plate that holds it [m].
struct DrapeRadii {
  double specimen, plate;
};

/// The cloth from above, from outside in: how far its edge or a fold reaches from the axis in each
/// of equally spaced directions [m], at least to the plate's rim.
using Outline = std::vector<double>;

/// x: 3 x N [m], z up, the axis at x = y = 0.
Outline outline_of(const PerParticle3& x, const std::vector<std::array<int, 3>>& triangles,
                   double plate, int directions);

/// The shadow beyond the plate over that of the level ring [1].
double drape_coefficient(const Outline& outline, const DrapeRadii& radii);

/// Highest points around the outline that stand out by the prominence [m].
int folds_of(const Outline& outline, double prominence);

}  // namespace foldproof::oracles
