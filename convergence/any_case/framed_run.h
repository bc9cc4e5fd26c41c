// A run that a store keeps: its frames, its seconds, why it stopped. Questions about a case add
// what else they need of it. And how far two runs of the same cloth are apart.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reference/types.h"
#include "verification/files/result_store.h"

namespace foldproof {

struct FramedRun {
  std::vector<double> times;    // of the frames [s]
  std::vector<PerParticle3> x;  // in each of them, 3 x N [m]
  double seconds = 0;           // of the processor, in the run's own thread
  std::string stopped;          // why the run came to no end, or ""
};

/// It came to its end.
bool is_whole(const FramedRun& run);

/// The run as the store has it: arrays "times", "positions", "seconds", text "stopped".
StoredResult packed_frames(const FramedRun& run);

/// Fills in what packed_frames kept of a run of N particles; false where something
/// of it is missing.
bool unpack_frames(const StoredResult& kept, Eigen::Index particles, FramedRun& run);

/// The array of this name; empty where there is none.
std::vector<double> array_of(const StoredResult& kept, const std::string& name);

// Distances: root mean squares over the particles, by mass (N [kg], some > 0).

/// The longest side of the box around x, 3 x N [m].
double longest_side(const PerParticle3& x);

/// Differences of positions, or of numbers, of this size at most are rounding over a run, no error
/// of discretization.
double rounding_floor(double size);

/// The root mean square over the particles of |u_i|, in the unit of u.
double mean_square_root(const PerParticle3& u, const PerParticle& mass);

/// The largest distance over the frames that both runs have, each 3 x N [m]; 0 without a frame, NaN
/// where a position is none.
double largest_difference(const std::vector<PerParticle3>& a, const std::vector<PerParticle3>& b,
                          const PerParticle& mass);

/// The same; NaN where they are not the same frames, or there is none.
double frame_distance(const std::vector<PerParticle3>& a, const std::vector<PerParticle3>& b,
                      const PerParticle& mass);

/// frame_distance of two runs [m]; NaN where one of them stopped.
double field_difference(const FramedRun& a, const FramedRun& b, const PerParticle& mass);

/// The largest distance of a run from its first frame [m].
double largest_motion(const std::vector<PerParticle3>& x, const PerParticle& mass);

}  // namespace foldproof
