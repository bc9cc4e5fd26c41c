// A solver on trial: kept running from law to law, started again after a failure.
#pragma once

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "verification/subjects/suite/watched_solver.h"

namespace foldproof {

/// Thrown by a law that fails before it has a number. The text says what was seen.
struct FailedWithoutNumber : std::runtime_error {
  std::string required;  // to get a number: the reason in place of that of a bound
  FailedWithoutNumber(const std::string& seen, std::string required_)
      : std::runtime_error(seen), required(std::move(required_)) {}
};

/// Thrown by a law whose bound the declaration makes so wide that anything would hold.
struct CannotTell : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Trial {
 public:
  explicit Trial(SolverCommand command, WatchedSolver::Heard heard = {})
      : command_(std::move(command)), heard_(std::move(heard)) {}

  Trial(const Trial&) = delete;  // the running solver reports to it

  /// The running solver. Throws SolverFailure if it cannot be started; a start that failed, or a
  /// third hang, is not tried again: the same failure is thrown.
  WatchedSolver& solver();

  /// Forgets what was observed under the law before.
  ///   seconds   of the clock, for the law; 0: no limit
  void begin_law(double seconds = 0);
  const Observed& observed() const { return observed_; }

  /// Whether the latest scene deforms if it is stretched by 1 % and without its obstacles: the
  /// companion of a law that holds because nothing moves. Does not count as asked by the law.
  bool deforms_when_stretched();

  /// The values of the solver's tunables from now on; an empty map leaves it to its own.
  void tune(const std::map<std::string, double>& tunables);

  /// Starts another process in place of the running one.
  void restart();

  const Declaration& declaration();

  /// The latest declaration; unset if the solver never started.
  const Declaration& last_declaration() const { return declared_; }

  /// Whether the solver will not be asked again.
  bool has_ended() const { return gave_up_ || is_out_of_time_; }

  /// To be called when TimeIsUp was thrown.
  void run_out_of_time() { is_out_of_time_ = true; }
  bool is_out_of_time() const { return is_out_of_time_; }

  /// Throws NotOffered unless the solver declares it.
  void require_level(int level);
  void require(const std::string& capability);

  /// Makes the scene ready and remembers the mapping.
  void prepare(const PortableScene& scene);

  /// The states after these numbers of steps, ascending, by `advance`, or by `run` at level 0.
  std::vector<Snapshot> motion(const PortableScene& scene, const std::vector<long>& steps);
  Snapshot after(const PortableScene& scene, long steps) { return motion(scene, {steps}).front(); }

  /// By the clock, how long the answers of the latest motion took [s], to its failure if it failed:
  /// its steps and the pipe, and at level 0 the scene's setup, too.
  double seconds_of_motion() const { return seconds_of_motion_; }

  /// Likewise of the processor, of all processes and threads of the solver; NaN where the system
  /// does not say, and after a failure.
  double processor_seconds_of_motion() const { return processor_seconds_of_motion_; }

  /// To be called when a law has thrown: the process has ended, the next law starts another.
  void note(const SolverFailure& failure);

  const std::vector<std::pair<std::string, std::string>>& mapping() const { return mapping_; }

 private:
  std::vector<Snapshot> timed_motion(const PortableScene& scene, const std::vector<long>& steps);
  std::vector<Snapshot> advance(double dt, const std::vector<long>& steps);

  SolverCommand command_;
  WatchedSolver::Heard heard_;
  Observed observed_;
  std::optional<WatchedSolver> running_;
  std::optional<SolverFailure> gave_up_;
  Declaration declared_;
  std::vector<std::pair<std::string, std::string>> mapping_;
  int hangs_ = 0;
  bool is_out_of_time_ = false;
  double seconds_of_motion_ = 0, processor_seconds_of_motion_ = 0;
};

}  // namespace foldproof
