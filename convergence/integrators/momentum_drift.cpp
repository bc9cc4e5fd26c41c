// momentum-drift: which scheme keeps the angular momentum of a free sheet, and how fast the drift
// of the other falls.
#include <Eigen/Geometry>

#include "convergence/study.h"
#include "reference/dynamics/integrator.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double end = 0.24;   // s
constexpr int coarsest = 120;  // steps
constexpr int pairs_judged = 3;

constexpr double solver_tolerance = 1e-10;

/// Drifts of one method over all levels: the angular momentum's, relative, in roundings (epsilon *
/// steps * the largest sum of m |x| |v| seen) and in tolerances (the solver's tolerance * steps *
/// the largest |x| |v| seen, both in the norm weighted with the masses); the linear momentum's in
/// roundings (epsilon * steps * the largest sum of m |v| seen).
struct Drift {
  std::string scheme;
  Table levels;
};

/// A jittered sheet, bent and stretched, that turns, flaps and flies away.
Scene flying_sheet(double spring_damping, double bending_damping) {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::jittered, 0.53, 0, 5, 4, 0.23, 11}), 0.17);
  scene.stretch = StretchMaterial{13, spring_damping, 1};
  scene.bending = BendingMaterial{0.0017, bending_damping};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0.07);
  scene.solver.tolerance = solver_tolerance;
  const Vector3 spin(1.9, -3.3, 2.6), flight(0.3, 0.2, -0.5);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double a = scene.mesh.rest(0, i) / 0.53, b = scene.mesh.rest(1, i) / 0.53;
    const Vector3 wave(0.011 * std::sin(4.1 * b), 0.017 * std::cos(3.3 * a),
                       0.07 * std::sin(4.7 * a + 2.9 * b));
    const Vector3 flap(0.5 * std::cos(5.1 * b), 0.4 * std::sin(3.7 * a),
                       1.7 * std::cos(5.9 * a - 3.1 * b));
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

/// Sizes that drifts are compared with, each the largest of a run.
struct Scales {
  // sum m |x| |v|, sqrt(sum m x^2 sum m v^2) [kg m^2/s], sum m |v| [kg m/s]
  Worst angular, weighted, linear;

  void observe(const PerParticle& mass, const State& s) {
    const Eigen::RowVectorXd x = s.x.colwise().norm(), v = s.v.colwise().norm();
    angular.observe(x.cwiseProduct(v).dot(mass.transpose()));
    weighted.observe(
        std::sqrt(x.cwiseAbs2().dot(mass.transpose()) * v.cwiseAbs2().dot(mass.transpose())));
    linear.observe(v.dot(mass.transpose()));
  }
};

/// One level: its mean step and the drifts over `count` steps.
std::array<double, 5> level_of(Stepper& stepper, const Integrator& method, int count) {
  const PerParticle mass = lumped_masses(stepper.scene().mesh, stepper.scene().density);
  const State start = stepper.start();
  History history(start, method.history);
  Scales scales;
  for (int i = 0; i < count; ++i) {
    scales.observe(mass, history.now());
    const std::span<const State> past = history.past();
    history.advance(stepper.step_after({past.begin(), past.end()}, end / count));
  }
  const Vector3 before = momentum_about_origin(mass, start);
  const double moved = (momentum_about_origin(mass, history.now()) - before).norm();
  const Vector3 pushed = (history.now().v - start.v) * mass;
  return {end / count, moved / before.norm(), moved / (epsilon * count * scales.angular.value()),
          moved / (solver_tolerance * count * scales.weighted.value()),
          pushed.norm() / (epsilon * count * scales.linear.value())};
}

Drift drift_of(const Subject& subject, const Scene& scene, const Integrator& method, int levels) {
  Stepper stepper(subject, scene, std::string(method.name));
  return {std::string(method.name),
          refine({{"step", "s"},
                  {"relative drift", "1"},
                  {"drift in roundings", "1"},
                  {"drift in tolerances", "1"},
                  {"linear momentum's drift in roundings", "1"}},
                 doubling_range(coarsest, coarsest << (levels - 1)),
                 [&](int count) { return level_of(stepper, method, count); })};
}

