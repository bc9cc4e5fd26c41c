// Labels of findings in files and on pages: the kind of result, and how well its number is known.
// Labels are derived from the finding; outcomes do not depend on them.
#pragma once

#include <string_view>
#include <vector>

#include "verification/verdict.h"

namespace foldproof {

enum class FindingScope {
  specific,   // a statement made by one finding only
  generic,    // made for every case: runs to its end, repeats its bits, does not cross itself
  structural  // true by construction: an error of the method cannot make it fail
};

/// How well the measured number is known. All but `estimated` have uncertainty 0.
enum class Certainty {
  estimated,  // with an uncertainty: of an oracle, a fit, a repetition
  counted,    // whole numbers of things or of differing bits: exact
  // in a unit of its own error (epsilon, tolerance, standard error): covered by the bound
  within_bound,
  computed,    // read off one deterministic run, which repeats to the bit: exact for that run
  timed_once,  // by a clock, once, without a spread
  structural   // nothing uncertain
};

/// The word for each kind in files: "within bound", "timed once"; otherwise the name above.
std::string_view name_of(FindingScope scope);
std::string_view name_of(Certainty certainty);

FindingScope scope_of(const Record& record);

/// From the uncertainty, the unit and the bound; independent of whether the finding holds.
Certainty certainty_of(const Record& record);

/// True if the reason of the bound begins with "empirical": a measured number with a margin.
bool has_empirical_bound(const Record& record);

/// Fraction of the judged findings that have such a bound [1]; 0 if none is judged.
double empirical_share(const std::vector<Record>& records);

/// A run of the whole suite fails if a larger fraction of its bounds is empirical [1].
constexpr double most_empirical = 0.05;

}  // namespace foldproof
