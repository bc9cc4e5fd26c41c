// A run with all that its files hold, for the tests of those files: every value differs from all
// others, and from its default.
#pragma once

#include <cmath>

#include "verification/files/results_file.h"

namespace foldproof {

inline Record full_record() {
  Record record;
  record.name = "law.full", record.kind = "bench", record.study = "of-steps";
  record.claim = "it is so", record.source = "BMF03 section 7";
  record.finding.verdict = {3.25, 4.5, 0.125, "steps", "empirical: twice the largest"};
  record.finding.evidence = Table{{"step", "s"}, {"case", ""}, {"error", "m"}};
  record.finding.evidence.row(0.5, "drape", -2.75);
  record.finding.evidence.row(0.25, "twist", 1e-9);
  record.finding.note = "a <note>";
  record.better = "lower", record.seconds = 6.5;
  return record;
}

/// One without all that may be missing.
inline Record bare_record() {
  Record record;
  record.name = "law.bare", record.kind = "check";
  record.finding.verdict = {0.375, 0.75, 0, "1", "by hand"};
  record.outcome = Outcome::not_applicable;
  return record;
}

/// Figures with a curve that has all, and one with the least; a map of 3 x 2 points; a table.
inline StudyRecord full_study() {
  const double none = std::nan("");
  const Curve full{"marked",
                   {0.5, 0.25, 0.125},
                   {7, 9, none},
                   1e-12,
                   {1.75, 2.5},
                   3.5,
                   {Mark::unfinished, Mark::measured, Mark::diverged}},
      bare{"bare", {1.5, 2.5}, {-4, 6.5}, none, {}};
  const Axis step{"step", "ms", Scale::log}, damping{"damping", "kg/s", Scale::linear};
  const Figure figure{"convergence", "A title", step, damping, 4.5, "as expected.", {full, bare}},
      empty{"empty", "Nothing", damping, step, none, "", {}};
  const Map map{"stability",
                "Where it is",
                damping,
                step,
                {0.25, 0.5, 0.75},
                {10, 20},
                {1.5, 2.5, 3.5, 4.5, 5.5, 6.5},
                "growth",
                "1/s",
                Scale::log,
                "of one mode.",
                {bare}};
  const Table table("first", "One", Table{{"case", ""}, {"length", "m"}}.with_row("c", 0.875));
  return {"steps", "they converge", "theory", "about it", 9.5, {figure, empty}, {map}, {table}};
}

inline ClaimRecord full_claim() {
  Claim claim{"BMF03", "stiff", "7.3", "it is > stiff", {}, Ruling::refuted, "if dry", "because"};
  claim.decided_by = {{"law.full", Role::limits}, {"law.bare", Role::contradicts}};
  claim.cited = {4, "We saw", "a + b", "a - b"};
  claim.missing = "a lab", claim.paper_title = "Folds (2003)";
  return {claim, {"fails", "missing"}, Ruling::conditional};
}

inline RunRecord full_run() {
  RunRecord run;
  run.provenance = {"v3", "c4", "dirty", "gcc", "-O7", "Odd", "a cpu", "a date", "a command", 5};
  run.tier = "full", run.subject = "a solver", run.subject_version = "v8";
  run.seed = 37, run.seconds = 12.25;
  run.records = {full_record(), bare_record()};
  run.studies = {full_study(), {"bare", "a claim", "a source", "an about", 2.25, {}, {}, {}}};
  run.cases = {{"drape", "drape.h5", "Drape", "of a sheet", 3.5, "it diverged"},
               {"twist", "twist.h5", "Twist", "of a rope", 4.25, ""}};
  run.claims = {full_claim()};
  run.origins = {{"0123456789abcdef", "clean", "day 1", 12},
                 {"fedcba9876543", "dirty", "day 2", 1}};
  return run;
}

}  // namespace foldproof
