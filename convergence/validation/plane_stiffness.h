// When a flat sheet that is loaded in its plane leaves it: from the subject's forces alone.
#pragma once

#include "reference/scene/scene.h"
#include "verification/subject.h"

namespace foldproof {

struct Tipping {
  double load;        // of the scene's gravity [1]
  PerParticle mode;   // displacements along z at that load, N; the largest is 1
  double unfinished;  // relative change of the load in the last turn [1]
};

/// A long flat sheet at rest in the plane z = 0, with gravity in that plane, held where the scene
/// prescribes particles. With K the stiffness along z, u the displacements in the plane under the
/// load 1, and small t, the sheet leaves its plane at the load where
///   K(rest) + load (K(rest + t u) - K(rest - t u))/(2 t)
/// first becomes singular. Stiffnesses are central differences of forces; many particles move at
/// once. reach [m]: along x, no particle feels one farther away. A load and its opposite must tip
/// the sheet alike, as they do if it is its own mirror image across its width.
Tipping tipping_of(const Subject& subject, const Scene& scene, double reach);

}  // namespace foldproof
