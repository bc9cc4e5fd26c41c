// Part of the study bending-rigidity: sheets whose triangles do not repeat themselves.
#pragma once

#include "convergence/study.h"

namespace foldproof {

/// Adds the findings, the figure and the table of jittered and random sheets to those of the
/// regular ones.
void add_irregular_rigidity(const Subject& subject, Tier tier, const Progress& progress,
                            StudyResult& result);

}  // namespace foldproof
