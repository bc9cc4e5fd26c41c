// The headers that nearly every check needs, and checks for each of the paper's schemes.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "verification/evidence.h"
#include "verification/subject.h"
#include "verification/verdict.h"

namespace foldproof {

/// A table for statements that are true or false, one per row.
Table no_statements();

/// Number of false statements; NaN for an empty table.
double count_false(const Table& statements);

/// A property that each scheme must have; `run` may ignore the subject.
struct SchemeCheck {
  using OfReference = std::function<Finding(const std::string& scheme)>;
  using OfSubject = std::function<Finding(const Subject&, const std::string& scheme)>;
  SchemeCheck(std::string name, std::string claim, std::string source, OfSubject run);
  SchemeCheck(std::string name, std::string claim, std::string source, OfReference run);

  std::string name, claim, source;
  OfSubject run;
};

/// Adds one check for each of the paper's schemes A, B and C; its name ends in a dot and the
/// scheme's name.
void add_for_each_scheme(std::vector<Check>& list, const std::vector<SchemeCheck>& patterns);

/// The message of the InputError that `act` throws; empty if it throws none.
std::string rejection_message(const std::function<void()>& act);

/// Number of these parts that the text lacks.
int count_missing(const std::string& text, const std::vector<std::string>& parts);

/// True if `act` throws an InputError whose message contains the words.
bool is_rejected(const std::function<void()>& act, const std::string& words);

}  // namespace foldproof
