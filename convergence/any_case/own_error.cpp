#include "convergence/any_case/own_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "reference/dynamics/integrator.h"
#include "reference/level_set/mesh_distance.h"

namespace foldproof {

namespace {

constexpr double spread_of_two = 3;  // over their difference, as of ladders without an order [1]

ErrorPart not_known(const std::string& why) { return {nan, nan, why}; }

/// Of three levels or more; formal_order: of the method, or the mesh.
ErrorPart error_of_ladder(const Scene& scene, const std::vector<LevelRun>& runs,
                          double formal_order) {
  const QuantityOverLevels positions = positions_over_levels(scene, runs, formal_order);
  return {positions.first_error - positions.bar.half_width, positions.first_error, ""};
}

/// The ladder that `foldproof converge` would make of the case.
LadderPlan plan_of(const CaseSource& source) {
  LadderPlan plan{case_of(source), levels_of_own_error, {}};
  plan.measurements = measurements_of(plan.input_case);
  return plan;
}

/// Of the runs of two neighbouring levels.
ErrorPart error_of_two(const Scene& scene, const LevelRun& own, const LevelRun& finer,
                       std::string unknown) {
  const double difference = field_difference(own, finer, masses_of(scene));
  return {difference, (1 + spread_of_two) * difference, std::move(unknown)};
}

using Ends = std::vector<double>;  // of steps [s]

/// Runs the levels in this order, by the steps of the first; ends with one that stops.
std::vector<LevelRun> runs_of(const std::vector<int>& order,
                              const std::function<Level(int k, const Ends& ends)>& level,
                              const KeptRuns& by) {
  std::vector<LevelRun> runs;
  for (const int k : order) {
    const Ends ends = runs.empty() ? Ends() : runs[0].step_ends;
    runs.push_back(stored_level(level(k, ends), by));
    if (!runs.back().stopped.empty()) break;
  }
  return runs;
}

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

ErrorPart error_of_steps(const CaseSource& source, const KeptRuns& by) {
  const LadderPlan plan = plan_of(source);
  const Scene& scene = plan.input_case.scene;
  const std::vector<LevelRun> runs = runs_of(
      {0, 1, 2}, [&](int k, const Ends& ends) { return time_level(plan, k, ends); }, by);
  const std::string& why = runs.back().stopped;
  if (why.empty()) return error_of_ladder(scene, runs, integrator_named(scene.integrator).order);
  if (runs.size() < size_t(levels_of_own_error)) return not_known(why);
  return error_of_two(scene, runs[0], runs[1], "with a quarter of the step: " + why);
}

ErrorPart error_of_mesh(const CaseSource& source, int levels, const KeptRuns& by) {
  const SpaceLadder ladder = space_ladder(source, levels, ObjectsToo::no);
  std::vector<int> fine_to_coarse;
  for (int k = levels - 1; k >= 0; --k) fine_to_coarse.push_back(k);
  std::vector<LevelRun> runs = runs_of(
      fine_to_coarse, [&](int k, const Ends& ends) { return space_level(ladder, k, ends); }, by);
  if (const std::string& why = runs.back().stopped; !why.empty()) return not_known(why);
  std::ranges::reverse(runs);
  const Scene& scene = ladder.levels[0].input_case.scene;
  if (levels > 2) return error_of_ladder(scene, runs, order_in_space);
  return error_of_two(scene, runs[0], runs[1], "");
}

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

ErrorPart error_from_coarser_mesh(const CaseSource& source, const std::vector<std::string>& coarser,
                                  const KeptRuns& by) {
  CaseSource other = source;
  other.overrides.insert(other.overrides.end(), coarser.begin(), coarser.end());
  const LadderPlan plan = plan_of(source), coarser_plan = plan_of(other);
  Level coarser_level = time_level(coarser_plan, 0, {});
  coarser_level.label = plan.input_case.scene.name + ", coarser mesh";
  const LevelRun own = stored_level(time_level(plan, 0, {}), by),
                 of_coarser = stored_level(coarser_level, by);
  for (const LevelRun* run : {&own, &of_coarser})
    if (!run->stopped.empty()) return not_known(run->stopped);
  const TriangleMesh &mesh = plan.input_case.scene.mesh,
                     &coarser_mesh = coarser_plan.input_case.scene.mesh;
  const double first_order = error_from_coarser(own, mesh, of_coarser, coarser_mesh);
  return {first_order / (coarseness(mesh, coarser_mesh) + 1), spread_of_two * first_order, ""};
}

}  // namespace foldproof
