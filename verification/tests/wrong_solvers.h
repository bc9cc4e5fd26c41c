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
#include "verification/subjects/suite/scenes.h"

namespace foldproof {

inline SolverCommand python(const std::string& program) {
  return {"exec /usr/bin/python3 " SUBJECTS_FOLDER "/" + program, {}, {}};
}

/// A solver of bad/broken.py.
inline SolverCommand broken(const std::string& kind) {
  SolverCommand command = python("bad/broken.py " + kind);
  command.limits.seconds = 20;
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
    return std::ranges::none_of(
        beginnings, [&](const std::string& beginning) { return law.name.starts_with(beginning); });
  });
  return laws;
}

/// Those of the laws that a solver of bad/wrong.py fails.
inline std::set<std::string> failing_laws(const std::string& kind, const std::vector<Law>& laws) {
  std::set<std::string> names;
  for (const Record& record : judge_solver(python("bad/wrong.py " + kind), laws, ignore).records)
    if (record.outcome != Outcome::holds && record.outcome != Outcome::not_applicable)
      names.insert(record.name);
  return names;
}

inline std::set<std::string> failing_laws(const std::string& kind) {
  return failing_laws(kind, portable_laws());
}

inline std::optional<Outcome> outcome_of_law(const std::string& kind, const std::string& law) {
  const SolverCommand command = python("bad/wrong.py " + kind);
  return judge_solver(command, laws_of({law}), ignore).records.at(0).outcome;
}

inline void require_law_fails(const std::string& kind, const std::string& law) {
  INFO(kind);
  CHECK(failing_laws(kind, laws_of({law})) == std::set<std::string>{law});
}

}  // namespace foldproof
