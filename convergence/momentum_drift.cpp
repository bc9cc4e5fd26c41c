// momentum-drift: which scheme keeps the angular momentum of a free sheet, and how fast the drift of the
// other falls.
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "convergence/order.h"
#include "convergence/studies.h"
#include "reference/dynamics/integrator.h"
#include "reference/mesh/shapes.h"
#include "verification/subject.h"

namespace foldproof {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double end = 0.24;   // s
constexpr int coarsest = 120;  // steps
constexpr int pairs_judged = 3;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Drifts of one scheme over all levels.
struct Drift {
  std::string scheme;
  std::vector<double> steps;     // mean step [s]
  std::vector<double> relative;  // |L(end) - L(0)| / |L(0)| [1]
  std::vector<double>
      roundings;  // |L(end) - L(0)| in units of epsilon * steps * the largest sum of m |x| |v| seen [1]
};

/// A jittered sheet, bent and stretched, that turns, flaps and flies away.
Scene free_sheet(double spring_damping, double bending_damping) {
  Scene scene = scene_of(make_sheet({SheetPattern::jittered, 0.53, 0, 5, 4, 0.23, 11}), 0.17);
  scene.stretch = StretchMaterial{13, spring_damping, 1};
  scene.bending = BendingMaterial{0.0017, bending_damping, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0.07);
  scene.solver.tolerance = 1e-10;
  const Vector3 spin(1.9, -3.3, 2.6), flight(0.3, 0.2, -0.5);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double a = scene.mesh.rest(0, i) / 0.53, b = scene.mesh.rest(1, i) / 0.53;
    const Vector3 wave(0.011 * std::sin(4.1 * b), 0.017 * std::cos(3.3 * a),
                       0.07 * std::sin(4.7 * a + 2.9 * b));
    const Vector3 flap(0.5 * std::cos(5.1 * b), 0.4 * std::sin(3.7 * a), 1.7 * std::cos(5.9 * a - 3.1 * b));
    const Vector3 x = scene.mesh.rest.col(i) + wave;
    scene.x.col(i) = x;
    scene.v.col(i) = spin.cross(x) + flap + flight;
  }
  return scene;
}

Vector3 momentum_about_origin(const PerParticle& mass, const State& s) {
  Vector3 sum = Vector3::Zero();
  for (Eigen::Index i = 0; i < mass.size(); ++i) {
    const Vector3 x = s.x.col(i), v = s.v.col(i);
    sum += mass[i] * x.cross(v);
  }
  return sum;
}

/// What the terms of that sum are made of: sum m |x| |v|.
double momentum_scale(const PerParticle& mass, const State& s) {
  double sum = 0;
  for (Eigen::Index i = 0; i < mass.size(); ++i) sum += mass[i] * s.x.col(i).norm() * s.v.col(i).norm();
  return sum;
}

void add_level(const Subject& subject, Prepared& prepared, const Scene& scene, int count, Drift& drift) {
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  State s = start_state(scene);
  const Vector3 before = momentum_about_origin(mass, s);
  Worst scale;
  Work uncounted;
  for (int i = 0; i < count; ++i) {
    scale.see(momentum_scale(mass, s));
    s = subject.step(prepared, {&s, 1}, end / count, uncounted);
  }
  const double moved = (momentum_about_origin(mass, s) - before).norm();
  drift.steps.push_back(end / count);
  drift.relative.push_back(moved / before.norm());
  drift.roundings.push_back(moved / (epsilon * count * scale.value()));
}

Drift drift_of(const Subject& subject, Scene scene, std::string_view scheme, int levels) {
  scene.integrator = std::string(scheme);
  const auto prepared = offered(subject.prepare, "prepare")(scene);
  offered(subject.step, "step");
  Drift drift{scene.integrator, {}, {}, {}};
  for (int level = 0, count = coarsest; level < levels; ++level, count *= 2)
    add_level(subject, *prepared, scene, count, drift);
  return drift;
}

NamedFinding kept(const Drift& drift, const std::string& material) {
  Worst worst;
  for (double roundings : drift.roundings) worst.see(roundings);
  Finding finding{
      {worst.value(), 16, 0, "epsilon, a step, of sum m|x||v|",
       "a step rounds x and v of each particle once, and the dozen or so forces on it, each at most about "
       "m|v|/h, in their last digits; sixteen is all of these erring to one side"},
      {{"step", "s", drift.steps},
       {"relative drift", "1", drift.relative},
       {"drift in roundings", "1", drift.roundings}},
      ""};
  return {
      "momentum-drift." + material + "." + drift.scheme,
      "Scheme " + drift.scheme + " keeps the angular momentum of a free, " + material + " sheet to rounding.",
      std::move(finding)};
}

