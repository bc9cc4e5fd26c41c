// Frames in the numbering of a case's cloth: points without faces, and meshes before sewing.
#pragma once

#include <string>
#include <vector>

#include "verification/cases/frame_comparison.h"

namespace foldproof {

struct CaseFrames {
  std::vector<TimedMesh> frames;
  std::string seams;  // what was done with seams, or unused vertices, in words; "": nothing
};

/// Points without faces get the triangles of the case's cloth if they are as many as its particles,
/// or those of its mesh file before its seams were closed if they are as many as its vertices.
/// Vertices numbered as in that file, with its triangles in any order, become particles: each is at
/// the first vertex that the seams joined. If such vertices are farther apart than the case's
/// `seams` and the rounding of six digits, the frames stay as they are, and `seams` says where.
/// Other meshes lose the vertices that no triangle uses.
CaseFrames frames_of_case(const Scene& scene, std::vector<TimedMesh> frames);

}  // namespace foldproof
