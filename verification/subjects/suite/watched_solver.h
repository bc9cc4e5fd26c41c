// A solver whose scenes and answers are watched: whether anything happened in them, and how much
// was asked.
#pragma once

#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "verification/subjects/pipe/piped_solver.h"

namespace foldproof {

/// Thrown by a call after the time of a law is up; the next law goes on.
struct LawTimeIsUp : std::runtime_error {
  LawTimeIsUp() : std::runtime_error("its time (--law-seconds) was up") {}
};

/// What a law asked for, and what happened in its scenes. Lengths are fractions of a scene's size.
struct Observed {
  long scenes = 0, advances = 0;         // advances: calls of advance and of step
  double steps = 0, particle_steps = 0;  // of all calls
  long most_particles = 0;               // of a scene
  bool sent_motion = false;              // some scene was to be moved
  bool sent_strain = false;              // some scene to be moved starts with strained edges
  double moved = 0, deformed = 0;        // largest displacement; change of an edge's length
  double sped = 0;                       // largest change of a velocity, of what gravity gives [1]
  bool met_obstacle = false;             // obstacles changed the mean velocity of a free sheet
  bool asked_inner_force = false;        // of strained edges or of dampers
  double inner_force = 0;                // the largest, without weight; of the scale of springs

  std::chrono::steady_clock::time_point end = std::chrono::steady_clock::time_point::max();

  /// Why what the law is about cannot have happened, by words of Law::needs; "" if it did.
  ///   rounding   of the solver's numbers [1]
  std::string nothing_happened(bool touches, double rounding) const;
};

/// The scene as it is sent to a solver that keeps cloth at a distance from obstacles: obstacles are
/// smaller by it, so that the cloth meets the surface that the law describes. Throws NotOffered for
/// a box that is thinner than that.
PortableScene within_contact_offset(PortableScene scene, double offset);

class WatchedSolver : public PipedSolver {
 public:
  /// Called after each answer with the scene, its steps so far, and the state.
  using Heard = std::function<void(const PortableScene&, long steps, const Snapshot&)>;

  WatchedSolver(SolverCommand command, Observed& observed, const Heard& heard)
      : PipedSolver(std::move(command)), observed_(observed), heard_(heard) {}

  std::vector<std::pair<std::string, std::string>> prepare(const PortableScene& scene);
  Snapshot advance(double dt, long steps, long of = 0);
  Snapshot step(const std::vector<Snapshot>& past, const std::vector<double>& times, double dt);
  std::vector<Snapshot> run(const PortableScene& scene, const std::vector<long>& frames);
  PerParticle3 forces(const Snapshot& state, double time);
  PerParticle3 damping(const Snapshot& state, double time);

  const PortableScene& scene() const { return scene_; }  // the latest

 private:
  void require_time() const;
  void begin(const PortableScene& scene);
  void count(long calls, long steps);
  void observe(const Snapshot& start, const Snapshot& now, double time);
  void observe_force(const PerParticle3& force);

  Observed& observed_;
  const Heard& heard_;
  PortableScene scene_;
  double size_ = 0;           // of its start [m]
  bool is_strained_ = false;  // at its start
  double time_ = 0;           // since the start of the scene [s]
  long steps_ = 0;            // likewise
};

}  // namespace foldproof
