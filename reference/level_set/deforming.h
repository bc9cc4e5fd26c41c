// Bodies that deform: a level set for each frame of an animation, and what lies between two frames
// (BMF03 section 5.1).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "reference/level_set/octree.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

/// A closed mesh in motion: the same triangles at every frame. Between frames each vertex moves
/// straight and evenly; before the first and after the last it rests.
struct MeshSequence {
  std::vector<Triangle> triangles;      // M
  std::vector<double> times;            // F, rising [s]
  std::vector<PerParticle3> positions;  // F of 3 x N [m]
};

/// Where the point that is at X at rest is at time t [s].
using Deformation = std::function<Vector3(const Vector3& X, double t)>;

/// The mesh carried through a deformation, a frame at each of the times.
MeshSequence deformed_mesh(const TriangleMesh& mesh, const Deformation& deformation,
                           std::vector<double> times);

/// The vertices at time t [s], 3 x N [m].
PerParticle3 positions_at(const MeshSequence& sequence, double t);

/// All files *.obj of a folder in the order of their names, `interval` [s] apart from time 0 on.
/// Throws InputError naming the file: none, more than `most`, one whose triangles differ from the
/// first's, what read_obj refuses.
MeshSequence read_obj_sequence(const std::string& folder, double interval, long most = 1000);

/// A frame's level set. The displacement at a node is that of the surface point nearest to it, so
/// that it is constant along N.
struct DeformingFrame {
  double time;  // s
  Octree field;
  // one a branch, up to the next frame; last frame: none [m]
  std::vector<BranchNodes<Vector3>> to_next;
  // one a branch, since the frame before; first: none [m]
  std::vector<BranchNodes<Vector3>> from_previous;
  // while it was built: distinct nodes, and those whose nearest point was looked for
  long nodes = 0, searches = 0;
};

/// How phi and v are interpolated between two frames.
enum class BetweenFrames {
  // both linearly in time, at the point: a body that moves by more than its size
  // vanishes in between
  blended,
  // linearly in time, between the places that the point's own motion takes it to at the two frames
  carried
};

struct DeformingBody {
  std::vector<DeformingFrame> frames;  // at least one
  BetweenFrames between;
};

/// Level sets of every frame, as octrees that cover the cube of the settings. Within the settings'
/// band of the surface a node's value is exact. Beyond it a frame keeps the frame before's nearest
/// points where they are still near enough: there |phi| may be too large by half of what a cell may
/// miss, beyond (|phi| - band)/2, and the displacement is that of the point that was kept. Throws
/// what make_octree throws, and InputError for a sequence without frames, with times that do not
/// rise or numbers of vertices that differ.
DeformingBody make_deforming_body(const MeshSequence& sequence, const OctreeSettings& settings,
                                  BetweenFrames between);

/// phi and N at the point p and time t, and the velocity [m/s] of the body's point there.
struct DeformingPoint {
  double phi;
  Vector3 normal, velocity;
};

DeformingPoint deforming_at(const DeformingBody& body, const Vector3& p, double t);

/// Where the body takes the point that is at p at time `start` until the time `end` [m].
Vector3 advected_position(const DeformingBody& body, const Vector3& p, double start, double end);

}  // namespace foldproof
