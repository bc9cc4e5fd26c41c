// Labels of findings in files and on pages: the kind of result, and how well its number is known.
// Labels are derived from the finding; outcomes do not depend on them.
#pragma once

#include <string_view>
#include <vector>

#include "verification/verdict.h"

namespace foldproof {

enum class FindingScope {
  specific,   // a statement of its own
  generic,    // every case makes it: runs to its end, repeats its bits, does not cross itself
  structural  // true by construction: an error of the method cannot make it fail
};

/// How well the measured number is known. All but `estimated` have the uncertainty 0.
enum class Certainty {
  estimated,  // with an uncertainty: of an oracle, a fit, a repetition
  counted,    // whole numbers of things or of differing bits: exact
  // in a unit of its own error (epsilon, tolerance, standard error): the bound has it
  within_bound,
  computed,    // read off one deterministic run, which repeats to the bit: exact for that run
  timed_once,  // by a clock, without a spread: the outcome rests on one reading
  structural   // nothing to be uncertain about
};

/// The word for each kind in files: "within bound", else as above ("timed once").
std::string_view name_of(FindingScope scope);
std::string_view name_of(Certainty certainty);

FindingScope scope_of(const Record& record);

/// From the uncertainty, the unit and the bound; never from whether it holds.
Certainty certainty_of(const Record& record);

/// True if the reason of the bound begins with "empirical": a measured number with a margin.
bool has_empirical_bound(const Record& record);

/// Of the findings that are judged, the share with such a bound [1]; 0 if none is judged.
double empirical_share(const std::vector<Record>& records);

/// A run of the whole suite fails if more of its bounds were measured rather than reasoned [1].
constexpr double most_empirical = 0.05;

}  // namespace foldproof
