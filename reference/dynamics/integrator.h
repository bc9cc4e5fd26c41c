// The table of integrators. A study compares the observed order of each row with its `order`, so a
// wrong entry is found.
#pragma once

#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "reference/dynamics/system.h"

namespace foldproof {

/// Which forces a method treats implicitly. mixed: only the damping, in the velocity update, as
/// in the paper; fully_explicit: none, so that damping limits its step; fully_implicit: the
/// elastic forces too.
enum class Family { mixed, fully_explicit, fully_implicit };

struct Integrator {
  std::string_view name, title, source;
  int order;    // of the global error in x and v, for any step sequence within largest_growth
  int history;  // states that `step` can use, the latest last; with fewer it is self-starting
  State (*step)(const System& system, std::span<const State> past, double h, Work& work);  // h [s]
  Family family = Family::mixed;
  // ratio of a step to the one before [1]
  double largest_growth = std::numeric_limits<double>::infinity();
  bool damping_widens_limit = false;  // stable for h^2 K < 4 M + 2 h D, not for h^2 K < 4 M only
};

const std::vector<Integrator>& integrators();

/// The paper's own schemes: A, B, C.
std::vector<Integrator> paper_schemes();

/// Throws InputError with the known names.
const Integrator& integrator_named(std::string_view name);

/// The latest states of a run, as seen by a step.
class History {
 public:
  /// Starts, or restarts after an event, since no method may look across it. length: maximum number
  /// of states kept, >= 1.
  History(State start, int length) : states_{std::move(start)}, length_(size_t(length)) {}

  /// Continues from the stored states of a history of this length, the latest last; at least one.
  History(std::vector<State> states, int length)
      : states_(std::move(states)), length_(size_t(length)) {}

  /// Appends the state at the end of a step.
  void advance(State next) {
    states_.push_back(std::move(next));
    if (states_.size() > length_) states_.erase(states_.begin());
  }

  const std::vector<State>& past() const { return states_; }
  const State& now() const { return states_.back(); }
  State& now() { return states_.back(); }

 private:
  std::vector<State> states_;
  size_t length_;
};

}  // namespace foldproof
