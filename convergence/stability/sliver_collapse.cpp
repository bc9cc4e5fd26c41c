#include "convergence/stability/hard_limits.h"

#include <cmath>
#include <limits>

#include "reference/mesh/shapes.h"
#include "reference/scene/scene.h"

namespace foldproof {

namespace {

/// The ribbon of cases/hard/slivers.toml: held at one end, it falls from the horizontal.
Scene falling_ribbon(double safety) {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::one_diagonal, 1.2, 0.003, 2, 6}), 0.2);
  scene.gravity = Vector3(0, 0, -9.80665);
  scene.stretch = StretchMaterial{50, 0, 1};
  scene.bending = BendingMaterial{1e-6, 0, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  for (int i = 0; i < scene.mesh.particles(); ++i)
    if (scene.x(0, i) == 0) scene.prescribed.push_back({i, scene.x.col(i), {}});
  scene.schedule = {0.3, 0.1, {0, safety, 0.1}, 200'000};
  return scene;
}

/// The time at which the run loses a triangle [s]; NaN if it does not, or stops for another reason.
double collapse_time(const Scene& scene) {
  const RunResult result =
      simulate(build_system(scene), integrator_named("C"), start_state(scene), scene.schedule, {});
  const bool is_lost =
      result.stop && result.stop->reason.find("lost its area") != std::string::npos;
  return is_lost ? result.stop->time : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

NamedFinding sliver_collapse() {
  Table collapses{{"step over the elastic limit", "1"}, {"time of collapse", "s"}};
  Worst apart;
  for (const double safety : {0.9, 0.45}) {
    collapses.row(safety, collapse_time(falling_ribbon(safety)));
    const std::vector<double>& times = collapses.numbers("time of collapse");
    apart.observe(std::abs(times.back() / times.front() - 1));
  }
  return {"hard-limits.slivers-collapse-at-any-step",
          "A falling ribbon of triangles 1200 times as long as high shears until one has lost its "
          "area, at the same time for every step: a limit of the model, not of the integration.",
          {{apart.value(), 1e-3, 0, "1",
            "a failure of the steps would come at another time when they are halved; second order "
            "leaves less than a thousandth"},
           collapses,
           "measured is the relative difference of the times"}};
}

}  // namespace foldproof
