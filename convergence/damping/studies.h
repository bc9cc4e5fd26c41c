// The studies of this room: what is damped, by the method and by the material?
#pragma once

#include "convergence/study.h"

namespace foldproof {

// artificial-damping: what methods take from vibrations that nothing damps
Study artificial_damping_study();
Study monotonicity_study();  // monotonicity: coming to rest in steps longer than the damping's time

}  // namespace foldproof