Convergence convergence_of(const Drift& drift) {
  return {drift.steps, drift.relative, 0};  // no floor: the start is known, and rounding is judged by itself
}

NamedFinding falls_with_order_two(const Drift& drift) {
  const Convergence convergence = convergence_of(drift);
  const Estimate deviation = order_deviation(convergence, 2, pairs_judged);
  std::vector<double> orders = pair_orders(convergence);
  orders.insert(orders.begin(), nan);
  Finding finding{
      {deviation.value, 0.1, deviation.uncertainty, "1",
       "a drift of first or third order is off by 1; at these steps the next term leaves less than a tenth"},
      {{"step", "s", drift.steps},
       {"relative drift", "1", drift.relative},
       {"order of the pair", "1", orders},
       {"drift in roundings", "1", drift.roundings}},
      "measured is the largest |order - 2| over the last three pairs; C moves x with one velocity and "
      "carries the momentum of "
      "another"};
  return {"momentum-drift.damped.C.order",
          "The angular momentum of a free, damped sheet drifts under scheme C, by second order in the step.",
          std::move(finding)};
}

NamedFinding drift_is_real(const Drift& drift) {
  constexpr double rounding_bound = 16;
  Worst worst;
  for (double roundings : drift.roundings) worst.see(rounding_bound / roundings);
  Finding finding{
      {worst.value(), 0.01, 0, "of the drift", "a hundred times what counts as kept cannot be rounding"},
      {{"step", "s", drift.steps}, {"drift in roundings", "1", drift.roundings}},
      "measured is the bound of a kept momentum over the drift"};
  return {"momentum-drift.damped.C.is-no-rounding", "The drift of scheme C on a damped sheet is no rounding.",
          std::move(finding)};
}

Figure figure_of(const std::vector<Drift>& damped, const std::vector<Drift>& undamped) {
  Figure figure{"drift",
                "Angular momentum of a free sheet",
                {"step", "s", Scale::log},
                {"relative drift of angular momentum", "1", Scale::log},
                2,
                "Change of the angular momentum from the start to the end of the run, over its size. Curves "
                "without slope are rounding.",
                {}};
  for (const Drift& drift : damped)
    figure.curves.push_back(
        {drift.scheme + ", damped", drift.steps, drift.relative, nan,
         drift.scheme == "C" ? pair_orders(convergence_of(drift)) : std::vector<double>{}});
  for (const Drift& drift : undamped)
    figure.curves.push_back({drift.scheme + ", undamped", drift.steps, drift.relative, nan, {}});
  return figure;
}

StudyResult run(const Subject& subject, Tier tier, const Progress& progress) {
  const int levels = tier == Tier::quick ? 5 : 7;
  std::vector<Drift> undamped, damped;
  const double runs = 2.0 * double(paper_schemes().size());
  for (const Integrator& integrator : paper_schemes()) {
    undamped.push_back(drift_of(subject, free_sheet(0, 0), integrator.name, levels));
    progress(double(undamped.size() + damped.size()) / runs);
    damped.push_back(drift_of(subject, free_sheet(0.031, 0.0004), integrator.name, levels));
    progress(double(undamped.size() + damped.size()) / runs);
  }

  StudyResult result;
  for (const Drift& drift : undamped) result.findings.push_back(kept(drift, "undamped"));
  for (const Drift& drift : damped) {
    if (drift.scheme != "C") {
      result.findings.push_back(kept(drift, "damped"));
      continue;
    }
    result.findings.push_back(falls_with_order_two(drift));
    result.findings.push_back(drift_is_real(drift));
  }
  result.figures.push_back(figure_of(damped, undamped));
  return result;
}

}  // namespace

Study momentum_drift() {
  return {"momentum-drift",
          "Schemes A and B keep the angular momentum of a free sheet to rounding, damped or not; C keeps it "
          "undamped, and lets it drift by "
          "second order in the step when damped.",
          "BMF03 section 3",
          "An irregular sheet, bent, stretched and spinning, flies without any force from outside. All "
          "forces keep angular momentum call by "
          "call; a scheme keeps it only if the velocity that moves the positions is parallel in sum to the "
          "one that carries the "
          "momentum. The drift from start to end is measured while the step is halved.",
          run};
}

}  // namespace foldproof
