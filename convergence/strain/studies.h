// The studies of this room: what do limits of strain do?
#pragma once

#include "convergence/study.h"

namespace foldproof {

Study strain_sweeps_study();    // strain-sweeps: sweeps of strain limiting over mesh and order
Study strain_momentum_study();  // strain-momentum: angular momentum at the strain limits
Study biphasic_study();         // biphasic: weak springs with limits under a growing load

}  // namespace foldproof
