#include "verification/cases/frames_of_case.h"

#include <fmt/format.h>

#include <algorithm>

namespace foldproof {

namespace {

/// The particle of each vertex of the unsewn mesh, -1 if no triangle has it; empty if the cloth was
/// not sewn from it, or a vertex was split.
std::vector<int> particles_of_vertices(const Scene& scene) {
  const UnsewnMesh& unsewn = scene.unsewn;
  if (unsewn.triangles.empty() || unsewn.triangles.size() != scene.mesh.triangles.size()) return {};
  std::vector<int> particles(std::size_t(unsewn.vertices), -1);
  for (std::size_t t = 0; t < unsewn.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      int& particle = particles[std::size_t(unsewn.triangles[t][k])];
      const int corner = scene.mesh.triangles[t][k];
      if (particle >= 0 && particle != corner) return {};
      particle = corner;
    }
  return particles;
}

/// The farthest that a vertex is from the first one of its particle.
struct SeamGap {
  double width = 0;  // m
  int first = 0, second = 0;
};

/// The particles' positions, each that of its first vertex.
PerParticle3 sewn(const TimedMesh& frame, const std::vector<int>& particles, Eigen::Index count,
                  SeamGap& widest) {
  PerParticle3 x = PerParticle3::Zero(3, count);
  std::vector<int> firsts(std::size_t(count), -1);
  for (std::size_t v = 0; v < particles.size(); ++v) {
    if (particles[v] < 0) continue;
    int& first = firsts[std::size_t(particles[v])];
    if (first < 0) {
      first = int(v);
      x.col(particles[v]) = frame.x.col(first);
    }
    const double gap = (frame.x.col(Eigen::Index(v)) - x.col(particles[v])).norm();
    if (!(gap <= widest.width)) widest = {gap, first, int(v)};
  }
  return x;
}

/// Takes the vertices that no triangle uses out of frames with more than `wanted`; in words.
std::string left_out(std::vector<TimedMesh>& frames, Eigen::Index wanted) {
  std::string words;
  for (TimedMesh& frame : frames) {
    if (frame.triangles.empty() || frame.x.cols() == wanted) continue;
    TriangleSoup used = without_unused_vertices({frame.x, frame.triangles, {}});
    const Eigen::Index unused = frame.x.cols() - used.rest.cols();
    if (unused > 0 && words.empty())
      words =
          fmt::format("{}: {} unused vertices, in no triangle, are left out", frame.file, unused);
    frame.x = std::move(used.rest);
    frame.triangles = std::move(used.triangles);
  }
  return words;
}

bool is_unsewn(const Scene& scene, const std::vector<TimedMesh>& frames) {
  const Eigen::Index vertices = scene.unsewn.vertices;
  return vertices != scene.x.cols() && has_faces(vertices, scene.unsewn.triangles, frames);
}

}  // namespace

CaseFrames frames_of_case(const Scene& scene, std::vector<TimedMesh> frames) {
  const std::vector<int> particles = particles_of_vertices(scene);
  for (TimedMesh& frame : frames) {
    if (!frame.triangles.empty()) continue;
    if (frame.x.cols() == scene.x.cols())
      frame.triangles = scene.mesh.triangles;
    else if (!particles.empty() && frame.x.cols() == scene.unsewn.vertices)
      frame.triangles = scene.unsewn.triangles;
  }
  if (particles.empty() || !is_unsewn(scene, frames)) {
    std::string words = left_out(frames, scene.x.cols());
    return {std::move(frames), std::move(words)};
  }
  std::vector<TimedMesh> all;
  double widest = 0;  // m
  for (const TimedMesh& frame : frames) {
    SeamGap gap;
    all.push_back({frame.file, frame.time, sewn(frame, particles, scene.x.cols(), gap),
                   scene.mesh.triangles});
    const double rounding = std::max(1e-5 * frame.x.cwiseAbs().maxCoeff(), 1e-6);
    if (!(gap.width <= scene.unsewn.distance + 2 * rounding))
      return {std::move(frames),
              fmt::format("{}: vertices {} and {} (counted from 0), which the case's seams join, "
                          "are {:.3g} m apart",
                          frame.file, gap.first, gap.second, gap.width)};
    widest = std::max(widest, gap.width);
  }
  return {std::move(all),
          fmt::format("vertices are numbered as before sewing, and taken through the case's seams, "
                      "which are at most {:.3g} m open",
                      widest)};
}

}  // namespace foldproof
