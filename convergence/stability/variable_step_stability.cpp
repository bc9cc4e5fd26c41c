// variable-step-stability: steps that are stable each by itself need not be so in turn.

#include "convergence/stability/stable_step.h"
#include "convergence/stability/step_matrix.h"
#include "convergence/study.h"
#include "reference/dynamics/integrator.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/stability.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

/// The hinge's corner without any force: x'' = 0.
SteppedMotion bdf2_without_forces(const Subject& subject) {
  SmallMotion motion = hinge_oscillator(0);
  motion.scene.bending.reset();
  motion.scene.rest_angles.clear();
  return stepped_motion(subject, std::move(motion), "BDF2");
}

/// Factor on the difference of the two latest velocities in one step of ratio times the one before.
double difference_factor(const SteppedMotion& of, double ratio) {
  const double h = 1 / of.motion.omega0;
  const Eigen::MatrixXd matrix = step_matrix(of, {ratio * h, h});
  return -matrix(3, 1);  // v'' = (1 + p) v' - p v
}

NamedFinding zero_stability(const Subject& subject) {
  const SteppedMotion of = bdf2_without_forces(subject);
  double below = 1, above = 5;
  for (int i = 0; i < 45; ++i) {
    const double middle = (below + above) / 2;
    (difference_factor(of, middle) <= 1 ? below : above) = middle;
  }
  const oracles::Estimate exact = oracles::bdf2_largest_ratio();
  return {
      "variable-step-stability.BDF2.largest-step-ratio-is-as-derived",
      "With steps that grow by a constant ratio, BDF2 amplifies differences between solutions of "
      "x'' = 0 from the ratio 1 + sqrt(2) on.",
      {{std::abs((below + above) / 2 - exact.value), 1e-9, exact.uncertainty, "1",
        "the factor r^2/(1 + 2 r) is found to roundings, and its slope there is 0.35"},
       Table{{"ratio found", "1"}, {"1 + sqrt(2)", "1"}}.with_row((below + above) / 2,
                                                                  exact.value)}};
}

/// A corner in flight at v0, whose second state is disturbed: what comes of the disturbance after
/// steps that grow by `ratio` up to omega h = .001, over the disturbance.
double amplification(const SteppedMotion& of, double ratio) {
  constexpr int steps = 600;
  double h = 1e-3 / of.motion.omega0 * std::pow(ratio, -steps);
  State first = start_state(of.motion.scene), second = first;
  second.v(2, 0) = of.motion.omega0 * of.motion.disturbance;
  second.time = h;
  const double size = second.v(2, 0);
  std::vector<State> past = {first, second};
  Work uncounted;
  for (int i = 0; i < steps; ++i) {
    h *= ratio;
    State next = of.subject.step(*of.prepared, past, h, uncounted);
    past = {past[1], std::move(next)};
  }
  return std::abs(past[1].v(2, 0)) / size;
}

std::vector<NamedFinding> growing_steps(const std::string& where, const SteppedMotion& of) {
  constexpr double below = 2.40, above = 2.43;
  const auto factor = [](double r) { return r * r / (1 + 2 * r); };
  const double kept = amplification(of, below), grown = amplification(of, above);
  const double bound = 1 / (1 - factor(below));  // 1 + p + p^2 + ...
  return {
      {"variable-step-stability.BDF2.bounded-below-that-ratio." + where,
       "Steps that grow by 2.40 leave BDF2 bounded on " + where + ".",
       {{kept / bound, 1, 0, "1",
         "differences fall by p = r^2/(1 + 2 r) each step, so they add up to less than 1/(1 - p)"},
        Table{{"amplification after 600 steps", "1"}, {"1/(1 - p)", "1"}}.with_row(kept, bound)}},
      {"variable-step-stability.BDF2.grows-above-that-ratio." + where,
       "Steps that grow by 2.43 make BDF2 grow without bound on " + where + ", though implicit.",
       {{1000 / grown, 1, 0, "1",
         "p = 1.0077 to the power 600 is 98, and the sum exceeds ten thousand; a thousand "
         "separates it from bounded motion"},
        Table{{"amplification after 600 steps", "1"}}.with_row(grown),
        "measured is a thousand over the amplification"}}};
}

std::vector<NamedFinding> bdf2_growing_steps(const Subject& subject) {
  std::vector<NamedFinding> findings = {zero_stability(subject)};
  for (NamedFinding& finding : growing_steps("free-flight", bdf2_without_forces(subject)))
    findings.push_back(std::move(finding));
  for (NamedFinding& finding :
       growing_steps("the-hinge", stepped_motion(subject, hinge_oscillator(0), "BDF2")))
    findings.push_back(std::move(finding));
  return findings;
}

constexpr double short_step = 0.69, long_step = 1.99;  // omega h of the worst pair of stable steps

/// Spectral radius of two steps in turn, by the derived matrices.
double exact_radius(std::string_view scheme, double zeta, double first, double second) {
  const oracles::Oscillator oscillator{1, 2 * zeta, 0, 0};
  return spectral_radius(oracles::step_matrix(derived_scheme(scheme), oscillator, second) *
                         oracles::step_matrix(derived_scheme(scheme), oscillator, first));
}

