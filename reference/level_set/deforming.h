// Deforming bodies: a level set for each frame of an animation, and interpolation between frames
// (BMF03 section 5.1).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "reference/fast/team.h"
#include "reference/level_set/octree.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

/// How a frame tells inside from outside.
enum class Inside {
  normals,  // by the normal of the nearest feature: closed meshes without intersections
  // where the winding number is at least 1/2: any triangles whose normals point outward
  winding
};

/// A mesh in motion: the same triangles at every frame. Between frames each vertex moves straight
/// and evenly; it is at rest before the first and after the last.
struct MeshSequence {
  std::vector<Triangle> triangles;      // M
  std::vector<double> times;            // F, rising [s]
  std::vector<PerParticle3> positions;  // F of 3 x N [m]
  Inside inside = Inside::normals;
};

/// Position at time t [s] of the point whose rest position is X.
using Deformation = std::function<Vector3(const Vector3& X, double t)>;

/// The mesh carried through a deformation, one frame per time.
MeshSequence deformed_mesh(const TriangleMesh& mesh, const Deformation& deformation,
                           std::vector<double> times);

/// The vertices at time t [s], 3 x N [m].
PerParticle3 positions_at(const MeshSequence& sequence, double t);

struct SequenceSource {
  std::string path;     // as in mesh/mesh_frames.h
  double interval = 0;  // between two frames [s]; 0: the times of a file that has them, or 1/30 s
  std::vector<Triangle> triangles = {};  // M, of frames that have none
  long most = 1000;                      // frames
  Inside inside = Inside::normals;
};

/// The frames of a folder or a cache, from time 0 on, or at the times that it states. Throws
/// InputError naming the file: what read_mesh_frames refuses, a gap in the numbers of files, frames
/// without triangles, triangles that differ from the first frame's, or, with Inside::normals, what
/// make_triangle_mesh refuses. Vertices that no triangle uses are left out.
MeshSequence read_mesh_sequence(const SequenceSource& source);

/// A frame's level set. A node has the displacement of the nearest surface point, so it is constant
/// along N.
struct DeformingFrame {
  double time;  // s
  Octree field;
  // per branch, to the next frame; empty for the last frame [m]
  std::vector<BranchNodes<Vector3>> to_next;
  // per branch, from the frame before; empty for the first [m]
  std::vector<BranchNodes<Vector3>> from_previous;
  // during the build: distinct nodes, and nodes with a search for the nearest point
  long nodes = 0, searches = 0;
};

/// Interpolation of phi and v between two frames.
enum class BetweenFrames {
  // both linearly in time, at the point: a body that moves by more than its size
  // vanishes in between
  blended,
  // linearly in time, between the places where the point's own motion puts it at the two frames
  carried
};

struct DeformingBody {
  std::vector<DeformingFrame> frames;  // at least one
  BetweenFrames between;
};

/// Level sets of every frame, as octrees that cover the cube of the settings. Within the settings'
/// band around the surface a node's value is exact. Beyond it a frame reuses the nearest points of
/// the previous frame while they are close enough. There |phi| may be too large by half of a cell's
/// allowed error, beyond (|phi| - band)/2, and the displacement is the reused point's. Throws what
/// make_octree throws, and InputError for a sequence without frames, with times that do not rise or
/// numbers of vertices that differ. The same bits for every team.
///
/// Inside::winding: the distance is to the triangles that have an inside and an outside, those that
/// lie within the body left out; no node reuses anything. Outside it is the distance to the union;
/// inside it may be too small near triangles that others cross, by their size at most. Throws
/// InputError for a frame without a node inside.
DeformingBody make_deforming_body(const MeshSequence& sequence, const OctreeSettings& settings,
                                  BetweenFrames between, const Team& team = {});

/// phi and N at the point p and time t, and the velocity [m/s] of the body there.
struct DeformingPoint {
  double phi;
  Vector3 normal, velocity;
};

DeformingPoint deforming_at(const DeformingBody& body, const Vector3& p, double t);

/// Position at time `end` of the body's point that is at p at time `start` [m].
Vector3 advected_position(const DeformingBody& body, const Vector3& p, double start, double end);

}  // namespace foldproof
