// How far is a cloth, of any program or captured, from that of a run? Frame by frame, in numbers.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "reference/scene/scene.h"
#include "verification/cases/folds.h"
#include "verification/figures.h"

namespace foldproof {

/// One frame of the other cloth.
struct TimedMesh {
  std::string file;                 // that it was read from, for messages
  double time;                      // s
  PerParticle3 x;                   // 3 x N [m]
  std::vector<Triangle> triangles;  // empty: points alone
};

/// How a frame's vertices are matched to the run's particles.
enum class Matching {
  particles,  // as many, and the same triangles: vertex i is particle i
  surface,    // another mesh of the cloth: nearest points of the surfaces are compared
  points      // points without triangles: one-sided, to the run's surface
};

// "vertex by vertex", "by nearest points", "one-sided, points to the run's surface"
std::string_view name_of(Matching matching);

/// Whether every frame has as many vertices and these triangles, in any order of the triangles and
/// of their corners.
bool has_faces(Eigen::Index vertices, const std::vector<Triangle>& triangles,
               std::span<const TimedMesh> frames);

/// particles if every frame has the cloth's particles and triangles; points if one has no triangle.
Matching matching_of(const TriangleMesh& cloth, std::span<const TimedMesh> frames);

/// Why vertices are no particles: the first frame, and its first triangle, that differ from the
/// cloth's; "" if matching_of is `particles`.
std::string mesh_difference(const TriangleMesh& cloth, std::span<const TimedMesh> frames);

/// Between two frames of a run, by the cubic that has their positions and velocities. t in
/// [a.time, b.time] [s].
State state_between(const State& a, const State& b, double t);

/// One cloth at one time.
struct ClothShape {
  double stretch, bending;  // energies by the run's own forces [J]; NaN of another mesh
  FoldSpectrum folds;       // NaN of what is no oriented manifold
  double crossings;         // pairs of an edge and a triangle that meet, decided exactly; or NaN
  double depth;             // of the deepest vertex inside an object of the run [m]; 0: none is
};

/// Distances of two cloths. Vertex by vertex: of each particle. By nearest points: of each vertex
/// of either mesh to the surface of the other. One-sided: of each point to the run's surface.
struct ClothDistance {
  // root mean square [m], each vertex weighted with a third of its triangles' areas, a particle
  // with those at rest: it belongs to the surfaces, not to their meshes; points count alike
  double rms;
  double largest;  // m
};

struct FrameComparison {
  std::string file;
  double time;  // s
  ClothDistance distance;
  ClothShape run, frame;
};

/// The run that frames are held against.
struct ComparedRun {
  const Scene& scene;
  const BuiltScene& built;
  Matching matching;
};

/// at: the run's state at the frame's time.
FrameComparison compare_frame(const ComparedRun& run, const State& at, const TimedMesh& frame);

/// A figure over time.
Figure over_time(const std::string& name, const std::string& title, const Axis& y,
                 const std::string& caption, const std::vector<Curve>& curves);

/// The comparison of whole sequences as tables and figures of a study, for a report.
struct ComparisonEvidence {
  std::vector<Table> tables;
  std::vector<Figure> figures;
};
ComparisonEvidence evidence_of(const std::vector<FrameComparison>& frames, Matching matching);

}  // namespace foldproof