/// The same by stepping; first and second are omega h.
double stepped_radius(const SteppedMotion& of, double first, double second) {
  return spectral_radius(pair_matrix(of, first / of.motion.omega0, second / of.motion.omega0));
}

// ---- one oscillator

NamedFinding resonance_finding(const Subject& subject, const std::string& scheme) {
  const SteppedMotion of = stepped_motion(subject, hinge_oscillator(0), scheme);
  const double pair = stepped_radius(of, short_step, long_step);
  const std::vector<double> alone = {stepped_radius(of, short_step, short_step),
                                     stepped_radius(of, long_step, long_step)};
  constexpr double rounding = 1e-6;  // of a radius that is 1
  Worst either;
  for (const double radius : alone) either.observe(radius <= 1 + rounding ? radius : nan);
  const Verdict verdict{either.value() / pair, 0.5, 0, "1",
                        "growth by more than a factor of two in each pair of steps is neither "
                        "rounding nor slow drift"};
  return {"variable-step-stability.alternating-steps-resonate." + scheme,
          "Undamped, alternating steps of 0.69/omega and 1.99/omega make scheme " + scheme +
              " grow, though each alone is stable: to stay below the limit does not suffice if "
              "steps vary.",
          {verdict,
           Table("spectral radius of the pair [1]; of two short steps [1]; of two long steps [1]")
               .with_row(pair, alone[0], alone[1]),
           "measured is the larger spectral radius of two equal steps over that of the pair; NaN "
           "if equal steps grow"}};
}

NamedFinding damped_finding(const Subject& subject, const std::string& scheme) {
  Table radii{{"damping ratio", "1"}, {"spectral radius of the pair", "1"}};
  for (const double zeta : {0.5, 0.7, 1.0, 2.0, 5.0, 20.0})
    radii.row(zeta, stepped_radius(stepped_motion(subject, hinge_oscillator(zeta), scheme),
                                   short_step, long_step));
  return {"variable-step-stability.damping-removes-resonance." + scheme,
          "A damping ratio of a half or more makes alternating steps of 0.69/omega and 1.99/omega "
          "stable in scheme " +
              scheme + ".",
          judge_worst(radii, 1, "a spectral radius above 1 grows",
                      "measured is the largest of the radii")};
}

/// The damping ratio from which on a pair of steps no longer grows; 0 if it never does.
double curing_ratio(const std::string& scheme, double first, double second) {
  double grows = 0, stays = 1;
  if (exact_radius(scheme, 0, first, second) <= 1 + 1e-9) return 0;
  for (int i = 0; i < 40; ++i) {
    const double middle = (grows + stays) / 2;
    (exact_radius(scheme, middle, first, second) > 1 ? grows : stays) = middle;
  }
  return stays;
}

Map ratio_map(const Subject& subject, const std::string& method, int fineness) {
  Map map{"pair-" + method,
          "Steps of 1.99/omega and shorter ones in turn, method " + method,
          {"shorter step over longer one", "1"},
          {"damping ratio", "1"},
          linear_range(0.02, 1, 14 * fineness),
          linear_range(0, 0.6, 8 * fineness),
          {},
          "spectral radius of a pair of steps",
          "1",
          Scale::linear,
          "Above 1 a disturbance grows from pair to pair, though each step alone is stable.",
          {}};
  for (const double zeta : map.y_values) {
    const SteppedMotion of = stepped_motion(subject, hinge_oscillator(zeta), method);
    for (const double ratio : map.x_values)
      map.values.push_back(stepped_radius(of, ratio * long_step, long_step));
  }
  return map;
}

void add_border(const std::string& scheme, Map& map) {
  Curve curve{"spectral radius 1, derived"};
  for (const double ratio : linear_range(0.02, 1, 197)) {
    const double zeta = curing_ratio(scheme, ratio * long_step, long_step);
    curve.point(ratio, zeta > 0 ? zeta : nan);
  }
  map.curves.push_back(std::move(curve));
  map.caption += " Below the curve, from the derived matrices, pairs grow.";
}

NamedFinding map_finding(const std::string& scheme, const Map& map) {
  Worst worst;
  for (size_t iy = 0, i = 0; iy < map.y_values.size(); ++iy)
    for (const double ratio : map.x_values) {
      const double exact = exact_radius(scheme, map.y_values[iy], ratio * long_step, long_step);
      worst.observe(std::abs(map.values[i++] / exact - 1));
    }
  return {"variable-step-stability.growth-is-as-derived." + scheme,
          "The spectral radius of two steps in turn of scheme " + scheme +
              " is that of the derived matrices, over step ratios and damping ratios.",
          {{worst.value(), 1e-6, 0, "1",
            "entries are found to 1e-12 or so, which moves the two eigenvalues by the square root "
            "of that where they coincide"},
           Table{{"points compared", "1"}}.with_row(double(map.values.size())),
           "measured is the largest relative deviation over the map"}};
}

