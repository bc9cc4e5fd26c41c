// strain-momentum: which scheme keeps the angular momentum of a free sheet while strain
// limits act on it.
#include <Eigen/Geometry>

#include "convergence/study.h"
#include "reference/dynamics/integrator.h"
#include "reference/dynamics/system.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double end = 0.24;  // s
constexpr int coarsest = 60;  // steps

/// A jittered sheet that spins so fast, and flaps so wildly, that its weak, undamped springs are at
/// their limits most of the time; it starts within them.
Scene spinning_sheet() {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::jittered, 0.53, 0, 5, 4, 0.23, 11}), 0.17);
  scene.stretch = StretchMaterial{3, 0, 1};
  scene.bending = BendingMaterial{0.0017, 0};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0.07);
  StrainLimits limits;
  limits.extension = 0.04;
  limits.compression = 0.03;
  limits.sweeps = 1000;
  limits.tolerance = 1e-9;
  scene.strain_limits = limits;
  const Vector3 spin(1.9, -3.3, 6.6), flight(0.3, 0.2, -0.5);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double a = scene.mesh.rest(0, i) / 0.53, b = scene.mesh.rest(1, i) / 0.53;
    const Vector3 flap(0.2 * std::cos(5.1 * b), 0.2 * std::sin(3.7 * a),
                       0.9 * std::cos(5.9 * a - 3.1 * b));
    const Vector3 x = scene.mesh.rest.col(i);
    scene.v.col(i) = spin.cross(x) + flap + flight;
  }
  return scene;
}

/// One level: the drift of the angular momentum over a run of `count` steps.
struct Drift {
  double relative, roundings;  // of |L|; in epsilon a step of sum m |x| |v|
  double sweeps;               // a step [1]
};

Drift drift_over(const Subject& subject, const Scene& scene, const std::string& scheme, int count) {
  Stepper stepper(subject, scene, scheme);
  const System system = build_system(scene);
  const State start = stepper.start();
  State s = start;
  Worst size;
  for (int n = 0; n < count; ++n) {
    size.observe(
        s.x.colwise().norm().cwiseProduct(s.v.colwise().norm()).dot(system.mass.transpose()));
    s = stepper.step(s, end / count);
  }
  const Vector3 before = angular_momentum(system, start);
  const double moved = (angular_momentum(system, s) - before).norm();
  return {moved / before.norm(), moved / (epsilon * count * size.value()),
          double(stepper.work().strain_sweeps) / count};
}

const std::string sweeps_at_finest = "sweeps a step, at the finest";

/// The drifts of a scheme over steps that are halved level by level.
Table drifts_of(const Subject& subject, const std::string& scheme, int levels) {
  const Scene scene = spinning_sheet();
  double sweeps = 0;
  Table drifts = refine({{"step", "s"}, {"relative drift", "1"}, {"drift in roundings", "1"}},
                        doubling_range(coarsest, coarsest << (levels - 1)), [&](int count) {
                          const Drift drift = drift_over(subject, scene, scheme, count);
                          sweeps = drift.sweeps;
                          return std::tuple{end / count, drift.relative, drift.roundings};
                        });
  drifts.add({sweeps_at_finest, "1", std::vector<double>(drifts.rows(), sweeps)});
  return drifts;
}

NamedFinding kept(const std::string& scheme, const Table& drifts) {
  const double sweeps = drifts.numbers(sweeps_at_finest).back();
  return {
      "strain-momentum.is-conserved." + scheme,
      "Scheme " + scheme +
          " keeps the angular momentum of a free, undamped sheet at its strain limits to rounding.",
      {{drifts.worst("drift in roundings"), 16 + 12 * sweeps, 0, "epsilon, a step, of sum m|x||v|",
        "sixteen roundings of x, v and the forces, all to the same side, and two in each sweep for "
        "each of about six springs at a particle"},
       drifts}};
}

NamedFinding drift_order(const std::string& scheme, const Table& drifts) {
  const double fitted = fitted_order(convergence_of(drifts, "relative drift"));
  return {"strain-momentum.drift-is-first-order." + scheme,
          "The angular momentum of a free, undamped sheet at its strain limits drifts under " +
              scheme + ", by first order in the step.",
          {{std::abs(fitted - 1), 0.1, 0, "1",
            "a drift of another power of the step is off by 1; at these steps the next term leaves "
            "less than a tenth"},
           drifts,
           "measured is |order - 1| of the line through all levels"}};
}

StudyResult run_strain_momentum(const Subject& subject, Tier tier, const Progress& progress) {
  const int levels = tier == Tier::quick ? 5 : 7;
  StudyResult result;
  Figure figure{
      "drift",
      "Angular momentum of a free sheet at its strain limits",
      {"step", "s", Scale::log},
      {"relative drift of angular momentum", "1", Scale::log},
      1,
      "Change of the angular momentum from the start to the end of the run, over its size. The "
      "sheet is not damped, so that A and C are the same scheme; B's drift is rounding."};
  double done = 0;
  for (const Integrator& method : paper_schemes()) {
    const std::string scheme(method.name);
    const Table drifts = drifts_of(subject, scheme, levels);
    result.findings.push_back(scheme == "B" ? kept(scheme, drifts) : drift_order(scheme, drifts));
    figure.curves.push_back(curve_of(scheme, drifts, "step", "relative drift"));
    progress(++done / 3);
  }
  result.figures.push_back(std::move(figure));
  return result;
}

}  // namespace

Study strain_momentum_study() {
  return {"strain-momentum",
          "While strain limits act, scheme B keeps the angular momentum of a free, undamped sheet "
          "to rounding; A and C let it drift, by first order in the step.",
          {"is-conserved.B", "drift-is-first-order"},
          "BMF03 section 3",
          "An undamped sheet spins and flaps at its strain limits. Each correction keeps angular "
          "momentum. But A and C move positions with the corrected velocity and keep the "
          "uncorrected one: a step changes the momentum by h times the sum of m (corrected - "
          "uncorrected) x v. Impulses that resist a force are of order h, so a step errs by h^2, "
          "and a run by h. B keeps the velocity that it moved with.",
          run_strain_momentum};
}

}  // namespace foldproof
