// Quantities of whole triangles of the cloth against objects.
#include <algorithm>
#include <vector>

#include "verification/cases/face_depth.h"
#include "verification/cases/quantities.h"

namespace foldproof {

namespace {

/// Where each particle is: its depth in each object, and whether its triangles count.
struct ParticleDepths {
  Eigen::MatrixXd depths;    // objects x particles [m]
  std::vector<char> counts;  // neither prescribed nor inside two objects
};

ParticleDepths particle_depths(const Scene& scene, std::span<const Object> objects,
                               const State& s) {
  ParticleDepths all{Eigen::MatrixXd(objects.size(), s.x.cols()),
                     std::vector<char>(std::size_t(s.x.cols()), 1)};
  ObjectsOverSpan now(objects, {s.time, s.time, 0});
  for (Eigen::Index i = 0; i < s.x.cols(); ++i) {
    const std::span<const ObjectPoint> points = now.at(s.x.col(i));
    for (std::size_t k = 0; k < points.size(); ++k) all.depths(Eigen::Index(k), i) = -points[k].phi;
    if (nearest_of(points).held_between()) all.counts[std::size_t(i)] = 0;
  }
  for (const PrescribedParticle& p : scene.prescribed) all.counts[std::size_t(p.particle)] = 0;
  return all;
}

/// Triangles whose particles all count.
std::vector<Triangle> counted_triangles(const Scene& scene, const ParticleDepths& particles) {
  std::vector<Triangle> counted;
  for (const Triangle& t : scene.mesh.triangles)
    if (std::ranges::all_of(t, [&](int i) { return particles.counts[std::size_t(i)]; }))
      counted.push_back(t);
  return counted;
}

double longest_side(const FaceCorners& face) {
  return std::max(
      {(face[1] - face[0]).norm(), (face[2] - face[1]).norm(), (face[0] - face[2]).norm()});
}

/// Of each triangle with a point that may be deeper than `known` in an object: from a corner, depth
/// rises by at most three (deepest_in_object) per distance.
std::vector<FaceCorners> faces_to_ask(const std::vector<Triangle>& triangles, const State& s,
                                      const Eigen::VectorXd& depths, double known) {
  std::vector<FaceCorners> faces;
  for (const Triangle& t : triangles) {
    const FaceCorners face{s.x.col(t[0]), s.x.col(t[1]), s.x.col(t[2])};
    const double shallowest = std::min({depths[t[0]], depths[t[1]], depths[t[2]]});
    if (shallowest + 3 * longest_side(face) > known) faces.push_back(face);
  }
  return faces;
}

double face_penetration(const Scene& scene, std::span<const Object> objects, const State& s) {
  if (!s.x.allFinite()) return nan;
  const ParticleDepths particles = particle_depths(scene, objects, s);
  const std::vector<Triangle> triangles = counted_triangles(scene, particles);
  double deepest = 0, longest = 0;  // m
  for (const Triangle& t : triangles) {
    for (const int i : t) deepest = std::max(deepest, particles.depths.col(i).maxCoeff());
    longest = std::max(longest, longest_side({s.x.col(t[0]), s.x.col(t[1]), s.x.col(t[2])}));
  }
  for (std::size_t k = 0; k < objects.size(); ++k) {
    const std::vector<FaceCorners> faces =
        faces_to_ask(triangles, s, particles.depths.row(Eigen::Index(k)).transpose(), deepest);
    deepest = deepest_in_object(objects[k], s.time, faces, deepest, 1e-3 * longest);
  }
  return deepest;
}

}  // namespace

std::vector<Quantity> face_quantities() {
  return {
      {"faces_outside", "m",
       "No point of a triangle is deeper inside an object than this, except triangles with a "
       "prescribed particle or with one between two objects.",
       Sense::at_most, Scope::this_shape, nullptr, nullptr, without_objects, face_penetration},
  };
}

}  // namespace foldproof
