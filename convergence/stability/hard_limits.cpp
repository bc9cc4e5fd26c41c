// hard-limits: where stiffness ratios, slivers, graded meshes, heavy damping and jumps of the step
// stop the schemes.

#include "convergence/stability/stable_step.h"
#include "convergence/stability/step_matrix.h"
#include "convergence/study.h"
#include "reference/dynamics/integrator.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

// ---- a jump of the step, and the energy of a vibration

constexpr double fraction = 0.9;                               // s: the long step over 2/omega
constexpr double one_minus_squared = 1 - fraction * fraction;  // 1 - s^2
constexpr int jump = 100;

/// Energies after the jump over that at the start [1].
struct EnergyRange {
  Worst largest, over_least;  // largest, and one over the least
};

/// The sheet vibrates in one mode.
EnergyRange after_jump(Stepper& stepper, const Probe& probe, const FastestMode& mode,
                       double phase) {
  const PerParticle mass = lumped_masses(stepper.scene().mesh, stepper.scene().density);
  const auto energy = [&](const State& s) {
    return 0.5 * s.v.colwise().squaredNorm().dot(mass.transpose()) + probe.energy(s);
  };
  const double h = fraction * 2 / mode.omega;
  State s = stepper.start();
  s.x += small_disturbance * mode.shape;
  const double start = energy(s);
  s = stepper.run(s, h / jump, int(std::lround(phase / mode.omega / (h / jump))));
  EnergyRange range;
  for (int i = 0; i < 60; ++i) {
    s = stepper.step(s, h);
    range.largest.observe(energy(s) / start);
    range.over_least.observe(start / energy(s));
  }
  return range;
}

// At the step h = s (2/omega) the leapfrog keeps Q = v^2/2 + (1 - s^2) omega^2 x^2/2 of an undamped
// mode. At any phase, the energy E at the jump gives a Q in [(1 - s^2) E, E]; afterwards the
// energy lies in [Q, Q/(1 - s^2)].
/// The finding hard-limits.energy-is-bounded-across-a-step-jump.<scheme>: an undamped sheet
/// vibrates in its fastest mode in steps of 0.009 (2/omega), which jump to 0.9 (2/omega) at one of
/// eight phases of the period.
NamedFinding step_jump(const Subject& subject, Scene scene, const std::string& scheme) {
  scene.integrator = scheme;
  Stepper stepper(subject, scene, scheme);
  const Probe probe(subject, scene);
  const FastestMode mode = fastest_mode(subject, scene);
  Worst worst;
  Table energies(
      "phase at the jump [rad]; least energy after it, over the start's [1]; largest energy after "
      "it, over the start's [1]");
  for (int k = 0; k < 8; ++k) {
    const double phase = 2 * pi * k / 8;
    const EnergyRange range = after_jump(stepper, probe, mode, phase);
    energies.row(phase, 1 / range.over_least.value(), range.largest.value());
    worst.observe(range.largest.value() * one_minus_squared);
    worst.observe(range.over_least.value() * one_minus_squared);
  }
  return {"hard-limits.energy-is-bounded-across-a-step-jump." + scheme,
          "When the step jumps by 1 : 100 to s (2/omega), s = 0.9, the energy of scheme " + scheme +
              " stays within [1 - s^2, 1/(1 - s^2)] of what it was.",
          {{worst.value(), 1.01, 0, "1",
            "one for the derived range; a hundredth for the vibration being not quite the fastest "
            "mode alone"},
           energies,
           "measured is how far the range is used: the largest energy, or one over the least, "
           "times 1 - s^2"}};
}

/// The ribbon of cases/hard/slivers.toml: held at one end, it falls from the horizontal.
Scene falling_ribbon(double safety) {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::one_diagonal, 1.2, 0.003, 2, 6}), 0.2);
  scene.gravity = Vector3(0, 0, -9.80665);
  scene.stretch = StretchMaterial{50, 0, 1};
  add_flat_hinges(scene, 1e-6, 0);
  for (int i = 0; i < scene.mesh.particles(); ++i)
    if (scene.x(0, i) == 0) scene.prescribed.push_back({i, scene.x.col(i), {}});
  scene.schedule = {0.3, 0.1, {0, safety, 0.1}, 200'000};
  return scene;
}

