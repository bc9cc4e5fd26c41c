// Laws that frames of any program must meet: what can be seen of a motion without its solver.
#pragma once

#include <string>
#include <vector>

#include "verification/cases/frame_motion.h"

namespace foldproof {

/// A law of frames. `run` throws NotOffered where the frames, or the case, lack what it needs.
struct FrameLaw {
  std::string name, claim, source;
  Finding (*run)(const FrameMotion& motion);
};

/// The one that tells a wrong file from a wrong motion comes first.
const std::vector<FrameLaw>& frame_laws();

}  // namespace foldproof
