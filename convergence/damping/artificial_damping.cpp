// artificial-damping: what a method takes from, or adds to, vibrations that nothing damps, mode by
// mode and over a hundred periods.
#include <algorithm>
#include <cmath>

#include "convergence/damping/artificial_damping.h"
#include "convergence/damping/sheet_modes.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

namespace {

constexpr double heavy = 10;  // h c/2 of the fastest damped mode

struct OneSided {
  std::string method, damped;
  double worst;  // |change of amplitude per period| of the undamped modes
};

OneSided one_sided(const Subject& subject, const VibratingSheet& sheet, const Integrator& method,
                   ModeKind damped) {
  const double h = sheet.limit / 2;
  double fastest = 0;
  for (const SheetMode& mode : sheet.modes)
    if (mode.kind == damped) fastest = std::max(fastest, mode.frequency);
  const double relaxation = 2 * heavy / (h * fastest * fastest);
  const bool springs = damped == ModeKind::stretch;
  const std::vector<oracles::Factors> factors =
      factors_of(subject, sheet, method, {springs ? relaxation : 0, springs ? 0 : relaxation}, h);
  Worst worst;
  for (size_t i = 0; i < sheet.modes.size(); ++i)
    if (sheet.modes[i].kind != damped)
      worst.observe(std::abs(loss_per_period(sheet.modes[i], factors[i], h)));
  return {std::string(method.name), springs ? "springs" : "hinges", worst.value()};
}

Table evidence_of(const OneSided& springs, const OneSided& hinges) {
  Table evidence{{"damped", "1"}, {"change of the undamped modes", "of the amplitude, a period"}};
  for (const OneSided& one : {springs, hinges}) evidence.row(one.damped, one.worst);
  return evidence;
}

NamedFinding spares_the_undamped(const OneSided& springs, const OneSided& hinges) {
  return {"artificial-damping.undamped-parts-stay-undamped." + springs.method,
          "Scheme " + springs.method +
              " adds no damping to bending when springs alone are damped heavily, nor to stretch "
              "when hinges are.",
          judge_worst(evidence_of(springs, hinges), 100 * factor_noise,
                      "the slowest mode takes a hundred steps for a period; of each step, " +
                          std::string(why_factor_noise),
                      "h c/2 is 10 for the fastest damped mode, the step half the elastic limit")};
}

/// The same measure of backward Euler, which must be large: the claim's other half.
NamedFinding damps_everything(const OneSided& springs, const OneSided& hinges) {
  Worst worst;
  for (const OneSided& one : {springs, hinges}) worst.observe(0.1 / one.worst);
  return {"artificial-damping.damps-every-motion.backward-euler",
          "Backward Euler damps undamped motions: at half the elastic limit the fastest of them "
          "loses more than a tenth of its amplitude in a period.",
          {{worst.value(), 1, 0, "1",
            "measured is a tenth over the loss; the derived loss is pi omega h"},
           evidence_of(springs, hinges)}};
}

Table one_sided_table(const std::vector<OneSided>& rows) {
  Table table("method [1]; damped [1]; of the amplitude, a period [1]");
  for (const OneSided& row : rows) table.row(row.method, row.damped, row.worst);
  return {"one-sided",
          "Largest change of an undamped mode while the others are damped heavily (h c/2 up to 10)",
          table};
}

/// Damping of one kind of motion, the other kind free: does a method leave the free one alone?
void add_one_sided_damping(const Subject& subject, const VibratingSheet& sheet,
                           StudyResult& result) {
  std::vector<OneSided> rows;
  for (const Integrator& method : integrators()) {
    if (method.family == Family::fully_explicit) continue;  // unstable at this damping
    const OneSided springs = one_sided(subject, sheet, method, ModeKind::stretch);
    const OneSided hinges = one_sided(subject, sheet, method, ModeKind::bending);
    rows.push_back(springs);
    rows.push_back(hinges);
    if (method.family == Family::mixed)
      result.findings.push_back(spares_the_undamped(springs, hinges));
    if (method.name == "backward-euler")
      result.findings.push_back(damps_everything(springs, hinges));
  }
  result.tables.push_back(one_sided_table(rows));
}

// steps over 2/omega_max
constexpr std::array<double, 3> parts_of_limit = {1. / 4, 1. / 8, 1. / 16};

// ---- every mode against the derived factors

/// Effect of a method on all modes, undamped at three steps, and damped at the middle one.
struct Response {
  Integrator method;
  std::vector<double> steps;                        // s
  std::vector<std::vector<oracles::Factors>> free;  // undamped: a row a step
  Relaxation relaxation;
  std::vector<oracles::Factors> damped;  // at steps[1]
};

Response response_of(const Subject& subject, const VibratingSheet& sheet,
                     const Integrator& method) {
  // damping ratios up to 0.3 across the plane and 0.12 in it, so that no mode is lost in 30 steps
  const double relaxation = 0.6 * sheet.limit / 2;
  Response response{method, {}, {}, {0.4 * relaxation, relaxation}, {}};
  for (const double part : parts_of_limit) {
    response.steps.push_back(part * sheet.limit);
    response.free.push_back(factors_of(subject, sheet, method, {}, response.steps.back()));
  }
  response.damped = factors_of(subject, sheet, method, response.relaxation, response.steps[1]);
  return response;
}

NamedFinding as_derived(const VibratingSheet& sheet, const Response& response) {
  const std::string name(response.method.name);
  Table factors_seen("omega h [1]; damping ratio [1]; |factor| [1]; error of the factors [1]");
  const auto observe = [&](const SheetMode& mode, const Relaxation& relaxation, double h,
                           const oracles::Factors& factors) {
    const oracles::Oscillator oscillator = oscillator_of(mode, relaxation);
    factors_seen.row(mode.frequency * h, oscillator.damping / (2 * mode.frequency),
                     decay_of(factors),
                     distance_of(factors, oracles::step_factors(name, oscillator, h)));
  };
  for (size_t i = 0; i < sheet.modes.size(); ++i) {
    for (size_t s = 0; s < response.steps.size(); ++s)
      observe(sheet.modes[i], {}, response.steps[s], response.free[s][i]);
    observe(sheet.modes[i], response.relaxation, response.steps[1], response.damped[i]);
  }
  return {"artificial-damping.mode-factors-are-as-derived." + name,
          "A step of " + name +
              " multiplies each vibration of a sheet, damped or not, by the factor derived for the "
              "method.",
          judge_worst(factors_seen, factor_noise, why_factor_noise)};
}

/// Backward Euler's factor is 1/sqrt(1 + (omega h)^2): each vibration loses, fast ones most.
NamedFinding loses_with_the_frequency(const VibratingSheet& sheet, const Response& response) {
  const std::string judged = "|factor| sqrt(1 + (omega h)^2/2)";
  Table losses{{"omega h", "1"}, {"|factor|", "1"}, {judged, "1"}};
  for (size_t s = 0; s < response.steps.size(); ++s)
    for (size_t i = 0; i < sheet.modes.size(); ++i) {
      const double omega_h = sheet.modes[i].frequency * response.steps[s],
                   factor = decay_of(response.free[s][i]);
      losses.row(omega_h, factor, factor * std::sqrt(1 + omega_h * omega_h / 2));
    }
  return {"artificial-damping.loss-grows-with-the-frequency." + std::string(response.method.name),
          "Backward Euler damps every undamped vibration of a sheet, in each step at least by the "
          "factor 1/sqrt(1 + (omega h)^2/2), which falls with the frequency.",
          judge_worst(std::move(losses), judged, 1,
                      "at 1 a vibration loses just that; derived is 1/sqrt(1 + (omega h)^2)")};
}

/// Powers of the step in what an undamped mode loses per period, by the expansion of |factor|. The
/// next term of it shifts the order of a pair: by less than a tenth, but for BDF2, whose loss is
///   (omega h)^3 pi/2 (1 - 5/2 (omega h)^2 + ...)
/// so that between omega h = 1/4 and 1/8 the order of the pair is log2(.844/.961) =
/// .19 below three.
struct LossLaw {
  std::string name, words;
  double order, largest_deviation = 0.1;
};

std::vector<LossLaw> loss_laws() {
  return {{"forward-euler", "gain amplitude per period in proportion to the step", 1},
          {"RK2", "gain amplitude per period as the cube of the step", 3},
          {"SSP-RK3", "lose amplitude per period as the cube of the step", 3},
          {"RK4", "lose amplitude per period as the fifth power of the step", 5},
          {"backward-euler", "lose amplitude per period in proportion to the step", 1},
          {"linear-backward-euler", "lose amplitude per period in proportion to the step", 1},
          {"BDF2", "lose amplitude per period nearly as the cube of the step", 3, 0.2}};
}

NamedFinding order_of_loss(const VibratingSheet& sheet, const Response& response,
                           const LossLaw& law) {
  const size_t fastest = size_t(std::ranges::max_element(sheet.modes, {}, &SheetMode::frequency) -
                                sheet.modes.begin());
  const std::string loss = "|change of amplitude per period|";
  Table losses{{"step", "s"}, {loss, "1"}};
  for (size_t s = 0; s < response.steps.size(); ++s) {
    const double h = response.steps[s];
    losses.row(h, std::abs(loss_per_period(sheet.modes[fastest], response.free[s][fastest], h)));
  }
  losses.add({"order of the pair", "1", row_orders(convergence_of(losses, loss))});
  return {"artificial-damping.change-per-period-is-as-derived." + law.name,
          "Under " + law.name + " undamped vibrations " + law.words + ".",
          {order_verdict(
               convergence_of(losses, loss), law.order, 1, law.largest_deviation,
               "a loss of another power of the step is off by 1 at least; the next term of the "
               "expansion leaves less than this at omega h = 1/8"),
           losses,
           "measured is |order - expected| of the last pair, on the fastest mode of the sheet"}};
}

// ---- what is shown

Curve loss_curve(const VibratingSheet& sheet, const Response& response) {
  const double h = response.steps.front();
  std::vector<std::pair<double, double>> points;
  Worst grows;
  for (size_t i = 0; i < sheet.modes.size(); ++i) {
    const double loss = loss_per_period(sheet.modes[i], response.free.front()[i], h);
    const double least = 2 * pi / (sheet.modes[i].frequency * h) * 1e-9;
    points.emplace_back(sheet.modes[i].frequency * h,
                        std::abs(loss) > least ? std::abs(loss) : nan);
    if (std::abs(loss) > least) grows.observe(-loss);
  }
  std::ranges::sort(points, {}, &std::pair<double, double>::first);
  Curve curve{std::string(response.method.name) + (grows.value() > 0 ? ", grows" : "")};
  for (const auto& [omega_h, loss] : points) curve.point(omega_h, loss);
  return curve;
}

Figure loss_figure(const VibratingSheet& sheet, const std::vector<Response>& responses) {
  Figure figure{"loss",
                "What undamped vibrations lose",
                {"omega h", "1", Scale::log},
                {"|change of amplitude| per period", "1", Scale::log},
                "Each marker is one mode of the sheet, at a step of a quarter of the elastic "
                "limit. A, B, C and the implicit midpoint rule change no amplitude beyond what "
                "their solves leave, and are not drawn."};
  for (const Response& response : responses)
    for (const LossLaw& law : loss_laws())
      if (law.name == response.method.name) figure.curves.push_back(loss_curve(sheet, response));
  return figure;
}

/// By how much the decay of damped modes differs from the exact one.
Figure decay_figure(const VibratingSheet& sheet, const std::vector<Response>& responses) {
  Figure figure{"decay",
                "Decay of damped vibrations",
                {"omega h", "1", Scale::log},
                {"|rate of decay over the exact one - 1|", "1", Scale::log},
                "Bending modes of the sheet, at a step of an eighth of the elastic limit, damped "
                "in proportion to their stiffness: the damping ratio is 1.2 omega h."};
  for (const Response& response : responses) {
    Curve curve{std::string(response.method.name)};
    const double h = response.steps[1];
    for (size_t i = 0; i < sheet.modes.size(); ++i) {
      if (sheet.modes[i].kind != ModeKind::bending) continue;
      const oracles::Oscillator oscillator = oscillator_of(sheet.modes[i], response.relaxation);
      const double exact = std::log(decay_of(oracles::exact_factors(oscillator, h)));
      curve.point(sheet.modes[i].frequency * h,
                  std::abs(std::log(decay_of(response.damped[i])) / exact - 1));
    }
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

void add_responses(const Subject& subject, const VibratingSheet& sheet, StudyResult& result) {
  std::vector<Response> responses;
  for (const Integrator& method : integrators()) {
    responses.push_back(response_of(subject, sheet, method));
    result.findings.push_back(as_derived(sheet, responses.back()));
    if (method.name == "backward-euler")
      result.findings.push_back(loses_with_the_frequency(sheet, responses.back()));
    for (const LossLaw& law : loss_laws())
      if (law.name == method.name)
        result.findings.push_back(order_of_loss(sheet, responses.back(), law));
  }
  result.figures.push_back(loss_figure(sheet, responses));
  result.figures.push_back(decay_figure(sheet, responses));
}

StudyResult run_artificial_damping(const Subject& subject, Tier tier, const Progress& progress) {
  const VibratingSheet sheet = make_vibrating_sheet(tier == Tier::quick ? 3 : 6);
  StudyResult result;
  add_responses(subject, sheet, result);
  progress(0.4);
  add_one_sided_damping(subject, sheet, result);
  progress(0.5);
  add_long_vibrations(subject, tier, result);
  progress(1);
  return result;
}

}  // namespace

Study artificial_damping_study() {
  return {
      "artificial-damping",
      "Schemes A, B and C damp no vibration that the material does not damp; backward Euler damps "
      "every vibration, fast ones most.",
      {"mode-factors-are-as-derived", "undamped-parts-stay-undamped", "energy-has-no-trend",
       "loss-grows-with-the-frequency.backward-euler",
       "change-per-period-is-as-derived.backward-euler"},
      "BMF03 section 3",
      "All vibrations of a flat, free sheet are excited at once, and the factor by which a step of "
      "each method multiplies each of them is compared with the derived factor. Then a crumpling "
      "sheet vibrates for a hundred periods of its slowest mode: does its energy have a trend?",
      run_artificial_damping};
}

}  // namespace foldproof
