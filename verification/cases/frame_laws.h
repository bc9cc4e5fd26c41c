// Laws that frames of any program must meet: what can be seen of a motion without its solver.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "verification/cases/expectations.h"
#include "verification/cases/frame_comparison.h"
#include "verification/verdict.h"

namespace foldproof {

/// Frames, and the case whose cloth they show.
struct FrameMotion {
  const Case& of;
  const BuiltScene& built;
  Matching matching;
  std::span<const TimedMesh> frames;  // at least one, ascending in time
  std::vector<State> states;  // with velocities of differences; empty where matching is `surface`

  /// Half a unit of the sixth digit of the largest coordinate: files may have no more [m].
  double rounding() const;
};

/// The motion of these frames; velocities are those of the neighbouring frames' difference.
FrameMotion motion_of(const Case& of, const BuiltScene& built, std::span<const TimedMesh> frames);

/// A law of frames. `run` throws NotOffered where the frames, or the case, lack what it needs.
struct FrameLaw {
  std::string name, claim, source;
  Finding (*run)(const FrameMotion& motion);
};

/// The one that tells a wrong file from a wrong motion comes first.
const std::vector<FrameLaw>& frame_laws();

/// Pairs of an edge and a triangle that meet, decided exactly; NaN if a position is not finite.
double crossings_in(const TimedMesh& frame);

/// Depth of the deepest vertex inside an object [m]; prescribed vertices, and those between two
/// objects, do not count.
double depth_in(const FrameMotion& motion, const TimedMesh& frame);

}  // namespace foldproof
