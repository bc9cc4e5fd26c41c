#include "convergence/work_precision/precision_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convergence/integrators/oracle_problem.h"
#include "convergence/stability/stable_step.h"
#include "reference/dynamics/integrator.h"
#include "reference/forces/degenerate.h"

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

}  // namespace foldproof
