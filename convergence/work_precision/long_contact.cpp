// long-contact: which steps last on cloth that falls on a ball, slides, folds and hangs from it,
// and what does a second of that motion cost with each method?

#include <optional>

#include "convergence/work_precision/precision_problem.h"
#include "convergence/study.h"
#include "reference/dynamics/integrator.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/contact_scenes.h"

namespace foldproof {

namespace {

constexpr double cloth_width = 0.6, ball_radius = 0.15;  // of the sheet, of the ball [m]
constexpr double length = 1.5;                // of a run [s]; the ball is met in its first tenth
constexpr double settling = length / longer;  // from when on energies are compared [s]
constexpr double farthest = 2;  // m, six times the fall: a run that gets there has diverged
constexpr const char* one_solve = "linear-backward-euler";  // takes one linear solve a step
constexpr int most_doublings = 5;  // the longest step tried is 32 elastic limits

/// A level sheet above a ball on a floor, not quite over its middle.
Scene sheet_over_ball(int cells) {
  Scene scene = scene_at_rest(
      make_sheet({SheetPattern::alternating, cloth_width, cloth_width, cells, cells}), 0.2);
  scene.x.colwise() += Vector3(0.03 - cloth_width / 2, 0.02 - cloth_width / 2, ball_radius + 0.02);
  scene.gravity = Vector3(0, 0, -9.80665);
  scene.stretch = StretchMaterial{40, 0.05, 1};
  scene.bending = BendingMaterial{1e-4, 3e-6, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  scene.solver.tolerance = 1e-8;
  const Pose middle{{1, 0, 0, 0}, {0, 0, 0}}, below{{1, 0, 0, 0}, {0, 0, -ball_radius}};
  scene.objects = {with_motion(object_at("ball", Sphere{ball_radius}, middle), Motion{}, 0.3),
                   with_motion(object_at("floor", HalfSpace{}, below), Motion{}, 0.3)};
  return scene;
}

/// A run with constant steps of at most h [s].
EnergyRun long_run(const Subject& subject, const Scene& scene, double h) {
  return run_with_energy(subject, scene, {length, int(std::ceil(length / h)), farthest, INFINITY},
                         settling);
}

/// A method's longest step that lasts, and the next one, twice as long.
struct LongestStep {
  const Integrator* method;
  std::optional<double> doublings;  // of the elastic limit; none: not even the limit lasts
  double applications = nan;        // with that step [1/s]
  double gain_at_limit = nan;       // of energy, over half the step [1]
  double energy_left = nan;         // at the end of the run with that step [1]
  double gain_beyond = nan;         // the first that is too large; NaN: no longer step was tried
  double stopped_beyond = nan;      // when that run ended [s]
};

LongestStep longest_step(const Subject& subject, Scene scene, const Integrator& method,
                         double limit) {
  scene.integrator = std::string(method.name);
  LongestStep longest{&method, {}};
  EnergyRun half = long_run(subject, scene, limit / 2);
  for (int doublings = 0; doublings <= most_doublings; ++doublings) {
    const double h = limit * (1 << doublings);
    const EnergyRun run = long_run(subject, scene, h);
    const double gain = energy_gain({h, run.energy, half.energy});
    if (doublings == 0) longest.gain_at_limit = gain;
    if (!(gain <= most_energy_gain)) {
      longest.gain_beyond = gain;
      longest.stopped_beyond = run.last.time;
      break;
    }
    longest.doublings = doublings;
    longest.applications = operator_applications(run.work) / run.last.time;
    longest.energy_left = run.energy_left;
    half = run;
  }
  return longest;
}

/// Those that iterate to the end of each step are left out: here they take tens of times the work.
std::vector<const Integrator*> asked_methods() {
  std::vector<const Integrator*> methods;
  for (const Integrator& method : integrators())
    if (method.family != Family::fully_implicit || method.name == one_solve)
      methods.push_back(&method);
  return methods;
}

/// Why the next step, twice as long, is not the method's.
std::string beyond(const LongestStep& one) {
  if (std::isnan(one.gain_beyond)) return "not tried";
  if (std::isfinite(one.gain_beyond)) return "gains energy";
  return fmt::format("diverges at {:.2g} s", one.stopped_beyond);
}

struct LongContact {
  double limit;  // the elastic limit of the start [s]
  std::vector<LongestStep> methods;

  const LongestStep& of(std::string_view name) const {
    return *std::ranges::find_if(methods,
                                 [&](const LongestStep& one) { return one.method->name == name; });
  }

  /// Over the elastic limit; 0: not even the limit lasts.
  double steps(const LongestStep& one) const {
    return one.doublings ? std::exp2(*one.doublings) : 0;
  }
};

Table steps_and_work(const LongContact& measured) {
  Table table(
      "method [1]; longest step that lasts [s]; over the elastic limit [1]; operator applications "
      "for a second of motion [1]; over those of C [1]; energy at the limit over that at half of "
      "it [1]; energy left at the end [1]; the next step, twice as long [1]");
  const double work_of_c = measured.of("C").applications;
  for (const LongestStep& one : measured.methods)
    table.row(one.method->name, measured.steps(one) * measured.limit, measured.steps(one),
              one.applications, one.applications / work_of_c, one.gain_at_limit, one.energy_left,
              beyond(one));
  return table;
}

NamedFinding limit_lasts(const LongContact& measured, const std::string& scheme) {
  return {"long-contact.limit-lasts." + scheme,
          "On cloth that falls on a ball and hangs from it, the elastic limit of its start is a "
          "step that lasts with " +
              scheme + ".",
          {{measured.of(scheme).gain_at_limit, most_energy_gain, 0, "1",
            "an unstable step multiplies energy many times over in a second; half the step shows "
            "how much energy the scene allows"},
           steps_and_work(measured),
           "measured is the largest kinetic energy after the first third of the run, over that of "
           "a run with half the step"}};
}

NamedFinding limit_is_sharp(const LongContact& measured, const std::string& scheme) {
  return {"long-contact.twice-the-limit-does-not-last." + scheme,
          "There, twice the elastic limit does not last with " + scheme + ".",
          {{measured.steps(measured.of(scheme)), 1, 0, "1", "the steps tried are powers of two"},
           steps_and_work(measured),
           "measured is the longest step that lasts, over the elastic limit"}};
}

NamedFinding costs_more(const LongContact& measured) {
  const LongestStep &one = measured.of(one_solve), &c = measured.of("C");
  return {"long-contact.longer-steps-cost-more.linear-backward-euler",
          "There, linearised backward Euler allows longer steps than C, but takes more work for a "
          "second of motion, each at its longest step.",
          {{std::max(c.applications / one.applications, measured.steps(c) / measured.steps(one)), 1,
            0, "1", "at 1 both take the same steps, or the same work"},
           steps_and_work(measured),
           "measured is the larger of two shares: work, and step, of C over those of linearised "
           "backward Euler"}};
}

StudyResult run_long_contact(const Subject& subject, Tier tier, const Progress& progress) {
  const Scene scene = sheet_over_ball(tier == Tier::full ? 44 : 9);
  LongContact measured{elastic_limit(build_system(scene), start_state(scene)), {}};
  const std::vector<const Integrator*> methods = asked_methods();
  for (const Integrator* method : methods) {
    measured.methods.push_back(longest_step(subject, scene, *method, measured.limit));
    progress(double(measured.methods.size()) / double(methods.size()));
  }
  StudyResult result;
  for (const std::string scheme : {"A", "B", "C"})
    result.findings.push_back(limit_lasts(measured, scheme));
  for (const std::string scheme : {"A", "B"})
    result.findings.push_back(limit_is_sharp(measured, scheme));
  result.findings.push_back(costs_more(measured));
  result.tables = {{"steps", "Longest steps that last, and their work", steps_and_work(measured)}};
  return result;
}

}  // namespace

Study long_contact_study() {
  return {
      "long-contact",
      "On cloth that falls on a ball and hangs from it, steps of the elastic limit last with A, B "
      "and C; twice that does not last with A and B. Linearised backward Euler allows longer steps "
      "than C, but takes more work.",
      {"limit-lasts", "twice-the-limit-does-not-last", "longer-steps-cost-more"},
      "BMF03 section 3",
      "A square of cloth falls on a ball that lies on a floor, slides with friction, folds and "
      "hangs from the ball: 100 particles (2,025 in the full tier) over 1.5 s. Each method runs "
      "with the elastic limit as its step, then with twice that, until a run diverges or has more "
      "than twice the kinetic energy of the run with half its step. Work is counted. How accurate "
      "these steps are is not measured: in contact they need not be (filtered-order).",
      run_long_contact};
}

}  // namespace foldproof
