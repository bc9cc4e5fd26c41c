// stretched-wrinkles, in the full tier: a sheet that only its clamps compress.
#pragma once

#include "convergence/study.h"

namespace foldproof {

/// Adds the findings, figures and tables of a clamped sheet to the study's.
void add_clamped_wrinkles(const Subject& subject, StudyResult& result);

}  // namespace foldproof
