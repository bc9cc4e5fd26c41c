// foldproof judge --frames: frames that any program wrote, without an adapter.
#pragma once

#include "scripts/program/options.h"

namespace foldproof {

/// Judges the frames as a motion of the case's cloth, prints and writes the verdicts; returns the
/// exit code. Throws InputError for frames or a case that cannot be read.
int judge_frames_of_a_case(const Options& options);

}  // namespace foldproof
