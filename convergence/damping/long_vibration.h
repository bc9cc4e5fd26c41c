// A hundred periods of a crumpling sheet that nothing damps: what becomes of its energy.
#pragma once

#include "verification/subject.h"

namespace foldproof {

/// Adds findings, figures and tables to the study artificial-damping: energy at equal step and at equal cost,
/// trends of the schemes that should have none.
void add_long_vibrations(const Subject& subject, Tier tier, StudyResult& result);

}  // namespace foldproof