/// The time at which the run loses a triangle [s]; NaN if it does not, or stops for another reason.
double collapse_time(const Scene& scene) {
  const RunResult result =
      simulate(build_system(scene), integrator_named("C"), start_state(scene), scene.schedule, {});
  const bool is_lost =
      result.stop && result.stop->reason.find("lost its area") != std::string::npos;
  return is_lost ? result.stop->time : nan;
}

/// The finding hard-limits.slivers-collapse-at-any-step. It runs the reference.
NamedFinding sliver_collapse() {
  Table collapses{{"step over the elastic limit", "1"}, {"time of collapse", "s"}};
  Worst apart;
  for (const double safety : {0.9, 0.45}) {
    collapses.row(safety, collapse_time(falling_ribbon(safety)));
    const std::vector<double>& times = collapses.numbers("time of collapse");
    apart.observe(std::abs(times.back() / times.front() - 1));
  }
  return {"hard-limits.slivers-collapse-at-any-step",
          "A falling ribbon of triangles 1200 times as long as high shears until one has lost its "
          "area, at the same time for every step: a limit of the model, not of the integration.",
          {{apart.value(), 1e-3, 0, "1",
            "a failure of the steps would come at another time when they are halved; second order "
            "leaves less than a thousandth"},
           collapses,
           "measured is the relative difference of the times"}};
}

constexpr double density = 0.2;  // kg/m^2
constexpr double stretch = 50;   // Y [N/m]

/// A flat, free, undamped sheet, and what is hard about it.
struct HardSheet {
  std::string name, words;
  Scene scene;
};

Scene sheet_scene(const Sheet& sheet, double bending) {
  Scene scene = scene_at_rest(make_sheet(sheet), density);
  scene.stretch = StretchMaterial{stretch, 0, 1};
  if (bending > 0) add_flat_hinges(scene, bending, 0);
  return scene;
}

Sheet square(double side, int cells, double grading) {
  return {SheetPattern::union_jack, side, side, cells, cells, 0, 0, grading};
}

/// ke / (Y dx^2) is the ratio of a hinge's stiffness to a spring's, dx the width of a cell.
std::vector<HardSheet> hard_sheets() {
  const double per_ratio = stretch * 0.1 * 0.1;  // J
  return {{"bending-stiff", "ke/(Y dx^2) = 1e6", sheet_scene(square(0.6, 6, 1), 1e6 * per_ratio)},
          {"bending-soft", "ke/(Y dx^2) = 1e-6", sheet_scene(square(0.6, 6, 1), 1e-6 * per_ratio)},
          {"slivers", "triangles 1200 times as long as high",
           sheet_scene({SheetPattern::one_diagonal, 1.2, 0.003, 2, 6, 0, 0, 1}, 1e-6)},
          {"edges-graded", "edges from 1 mm to 1 m", sheet_scene(square(1.594, 8, 1000), 1e-6)},
          {"masses-graded", "areas and masses 1 : 10^4", sheet_scene(square(0.6, 8, 100), 1e-6)}};
}

// ---- undamped sheets

/// Largest stable steps of one sheet over 2/omega, by scheme, and the solver's own
/// bound over 2/omega.
struct SheetLimits {
  double exact;  // 2/omega [s]
  double bound;
  std::vector<double> schemes;
};

SheetLimits limits_of(const Subject& subject, Scene scene) {
  const double omega = fastest_mode(subject, scene).omega;
  SheetLimits limits{
      2 / omega, elastic_limit(build_system(scene), start_state(scene)) * omega / 2, {}};
  for (const Integrator& integrator : paper_schemes()) {
    scene.integrator = std::string(integrator.name);
    limits.schemes.push_back(largest_stable_step(subject, scene, omega, {0.9, 1.1, 7, 400}));
  }
  return limits;
}

