// Frames that another program wrote, judged as a motion of a case's cloth.
#pragma once

#include "verification/cases/frame_laws.h"

namespace foldproof {

struct FramesJudgement {
  Matching matching = Matching::particles;
  std::vector<Record> records;  // the laws of frames, then what the case expects
  ComparisonEvidence evidence;  // numbers over time, folds at the end, and their figures
};

/// Judges the frames (at least one, ascending in time) by frame_laws, and by those expectations of
/// the case that frames can show; the others are recorded as not applicable, with the reason.
///   built   of the case's scene
FramesJudgement judge_frames(const Case& of, const BuiltScene& built,
                             std::span<const TimedMesh> frames);

}  // namespace foldproof
