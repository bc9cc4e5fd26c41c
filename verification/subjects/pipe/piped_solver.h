// A solver in a process of its own, asked over the protocol of verification/subjects/PROTOCOL.md.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "verification/subjects/pipe/child_process.h"
#include "verification/subjects/pipe/declaration.h"
#include "verification/subjects/pipe/portable_scene.h"
#include "verification/verdict.h"

namespace foldproof {

/// How a solver is started.
struct SolverCommand {
  std::string command;                                        // for sh -c
  std::vector<std::pair<std::string, std::string>> settings;  // passed through in every scene
  std::map<std::string, double> tunables = {};                // likewise: values of its tunables
  ProcessLimits limits = {};
};

/// Positions and velocities of a scene's particles, 3 x N [m], [m/s].
struct Snapshot {
  PerParticle3 x, v;
};

/// Each call throws SolverFailure if it goes wrong, NotOffered if the solver declines, and
/// TimeIsUp at the end of the limits. After a failure the process is ended; later calls fail with
/// the same words.
class PipedSolver {
 public:
  /// Starts the process and asks for its declaration.
  explicit PipedSolver(SolverCommand command);
  ~PipedSolver();
  PipedSolver(PipedSolver&&) noexcept;
  PipedSolver& operator=(PipedSolver&&) noexcept;

  const Declaration& declaration() const { return declaration_; }

  /// The values of its tunables in the scenes to come.
  void tune(const std::map<std::string, double>& tunables);

  /// Makes a scene ready. Returns the mapping: how the solver understood the parameters.
  std::vector<std::pair<std::string, std::string>> prepare(const PortableScene& scene);

  /// of: how many steps will be asked of the scene, for the words of a failure; 0: unknown
  Snapshot advance(double dt, long steps, long of = 0);
  Snapshot get_state();

  /// One step of dt [s] from the state, which the solver takes over. `past` are states before the
  /// latest, for solvers with capability "history".
  Snapshot step(const std::vector<Snapshot>& past, const std::vector<double>& times, double dt);

  /// What the last step's answer counted, in the order of for_each_counter; zeros if it
  /// counted nothing.
  const Work& last_work() const { return last_work_; }

  PerParticle3 forces(const Snapshot& state, double time);   // elastic and external [N], 3 x N
  PerParticle3 damping(const Snapshot& state, double time);  // [N], 3 x N
  double energy(const Snapshot& state, double time);         // potential [J]

  /// Mean forces of the obstacles on the particles during the last advance or step [N], 3 x N.
  PerParticle3 contact_forces();

  /// The states after these numbers of steps of scene.dt, ascending.
  std::vector<Snapshot> run(const PortableScene& scene, const std::vector<long>& frames);

  /// Of the solver's processes.
  ProcessorTime processor_time() const;

  /// Whether a call went wrong: the process has then ended.
  bool has_failed() const;

  /// Asks for an operation that no protocol has. Is it declined?
  bool declines_unknown_operation();

  /// Asks the solver to end, and checks that nothing but the answer came.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  Declaration declaration_;
  Work last_work_ = {};
};

}  // namespace foldproof
