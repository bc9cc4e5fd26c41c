// A case's own error, as `foldproof ablate` compares with it: from the ladders of `foldproof
// converge`, and from the same store; in space also from a coarser mesh, where a finer one would
// take hours.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/space_ladder.h"
#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

/// One cause of the error of positions: root mean square by mass, in the worst frame.
struct ErrorPart {
  double seen = nan;    // distance to the finest level [m]; NaN: not known
  double value = nan;   // and the error bar of that level added [m]; NaN: not known
  std::string unknown;  // why it is not known, or not well; or ""
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

/// How many times as long the sides of the coarser mesh's triangles are, which is to have triangles
/// of the same kind: the square root of how many times as large they are. Throws InputError below
/// 1.2, for a difference between meshes nearly alike says little of either, and where the area is
/// another by more than a tenth.
double coarseness(const TriangleMesh& mesh, const TriangleMesh& coarser);

/// The error that a run owes to its mesh, from a run of the same cloth on a coarser mesh
/// of its own [m]:
///     |u_coarse - u| / (r - 1),    r the coarseness,
/// u the displacement since the first frame, the difference as largest_difference takes it
/// (level_run.h). That is the error itself if it is of first order in the size of triangles, r + 1
/// times it if it is of second, and less than it, by (sqrt r + 1), if only of order 1/2. Meshes
/// need not be nested. A particle of the coarser mesh is compared with the point of the scene's
/// surface that is nearest to it in the first frame, moved linearly with its triangle: cloth that
/// starts in layers closer than its facets are flat is not for this. NaN where a run has no frames.
double error_from_coarser(const FramedRun& run, const TriangleMesh& mesh, const FramedRun& coarser,
                          const TriangleMesh& coarser_mesh);

/// The error of the case's mesh from the coarser mesh that these overrides make, for a case whose
/// finer mesh would take hours. The case itself is then the finest level of two: the bar is three
/// times the first-order error, and seen is the error of second order (error_from_coarser).
ErrorPart error_from_coarser_mesh(const CaseSource& source, const std::vector<std::string>& coarser,
                                  const KeptRuns& by);

}  // namespace foldproof
