// A case's own error, as `foldproof ablate` compares with it: from the ladders of `foldproof
// converge`, and from the same store.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/space_ladder.h"

namespace foldproof {

/// One cause of the error of positions: root mean square by mass, in the worst frame.
struct ErrorPart {
  double seen = nan;    // distance to the finest level [m]; NaN: not known
  double value = nan;   // and the error bar of that level added [m]; NaN: not known
  std::string unknown;  // why it is not known, or not well; or ""
};

/// Where runs are kept, and who made them.
struct KeptRuns {
  const LevelSetProvider& level_sets;
  ResultStore& store;
  std::string program;  // its identity
};

/// The least number of levels that has an error bar: seven runs of the case.
constexpr int levels_of_own_error = 3;

// All of them mean the error that `foldproof converge` prints of the case as it is
// (QuantityOverLevels::first_error): the distance to the finest level, which is seen, and that
// level's error bar. Two levels show no order; as for every ladder without one the bar is then
// three times their difference (error_bar.h), four times what is seen in all.

/// The error of the case's steps, over all frames: beyond a horizon it is as large as what is left
/// to chance. Where only the third level comes to no end, that of the other two; `unknown` then
/// says why there is no better value.
ErrorPart error_of_steps(const CaseSource& source, const KeptRuns& by);

/// The error of the case's mesh from a ladder in space of `levels` meshes (>= 2), all with the
/// steps of the finest. Each mesh more takes some ten times as long.
ErrorPart error_of_mesh(const CaseSource& source, int levels, const KeptRuns& by);

/// The error of the case's mesh from the coarser mesh that these overrides make, for a case whose
/// finer mesh would take hours. The case itself is then the finest level of two: the bar is three
/// times the first-order error, and seen is the error of second order (coarser_mesh.h).
ErrorPart error_from_coarser_mesh(const CaseSource& source, const std::vector<std::string>& coarser,
                                  const KeptRuns& by);

}  // namespace foldproof
