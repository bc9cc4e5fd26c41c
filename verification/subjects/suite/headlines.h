// What a law measured, in the words and units of its evidence, where the judged number is another.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "verification/verdict.h"

namespace foldproof {

/// Columns of a law's evidence that make its headline: those of the row where `judged` is worst.
struct HeadlineColumns {
  std::string_view law, judged;
  std::vector<std::string_view> shown;
};

const std::vector<HeadlineColumns>& headline_columns();

/// "observed 0.98, claimed 2"; "" for a law whose judged number says it, and without evidence.
std::string headline_of(std::string_view law, const Finding& finding);

/// What a bisection between two numbers found: "0.235", or ">= 0.299" if it ended where it began.
std::string found_text(const std::array<double, 2>& found, const std::array<double, 2>& tried);

}  // namespace foldproof