NamedFinding undamped_finding(const HardSheet& sheet, const SheetLimits& limits) {
  Worst worst;
  Table ratios{{"scheme", "1"}, {"largest stable step over 2/omega", "1"}};
  for (size_t k = 0; k < limits.schemes.size(); ++k) {
    ratios.row(paper_schemes()[k].name, limits.schemes[k]);
    worst.observe(std::abs(limits.schemes[k] - 1));
  }
  const Verdict verdict{worst.value(), 0.01, 0, "1",
                        "the bisection ends at a width of a sixth of that, and power iteration has "
                        "found omega to better than half of it"};
  return {"hard-limits.is-two-over-omega." + sheet.name,
          "With " + sheet.words +
              ", the largest stable step of schemes A, B and C is 2/omega all the same.",
          {verdict, ratios, "measured is the largest |ratio - 1|"}};
}

NamedFinding bound_finding(const std::vector<HardSheet>& sheets,
                           const std::vector<SheetLimits>& limits) {
  Table ratios{{"sheet", "1"}, {"elastic limit over 2/omega", "1"}};
  for (size_t i = 0; i < sheets.size(); ++i) ratios.row(sheets[i].words, limits[i].bound);
  const double worst = ratios.worst("elastic limit over 2/omega");
  return {
      "hard-limits.bound-is-safe",
      "The reference's elastic limit is no longer than the largest stable step on hard sheets "
      "either.",
      {{worst, 1, 0.01 * worst, "1", "the bound on the frequency must not lie below the frequency"},
       ratios,
       "power iteration approaches omega from below, which errs towards passing; the uncertainty "
       "is the one percent within which runs confirm 2/omega"}};
}

// ---- damping

struct DampedLimit {
  std::string scheme;
  double ratio;     // of damping, at the fastest mode [1]
  double expected;  // largest stable step over 2/omega [1]
};

/// Springs alone with damping in proportion to stiffness: the modes stay those of the undamped
/// sheet, and each is an oscillator with the damping ratio zeta = kd_s omega/(2 Y). The step of A
/// and B is then limited to 2/omega, that of C to (2/omega) (zeta + sqrt(1 + zeta^2)); the
/// fastest mode decides.
std::vector<DampedLimit> damped_limits() {
  std::vector<DampedLimit> limits;
  for (const double zeta : {0.5, 1.5, 4.0, 10.0, 30.0, 100.0}) {
    limits.push_back({"C", zeta, zeta + std::sqrt(1 + zeta * zeta)});
    for (const char* scheme : {"A", "B"}) limits.push_back({scheme, zeta, 1});
  }
  return limits;
}

/// A and B leave their limit slowly: at a step longer by a fraction d a disturbance grows by about
/// 2 d/zeta a step. No run of bearable length tells that from decay; the matrix of the fastest
/// mode's step does.
bool is_told_by_runs(const DampedLimit& limit) { return limit.scheme == "C" || limit.ratio < 1; }

double damped_limit(const Subject& subject, const DampedLimit& limit) {
  constexpr double growth = 1e-6;
  Scene scene = sheet_scene(square(0.2, 2, 1), 0);
  const FastestMode mode = fastest_mode(subject, scene);
  scene.stretch->damping = 2 * limit.ratio * stretch / mode.omega;
  scene.solver.tolerance = 1e-12;
  scene.integrator = limit.scheme;
  if (is_told_by_runs(limit))
    return largest_stable_step(subject, scene, mode.omega,
                               {0.9 * limit.expected, 1.1 * limit.expected, 7, 2000});
  const double expected = limit.expected * 2 / mode.omega;
  return largest_constant_step(
             stepped_motion(subject, motion_along(scene, mode.shape, mode.omega), limit.scheme),
             {expected / 2, 4 * expected, growth, 9}) *
         mode.omega / 2;
}

/// All of them, measured; after each one `step` is called.
Table measured_limits(const Subject& subject, const std::function<void()>& step) {
  Table table(
      "scheme [1]; told by [1]; damping ratio of the fastest mode [1]; largest stable step over "
      "2/omega [1]; expected [1]");
  for (const DampedLimit& limit : damped_limits()) {
    table.row(limit.scheme, is_told_by_runs(limit) ? "runs" : "step matrix of the fastest mode",
              limit.ratio, damped_limit(subject, limit), limit.expected);
    step();
  }
  return table;
}

