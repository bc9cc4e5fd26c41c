// A study measures a rate or a cost over a range: its findings are judged like checks, its
// curves are evidence. With this header comes what most studies use.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "convergence/order.h"
#include "convergence/ranges.h"
#include "convergence/tables.h"
#include "verification/verdict.h"

namespace foldproof {

struct NamedFinding {
  std::string name;   // the study's name, a dot, and which of its measurements
  std::string claim;  // one sentence
  Finding finding;
};

struct StudyResult {
  std::vector<NamedFinding> findings = {};
  std::vector<Figure> figures = {};  // shown if a curve has three points
  std::vector<Map> maps = {};
  std::vector<Table> tables = {};

  void add(std::vector<NamedFinding> more) {
    for (NamedFinding& finding : more) findings.push_back(std::move(finding));
  }
};

struct Study {
  std::string name, claim;
  // Families of findings without which the claim would not stand; it is true if all of them hold. A
  // family is a finding's name after that of its study and the dot, or such a name up to another
  // dot: "exponent" is "elastic-limit.exponent.springs" and "elastic-limit.exponent.bending".
  std::vector<std::string> rests_on;
  std::string source;
  std::string about;  // a paragraph for the report
  std::function<StudyResult(const Subject&, Tier, const Progress&)> run;
  // of its findings: "study", or "validation" for one that compares with something measured, or
  // with the continuum that the paper means
  std::string kind = "study";
};

/// Runs a study: one record for each of its findings; one that failed, with the message, if it
/// threw or has no finding of a family that its claim rests on.
std::pair<std::vector<Record>, StudyRecord> run_study(const Study& study, const Subject& subject,
                                                      Tier tier, const Progress& progress);

}  // namespace foldproof
