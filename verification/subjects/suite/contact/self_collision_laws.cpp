// Cloth that is folded onto itself, judged by exact arithmetic.

#include "verification/oracles/exact_crossings.h"
#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

//     \      /       Both halves turn towards each other about the fold. They would meet after
//   -> \    / <-      0.17 s, 87 steps, and cross from then on.
//       \  /
//        \/
constexpr double half_opening = 10 * pi / 180;  // rad
constexpr double turning = 1;                   // rad/s, of each half
constexpr double layer_gap = 0.004;             // m; less than half the height of any triangle

PortableScene folding_sheet() {
  PortableScene scene = sheet_at_rest();
  scene.name = "folding sheet";
  scene.thickness = layer_gap;
  const double fold = scene.mesh.rest.row(0).maxCoeff() / 2;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double along = scene.mesh.rest(0, i) - fold, side = along < 0 ? -1 : 1;
    const double across = along * std::sin(half_opening), up = std::abs(along);
    scene.x.col(i) << across, scene.mesh.rest(1, i), up * std::cos(half_opening);
    scene.v.col(i) << -side * turning * up * std::cos(half_opening), 0, side * turning * across;
  }
  return scene;
}

Finding never_passes_through_itself(Trial& trial) {
  const PortableScene scene = folding_sheet();
  const std::vector<long> steps = multiples(10, 20);
  Table measured{{"steps", "1"}, {"edges in triangles", "1"}};
  measured.row(0, oracles::exact_crossings(scene.x, scene.mesh.triangles).size());
  const std::vector<Snapshot> states = trial.motion(scene, steps);
  require_start_velocity(scene, states[0].x, steps[0]);
  for (size_t k = 0; k < states.size(); ++k)
    measured.row(steps[k], oracles::exact_crossings(states[k].x, scene.mesh.triangles).size());
  return judge_worst(measured, 0, "pairs that meet are counted without rounding");
}

}  // namespace

std::vector<Law> self_collision_laws() {
  return {
      {"self-collision.folded-sheet-never-passes-through-itself",
       "A sheet that is folded onto itself never passes through itself.", "impenetrability",
       never_passes_through_itself, "self_collision"},
  };
}

}  // namespace foldproof
