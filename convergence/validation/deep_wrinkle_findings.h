// stretched-wrinkles, beyond the onset: how high the waves are for a prescribed compression.
#pragma once

#include "convergence/study.h"

namespace foldproof {

/// Adds the findings, figures and tables of deep waves to the study's, as the second half of it.
void add_deep_wrinkles(const Subject& subject, Tier tier, const Progress& progress,
                       StudyResult& result);

}  // namespace foldproof
