// A sheet of cloth hangs from two of its corners; prints its height ten times a second.
#include <cstdio>

#include "reference/dynamics/simulate.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/scene.h"

int main() {
  using namespace foldproof;
  // m, kg/m^2
  Scene scene =
      scene_at_rest(make_sheet({.width = 1, .height = 1, .columns = 12, .rows = 12}), 0.2);
  scene.gravity = Vector3(0, -9.80665, 0);                           // m/s^2
  scene.stretch = StretchMaterial{.stiffness = 50, .damping = 0.5};  // N/m, N s/m
  scene.bending = BendingMaterial{.stiffness = 1e-3};                // J
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);             // rad
  for (const int corner : {156, 168})                                // of the upper border
    scene.prescribed.push_back({corner, scene.x.col(corner), Motion{}});
  scene.schedule.end = 1;               // s
  scene.schedule.frame_interval = 0.1;  // s
  const auto print = [](const State& s) {
    std::printf("%.1f s: %.4f m high\n", s.time, s.x.row(1).maxCoeff() - s.x.row(1).minCoeff());
  };
  const RunResult run = simulate(build_system(scene), integrator_named("C"), start_state(scene),
                                 scene.schedule, {.frame = print, .step = {}});
  return run.stop ? 1 : 0;
}
