// Ways in which a body can be made to deform without an animator: it bends, twists and breathes.
#pragma once

#include <vector>

#include "reference/level_set/deforming.h"
#include "reference/mesh/box_tree.h"

namespace foldproof {

enum class DeformationKind {
  // the vertical axis becomes an arc of its own length, towards +x; what is beside it turns along
  bend,
  twist,   // heights turn about the axis, each in proportion
  breathe  // widths grow, most at half the height, and by nothing at both ends
};

/// Comes and goes: its share of the amplitude is (1 - cos(2 pi t/period))/2, nothing at t = 0.
struct BodyDeformation {
  DeformationKind kind;
  // bend, twist: how far the top turns against the base [rad]; breathe: growth over width [1]
  double amplitude;
  double period;  // s
};

/// One after the other, about the vertical (y) axis through the middle of the bounds, heights
/// counted from their lowest point. Lengths in m.
Deformation deformation_of(std::vector<BodyDeformation> parts, const Bounds& bounds);

}  // namespace foldproof
