// time-order.sheet: a hanging sheet, so that the solves are real ones and hinges share
// their particles.
#include <cmath>

#include "convergence/integrators/oracle_problem.h"
#include "convergence/integrators/time_order.h"
#include "reference/mesh/shapes.h"

namespace foldproof {

namespace {

constexpr int cells = 16;
constexpr double width = 0.83, height = 0.71;  // m
constexpr double end = 0.06;                   // s

/// Where the sheet starts and how fast: waves in all directions over the rest shape. 3 x N each.
void set_waves(Scene& scene) {
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double a = scene.mesh.rest(0, i) / width, b = scene.mesh.rest(1, i) / height;
    scene.x.col(i) += Vector3(0.013 * std::sin(3.1 * b), 0.009 * std::cos(2.3 * a),
                              0.06 * std::sin(5.3 * a + 1.7 * b));
    scene.v.col(i) = Vector3(0.4 * std::cos(2.9 * b), 0.3 * std::sin(4.1 * a),
                             2.1 * std::cos(4.7 * a - 2.2 * b));
  }
}

/// Its two upper corners are led to and fro.
Scene hanging_scene() {
  Scene scene =
      scene_at_rest(make_sheet({SheetPattern::alternating, width, height, cells, cells}), 0.19);
  scene.gravity = Vector3(0, -9.81, 0);
  scene.stretch = StretchMaterial{11, 0.035, 1};
  scene.bending = BendingMaterial{3e-4, 3e-5};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0.03);
  scene.solver.tolerance = 1e-13;
  set_waves(scene);
  Motion swing;
  swing.amplitude = Vector3(0.004, 0.003, 0.021);
  swing.frequency = 4.3;
  swing.phase = 0.8;
  const int top = cells * (cells + 1);
  for (int particle : {top, top + cells}) {
    scene.prescribed.push_back({particle, scene.x.col(particle), swing});
    scene.v.col(particle) = velocity_at(swing, scene.x.col(particle), 0);
  }
  return scene;
}

StudyResult run_sheet_order(const Subject& subject, Tier tier, const Progress& progress) {
  const Scene scene = hanging_scene();
  const double tolerance = tier == Tier::quick ? 1e-10 : 1e-12;
  const ExactEnd exact = exact_end(scene, oracle_of(scene), end, tolerance);
  const int levels = tier == Tier::quick ? 6 : 8;
  return time_order(subject,
                    {"time-order.sheet", "the hanging sheet", scene, end, paper_methods(24, levels),
                     exact.state, exact.uncertainty},
                    progress);
}

}  // namespace

Study sheet_time_order_study() {
  return {"time-order.sheet",
          "Schemes A, B and C are second order in x and v on a damped hanging sheet, with "
          "constant, alternating and random steps.",
          {"A", "B", "C", "B-is-second-order-with-variable-steps"},
          "BMF03 section 3",
          "A sheet of squares, rows split along alternating diagonals, hangs by its two upper "
          "corners, which are moved to and fro. It is released from a wavy shape with a wavy "
          "velocity; springs and bending are both damped. Everything else is as in the study of "
          "the hinge, with the solution by GSL over all free particles.",
          run_sheet_order};
}

}  // namespace foldproof
