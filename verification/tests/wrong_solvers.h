// Solvers of bad/, how they break, and the laws that they fail. For files that know
// SUBJECTS_FOLDER.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "verification/subjects/suite/laws.h"

namespace foldproof {

using Names = std::set<std::string>;

inline SolverCommand python(const std::string& program) {
  return {"exec /usr/bin/python3 " SUBJECTS_FOLDER "/" + program, {}, {}};
}

/// A solver of bad/broken.py.
inline SolverCommand broken(const std::string& kind, double seconds = 20) {
  SolverCommand command = python("bad/broken.py " + kind);
  command.limits.seconds = seconds;
  return command;
}

/// The failure of the first advance that is followed by another call.
inline SolverFailure failure_of(const SolverCommand& command) {
  try {
    PipedSolver solver(command);
    solver.prepare(suite::small_sheet());
    solver.advance(1e-3, 2);
    solver.get_state();
  } catch (const SolverFailure& failure) {
    return failure;
  }
  return {"none", "nothing failed"};
}

inline void ignore(const Record&) {}

/// Those of the laws whose names begin with one of these.
inline std::vector<Law> laws_of(const std::vector<std::string>& beginnings) {
  std::vector<Law> laws = portable_laws();
  std::erase_if(laws, [&](const Law& law) {
    return std::ranges::none_of(beginnings,
                                [&](const auto& start) { return law.name.starts_with(start); });
  });
  return laws;
}

/// Records of a solver of bad/wrong.py.
inline std::vector<Record> records_of(const std::string& kind,
                                      const std::vector<std::string>& laws) {
  return judge_solver(python("bad/wrong.py " + kind), laws_of(laws), ignore).records;
}

/// Those of the laws that it fails.
inline Names failing_laws(const std::string& kind, const std::vector<std::string>& laws) {
  Names names;
  for (const Record& record : records_of(kind, laws))
    if (record.outcome != Outcome::holds && record.outcome != Outcome::not_applicable)
      names.insert(record.name);
  return names;
}

inline std::optional<Outcome> outcome_of_law(const std::string& kind, const std::string& law) {
  return records_of(kind, {law}).at(0).outcome;
}

/// Of the laws whose names begin so (all, for ""), each of these solvers fails exactly those.
inline void require_found(const std::vector<std::string>& kinds,
                          const std::vector<std::string>& laws, const Names& failing) {
  for (const std::string& kind : kinds) {
    INFO(kind);
    CHECK(failing_laws(kind, laws) == failing);
  }
}

inline void require_law_fails(const std::string& kind, const std::string& law) {
  require_found({kind}, {law}, {law});
}

/// The law has this outcome for each of these solvers.
inline void require_outcome(const std::vector<std::string>& kinds, const std::string& law,
                            Outcome outcome) {
  for (const std::string& kind : kinds) {
    INFO(kind << " " << law);
    CHECK(outcome_of_law(kind, law) == outcome);
  }
}

}  // namespace foldproof
