// Findings of the study level-set-cache about the folder of level sets that a case may use.
#pragma once

#include "convergence/study.h"

namespace foldproof {

NamedFinding runs_with_cached_level_sets_agree();
NamedFinding unfit_grids_are_rejected();

}  // namespace foldproof
