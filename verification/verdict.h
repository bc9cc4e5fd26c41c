// Verdicts, findings, their evidence, and the checks and studies that produce them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "verification/evidence.h"
#include "verification/figures.h"

namespace foldproof {

struct Subject;

enum class Outcome { holds, fails, inconclusive, not_applicable };

std::string_view name_of(Outcome outcome);  // "holds", "fails", "inconclusive", "not applicable"

/// A measured number and its bound. Every statement is phrased so that smaller is better.
struct Verdict {
  double measured = 0, bound = 0, uncertainty = 0;  // all in `unit`
  std::string unit;                                 // "1" for none
  std::string why_bound;                            // the reason for the bound
};

/// holds iff measured + uncertainty <= bound, fails iff measured - uncertainty > bound, else
/// inconclusive. Also fails if one of them is NaN, the bound infinite or the uncertainty negative.
Outcome outcome_of(const Verdict& verdict);

struct Finding {
  Verdict verdict;
  Table evidence;
  std::string note = {};  // context that the numbers need; may be empty
  // the measured value, in words and units, if the judged number is another; may be empty
  std::string headline = {};
  // for a failure without a number: what happened; the same text for the same reason
  std::string failure = {};
};

/// Judges the worst number of a column (Table::worst), with the largest uncertainty of the column,
/// against a bound in the column's unit.
Finding judge_worst(Table evidence, std::string_view column, double bound, std::string why_bound,
                    std::string note = "");

/// The same for the table's last column.
Finding judge_worst(Table evidence, double bound, std::string why_bound, std::string note = "");

/// A property that the subject must have. `run` may throw NotOffered; a check that uses the
/// reference alone passes a function without a parameter.
struct Check {
  using OfSubject = std::function<Finding(const Subject&)>;
  Check(std::string name, std::string claim, std::string source, OfSubject run);
  Check(std::string name, std::string claim, std::string source, std::function<Finding()> run);

  std::string name;    // "subject-matter.statement-in-the-present-tense"
  std::string claim;   // one sentence, true when the check passes
  std::string source;  // paper section or citation
  OfSubject run;
};

/// Thrown by a check whose subject lacks an operation: the check is "not applicable".
struct NotOffered {
  std::string operation;
};

enum class Tier { quick, full };

/// Receives the progress of a study, from 0 to 1.
using Progress = std::function<void(double)>;

/// A finding with its context, as recorded by a run.
struct Record {
  // kind "check", "study" or "bench"; study: the name of the study, or ""
  std::string name, kind, study;
  std::string claim, source;
  Finding finding;
  std::optional<Outcome> outcome;  // none for a bench, and before the run
  std::string better;              // bench only: "higher" or "lower"
  double seconds = 0;
  std::vector<std::string> faults;  // seeded faults that the check catches
};

/// True if the outcome is missing, which only a bench may lack.
bool did_not_run(const Record& record);

/// The outcome as spelt in files and listings: name_of it, else "measured" (a bench) or "did not
/// run".
std::string_view outcome_text(const Record& record);

struct StudyRecord {
  std::string name, claim, source, about;
  double seconds = 0;
  std::vector<Figure> figures;
  std::vector<Map> maps;
  std::vector<Table> tables;
};

/// Runs a check. One that throws anything but NotOffered fails, with the message as its note.
Record run_check(const Check& check, const Subject& subject);

/// Runs `act`, which returns a check's or a study's finding, and completes the record: outcome,
/// note on what was thrown, seconds.
Record judge(Record record, const std::function<Finding()>& act);

}  // namespace foldproof
