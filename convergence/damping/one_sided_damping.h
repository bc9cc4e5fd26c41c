// Damping of one kind of motion, the other kind free: does a method leave the free one alone?
#pragma once

#include "convergence/damping/sheet_modes.h"

namespace foldproof {

/// Adds findings and a table to the study artificial-damping.
void add_one_sided_damping(const Subject& subject, const VibratingSheet& sheet, StudyResult& result);

}  // namespace foldproof