NamedFinding kept(const Drift& drift, const std::string& material) {
  Finding finding{
      {drift.levels.worst("drift in roundings"), 16, 0, "epsilon, a step, of sum m|x||v|",
       "a step rounds x and v of each particle once, and the dozen or so forces on it, each at "
       "most about m|v|/h, in their last digits; sixteen assumes that all err to the same side"},
      with_columns(drift.levels, {"step", "relative drift", "drift in roundings"})};
  return {"momentum-drift." + material + "-angular-is-conserved." + drift.scheme,
          "Scheme " + drift.scheme + " keeps the angular momentum of a free, " + material +
              " sheet to rounding.",
          std::move(finding)};
}

/// Without a floor: the start is known, and rounding is judged by itself.
Convergence relative_drift(const Drift& drift) {
  return convergence_of(drift.levels, "relative drift");
}

NamedFinding falls_with_the_order(const Drift& drift) {
  const int order = integrator_named(drift.scheme).order;
  const Convergence convergence = relative_drift(drift);
  Table evidence = with_columns(drift.levels, {"step", "relative drift"});
  evidence.add({"order of the pair", "1", row_orders(convergence)});
  evidence.add(drift.levels.column("drift in roundings"));
  Finding finding{
      order_verdict(
          convergence, order, std::min(pairs_judged, int(drift.levels.rows()) - 2), 0.1,
          "a drift of another power of the step is off by 1; at these steps the next term "
          "leaves less than a tenth"),
      std::move(evidence),
      "measured is the largest |order - " + std::to_string(order) +
          "| over the last pairs, three if there are so many"};
  return {"momentum-drift.damped-drift-order." + drift.scheme,
          "The angular momentum of a free, damped sheet drifts under " + drift.scheme +
              ", by order " + std::to_string(order) + " in the step.",
          std::move(finding)};
}

NamedFinding drift_is_real(const Drift& drift) {
  constexpr double rounding_bound = 16;
  Worst worst;
  for (double roundings : drift.levels.numbers("drift in roundings"))
    worst.observe(rounding_bound / roundings);
  Finding finding{{worst.value(), 0.01, 0, "of the drift",
                   "a hundred times what counts as kept cannot be rounding"},
                  with_columns(drift.levels, {"step", "drift in roundings"}),
                  "measured is the bound of a kept momentum over the drift"};
  return {"momentum-drift.damped-drift-exceeds-rounding.C",
          "The drift of scheme C on a damped sheet is not rounding error.", std::move(finding)};
}

// ---- all methods

/// The same method on the undamped and on the damped sheet.
struct Drifts {
  Drift undamped, damped;
};

NamedFinding linear_is_kept(const Drifts& drifts) {
  Table drift{{"step", "s"}, {"drift in roundings", "1"}};
  for (const Drift* one : {&drifts.undamped, &drifts.damped})
    for (size_t k = 0; k < one->levels.rows(); ++k)
      drift.row(one->levels.numbers("step")[k],
                one->levels.numbers("linear momentum's drift in roundings")[k]);
  return {"momentum-drift.linear-is-conserved." + drifts.damped.scheme,
          "The linear momentum of a free sheet is kept to rounding under " + drifts.damped.scheme +
              ", damped or not, however early a solve stops.",
          {{drift.worst("drift in roundings"), 1, 0, "epsilon, a step, of sum m|v|",
            "forces sum to zero, and every iterate of a solve differs from its guess by such "
            "forces: only the roundings of each particle's velocity are left, at most half an "
            "epsilon of it, of either sign"},
           drift}};
}

NamedFinding kept_to_tolerance(const Drift& drift, const std::string& material) {
  return {
      "momentum-drift." + material + "-angular-is-conserved." + drift.scheme,
      "The implicit midpoint rule keeps the angular momentum of a free, " + material +
          " sheet to the tolerance of its solves.",
      {{drift.levels.worst("drift in tolerances"), 4, 0, "tolerances, a step, of |x||v|",
        "derived: a step changes it by x cross twice the residual, which is at most the tolerance "
        "times the momentum and the first impulse, less than twice the momentum here"},
       with_columns(drift.levels, {"step", "relative drift", "drift in tolerances"}),
       "|x||v| stands for sqrt(sum m|x|^2 sum m|v|^2)"}};
}

