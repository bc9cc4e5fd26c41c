#include "scripts/program/bench/bench_load.h"

#include <cmath>
#include <random>

#include "reference/mesh/shapes.h"

namespace foldproof {

Load make_load(int cells) {
  constexpr double damping_ratio = 0.1, density = 0.2, young = 60, bending_stiffness = 3e-5;
  Load load{
      scene_at_rest(make_sheet({SheetPattern::alternating, 1, 1, cells, cells, 0, 1}), density),
      {},
      {},
      0};
  Scene& scene = load.scene;
  scene.stretch = StretchMaterial{young, 0, 1};
  scene.bending =
      BendingMaterial{bending_stiffness, 0, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  std::mt19937_64 random(7);
  const double amplitude = 0.1 / cells;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    scene.x(2, i) += amplitude * (std::sin(17 * scene.x(0, i)) + double(random() >> 11) * 0x1p-53);
    scene.v.col(i) = Vector3(std::sin(5 * scene.x(1, i)), std::cos(3 * scene.x(0, i)),
                             double(random() >> 11) * 0x1p-53);
  }
  // 2 zeta/omega [s]
  const double time_scale =
      2 * damping_ratio / (2 / elastic_limit(build_system(scene), start_state(scene)));
  scene.stretch->damping = young * time_scale;
  // ke c/2 over |E|, with c near 1 and |E| near 1/cells
  const double hinge_slope = bending_stiffness / 2 * cells;
  scene.bending->damping = hinge_slope * time_scale;
  scene.gravity = Vector3(0, -9.80665, 0);
  scene.solver.tolerance = 1e-6;
  load.system = build_system(scene);
  load.state = start_state(scene);
  load.limit = elastic_limit(load.system, load.state);
  return load;
}

}  // namespace foldproof
