// What a verification says: verdicts, findings, the evidence behind them, and the checks and studies that
// make them.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace foldproof {

struct Subject;

enum class Ruling { holds, fails, inconclusive, not_applicable };

std::string_view name_of(Ruling ruling);  // "holds", "fails", "inconclusive", "not applicable"

/// A measured number against its bound. Every statement is put so that smaller is better.
struct Verdict {
  double measured = 0, bound = 0, uncertainty = 0;  // all in `unit`
  std::string unit;                                 // "1" for none
  std::string why_bound;                            // the bound's reason in words
};

/// holds iff measured + uncertainty <= bound, fails iff measured - uncertainty > bound, else inconclusive. Fails,
/// too, if one of them is NaN, the bound infinite or the uncertainty negative.
Ruling ruling(const Verdict& verdict);

/// One column of evidence; the columns of a finding have the same length.
struct Column {
  std::string name, unit;
  std::variant<std::vector<double>, std::vector<std::string>> values;
};

struct Finding {
  Verdict verdict;
  std::vector<Column> evidence;
  std::string note;  // what a reader has to know beside the numbers; may be empty
};

/// A maximum that keeps NaN: once a NaN was seen, it stays.
class Worst {
 public:
  void see(double value);
  double value() const { return worst_; }  // 0 if nothing was seen

 private:
  double worst_ = 0;
};

/// A property that the subject must have. `run` may throw NotOffered.
struct Check {
  std::string name;    // "subject-matter.statement-in-the-present-tense"
  std::string claim;   // one sentence, true when the check passes
  std::string source;  // paper section or citation
  std::function<Finding(const Subject&)> run;
};

/// Thrown by a check whose subject lacks an operation: the check is "not applicable".
struct NotOffered {
  std::string operation;
};

/// What a point of a curve stands for: measured, measured though a solve on the way did not finish, or a run
/// that diverged, which has an x but no y.
enum class Mark { measured, unfinished, diverged };

std::string_view name_of(Mark mark);  // "measured", "unfinished", "diverged"

/// A number that is not there: no floor, no slope, a gap in a curve.
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A curve of a figure; floor is the level below which its y means nothing (NaN: none).
struct Curve {
  std::string label;
  std::vector<double> x, y;
  double floor;
  std::vector<double> pair_orders;  // observed order of each neighbouring pair; empty if orders make no sense
  double slope = nan;               // expected of this curve in log-log, NaN: none
  std::vector<Mark> marks = {};     // one a point; empty: all measured
};

enum class Scale { linear, log };

struct Axis {
  std::string label, unit;
  Scale scale;
};

struct Figure {
  std::string name, title;
  Axis x, y;
  double slope;  // expected in log-log, NaN: none
  std::string caption;
  std::vector<Curve> curves;
};

/// A quantity over two parameters.
struct Map {
  std::string name, title;
  Axis x, y;
  std::vector<double> x_values, y_values;  // ascending, in the axes' units
  std::vector<double>
      values;  // in `unit`, row by row: [iy * x_values.size() + ix]; NaN: no value, as the caption says
  std::string quantity, unit;  // what the values are
  Scale scale;                 // of the values
  std::string caption;
  std::vector<Curve> curves;  // drawn over the map, on its axes: limits known beforehand
};

struct Table {
  std::string name, title;
  std::vector<Column> columns;
};

enum class Tier { quick, full };

/// Told how far a study has come, from 0 to 1.
using Progress = std::function<void(double)>;

struct NamedFinding {
  std::string name;   // the study's name, a dot, and which of its measurements
  std::string claim;  // one sentence
  Finding finding;
};

struct StudyResult {
  std::vector<NamedFinding> findings;
  std::vector<Figure> figures;
  std::vector<Map> maps;
  std::vector<Table> tables;
};

/// Measures a rate or a cost over a range: its findings are judged like checks, its curves are evidence.
struct Study {
  std::string name, claim, source;
  std::string about;  // a paragraph for the report
  std::function<StudyResult(const Subject&, Tier, const Progress&)> run;
};

/// A finding with all that a reader wants to know of it: what a run records.
struct Record {
  std::string name, kind, study;  // kind "check", "study" or "bench"; study: the name of the study, or ""
  std::string claim, source;
  Finding finding;
  std::string outcome;  // name_of(ruling), or "measured" for a bench
  std::string better;   // bench only: "higher" or "lower"
  double seconds = 0;
  std::vector<std::string> faults;  // seeded faults that it catches
};

struct StudyRecord {
  std::string name, claim, source, about;
  double seconds = 0;
  std::vector<Figure> figures;
  std::vector<Map> maps;
  std::vector<Table> tables;
};

/// Runs a check or a study. A check that throws anything but NotOffered fails, with the message as its note.
Record run_check(const Check& check, const Subject& subject);
std::pair<std::vector<Record>, StudyRecord> run_study(const Study& study, const Subject& subject, Tier tier,
                                                      const Progress& progress);

}  // namespace foldproof
