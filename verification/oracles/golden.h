// Golden values: inputs and outputs of the paper's formulas, each output correctly rounded to
// double, for unit tests of any code in any language.
#pragma once

#include <string>
#include <vector>

namespace foldproof {

struct GoldenColumn {
  std::string name, unit;  // "1" for none
  bool is_input;
};

struct GoldenTable {
  std::string name, about;  // about: which formula, and where in the paper
  std::vector<GoldenColumn> columns;
  std::vector<std::vector<double>> rows;
};

/// bending, springs, integrator, forecast, friction, projection, sticking.
std::vector<std::string> golden_names();

/// `count` >= 1 rows; the same seed gives the same rows. Every output is computed with 50 digits
/// and rounded once. For an unknown name, throws InputError that lists the names.
GoldenTable golden_values(const std::string& name, int count, unsigned seed);

}  // namespace foldproof
