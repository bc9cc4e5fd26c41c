#include "verification/checks/oracles/agreement.h"

namespace foldproof {

namespace {

/// All, in the order of display.
std::vector<Comparison> comparisons() {
  std::vector<Comparison> all;
  for (const auto& part : {force_comparisons, motion_comparisons, static_comparisons,
                           strip_comparisons, geometry_comparisons})
    for (const Comparison& comparison : part()) all.push_back(comparison);
  return all;
}

/// The results of both methods of a comparison.
Answers answers_of(const Comparison& comparison) {
  Answers answers;
  comparison.compare(answers);
  return answers;
}

Finding uncertainties_are_small() {
  Table largest(
      "comparison; largest uncertainty of a pair, of its answer [1]; allowed [1]; over what is "
      "allowed [1]");
  for (const Comparison& comparison : comparisons()) {
    const double uncertainty = answers_of(comparison).largest_uncertainty();
    largest.row(comparison.name, uncertainty, comparison.allowed, uncertainty / comparison.allowed);
  }
  return judge_worst(largest, 1,
                     "two answers may agree merely because one of them is very uncertain: the "
                     "crudest, by differences in double precision, is good to five digits; "
                     "stresses of a clamped sheet, which are infinite in its corners, to three");
}

}  // namespace

std::vector<Check> oracle_checks() {
  std::vector<Check> list;
  for (const Comparison& comparison : comparisons())
    list.push_back({comparison.name, comparison.claim, "verification/oracles/README.md",
                    [comparison] { return answers_of(comparison).judged_agreement(); }});
  list.push_back({"oracle.uncertainties-are-small",
                  "The uncertainty of any two compared answers is a small part of the answer.",
                  "verification/oracles/README.md", uncertainties_are_small});
  return list;
}

}  // namespace foldproof
