// Methods of other papers on small cloth: Newmark's implicit method, and Baraff and Witkin's solve.
#include "reference/mesh/shapes.h"
#include "verification/specimens/check.h"
#include "verification/specimens/dense_steps.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

/// A small sheet held at one edge.
Scene held_sheet(double spring_damping) {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::alternating, 0.2, 0.2, 3, 3}), 0.19);
  scene.stretch = StretchMaterial{23, spring_damping, 1};
  for (int i = 0; i < scene.mesh.particles(); ++i)
    if (scene.mesh.rest(1, i) < 1e-9) scene.prescribed.push_back({i, scene.x.col(i), Motion{}});
  return scene;
}

// ---- Newmark

Scene vibrating_sheet() {
  Scene scene = held_sheet(0);
  scene.bending = BendingMaterial{2e-3, 0, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  Random random(23);
  scene.v = random.vectors(scene.x.cols(), 0.3);
  for (const PrescribedParticle& p : scene.prescribed) scene.v.col(p.particle).setZero();
  return scene;
}

/// Mean energies of the first and the last tenth of a run.
struct LongRun {
  double first = 0, last = 0, largest = 0;  // over the start's
};

LongRun long_run(const Subject& subject, double h, int steps) {
  const Scene scene = vibrating_sheet();
  DenseCloth cloth(subject, scene);
  State s{0, scene.x, scene.v};
  const double start = cloth.energy(s);
  LongRun run;
  const int tenth = steps / 10;
  for (int k = 0; k < steps; ++k) {
    s = cloth.average_acceleration(s, h);
    const double energy = cloth.energy(s) / start;
    update_worst(run.largest, energy);
    if (k < tenth) run.first += energy / tenth;
    if (k >= steps - tenth) run.last += energy / tenth;
  }
  return run;
}

Finding newmark_keeps_energy(const Subject& subject) {
  const Scene scene = vibrating_sheet();
  const double limit = elastic_limit(build_system(scene), start_state(scene));
  Table found(
      "step over the elastic limit [1]; steps [1]; largest energy, of the start's [1]; change from "
      "the first tenth to the last [1]");
  for (const double part : {0.25, 0.5, 1.0, 2.0}) {
    const int steps = int(1600 / std::max(part, 0.5));
    const LongRun run = long_run(subject, part * limit, steps);
    found.row(part, steps, run.largest, std::abs(run.last / run.first - 1));
  }
  return judge_worst(found, "change from the first tenth to the last", 0.02,
                     "two percent in thousands of steps is no trend: the method is conjugate to "
                     "the midpoint rule, so that its energy only wavers, by the square of the step",
                     "average acceleration, Newton's method to rounding");
}

// ---- the dropped term

/// A damped sheet that falls and swings about its held edge.
Scene swinging_sheet(double damping) {
  Scene scene = held_sheet(damping);
  scene.gravity = Vector3(0, 0, -9.80665);
  return scene;
}

PerParticle3 swung(const DenseCloth& cloth, const Scene& scene, double h, double until,
                   DampingDerivative part) {
  State s{0, scene.x, scene.v};
  for (int k = 0; k < int(std::lround(until / h)); ++k) s = cloth.one_solve(s, h, part);
  return s.x;
}

Table dropped_terms(const Subject& subject, double damping) {
  const Scene scene = swinging_sheet(damping);
  const DenseCloth cloth(subject, scene);
  constexpr double until = 0.24;  // s
  const auto run = [&](double h, DampingDerivative part) {
    return swung(cloth, scene, h, until, part);
  };
  // two fine runs, extrapolated: backward Euler is of first order
  const PerParticle3 exact =
      2 * run(until / 240, DampingDerivative::whole) - run(until / 120, DampingDerivative::whole);
  Table found(
      "step [s]; error, whole [m]; error, without the term [m]; one over the other [1]; error, "
      "without the derivative [m]");
  for (const int parts : {8, 16, 32, 64}) {
    const auto error = [&](DampingDerivative part) {
      return (run(until / parts, part) - exact).norm() / std::sqrt(double(exact.cols()));
    };
    const double whole = error(DampingDerivative::whole),
                 without = error(DampingDerivative::symmetric_part);
    found.row(until / parts, whole, without, without / whole, error(DampingDerivative::none));
  }
  return found;
}

constexpr double weak = 0.004, strong = 0.4;  // kd_s [N s/m]

Finding term_has_no_effect(const Subject& subject) {
  Table found = dropped_terms(subject, weak);
  double most = 0;
  for (const double ratio : found.numbers("one over the other"))
    update_worst(most, std::abs(ratio - 1));
  return {
      {most, 0.2, 0, "1",
       "a fifth of the error is what a step shorter by a fifth is worth; both are of first order"},
      std::move(found),
      "root of the mean square, after 0.24 s of a falling, swinging sheet"};
}

Finding term_matters(const Subject& subject) {
  Table found = dropped_terms(subject, strong);
  const double most = found.worst("one over the other");
  return {{1.2 / most, 1, 0, "1", "more than the fifth that would be no practical effect"},
          std::move(found),
          "the same sheet with a hundred times the damping"};
}

}  // namespace

std::vector<Check> other_method_checks() {
  return {{"dynamics.implicit-newmark-keeps-energy",
           "Newmark's implicit method leaves the energy of an undamped vibrating sheet without a "
           "trend over thousands of steps.",
           "Grinspun, Hirani, Desbrun, Schroeder 2003", newmark_keeps_energy},
          {"dynamics.dropped-damping-term-changes-little",
           "One linear solve a step errs as much without the term of the damping's derivative that "
           "breaks its symmetry as with it, to a fifth, on a swinging, weakly damped sheet.",
           "Baraff, Witkin 1998", term_has_no_effect},
          {"dynamics.dropped-damping-term-matters-in-strong-damping",
           "On a strongly damped sheet one linear solve a step errs by more than a fifth more "
           "without that term.",
           "Baraff, Witkin 1998", term_matters}};
}

}  // namespace foldproof
