// Parts of the study stretched-wrinkles: a sheet that only its clamps compress, and how high the
// waves of a prescribed compression are beyond the onset.
#pragma once

#include "convergence/study.h"

namespace foldproof {

/// A flat sheet's stress across beside that of a continuum, in both tiers.
void add_clamped_continuum(const Subject& subject, StudyResult& result);

/// The wrinkles of a clamped sheet, in the full tier: findings, figures and tables.
void add_clamped_wrinkles(const Subject& subject, StudyResult& result);

/// Findings, figures and tables of deep waves, as the second half of the study.
void add_deep_wrinkles(const Subject& subject, Tier tier, const Progress& progress,
                       StudyResult& result);

}  // namespace foldproof
