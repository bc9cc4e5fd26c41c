// The studies of this room: how long may a step be?
#pragma once

#include "convergence/study.h"

namespace foldproof {

Study elastic_limit_study();  // elastic-limit: the largest stable step under refinement
// stability-oscillator: every method's limit over the damping ratio
Study stability_oscillator_study();
Study stability_sheet_study();  // stability-sheet: limits of a sheet over damping and resolution
// variable-step-stability: stable steps in turn; BDF2's growing steps
Study variable_step_stability_study();
Study transient_growth_study();  // transient-growth: how far a stable scheme carries a disturbance
// hard-limits: largest stable steps of hard sheets, under damping, over jumps
Study hard_limits_study();

// frame-long-steps: implicit methods in steps of a frame, on cloth that crumples
Study frame_long_steps_study();

}  // namespace foldproof
