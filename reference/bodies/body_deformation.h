// Procedural deformations of a body: it bends, twists and breathes.
#pragma once

#include <vector>

#include "reference/level_set/deforming.h"
#include "reference/mesh/box_tree.h"

namespace foldproof {

enum class DeformationKind {
  // the vertical axis becomes an arc of its own length, towards +x; all around turns with it
  bend,
  twist,   // heights turn about the axis, each in proportion
  breathe  // widths grow, most at mid-height, not at all at either end
};

/// Periodic: reaches the fraction (1 - cos(2 pi t/period))/2 of the amplitude, 0 at t = 0.
struct BodyDeformation {
  DeformationKind kind;
  // bend, twist: rotation of the top relative to the base [rad]; breathe: relative
  // growth of width [1]
  double amplitude;
  double period;  // s
};

/// Applies the parts in order, about the vertical (y) axis through the centre of the bounds;
/// heights are measured from the lowest point. Lengths in m.
Deformation deformation_of(std::vector<BodyDeformation> parts, const Bounds& bounds);

}  // namespace foldproof
