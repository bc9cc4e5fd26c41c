// The answer of the search for the cheapest method, in words, figures and tables.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/precision.h"
#include "verification/verdict.h"

namespace foldproof {

/// One sentence for each wanted error: which method is cheapest, with which step, what the others
/// cost over it, and which do not reach the error.
std::vector<std::string> precision_sentences(const PrecisionAnswer& answer);

/// How the truth is known, in a sentence.
std::string truth_in_words(const PrecisionAnswer& answer);

/// Why methods appear that nobody requested; "" if none does.
std::string for_truth_in_words(const PrecisionAnswer& answer);

/// As the built-in studies are recorded, under the name precision.CASE. seconds: that it took [s].
StudyRecord precision_record(const PrecisionAnswer& answer, double seconds);

}  // namespace foldproof
