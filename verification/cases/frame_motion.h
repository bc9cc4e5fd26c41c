// Frames of any program as a motion of a case's cloth, and what laws of frames need of both.
#pragma once

#include <span>
#include <string_view>
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

  /// Half a unit of the sixth digit of the largest coordinate, or of the sixth decimal if that is
  /// more: files may have no more [m].
  double rounding() const;
};

/// The motion of these frames; velocities are those of the neighbouring frames' difference.
FrameMotion motion_of(const Case& of, const BuiltScene& built, std::span<const TimedMesh> frames);

/// Pairs of an edge and a triangle that meet, decided exactly; NaN if a position is not finite.
double crossings_in(const TimedMesh& frame);

/// How many more pairs meet in the first frame than at the case's start, if rounding is all that
/// parts them: layers that touch there cross in a file of six digits; else 0.
double crossings_by_rounding(const FrameMotion& motion);

/// Depth of the deepest vertex inside an object [m]; prescribed vertices, and those between two
/// objects, do not count. NaN if a position is not finite.
double depth_in(const FrameMotion& motion, const TimedMesh& frame);

/// Distance of the nearest free vertex from an object, negative inside [m]; infinite without
/// objects, NaN if a position is not finite.
double clearance_in(const FrameMotion& motion, const TimedMesh& frame);

/// The largest change of one form of energy since the start [J].
double exchanged(const Energies& now, const Energies& start);

// Each throws NotOffered with what is missing.

void require_particles(const FrameMotion& motion);  // vertex i is particle i
void require_start(const FrameMotion& motion);      // the first frame is at t = 0
/// Nothing does work on the cloth, and frames show all energy but the kinetic.
void require_closed_budget(const FrameMotion& motion);

}  // namespace foldproof
