// Of stretched-wrinkles: a sheet that only its clamps compress.
#pragma once

#include "convergence/study.h"

namespace foldproof {

/// Its wrinkles, in the full tier: findings, figures and tables (clamped_findings.cpp).
void add_clamped_wrinkles(const Subject& subject, StudyResult& result);

/// A flat sheet's stress across beside that of a continuum, in both tiers (clamped_continuum.cpp).
void add_clamped_continuum(const Subject& subject, StudyResult& result);

}  // namespace foldproof
