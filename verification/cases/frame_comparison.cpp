#include "verification/cases/frame_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/level_set/mesh_distance.h"
#include "reference/level_set/object.h"
#include "reference/mesh/box_tree.h"
#include "reference/mesh/seams.h"
#include "verification/oracles/exact_crossings.h"

namespace foldproof {

namespace {

/// The triangles, each from its lowest corner on, sorted: the same for the same faces.
std::vector<Triangle> sorted_faces(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::ranges::rotate(t, std::ranges::min_element(t));
  std::ranges::sort(triangles);
  return triangles;
}

/// The first triangle that is none of these sorted faces, in words; "" if all are.
std::string first_other_triangle(const std::vector<Triangle>& triangles,
                                 const std::vector<Triangle>& faces) {
  const auto is_face = [&](const Triangle& t) {
    return std::ranges::binary_search(faces, sorted_faces({t}).front());
  };
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const Triangle& t = triangles[k];
    if (is_face(t)) continue;
    const bool is_reversed = is_face({t[0], t[2], t[1]});
    return fmt::format("triangle {}, ({}, {}, {}), is {} (all counted from 0)", k, t[0], t[1], t[2],
                       is_reversed ? "one of the case's turned over" : "none of the case's");
  }
  return "";
}

/// ", of them 2 in no triangle" and the like: where other vertices than the case's may come from.
std::string vertices_to_spare(const TimedMesh& frame) {
  const TriangleSoup used = without_unused_vertices({frame.x, frame.triangles, {}});
  std::string words;
  if (const auto unused = frame.x.cols() - used.rest.cols(); unused > 0)
    words += fmt::format(", of them {} in no triangle", unused);
  const double near = 1e-6 * bounds_of(used.rest).sizes().maxCoeff();
  if (!(near > 0)) return words;
  const auto joined = used.rest.cols() - close_seams({used.rest, {}, {}}, near).rest.cols();
  if (joined > 0)
    words += fmt::format(
        ", of them {} that coincide with others, as at UV seams (seams = {:.1g} "
        "joins them)",
        joined, near);
  return words;
}

/// A third of each adjacent triangle's area [m^2].
PerParticle areas_of_vertices(const PerParticle3& x, const std::vector<Triangle>& triangles) {
  const Eigen::VectorXd areas = triangle_areas(triangles, x);
  PerParticle all = PerParticle::Zero(x.cols());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const int v : triangles[t]) all[v] += areas[Eigen::Index(t)] / 3;
  return all;
}

/// Of each vertex of x to the surface [m].
PerParticle distances_to(const MeshDistance& surface, const PerParticle3& x) {
  PerParticle all(x.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    all[i] = std::sqrt(nearest_feature(surface, x.col(i), std::numeric_limits<double>::infinity())
                           .squared_distance);
  return all;
}

ClothDistance summary_of(const PerParticle& distances, const PerParticle& weights) {
  Worst worst;
  for (const double distance : distances) worst.observe(distance);
  const PerParticle squares = distances.array().square();
  return {std::sqrt(squares.dot(weights) / weights.sum()), worst.value()};
}

ClothDistance surface_distance(const PerParticle3& a, const std::vector<Triangle>& a_triangles,
                               const TimedMesh& b) {
  const PerParticle to_b = distances_to(make_mesh_distance(b.x, b.triangles), a);
  const PerParticle to_a = distances_to(make_mesh_distance(a, a_triangles), b.x);
  PerParticle both(to_b.size() + to_a.size()), areas(both.size());
  both << to_b, to_a;
  areas << areas_of_vertices(a, a_triangles), areas_of_vertices(b.x, b.triangles);
  return summary_of(both, areas);
}

ClothDistance distance_of_points(const PerParticle3& x, const std::vector<Triangle>& triangles,
                                 const PerParticle3& points) {
  return summary_of(distances_to(make_mesh_distance(x, triangles), points),
                    PerParticle::Ones(points.cols()));
}

double deepest(std::span<const Object> objects, double time, const PerParticle3& x) {
  if (objects.empty()) return 0;
  ObjectsOverSpan now(objects, {time, time, 0});
  double depth = 0;
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    depth = std::max(depth, -nearest_of(now.at(x.col(i))).first.phi);
  return depth;
}

FoldSpectrum folds_of(const TimedMesh& mesh) {
  try {
    return fold_spectrum(make_triangle_mesh(mesh.x, mesh.triangles), mesh.x);
  } catch (const InputError&) {  // holes, fans or flaps of a captured surface
    FoldSpectrum none;
    none.fill(nan);
    return none;
  }
}

double crossings_of(const PerParticle3& x, const std::vector<Triangle>& triangles) {
  return double(oracles::exact_crossings(x, triangles).size());
}

ClothShape shape_of_particles(const ComparedRun& run, double time, const PerParticle3& x) {
  const State still{time, x, PerParticle3::Zero(3, x.cols())};
  const Energies e = energies(run.built.system, still);
  return {e.stretch, e.bending, fold_spectrum(run.scene.mesh, x),
          crossings_of(x, run.scene.mesh.triangles), deepest(run.built.objects, time, x)};
}

Table numbers_over_time(const std::vector<FrameComparison>& frames) {
  Table rows(
      "time [s]; rms distance [m]; largest distance [m]; stretch, run [J]; stretch, frame [J]; "
      "bending, run [J]; bending, frame [J]; crossings, run [pairs]; crossings, frame [pairs]; "
      "depth, run [m]; depth, frame [m]");
  for (const FrameComparison& f : frames)
    rows.row(f.time, f.distance.rms, f.distance.largest, f.run.stretch, f.frame.stretch,
             f.run.bending, f.frame.bending, f.run.crossings, f.frame.crossings, f.run.depth,
             f.frame.depth);
  return {"numbers", "The run and the frames, over time", rows};
}

Table folds_over_time(const std::vector<FrameComparison>& frames) {
  Table rows("time [s]; fold angle; share, run [1]; share, frame [1]");
  for (const FrameComparison& f : frames)
    for (std::size_t b = 0; b < f.run.folds.size(); ++b)
      rows.row(f.time, name_of_fold_band(b), f.run.folds[b], f.frame.folds[b]);
  return {"folds", "Shares of the hinges' length, by the angle of the fold", rows};
}

}  // namespace

