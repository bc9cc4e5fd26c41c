// Part of the study artificial-damping: a hundred periods of a crumpling sheet that nothing damps.
#pragma once

#include "convergence/study.h"

namespace foldproof {

/// Adds findings, figures and tables: energy at equal step and at equal cost, trends of the schemes
/// that should have none.
void add_long_vibrations(const Subject& subject, Tier tier, StudyResult& result);

}  // namespace foldproof
