// A case that is the laboratory's bending test: a strip clamped at one end.
#pragma once

#include <optional>

#include "reference/scene/scene.h"

namespace foldproof {

/// A strip at rest beside the elastica of its rigidity. Lengths in m.
struct ClampedStrip {
  double length;                         // L, from the middle of the clamped cell to the tip
  double rigidity;                       // B of a narrow strip of this mesh [N m]
  double gamma;                          // rho_A g L^3/B [1]
  double drop, reach;                    // of the tip's middle, below and out from the clamp
  double elastica_drop, elastica_reach;  // the same of an inextensible strip
};

/// None unless the cloth is a flat mesh that hinges bend, under gravity and without objects, whose
/// held particles are the two rows at one end of one direction, still, and level across.
///   x   where it is, 3 x N [m]
std::optional<ClampedStrip> clamped_strip(const Scene& scene, const PerParticle3& x);

}  // namespace foldproof
