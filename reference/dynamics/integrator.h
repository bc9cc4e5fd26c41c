// The table of integrators. A study runs over it and compares the observed order with `order`: a
// wrong row is refuted.
#pragma once

#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "reference/dynamics/system.h"

namespace foldproof {

/// Which forces a method takes implicitly. mixed: the damping in the velocity alone, as the
/// paper does; fully_explicit: nothing, so that damping limits its step; fully_implicit: the
/// elastic forces too.
enum class Family { mixed, fully_explicit, fully_implicit };

struct Integrator {
  std::string_view name, title, source;
  int order;  // of the global error in x and v, for any step sequence that keeps to largest_growth
  int history;  // states that `step` can use, the latest last; with fewer it starts itself
  State (*step)(const System& system, std::span<const State> past, double h, Work& work);  // h [s]
  Family family = Family::mixed;
  // of a step over the one before [1]
  double largest_growth = std::numeric_limits<double>::infinity();
  bool damping_widens_limit = false;  // stable for h^2 K < 4 M + 2 h D, not for h^2 K < 4 M only
};

const std::vector<Integrator>& integrators();

/// The paper's own schemes: A, B, C.
std::vector<Integrator> paper_schemes();

/// Throws InputError with the known names.
const Integrator& integrator_named(std::string_view name);

/// The latest states of a run, which is what a step sees.
class History {
 public:
  /// Starts, or starts again after an event that no method must look across. length: most
  /// states kept, >= 1.
  History(State start, int length) : states_{std::move(start)}, length_(size_t(length)) {}

  /// Goes on with states that a history of this length has kept, the latest last; at least one.
  History(std::vector<State> states, int length)
      : states_(std::move(states)), length_(size_t(length)) {}

  /// Takes up the state that a step has made.
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
