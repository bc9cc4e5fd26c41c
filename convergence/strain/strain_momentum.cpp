// strain-momentum: which scheme keeps the angular momentum of a free sheet while strain
// limits act on it.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "convergence/order.h"
#include "convergence/strain/studies.h"
#include "reference/dynamics/integrator.h"
#include "reference/dynamics/system.h"
#include "reference/mesh/shapes.h"
#include "verification/evidence.h"
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
  scene.bending = BendingMaterial{0.0017, 0, Weighting::rest, DampingFactor::edge, "sine"};
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

struct Drift {
  std::string scheme;
  std::vector<double> steps, relative, roundings;  // s; of |L|; in epsilon a step of sum m |x| |v|
  double sweeps = 0;                               // a step, at the finest step [1]
};

void add_level(const Subject& subject, const Scene& scene, int count, Drift& drift) {
  Stepper stepper(subject, scene, drift.scheme);
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
  drift.steps.push_back(end / count);
  drift.relative.push_back(moved / before.norm());
  drift.roundings.push_back(moved / (epsilon * count * size.value()));
  drift.sweeps = double(stepper.work().strain_sweeps) / count;
}

std::vector<Column> evidence_of(const Drift& drift) {
  return {
      {"step", "s", drift.steps},
      {"relative drift", "1", drift.relative},
      {"drift in roundings", "1", drift.roundings},
      {"sweeps a step, at the finest", "1", std::vector<double>(drift.steps.size(), drift.sweeps)}};
}

NamedFinding kept(const Drift& drift) {
  Worst worst;
  for (const double roundings : drift.roundings) worst.observe(roundings);
  return {"strain-momentum.is-conserved." + drift.scheme,
          "Scheme " + drift.scheme +
              " keeps the angular momentum of a free sheet at its strain limits to rounding.",
          {{worst.value(), 16 + 12 * drift.sweeps, 0, "epsilon, a step, of sum m|x||v|",
            "sixteen roundings of x, v and the forces, all erring to one side, and two for each of "
            "some six springs at a particle in each sweep"},
           evidence_of(drift),
           ""}};
}

NamedFinding drifts(const Drift& drift) {
  const double fitted = fitted_order({drift.steps, drift.relative, 0});
  return {"strain-momentum.drift-is-first-order." + drift.scheme,
          "The angular momentum of a free sheet at its strain limits drifts under " + drift.scheme +
              ", by first order in the step.",
          {{std::abs(fitted - 1), 0.1, 0, "1",
            "a drift of another power of the step is off by 1; at these steps the next term leaves "
            "less than a tenth"},
           evidence_of(drift),
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
      "sheet is not damped, so that A and C are the same scheme; B's drift is rounding.",
      {}};
  double done = 0;
  for (const Integrator& method : paper_schemes()) {
    Drift drift{std::string(method.name), {}, {}, {}};
    for (int level = 0, count = coarsest; level < levels; ++level, count *= 2)
      add_level(subject, spinning_sheet(), count, drift);
    result.findings.push_back(drift.scheme == "B" ? kept(drift) : drifts(drift));
    figure.curves.push_back({drift.scheme, drift.steps, drift.relative, nan, {}});
    progress(++done / 3);
  }
  result.figures.push_back(std::move(figure));
  return result;
}

}  // namespace

Study strain_momentum_study() {
  return {"strain-momentum",
          "While strain limits act, scheme B keeps the angular momentum of a free sheet to "
          "rounding; A and C let it drift, by first order in the step.",
          "BMF03 section 3",
          "An undamped sheet spins and flaps at its strain limits. Each correction keeps angular "
          "momentum. But A and C move the positions with the corrected velocity and carry on the "
          "uncorrected one: a step changes the momentum by h times the sum of m (corrected - "
          "uncorrected) x v, which is the impulses' torque about where the other ends of their "
          "springs go. Impulses that hold against a force are of the order of h, so a step errs by "
          "h^2, and a run by h. B carries on the velocity that it moved with.",
          run_strain_momentum};
}

}  // namespace foldproof
