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

/// Has such a scene record, from now on, what its objects do to the particles.
void record_contact(PreparedScene& prepared);

/// The impulses of the objects on the particles since the last call [N s], 3 x N: what they add to
/// the momenta at the ends of steps. Needs record_contact.
PerParticle3 take_contact_impulses(PreparedScene& prepared);

}  // namespace foldproof