NamedFinding damped_finding(const Table& limits) {
  return {"hard-limits.damped-limit-is-as-derived",
          "Damped in proportion to stiffness, schemes A and B are stable up to 2/omega, C up to "
          "(2/omega) (zeta + sqrt(1 + zeta^2)), for damping ratios zeta up to 100.",
          {{largest_deviation(limits, "largest stable step over 2/omega", "expected"), 0.01, 0, "1",
            "the bisection ends at a width of a sixth of that; the limits are those of the damped "
            "oscillator"},
           limits,
           "measured is the largest |found/expected - 1|. Beyond their limit A and B grow too "
           "slowly at ratios of 10 and more for runs to tell it from decay: there the spectral "
           "radius of the fastest mode's step decides"}};
}

// ---- the study

Table table_of(const std::vector<HardSheet>& sheets, const std::vector<SheetLimits>& limits) {
  Table table{"largest-steps",
              "Largest stable steps of hard, undamped sheets",
              {{"sheet", "1"}, {"2/omega", "s"}, {"elastic limit over 2/omega", "1"}}};
  for (size_t i = 0; i < sheets.size(); ++i)
    table.row(sheets[i].words, limits[i].exact, limits[i].bound);
  for (size_t k = 0; k < paper_schemes().size(); ++k) {
    std::vector<double> ratios;
    for (const SheetLimits& one : limits) ratios.push_back(one.schemes[k]);
    table.add({"scheme " + std::string(paper_schemes()[k].name) + " over 2/omega", "1",
               std::move(ratios)});
  }
  return table;
}

Figure damping_figure(const Table& limits) {
  Figure figure{"damped",
                "Largest stable step of a sheet damped in proportion to its stiffness",
                {"damping ratio of the fastest mode", "1", Scale::log},
                {"largest stable step over 2/omega", "1", Scale::log},
                "Damping leaves the limit of schemes A and B where it is, and widens that of C."};
  for (const char* scheme : {"A", "B", "C"})
    figure.curves.push_back(curve_of(scheme, group_of(limits, "scheme", scheme),
                                     "damping ratio of the fastest mode",
                                     "largest stable step over 2/omega"));
  figure.curves.push_back(
      curve_over("derived for C: zeta + sqrt(1 + zeta^2)", geometric_range(0.5, 100, 81),
                 [](double zeta) { return zeta + std::sqrt(1 + zeta * zeta); }));
  return figure;
}

StudyResult run_hard_limits(const Subject& subject, Tier, const Progress& progress) {
  StudyResult result;
  const std::vector<HardSheet> sheets = hard_sheets();
  const double parts = double(sheets.size() + damped_limits().size() + paper_schemes().size());
  double done = 0;
  std::vector<SheetLimits> limits;
  for (const HardSheet& sheet : sheets) {
    limits.push_back(limits_of(subject, sheet.scene));
    result.findings.push_back(undamped_finding(sheet, limits.back()));
    progress(++done / parts);
  }
  result.findings.push_back(bound_finding(sheets, limits));
  const Table damped = measured_limits(subject, [&] { progress(++done / parts); });
  result.findings.push_back(damped_finding(damped));
  for (const char* scheme : {"A", "B", "C"}) {
    result.findings.push_back(step_jump(subject, sheet_scene(square(0.4, 4, 1), 0), scheme));
    progress(++done / parts);
  }
  result.findings.push_back(sliver_collapse());
  result.tables.push_back(table_of(sheets, limits));
  result.figures.push_back(damping_figure(damped));
  return result;
}

}  // namespace

Study hard_limits_study() {
  return {
      "hard-limits",
      "Stiffness ratios, slivers and graded meshes leave the largest stable step at 2/omega; "
      "damping leaves it there for A and B and widens it for C; a jump of the step changes "
      "energies by a bounded factor.",
      {"is-two-over-omega", "damped-limit-is-as-derived", "energy-is-bounded-across-a-step-jump"},
      "BMF03 section 3",
      "Flat, free sheets at the limit of the method are disturbed a little. The fastest mode is "
      "found by power iteration on the elastic forces, the largest stable step of each scheme by "
      "bisection on runs that stay bounded or do not, with heavy damping on the spectral radius of "
      "the fastest mode's step, and compared with what the oscillator's step matrices say.",
      run_hard_limits};
}

}  // namespace foldproof
