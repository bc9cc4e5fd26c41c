// A case's own error, as `foldproof ablate` compares with it: from the ladders of `foldproof
// converge`, and from the same store.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/space_ladder.h"

namespace foldproof {

/// One cause of the error of positions: root mean square by mass, in the worst frame.
struct ErrorPart {
  double value = nan;   // m; NaN: not known
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

/// The error of the case's steps, "as it is" of a ladder in time (QuantityOverLevels::first_error),
/// over all frames: beyond a horizon it is as large as what is left to chance. Where only the third
/// level comes to no end, the difference of the other two, and three times it as a spread;
/// `unknown` then says why there is no better value.
ErrorPart error_of_steps(const CaseSource& source, const KeptRuns& by);

/// The difference between the case's mesh and the next finer one of its ladder in space, both with
/// the finer one's steps. Not extrapolated, since two meshes show no order: an error of first
/// order is twice it, one of second order 4/3 of it. A third mesh would take as long as all other
/// runs of an ablation.
ErrorPart error_of_mesh(const CaseSource& source, const KeptRuns& by);

/// The error of the case's mesh from the coarser mesh that these overrides make (coarser_mesh.h),
/// for a case whose finer mesh would take hours.
ErrorPart error_from_coarser_mesh(const CaseSource& source, const std::vector<std::string>& coarser,
                                  const KeptRuns& by);

}  // namespace foldproof
