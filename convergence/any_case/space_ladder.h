// A case on finer and finer meshes: the same cloth, the same holds, the same steps.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/converge.h"

namespace foldproof {

/// How a case is read.
struct CaseSource {
  std::string path;                    // of its file
  std::vector<std::string> overrides;  // as typed
  std::string method;                  // integrator in place of the case's own; "" for that
  double until = 0;                    // the run ends here [s]; 0: at the case's own end
};

/// The case; read_case's errors.
Case case_of(const CaseSource& source);

/// One mesh of the ladder: the case's file read with further overrides, so that `foldproof
/// simulate` can run it alone.
struct SpaceLevel {
  std::vector<std::string> overrides;  // that make it finer; none for level 0
  Case input_case;
  std::vector<int> common;  // N of level 0: the particle here that each particle there is
  double edge = 0;          // of an equilateral triangle as large as the mean one at rest [m]
};

/// All meshes, coarse to fine.
struct SpaceLadder {
  std::vector<SpaceLevel> levels;
  std::string refined_by;             // "columns, rows", or "middles of edges"
  std::vector<std::string> warnings;  // a sentence each
};

enum class ObjectsToo { no, yes };

/// Level 0 is the case as it is; level k has edges 2^k times as short.
///   by numbers     shapes whose finer mesh has all particles of the coarser one: sheets of
///                  columns and rows, discs, cylinders, spheres; they approach the shape itself
///   by middles     all else, by [cloth] refine: files, hinges, statues, irregular sheets, graded
///                  ones; and where something goes by the number of a particle, a triangle or a
///                  hinge: noise of the start, one rest angle for all hinges, sticky triangles
/// Boxes, spheres, groups and `top` mean regions and are asked anew on each mesh; lists of
/// particles mean points, the same ones on each mesh. A thickness of self-collision too large for
/// finer triangles becomes what they allow. objects: yes, if level sets get cells as much smaller.
/// Throws InputError, "level k: ...", for a mesh that a case may not have.
SpaceLadder space_ladder(const CaseSource& source, int levels, ObjectsToo objects);

/// For each column of `of` (3 x n [m]) the column of `among` (3 x m) closer than `tolerance` [m].
/// Empty if one of them has none, or more than one.
std::vector<int> matching_points(const PerParticle3& of, const PerParticle3& among,
                                 double tolerance);

/// The run of level k. step_ends: those of all levels; empty for the finest, which makes them by
/// its own rule. That rule is the case's for an automatic step; a fixed step is divided by 2 a
/// level, since an elastic limit falls with the edges.
Level space_level(const SpaceLadder& ladder, int k, const std::vector<double>& step_ends);

/// The run that tells how much the steps of the ladder matter: the second-finest mesh, with
/// each step halved.
Level step_check_level(const SpaceLadder& ladder, const std::vector<double>& step_ends);

/// Reads all levels, coarse to fine, with the formal order 2 in space. halved: the run of
/// step_check_level. A time error above a tenth of the last difference in space is warned
/// of: below it, it changes an observed order by at most log2(1.1) = 0.14, less than what is
/// taken for the same order.
LadderAnswer space_answer(const SpaceLadder& ladder, const std::vector<LevelRun>& runs,
                          const LevelRun& halved);

}  // namespace foldproof
