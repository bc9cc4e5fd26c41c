// The studies of this room: which order has each method in time, and what does it keep?
#pragma once

#include "convergence/study.h"

namespace foldproof {

// time-order.hinge: errors at the end of a driven hinge's motion against the step
Study hinge_time_order_study();
Study sheet_time_order_study();  // time-order.sheet: the same on a hanging sheet
Study momentum_drift_study();    // momentum-drift: angular momentum of a free sheet
Study mirror_symmetry_study();   // mirror-symmetry: how rounding breaks it

}  // namespace foldproof
