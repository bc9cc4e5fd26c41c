// What the work-precision study measured, between its parts.
#pragma once

#include <array>
#include <vector>

#include "convergence/work_precision/precision_curve.h"

namespace foldproof {

/// One motion, what is known of it, and every method on it.
struct PrecisionScene {
  PrecisionProblem problem;
  PrecisionTruth truth;
  std::vector<PrecisionCurve> curves;  // in the order of the table of integrators
};

/// The errors that are asked for, over the motion [1].
constexpr std::array<double, 2> wanted_errors = {0.01, 0.001};

/// The method of a scene by its name; InputError if it has not run.
const PrecisionCurve& curve_of(const PrecisionScene& scene, std::string_view method);

std::vector<NamedFinding> precision_findings(const std::vector<PrecisionScene>& scenes);

/// Error against step, work and seconds of one scene.
std::vector<Figure> precision_figures(const PrecisionScene& scene);

/// Which method is cheapest; every method's price; every run.
std::vector<Table> precision_tables(const std::vector<PrecisionScene>& scenes);

}  // namespace foldproof
