// folding-inside-objects: are there more folds where points may stay inside of an object?

#include "convergence/contact/contact_runs.h"
#include "convergence/study.h"
#include "reference/mesh/shapes.h"
#include "reference/post/fold_projection.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr double radius = 0.2, length = 0.3;  // of the tube [m]
constexpr int around = 48, along = 13;
constexpr double band = 0.01;         // tau of the projection [m]
constexpr double least_crest = 1e-3;  // m

/// A tube on a drum as wide as it, 5 mm inside, pushed together by a tenth and held at both ends;
/// what pushes it makes it buckle to both sides of the drum's surface.
Scene tube_on_drum() {
  Scene scene = scene_at_rest(make_cylinder(radius, length, around, along), 0.2);
  std::uint64_t state = 4;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const Vector3 X = scene.mesh.rest.col(i);
    state = 6364136223846793005u * state + 1442695040888963407u;
    const double noise = 2e-3 * (double(state >> 11) * 0x1p-52 - 1);
    const Vector3 outward = Vector3(X.x(), 0, X.z()) / radius;
    scene.x.col(i) = Vector3(0, 0.9 * (X.y() - length / 2), 0) + (0.975 * radius + noise) * outward;
    if (X.y() < 0.5 * length / along || X.y() > length - 0.5 * length / along)
      scene.prescribed.push_back({int(i), scene.x.col(i), Motion{}});
  }
  scene.stretch = StretchMaterial{20, 0.05, 1};
  scene.bending = BendingMaterial{1e-4, 6e-6};
  scene.rest_angles = hinge_angles(scene.mesh, scene.mesh.rest);
  SceneObject drum = solid_object("drum", Capsule{radius, 0.3}, 0.2);
  std::get<RigidObject>(drum.object.body).place.rotation =
      oracles::rotation_between(Vector3::UnitZ(), Vector3::UnitY());
  scene.objects.push_back(drum);
  scene.solver.tolerance = 1e-8;
  return scene;
}

/// Local maxima of a closed row of values that stand out by `least` or more on both sides.
int crests_of(const std::vector<double>& row, double least) {
  const size_t start = size_t(std::min_element(row.begin(), row.end()) - row.begin());
  double low = row[start], high = row[start];
  bool rises = true;
  int crests = 0;
  for (size_t k = 1; k <= row.size(); ++k) {
    const double value = row[(start + k) % row.size()];
    if (rises) {
      high = std::max(high, value);
      if (high - value < least) continue;
      if (high - low >= least) ++crests;
      rises = false;
      low = value;
    } else {
      low = std::min(low, value);
      if (value - low < least) continue;
      rises = true;
      high = value;
    }
  }
  return crests;
}

std::vector<Object> objects_of(const Scene& scene) {
  std::vector<Object> objects;
  for (const SceneObject& part : scene.objects) objects.push_back(part.object);
  return objects;
}

double crests_a_ring(const Scene& scene, const State& s) {
  const ProjectedCloth cloth =
      project_folds(objects_of(scene), s.x, s.time,
                    {"blend", {0, band, 5e-3}, PinchedPoints::left_alone, 1e-9, 100});
  double sum = 0;
  for (int ring = 1; ring < along; ++ring) {
    const double* phi = cloth.after.data() + ring * around;
    sum += crests_of({phi, phi + around}, least_crest);
  }
  return sum / (along - 1);
}

double mean_fold(const Scene& scene, const State& s) {
  const std::vector<double> angles = hinge_angles(scene.mesh, s.x);
  double sum = 0;
  for (size_t k = 0; k < angles.size(); ++k) sum += std::abs(angles[k] - scene.rest_angles[k]);
  return sum / double(angles.size());
}

/// How deep the deepest particle is that nothing holds [m]; 0 if none is inside.
double deepest_free(const Scene& scene, const State& s) {
  Worst deepest;
  for (const int i : free_particles(scene))
    deepest.observe(-distance_at(scene, s.x.col(i), s.time));
  return deepest.value();
}

/// Runs the scene until `end` [s], with forecast times of so many steps. A row each: the deepest
/// free particle at the end, crests a turn of the tube after the projection, the mean over its free
/// rings, and the mean |theta - theta0|.
Table folds_of(const Subject& subject, Scene scene, double end,
               const std::vector<double>& taus_over_h) {
  Table folds("forecast time [s]; deepest particle [m]; crests a turn [1]; mean fold [rad]");
  const double h = usual_step(scene);
  for (const double steps : taus_over_h) {
    scene.collision.forecast_time = steps * h;
    const State s = run_to_end(subject, scene, h, end);
    const bool is_tube = scene.mesh.particles() == around * (along + 1);
    folds.row(steps * h, deepest_free(scene, s), is_tube ? crests_a_ring(scene, s) : nan,
              mean_fold(scene, s));
  }
  return folds;
}

NamedFinding tube_finding(const Table& folds) {
  const std::vector<double>& crests = folds.numbers("crests a turn");
  return {
      "folding-inside-objects.more-folds-when-allowed-inside",
      "Cloth that starts partly inside a drum and is pushed together has fewer folds if it is "
      "brought to the surface at once than if it may stay inside.",
      {{crests.front() / crests.back(), 0.5, 0, "1",
        "a surface that blocks one side blocks folds to that side: at most half of them are left"},
       folds,
       "measured is the number of crests around the tube with a forecast time of one step over the "
       "number with ten thousand steps, after the projection into [0, 0.01 m]"}};
}

NamedFinding ball_finding(const Table& folds) {
  const std::vector<double>& angles = folds.numbers("mean fold");
  return {
      "folding-inside-objects.same-folds-over-a-ball",
      "Cloth that falls on a ball from outside folds as much with the shortest forecast time tried "
      "as with the longest.",
      {{std::abs(angles.back() / angles.front() - 1), 0.1, 0, "1",
        "which folds form is chance; the mean over some four hundred hinges, whose angles scatter "
        "by as much as their mean, is known to a twentieth, and the ratio of two means to less "
        "than a tenth"},
       with_columns(folds, {"forecast time", "deepest particle", "mean fold"}),
       "measured is the change of the mean fold angle from the first forecast time to the last"}};
}

Scene sheet_over_ball(int n) {
  Scene scene = level_sheet(n, 0.6, {0, radius + 0.01, 0});
  scene.stretch->damping = 0.1;
  scene.objects.push_back(solid_object("ball", Sphere{radius}, 0.3));
  return scene;
}

StudyResult run_folds_inside(const Subject& subject, Tier tier, const Progress& progress) {
  const bool full = tier == Tier::full;
  const Table tube =
      folds_of(subject, tube_on_drum(), 0.3,
               full ? std::vector<double>{1, 10, 100, 1000, 1e4} : std::vector<double>{1, 1e4});
  progress(0.6);
  const Table ball =
      folds_of(subject, sheet_over_ball(full ? 24 : 16), 0.8,
               full ? std::vector<double>{1, 10, 100, 300} : std::vector<double>{1, 100});
  StudyResult result;
  result.findings = {tube_finding(tube), ball_finding(ball)};
  return result;
}

}  // namespace

Study folds_inside_study() {
  return {"folding-inside-objects",
          "A tube that starts partly inside a drum folds more if it may stay there; a sheet that "
          "falls on a ball from outside folds as much either way.",
          {"more-folds-when-allowed-inside", "same-folds-over-a-ball"},
          "BMF03 section 5.3",
          "A tube that starts inside a drum is pushed together, and a sheet falls on a ball: how "
          "many folds do they form with forecast times from one step to far longer than the run?",
          run_folds_inside};
}

}  // namespace foldproof
