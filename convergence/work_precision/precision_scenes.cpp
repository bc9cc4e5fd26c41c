// The scenes of the work-precision study.
#include <cmath>

#include "convergence/work_precision/precision_problem.h"
#include "reference/mesh/shapes.h"

namespace foldproof {

namespace {

constexpr double solver_tolerance = 1e-8;  // as in the shipped cases

/// Both opposite corners swing about the held edge, one of them from far out.
Scene swinging_hinge() {
  constexpr double rest_angle = 0.5;
  Scene scene = scene_at_rest(make_hinge(0.17, rest_angle), 0.23);
  scene.gravity = Vector3(0.3, -9.3, 1.7);
  scene.stretch = StretchMaterial{31, 0.011, 1};
  scene.bending = BendingMaterial{0.013, 0.0004, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles = {rest_angle};
  scene.solver.tolerance = solver_tolerance;
  scene.v.col(0) = Vector3(0.1, -0.2, 1.3);
  scene.prescribed = {{2, scene.mesh.rest.col(2), {}}, {3, scene.mesh.rest.col(3), {}}};
  return scene;
}

/// The seated figure of cases/stiff_statue.toml on a coarse mesh, held by the top of its head
/// and set swinging.
Scene swinging_statue() {
  constexpr double height = 1, held = 0.96;  // m
  Scene scene = scene_at_rest(make_statue(height, 3), 0.3);
  scene.gravity = Vector3(0, -9.81, 0);
  scene.stretch = StretchMaterial{100, 0.1, 1};
  scene.bending = BendingMaterial{2e-2, 4e-4, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles = hinge_angles(scene.mesh, scene.mesh.rest);
  scene.solver.tolerance = solver_tolerance;
  for (int i = 0; i < scene.mesh.particles(); ++i) {
    const double below = held * height - scene.mesh.rest(1, i);
    if (below < 0)
      scene.prescribed.push_back({i, scene.mesh.rest.col(i), {}});
    else
      scene.v.col(i) = Vector3(0.9, 0.1, 0.7) * below;
  }
  return scene;
}

}  // namespace

Scene hanging_sheet(int cells, double relaxation) {
  constexpr double width = 0.83, height = 0.71;  // m
  constexpr double young = 23, stiffness = 4e-4;
  Scene scene =
      scene_at_rest(make_sheet({SheetPattern::alternating, width, height, cells, cells}), 0.19);
  scene.gravity = Vector3(0, -9.81, 0);
  scene.stretch = StretchMaterial{young, young * relaxation, 1};
  // a hinge's stiffness is ke c/2, its damping with this factor kd c
  scene.bending = BendingMaterial{stiffness, stiffness / 2 * relaxation, Weighting::rest,
                                  DampingFactor::edge_squared_over_area, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0.03);
  scene.solver.tolerance = solver_tolerance;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double a = scene.mesh.rest(0, i) / width, b = scene.mesh.rest(1, i) / height;
    scene.x.col(i) += Vector3(0.011 * std::sin(3.1 * b), 0.008 * std::cos(2.3 * a),
                              0.05 * std::sin(4.3 * a + 1.7 * b));
    scene.v.col(i) = Vector3(0.3 * std::cos(2.9 * b), 0.2 * std::sin(4.1 * a),
                             1.1 * std::cos(3.7 * a - 2.2 * b));
  }
  const int top = cells * (cells + 1);
  for (int particle : {top, top + cells}) {
    scene.prescribed.push_back({particle, scene.x.col(particle), {}});
    scene.v.col(particle).setZero();
  }
  return scene;
}

std::vector<PrecisionProblem> precision_problems(Tier tier) {
  const bool quick = tier == Tier::quick;
  const double root = std::sqrt(2.);
  const int cells = quick ? 6 : 10, points = quick ? 2 : 5;
  const double relaxation = quick ? 0.1 : 0.06;  // s; the same damping ratio on either mesh
  constexpr FirstOpinion extrapolated = FirstOpinion::runge_kutta;
  // motion, end [s], opinions, ratio of steps, least points, finest reference, budget
  // [operator applications]
  return {
      {"damped-hinge", "the damped hinge", swinging_hinge(), 0.4, FirstOpinion::oracle, "C", root,
       points, 8, quick ? 3e4 : 6e4},
      {"light-sheet", "the lightly damped sheet", hanging_sheet(cells, 1e-4), quick ? 0.25 : 0.5,
       extrapolated, "C", root, points, 8, quick ? 4500 : 3e4},
      // so long that a step beyond 2/omega, which grows slowly where damping is heavy, has grown. B
      // is second, which keeps its order where h c is large
      {"heavy-sheet", "the heavily damped sheet", hanging_sheet(cells, relaxation), 2, extrapolated,
       "B", root, points, 4, quick ? 4.5e4 : 1.5e5},
      {"stiff-statue", quick ? "the stiff statue, 0.03 s" : "the stiff statue, 0.5 s",
       swinging_statue(), quick ? 0.03 : 0.5, extrapolated, "C", quick ? 2 : root, points, 1,
       quick ? 2500 : 4e4}};
}

}  // namespace foldproof
