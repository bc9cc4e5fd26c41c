// A scene in the oracles' words, so that its exact motion can be asked of an ODE solver that shares
// no formula with the reference.
#pragma once

#include "reference/scene/scene.h"
#include "verification/oracles/cloth.h"

namespace foldproof {

/// Masses, springs and hinges of the scene, with areas, lengths and masses computed anew from the
/// rest positions. Knows springs, bending of the law "sine", gravity and led particles that stand
/// or oscillate; InputError for a scene with more.
oracles::ClothDefinition oracle_of(const Scene& scene);

/// The end of the scene's motion, and how far any component may be off.
struct ExactEnd {
  oracles::ClothState state;  // 3 x N [m], 3 x N [m/s]
  double uncertainty;         // [m] and [m/s]
};

/// By GSL with this tolerance (see oracles/gsl.h), from the scene's start to `end` [s].
ExactEnd exact_end(const Scene& scene, const oracles::ClothDefinition& cloth, double end,
                   double tolerance);

/// The motion of one led particle. InputError for a motion that turns or drifts.
oracles::Motion oracle_motion(const PrescribedParticle& prescribed);

}  // namespace foldproof
