// The table of integrators. A study runs over it and compares the observed order with `order`: a wrong row is
// refuted.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "reference/dynamics/system.h"

namespace foldproof {

struct Integrator {
  std::string_view name, title, source;
  int order;    // of the global error in x and v, for any step sequence
  int history;  // states that `step` needs to see, the latest last
  State (*step)(const System& system, std::span<const State> past, double h, Work& work);  // h [s]
};

const std::vector<Integrator>& integrators();

/// Throws InputError with the known names.
const Integrator& integrator_named(std::string_view name);

}  // namespace foldproof