Table table_of(const std::vector<Drifts>& all) {
  Table table(
      "method [1]; sheet [1]; step [s]; angular momentum, relative drift [1]; order of the pair "
      "[1]; linear momentum, drift in roundings [1]");
  for (const Drifts& drifts : all)
    for (const auto& [drift, words] :
         {std::pair{&drifts.undamped, "undamped"}, {&drifts.damped, "damped"}}) {
      const std::vector<double>& relative = drift->levels.numbers("relative drift");
      for (size_t k = 0; k < relative.size(); ++k)
        table.row(drift->scheme, words, drift->levels.numbers("step")[k], relative[k],
                  k == 0 ? nan : std::log2(relative[k - 1] / relative[k]),
                  drift->levels.numbers("linear momentum's drift in roundings")[k]);
    }
  return {"all-methods", "Drift of momentum under all methods", table};
}

Figure figure_of(const std::string& name, const std::string& material,
                 const std::vector<const Drift*>& drifts) {
  Figure figure{name,
                "Angular momentum of a free, " + material + " sheet",
                {"step", "s", Scale::log},
                {"relative drift of angular momentum", "1", Scale::log},
                2,
                "Change of the angular momentum from the start to the end of the run, over its "
                "size. Level curves are rounding, or the tolerance of solves."};
  for (const Drift* drift : drifts) {
    Curve curve = curve_of(drift->scheme, relative_drift(*drift));
    if (!(curve.y.front() > 1e-7)) curve.pair_orders.clear();
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

void add_paper_findings(const Drifts& drifts, StudyResult& result) {
  result.findings.push_back(kept(drifts.undamped, "undamped"));
  if (drifts.damped.scheme != "C") {
    result.findings.push_back(kept(drifts.damped, "damped"));
    return;
  }
  result.add({falls_with_the_order(drifts.damped), drift_is_real(drifts.damped)});
}

StudyResult run_momentum_drift(const Subject& subject, Tier tier, const Progress& progress) {
  std::vector<Drifts> all;
  for (const Integrator& method : integrators()) {
    const int levels = (method.family == Family::mixed ? 5 : 3) + (tier == Tier::quick ? 0 : 2);
    all.push_back({drift_of(subject, flying_sheet(0, 0), method, levels),
                   drift_of(subject, flying_sheet(0.031, 0.0004), method, levels)});
    progress(double(all.size()) / double(integrators().size()));
  }

  StudyResult result;
  std::vector<const Drift*> undamped, damped;
  for (size_t i = 0; i < all.size(); ++i) {
    undamped.push_back(&all[i].undamped);
    damped.push_back(&all[i].damped);
    if (integrators()[i].family == Family::mixed) add_paper_findings(all[i], result);
    if (integrators()[i].name == "implicit-midpoint") {
      result.add({kept_to_tolerance(all[i].undamped, "undamped"),
                  kept_to_tolerance(all[i].damped, "damped")});
    } else if (integrators()[i].family != Family::mixed)
      result.findings.push_back(falls_with_the_order(all[i].damped));
    result.findings.push_back(linear_is_kept(all[i]));
  }
  result.figures.push_back(figure_of("drift-damped", "damped", damped));
  result.figures.push_back(figure_of("drift-undamped", "undamped", undamped));
  result.tables.push_back(table_of(all));
  return result;
}

}  // namespace

Study momentum_drift_study() {
  return {
      "momentum-drift",
      "Schemes A and B keep the angular momentum of a free sheet to rounding, damped or not; C "
      "keeps it without damping, and with damping lets it drift by second order in the step. The "
      "implicit midpoint rule keeps it to the tolerance of its solves; all methods keep the linear "
      "momentum.",
      {"undamped-angular-is-conserved", "damped-angular-is-conserved", "damped-drift-order.C",
       "damped-drift-exceeds-rounding.C", "linear-is-conserved"},
      "BMF03 section 3; Hairer, Lubich, Wanner, section IV.2",
      "An irregular sheet, bent, stretched and spinning, flies without any force from outside. The "
      "forces keep angular momentum whenever they are evaluated; a method keeps it only if the "
      "velocity that moves the positions and the velocity that carries the momentum agree in the "
      "sum of cross products. The drift from start to end is measured while the step is halved.",
      run_momentum_drift};
}

}  // namespace foldproof