/// Where an undamped pair grows: over both steps.
Map both_steps_map(const Subject& subject, int fineness) {
  Map map{"undamped-steps",
          "Two steps in turn without damping",
          {"first step, omega h", "1"},
          {"second step, omega h", "1"},
          linear_range(0.05, 2, 12 * fineness + 1),
          linear_range(0.05, 2, 12 * fineness + 1),
          {},
          "spectral radius of a pair of steps",
          "1",
          Scale::linear,
          "Schemes A, B and C agree without damping. Each of these steps alone is stable; off the "
          "diagonal some pairs resonate, most of all with a step near the limit.",
          {}};
  const SteppedMotion of = stepped_motion(subject, hinge_oscillator(0), "A");
  for (const double second : map.y_values)
    for (const double first : map.x_values) map.values.push_back(stepped_radius(of, first, second));
  return map;
}

// ---- the sheet

/// The largest size of a disturbance of the sheet over 300 pairs of steps, over that at the start.
double sheet_growth(const Subject& subject, Scene scene, const std::string& scheme, double zeta) {
  constexpr int pairs = 300;
  constexpr double enough = 1e6, stretch = 29;
  scene.stretch = StretchMaterial{stretch, 0, 1};
  const double omega = fastest_mode(subject, scene).omega;
  scene.stretch->damping = 2 * zeta * stretch / omega;
  Stepper stepper(subject, scene, scheme);
  State s = stepper.start();
  s.x += small_disturbance * disturbance_shape(s.x.cols());
  const double start = (s.x - scene.x).norm();
  Worst worst;
  for (int i = 0; i < 2 * pairs && !(worst.value() >= enough); ++i) {
    const double h = (i % 2 == 0 ? short_step : long_step) / omega;
    s = stepper.step(s, h);
    worst.observe((s.x - scene.x).norm() / start);
  }
  return worst.value();
}

void add_sheet_findings(const Subject& subject, const std::string& scheme, StudyResult& result) {
  const Scene scene = scene_at_rest(make_sheet({SheetPattern::union_jack, 0.61, 0.61, 5, 5}), 0.23);
  const double undamped = sheet_growth(subject, scene, scheme, 0);
  const double damped = sheet_growth(subject, scene, scheme, 0.5);
  result.findings.push_back(
      {"variable-step-stability.undamped-sheet-grows." + scheme,
       "The motion of an undamped sheet grows under scheme " + scheme +
           " with alternating steps of 0.69 and 1.99 over its highest frequency.",
       {{1e3 / undamped, 1, 0, "1",
         "a thousand times its size is beyond what bounded modes can add up to"},
        Table{{"largest size over the start's", "1"}}.with_row(undamped),
        "measured is a thousand over the growth"}});
  result.findings.push_back(
      {"variable-step-stability.damped-sheet-does-not-grow." + scheme,
       "The motion of a sheet whose highest mode has a damping ratio of a half stays below ten "
       "times its start under the same steps of scheme " +
           scheme + ".",
       {{damped / 10, 1, 0, "1",
         "a mode near its limit may exceed its start, by 1/sqrt(1 - (omega h/2)^2) = 10 at "
         "1.99/omega"},
        Table{{"largest size over the start's", "1"}}.with_row(damped),
        "measured is the growth over ten"}});
}

StudyResult run_variable_step_stability(const Subject& subject, Tier tier,
                                        const Progress& progress) {
  const int fineness = tier == Tier::quick ? 3 : 10;
  StudyResult result;
  double done = 0;
  for (const std::string scheme : {"A", "B", "C"}) {
    result.add({resonance_finding(subject, scheme), damped_finding(subject, scheme)});
    Map map = ratio_map(subject, scheme, fineness);
    result.findings.push_back(map_finding(scheme, map));
    add_border(scheme, map);
    result.maps.push_back(std::move(map));
    add_sheet_findings(subject, scheme, result);
    progress(++done / 5);
  }
  result.maps.push_back(ratio_map(subject, "BDF2", fineness));
  result.maps.push_back(both_steps_map(subject, fineness));
  progress(++done / 5);
  result.add(bdf2_growing_steps(subject));
  progress(1);
  return result;
}

}  // namespace

Study variable_step_stability_study() {
  return {"variable-step-stability",
          "Steps that are stable alone can resonate when they alternate: undamped, a disturbance "
          "under A, B or C more than doubles in each pair of steps of 0.69/omega and 1.99/omega; a "
          "damping ratio of a half prevents this.",
          {"alternating-steps-resonate", "damping-removes-resonance", "undamped-sheet-grows",
           "damped-sheet-does-not-grow"},
          "BMF03 section 3",
          "The paper asks for a scheme whose step may vary. The matrix of two steps in turn is the "
          "product of their two matrices, which are found by stepping a hinge whose corner is an "
          "oscillator and compared with the derived ones; the same steps are then taken on a "
          "sheet. BDF2 has a limit of its own: no step may be longer than 1 + sqrt(2) times the "
          "one before it.",
          run_variable_step_stability};
}

}  // namespace foldproof
