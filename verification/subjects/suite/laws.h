// The portable suite: laws of cloth, asked of any solver; and the headers that most laws need.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "verification/subjects/suite/scenes.h"
#include "verification/subjects/suite/trial.h"
#include "verification/verdict.h"

namespace foldproof {

/// A law: true of every solver, whatever its scheme. Its bound is made of the declared precision,
/// order and tolerance. `run` throws NotOffered where the solver lacks what else the law asks.
struct Law {
  std::string name, claim, source;
  std::function<Finding(Trial&)> run;

  /// Words: "L1" or "L2"; capabilities; "order", a claimed one; "f8". Who lacks one is not asked.
  /// "bending" tells that scenes have a bending rigidity, which a solver may decline.
  /// A law that holds though nothing happened in its scenes is inconclusive (Observed). "touches":
  /// a free sheet must meet an obstacle, too. "still": the law holds because nothing moves; its
  /// last scene must then deform when it is stretched.
  std::string needs = "";

  /// Columns of its evidence that say what it measured, "mu | slope", in the row where the last
  /// column is largest; none if the judged number says it.
  std::string headline = "";
};

/// `run` of a law of this scene.
std::function<Finding(Trial&)> in_scene(Finding (*measured)(Trial&, const PortableScene&),
                                        PortableScene (*scene)());

/// Smoke laws first. A file NAME_laws.cpp of this folder defines `std::vector<Law> NAME_laws()`;
/// CMake lists them.
std::vector<Law> portable_laws();

/// The outcome of a trial. Laws that were kept from an earlier one count nothing as asked.
struct Judgement {
  Declaration declaration;  // unset if the solver never started
  std::vector<std::pair<std::string, std::string>> mapping;
  std::vector<Record> records;  // one a law
  std::vector<Observed> asked;  // likewise
  bool smoke_holds = false;
};

/// What goes along with a trial; each function may be empty.
struct TrialWatch {
  std::function<void(const Law&)> before;                          // each law that is asked
  std::function<std::optional<Record>(const Law&)> kept;           // by an earlier trial
  std::function<void(const Record&, const Observed& asked)> done;  // after each law
  std::function<void(const Law&, const PortableScene&, long steps, const Snapshot&)> heard;
  double law_seconds = 0;  // longest time of a law, between calls [s]; 0: no limit
};

/// Asks the laws; a failure of the solver is the finding of its law, and the next one goes on.
/// After one that ends the trial, the others have no outcome.
/// Throws InputError if there is no such program.
///   done   is called after each law
Judgement judge_solver(const SolverCommand& command, const std::vector<Law>& laws,
                       const std::function<void(const Record&)>& done);
Judgement judge_solver(const SolverCommand& command, const std::vector<Law>& laws,
                       const TrialWatch& watch);

}  // namespace foldproof
