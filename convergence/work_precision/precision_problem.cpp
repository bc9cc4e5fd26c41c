#include "convergence/work_precision/precision_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convergence/integrators/oracle_problem.h"
#include "convergence/stability/stable_step.h"
#include "reference/dynamics/integrator.h"
#include "reference/forces/degenerate.h"
#include "reference/mesh/shapes.h"

namespace foldproof {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double oracle_tolerance = 1e-8;  // its uncertainty is far below the least error wanted
constexpr double tight = 1e-12;            // of the solves in the reference runs

double largest_distance_from(const PerParticle3& start, const PerParticle3& x) {
  Worst worst;
  for (Eigen::Index i = 0; i < x.cols(); ++i) worst.observe((x.col(i) - start.col(i)).norm());
  return worst.value();
}

/// The limit of a method's ends as its steps shrink, from two runs.
struct Extrapolation {
  PerParticle3 x;     // 3 x N [m]
  double correction;  // largest component of what was added to the finer one [m]
  double farthest;    // of the finer run [m]
};

Extrapolation extrapolate(const Subject& subject, Scene scene, const Integrator& integrator,
                          const RunPlan& coarse) {
  scene.integrator = std::string(integrator.name);
  scene.solver.tolerance = tight;
  RunPlan fine = coarse;
  fine.steps *= 2;
  const PlannedRun first = run_planned(subject, scene, coarse),
                   second = run_planned(subject, scene, fine);
  const PerParticle3 correction =
      (second.last.x - first.last.x) / (std::pow(2, integrator.order) - 1);
  const PerParticle3 x = second.last.x + correction;
  return {x, largest_distance(x, second.last.x), second.farthest};
}

void measure_limits(const Subject& subject, const Scene& scene, PrecisionTruth& truth) {
  truth.elastic_limit = elastic_limit(build_system(scene), start_state(scene));
  truth.two_over_omega = 2 / fastest_mode(subject, scene).omega;
  truth.two_over_c = 2 / largest_eigenvalue(scene, damping_operator(subject, scene)).value;
}

}  // namespace

double operator_applications(const Work& work) {
  return double(work.elastic_evaluations + work.damping_preparations + work.damping_products +
                work.stiffness_preparations + work.stiffness_products);
}

double largest_distance(const PerParticle3& p, const PerParticle3& q) {
  Worst worst;
  for (Eigen::Index i = 0; i < p.size(); ++i) worst.observe(std::abs(p.data()[i] - q.data()[i]));
  return worst.value();
}

PlannedRun run_planned(const Subject& subject, const Scene& scene, const RunPlan& plan) {
  const auto prepared = require_offered(subject.prepare, "prepare")(scene);
  const auto& step = require_offered(subject.step, "step");
  History history(start_state(scene), 2);
  PlannedRun run{Ending::reached, 0, history.now(), {}, 0};
  Worst farthest;
  try {
    while (run.steps < plan.steps && run.ending == Ending::reached) {
      ++run.steps;
      history.advance(step(*prepared, history.past(), plan.end / plan.steps, run.work));
      farthest.observe(largest_distance_from(scene.x, history.now().x));
      if (plan.seen) plan.seen(history.now());
      if (!(farthest.value() <= plan.farthest)) run.ending = Ending::diverged;
      if (operator_applications(run.work) > plan.budget) run.ending = Ending::over_budget;
    }
  } catch (const DegenerateElement&) {
    run.ending = Ending::diverged;
  }
  run.last = history.now();
  run.farthest = farthest.value();
  return run;
}

EnergyRun run_with_energy(const Subject& subject, const Scene& scene, RunPlan plan, double from) {
  const PerParticle mass = build_system(scene).mass;
  Worst largest, added;
  double last = nan;  // J
  plan.seen = [&](const State& s) {
    last = 0.5 * s.v.colwise().squaredNorm().dot(mass.transpose());
    largest.observe(last);
    if (s.time > from) added.observe(last);
  };
  const PlannedRun run = run_planned(subject, scene, plan);
  const LongerEnergy energy = run.ending == Ending::reached
                                  ? LongerEnergy{largest.value(), added.value()}
                                  : LongerEnergy{nan, nan};
  return {run, energy, last / largest.value()};
}

PrecisionTruth truth_of(const Subject& subject, const PrecisionProblem& problem) {
  PrecisionTruth truth{};
  measure_limits(subject, problem.scene, truth);
  const int at_limit = int(std::ceil(problem.end / truth.elastic_limit));
  const RunPlan second_plan{problem.end, problem.finest * at_limit, infinite, infinite};
  const Extrapolation second =
      extrapolate(subject, problem.scene, integrator_named(problem.second), second_plan);
  double own = 0;
  if (problem.first == FirstOpinion::oracle) {
    const ExactEnd exact =
        exact_end(problem.scene, oracle_of(problem.scene), problem.end, oracle_tolerance);
    truth.x = exact.state.x;
    own = exact.uncertainty;
  } else {
    // of fourth order, RK4 needs fewer steps; it is stable for damping rates up to 2.785/h: start
    // from 2/h, since rates change along the motion
    RunPlan plan = second_plan;
    plan.steps = std::max(
        {problem.finest * at_limit / 2, at_limit, int(std::ceil(problem.end / truth.two_over_c))});
    const Extrapolation first = extrapolate(subject, problem.scene, integrator_named("RK4"), plan);
    truth.x = first.x;
    own = first.correction;
  }
  truth.motion = second.farthest;
  truth.uncertainty = (own + largest_distance(truth.x, second.x)) / truth.motion;
  return truth;
}

// The scenes of the work-precision study.

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
