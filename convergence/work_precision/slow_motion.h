// What methods make of the slow motion that heavy damping leaves: a part of work-precision.
#pragma once

#include "verification/subject.h"

namespace foldproof {

/// An overdamped oscillator creeps home at a rate near k/c. The rate under A, B and C against the step: a
/// figure, that A keeps its second order, and that C has the error derived above its definition.
void add_slow_motion(const Subject& subject, StudyResult& result);

}  // namespace foldproof
