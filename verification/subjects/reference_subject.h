// The plain solver of reference/ as a subject.
#pragma once

#include <vector>

#include "reference/motion/motion.h"
#include "verification/subject.h"

namespace foldproof {

/// It offers every operation.
Subject reference_subject();

/// Gives the particles of a scene that the reference prepared these masses (N [kg], each > 0) in
/// place of those of its density; their weights, too. Particles with prescribed motion keep it.
void set_masses(PreparedScene& prepared, const PerParticle& masses);

/// The prescribed particles of such a scene, whose motion may be changed between steps.
std::vector<PrescribedParticle>& prescribed_of(PreparedScene& prepared);

}  // namespace foldproof
