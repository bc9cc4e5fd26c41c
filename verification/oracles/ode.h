#pragma once

#include <functional>
#include <span>
#include <vector>

namespace foldproof::oracles {

/// dydt = f(t, y): writes as many numbers as y has. Must not keep the spans.
using RightHandSide =
    std::function<void(double t, std::span<const double> y, std::span<double> dydt)>;

/// A solution at given times, and its uncertainty.
struct ReferenceSolution {
  std::vector<double> times;                // as requested
  std::vector<std::vector<double>> values;  // one y per time
  std::vector<double> uncertainty;          // per time, of the worst component, in the unit of y
};

}  // namespace foldproof::oracles
