#include "convergence/any_case/coarser_mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "convergence/any_case/distances.h"
#include "reference/level_set/mesh_distance.h"
#include "verification/evidence.h"

namespace foldproof {

namespace {

/// A point of a triangle by its coordinates along two sides: x_a + along_ab (x_b - x_a) +
/// along_ac (x_c - x_a).
struct PlaceOnTriangle {
  Triangle triangle;
  double along_ab, along_ac;

  Vector3 in(const PerParticle3& x) const {
    const Vector3 a = x.col(triangle[0]);
    return a + along_ab * (x.col(triangle[1]) - a) + along_ac * (x.col(triangle[2]) - a);
  }
};

PlaceOnTriangle place_of(const Vector3& point, const Triangle& triangle, const PerParticle3& x) {
  const Vector3 a = x.col(triangle[0]);
  Eigen::Matrix<double, 3, 2> sides;
  sides << x.col(triangle[1]) - a, x.col(triangle[2]) - a;
  const Eigen::Vector2d along = sides.colPivHouseholderQr().solve(point - a);
  return {triangle, along[0], along[1]};
}

/// Where the points lie on the surface, or next to it.
std::vector<PlaceOnTriangle> places_of(const PerParticle3& points, const PerParticle3& x,
                                       const std::vector<Triangle>& triangles) {
  const MeshDistance surface = make_mesh_distance(x, triangles);
  std::vector<PlaceOnTriangle> places;
  for (const auto& point : points.colwise()) {
    const NearestFeature nearest =
        nearest_feature(surface, point, std::numeric_limits<double>::infinity());
    const Triangle& triangle =
        surface.triangles[size_t(surface.tree.order[size_t(nearest.triangle)])];
    places.push_back(place_of(nearest.point, triangle, x));
  }
  return places;
}

}  // namespace

double coarseness(const TriangleMesh& mesh, const TriangleMesh& coarser) {
  const double ratio = std::sqrt(double(mesh.triangles.size()) / double(coarser.triangles.size()));
  if (ratio < 1.2)
    throw InputError(
        fmt::format("{} triangles of {}; give one with sides at least 1.2 times as long",
                    coarser.triangles.size(), mesh.triangles.size()));
  const double area = lumped_masses(mesh, 1).sum(), other_area = lumped_masses(coarser, 1).sum();
  if (!(std::abs(other_area - area) <= 0.1 * area))
    throw InputError(
        fmt::format("{:.3g} m^2 of {:.3g}; give a mesh of the same surface", other_area, area));
  return ratio;
}

double error_from_coarser(const FramedRun& run, const TriangleMesh& mesh, const FramedRun& coarser,
                          const TriangleMesh& coarser_mesh) {
  const double ratio = coarseness(mesh, coarser_mesh);
  if (run.x.empty() || coarser.x.empty()) return nan;
  const std::vector<PlaceOnTriangle> places = places_of(coarser.x[0], run.x[0], mesh.triangles);
  // the coarser run, had its particles been displaced as the surface is
  std::vector<PerParticle3> at_places;
  for (const PerParticle3& x : run.x) {
    PerParticle3 moved(3, Eigen::Index(places.size()));
    for (size_t k = 0; k < places.size(); ++k)
      moved.col(Eigen::Index(k)) =
          coarser.x[0].col(Eigen::Index(k)) + places[k].in(x)-places[k].in(run.x[0]);
    at_places.push_back(std::move(moved));
  }
  return largest_difference(at_places, coarser.x, lumped_masses(coarser_mesh, 1)) / (ratio - 1);
}

}  // namespace foldproof
