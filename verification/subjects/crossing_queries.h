#pragma once

#include <string>

namespace foldproof {

/// Runs the reference and the exact judge on the queries of a file: rows of 7 whole numbers,
/// numerator and denominator of x, y and z, and the expected answer, 1 (they meet) or 0;
/// eight rows a query. kind "vertex-face": the vertex and the triangle's corners, at the start and
/// then at the end; "edge-edge": the ends of both edges likewise. Of a folder, all .csv files
/// below it. An empty kind: the path says which. Prints misses and false alarms of both against
/// the file. keep [m], > 0: the distance that the reference must keep. Returns true if the
/// reference misses none and the exact judge agrees. Throws InputError "file:line: ...". Numbers
/// have at most 1000 digits.
bool evaluate_crossings(const std::string& path, const std::string& kind, double keep);

/// Results compared with the expected answers of a file.
struct CrossingAccount {
  long misses = 0, alarms = 0;

  void record(bool truth, bool answer) {
    misses += truth && !answer;
    alarms += !truth && answer;
  }
};

struct JudgedQueries {
  size_t queries = 0;
  long meetings = 0;  // as the file says
  CrossingAccount reference, exact;
};

/// The same for a file's text; messages call it `name`.
JudgedQueries judge_queries(const std::string& text, const std::string& name,
                            const std::string& kind, double keep);

}  // namespace foldproof
