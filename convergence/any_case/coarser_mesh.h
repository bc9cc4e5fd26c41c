// The scene's own error in space from a coarser mesh, where a finer one would take hours.
#pragma once

#include "convergence/any_case/framed_run.h"
#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

/// How many times as long the sides of the coarser mesh's triangles are, which is to have triangles
/// of the same kind: the square root of how many times as large they are. Throws InputError below
/// 1.2, for a difference between meshes nearly alike says little of either, and where the area is
/// another by more than a tenth.
double coarseness(const TriangleMesh& mesh, const TriangleMesh& coarser);

/// The error that a run owes to its mesh, from a run of the same cloth on a coarser mesh
/// of its own [m]:
///     |u_coarse - u| / (r - 1),    r the coarseness,
/// u the displacement since the first frame, the difference as largest_difference takes it
/// (distances.h). That is the error itself if it is of first order in the size of triangles, r + 1
/// times it if it is of second, and less than it, by (sqrt r + 1), if only of order 1/2. Meshes
/// need not be nested. A particle of the coarser mesh is compared with the point of the scene's
/// surface that is nearest to it in the first frame, moved linearly with its triangle: cloth that
/// starts in layers closer than its facets are flat is not for this. NaN where a run has no frames.
double error_from_coarser(const FramedRun& run, const TriangleMesh& mesh, const FramedRun& coarser,
                          const TriangleMesh& coarser_mesh);

}  // namespace foldproof