std::string_view name_of(Matching matching) {
  return matching == Matching::particles ? "vertex by vertex"
         : matching == Matching::surface ? "by nearest points"
                                         : "one-sided, points to the run's surface";
}

bool has_faces(Eigen::Index vertices, const std::vector<Triangle>& triangles,
               std::span<const TimedMesh> frames) {
  const std::vector<Triangle> faces = sorted_faces(triangles);
  for (const TimedMesh& frame : frames)
    if (frame.x.cols() != vertices || sorted_faces(frame.triangles) != faces) return false;
  return true;
}

Matching matching_of(const TriangleMesh& cloth, std::span<const TimedMesh> frames) {
  for (const TimedMesh& frame : frames)
    if (frame.triangles.empty()) return Matching::points;
  return has_faces(cloth.rest.cols(), cloth.triangles, frames) ? Matching::particles
                                                               : Matching::surface;
}

std::string mesh_difference(const TriangleMesh& cloth, std::span<const TimedMesh> frames) {
  const std::vector<Triangle> faces = sorted_faces(cloth.triangles);
  for (const TimedMesh& frame : frames) {
    if (frame.triangles.empty())
      return fmt::format("{} has {} points without faces, the case {} vertices", frame.file,
                         frame.x.cols(), cloth.rest.cols());
    if (frame.x.cols() != cloth.rest.cols())
      return fmt::format("{} has {} vertices{}, the case {}", frame.file, frame.x.cols(),
                         vertices_to_spare(frame), cloth.rest.cols());
    if (const std::string other = first_other_triangle(frame.triangles, faces); !other.empty())
      return fmt::format("{}: vertex order cannot match, {}", frame.file, other);
    if (sorted_faces(frame.triangles) != faces)
      return fmt::format("{} has {} triangles, the case {}", frame.file, frame.triangles.size(),
                         faces.size());
  }
  return "";
}

State state_between(const State& a, const State& b, double t) {
  const double h = b.time - a.time, s = (t - a.time) / h;
  if (s <= 0) return a;
  if (s >= 1) return b;
  const double c = s * s * (3 - 2 * s);  // of b's place
  State now{t, a.x, a.v};
  now.x = (1 - c) * a.x + c * b.x + h * s * (1 - s) * ((1 - s) * a.v - s * b.v);
  now.v = (1 - s) * a.v + s * b.v;
  return now;
}

FrameComparison compare_frame(const ComparedRun& run, const State& at, const TimedMesh& frame) {
  const std::vector<Triangle>& triangles = run.scene.mesh.triangles;
  FrameComparison c{frame.file, frame.time, {}, shape_of_particles(run, at.time, at.x), {}};
  if (run.matching == Matching::particles) {
    c.distance = summary_of((at.x - frame.x).colwise().norm().transpose(), masses_of(run.scene));
    c.frame = shape_of_particles(run, at.time, frame.x);
    return c;
  }
  if (run.matching == Matching::points) {
    FoldSpectrum none;
    none.fill(nan);
    c.distance = distance_of_points(at.x, triangles, frame.x);
    c.frame = {nan, nan, none, nan, deepest(run.built.objects, at.time, frame.x)};
    return c;
  }
  c.distance = surface_distance(at.x, triangles, frame);
  c.frame = {nan, nan, folds_of(frame), crossings_of(frame.x, frame.triangles),
             deepest(run.built.objects, at.time, frame.x)};
  return c;
}

Figure over_time(const std::string& name, const std::string& title, const Axis& y,
                 const std::string& caption, const std::vector<Curve>& curves) {
  return {name, title, {"time", "s", Scale::linear}, y, nan, caption, curves};
}

ComparisonEvidence evidence_of(const std::vector<FrameComparison>& frames, Matching matching) {
  ComparisonEvidence evidence{{numbers_over_time(frames), folds_over_time(frames)}, {}};
  const auto curve = [&](const char* label, const char* column) {
    return curve_of(label, evidence.tables[0], "time", column);
  };
  evidence.figures.push_back(
      over_time("distance", "Distance of the frames from the run", {"distance", "m", Scale::linear},
                "Compared " + std::string(name_of(matching)) + ".",
                {curve("root mean square", "rms distance"), curve("largest", "largest distance")}));
  if (matching == Matching::particles)
    evidence.figures.push_back(over_time(
        "energies", "Energies of the shapes", {"energy", "J", Scale::linear},
        "By the forces of the run's case, at the positions of both.",
        {curve("stretch, run", "stretch, run"), curve("stretch, frames", "stretch, frame"),
         curve("bending, run", "bending, run"), curve("bending, frames", "bending, frame")}));
  return evidence;
}

}  // namespace foldproof
