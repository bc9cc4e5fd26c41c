// Findings from the runs of the work-precision study.
#include <algorithm>
#include <cmath>

#include "convergence/work_precision/work_precision.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

namespace {

/// A tenth of the finest error that prices are read off at.
NamedFinding reference_is_known(const PrecisionScene& scene) {
  const Verdict verdict{scene.truth.uncertainty, wanted_errors.back() / 10, 0, "1",
                        "a tenth of the smallest error at which a cost is read off, so that it "
                        "shifts no cost by more than a tenth of a run's error"};
  return {
      "work-precision.reference-is-accurate." + scene.problem.name,
      "Two independent answers to where " + scene.problem.description +
          " ends agree to a ten-thousandth of its motion.",
      {verdict,
       Table{{"largest motion", "m"}, {"disagreement and own uncertainty", "1"}}.with_row(
           scene.truth.motion, scene.truth.uncertainty),
       (scene.problem.first == FirstOpinion::oracle ? "GSL and extrapolated scheme "
                                                    : "extrapolated RK4 and extrapolated scheme ") +
           scene.problem.second}};
}

/// By what an error shrinks when the step is halved, from a pair of runs.
double shrinkage(const PrecisionRun& coarse, const PrecisionRun& fine) {
  return std::pow(fine.error / coarse.error,
                  std::log(2.) / std::log(double(fine.steps) / coarse.steps));
}

/// The index of the finest run that, with the one before it, can be told from the reference; 0
/// if there is none.
size_t finest_judged(const PrecisionCurve& curve, double uncertainty) {
  // the uncertainty, so that it shifts an error by no more than a tenth
  constexpr double above = 10;
  size_t i = curve.runs.empty() ? 0 : curve.runs.size() - 1;
  while (i > 0 && curve.runs[i].error <= above * uncertainty) --i;
  return i > 0 && std::isnan(curve.runs[i - 1].error) ? 0 : i;
}

/// The two finest runs of every curve, where each method is closest to its asymptotic range.
NamedFinding errors_fall(const PrecisionScene& scene) {
  constexpr size_t least_judged = 6;  // of the eleven methods
  Worst worst, worst_with_uncertainty;
  Table shrinkages(
      "method [1]; error of the run before [1]; error of the finest run [1]; error left when the "
      "step is halved [1]");
  std::string left_out;
  for (const PrecisionCurve& curve : scene.curves) {
    const size_t i = finest_judged(curve, scene.truth.uncertainty);
    if (i == 0) {
      left_out += " " + curve.method;
      continue;
    }
    const PrecisionRun &coarse = curve.runs[i - 1], &fine = curve.runs[i];
    const double left = shrinkage(coarse, fine);
    shrinkages.row(curve.method, coarse.error, fine.error, left);
    worst.observe(left);
    worst_with_uncertainty.observe(left * (1 + 2 * scene.truth.uncertainty / fine.error));
  }
  if (shrinkages.rows() < least_judged) worst.observe(nan);
  const Verdict verdict{
      worst.value(), std::sqrt(0.5), worst_with_uncertainty.value() - worst.value(), "1",
      "where the error is of first order, half of it is left; where it does not fall, all of it; "
      "the bound is half an order, midway between the two on a logarithmic scale"};
  return {"work-precision.errors-decrease." + scene.problem.name,
          "On " + scene.problem.description +
              ", errors fall with the step at the end of each method's range, where two runs of it "
              "can be judged.",
          {verdict, shrinkages,
           "measured is the largest ratio of the error after a step is halved to the error before, "
           "from the two finest runs whose error exceeds ten times the reference's" +
               (left_out.empty() ? "" : "; without two such runs within the budget:" + left_out)}};
}

/// The largest step at a wanted error among the fully explicit methods [s]; NaN if none reaches it.
double largest_explicit_step(const PrecisionScene& scene, double wanted) {
  double largest = nan;
  for (const PrecisionCurve& curve : scene.curves) {
    if (integrator_named(curve.method).family != Family::fully_explicit) continue;
    const double step = price_of(scene, curve, wanted).step;
    if (!(step <= largest) && !std::isnan(step)) largest = step;
  }
  return largest;
}

/// One scheme's largest step at a wanted error [s].
double step_of(const PrecisionScene& scene, std::string_view scheme, double wanted) {
  return price_of(scene, curve_of(scene, scheme), wanted).step;
}

/// Damping limits explicit steps at best to 2.785/c (RK4), elasticity those of A and B to 2/omega.
NamedFinding mixed_steps_are_larger(const PrecisionScene& scene) {
  // of RK4 along the negative real axis, over that of Euler
  constexpr double runge_kutta_reach = 2.785 / 2;
  const double predicted =
      scene.truth.two_over_omega / (runge_kutta_reach * scene.truth.two_over_c);
  Worst worst;
  Table steps(
      "scheme [1]; error [1]; its largest step [s]; largest step of explicit methods [s]; their "
      "ratio [1]; ratio of the limits [1]");
  for (double error : wanted_errors) {
    for (const char* scheme : {"A", "B"}) {
      const double mixed = step_of(scene, scheme, error),
                   fully_explicit = largest_explicit_step(scene, error);
      steps.row(scheme, error, mixed, fully_explicit, mixed / fully_explicit, predicted);
      if (error != wanted_errors.front()) continue;
      worst.observe(predicted / (mixed / fully_explicit));
      worst.observe(mixed / fully_explicit / predicted);
    }
  }
  const double runs_apart = scene.problem.ratio * scene.problem.ratio;
  const Verdict verdict{
      worst.value(), runs_apart, 0, "1",
      "both steps are known to the ratio of neighbouring runs, and their quotient to its square"};
  return {"work-precision.mixed-steps-are-larger." + scene.problem.name,
          "On " + scene.problem.description +
              ", schemes A and B reach one percent of error with steps larger than the best "
              "explicit method's by the ratio of the elastic limit to the explicit damping limit, "
              "within a factor of two.",
          {verdict, steps,
           "measured is the factor between the two ratios at one percent, of either sense; at a "
           "tenth of a percent accuracy, not stability, limits the steps of A and B"}};
}

/// By what the fastest mode grows in a whole run of B with a step h >= 2/omega
/// [1]: z = -1 - g solves
///   (1 + a) z^2 + (h^2 omega^2 - 2) z + 1 - a = 0,   a = h c/2,
///   g = (h^2 omega^2/2 - 2)/a to first order.
double growth_beyond(const PrecisionScene& scene, double h) {
  const double beyond = std::pow(h / scene.truth.two_over_omega, 2), a = h / scene.truth.two_over_c;
  return std::pow(1 + std::max(0., 2 * beyond - 2) / a, scene.problem.end / h);
}

/// A lasting motion takes back what a short one forgives: steps beyond 2/omega.
NamedFinding within_the_limit(const PrecisionScene& scene) {
  Worst worst;
  Table steps("error [1]; largest step of B [s]; growth of the fastest mode in the run [1]");
  for (double error : wanted_errors) {
    const double step = step_of(scene, "B", error);
    steps.row(error, step, growth_beyond(scene, step));
    worst.observe(step / scene.truth.two_over_omega);
  }
  return {"work-precision.steps-stay-within-the-limit." + scene.problem.name,
          "On " + scene.problem.description +
              ", the largest step with which B reaches a wanted error is at most 2/omega, within "
              "the accuracy to which a step is known.",
          {{worst.value(), scene.problem.ratio, 0, "1",
            "beyond 2/omega the fastest mode grows only by about (h^2 omega^2/2 - 2)/a a step, a = "
            "h c/2, and a step is known only to the ratio of neighbouring runs"},
           steps,
           "measured is the largest of the steps over 2/omega"}};
}

/// Where h c is large C moves positions with F/c at the step's start, as forward Euler would: the
/// error is then of first order in h (order reduction), while A and B keep the middle of the step.
NamedFinding C_needs_shorter_steps(const PrecisionScene& scene) {
  const double error = wanted_errors.front(),
               ratio = step_of(scene, "C", error) / step_of(scene, "B", error);
  return {
      "work-precision.C-needs-shorter-steps." + scene.problem.name,
      "On " + scene.problem.description +
          ", C reaches one percent of error only with steps less than half of B's.",
      {{ratio, 0.5, 0, "1",
        "both steps are known to the ratio of neighbouring runs, the root of two"},
       Table{{"largest step of C", "s"}, {"largest step of B", "s"}}.with_row(
           step_of(scene, "C", error), step_of(scene, "B", error)),
       "measured is the ratio of the steps. Where h c is large, C moves positions by h F/c, taken "
       "at the step's start: its error falls with the first power of h until h c is small"}};
}

/// C's solves over A's at equal numbers of steps.
NamedFinding one_more_solve(const std::vector<PrecisionScene>& scenes) {
  Worst worst;
  Table ratios(
      "scene [1]; steps [1]; solves of C over those of A [1]; operator applications of C over "
      "those of A [1]");
  for (const PrecisionScene& scene : scenes) {
    for (const PrecisionRun& a : curve_of(scene, "A").runs) {
      for (const PrecisionRun& c : curve_of(scene, "C").runs) {
        if (a.steps != c.steps || std::isnan(a.error) || std::isnan(c.error)) continue;
        const double solves = double(c.work.solves) / double(a.work.solves);
        ratios.row(scene.problem.description, a.steps, solves, c.applications / a.applications);
        worst.observe(std::abs(solves - 2));
      }
    }
  }
  const Verdict verdict{ratios.rows() == 0 ? nan : worst.value(), 0, 0, "1",
                        "counted: two solves a step against one"};
  return {"work-precision.C-solves-twice-as-often-as-A",
          "At equal steps scheme C makes two implicit solves where A makes one.",
          {verdict, ratios, "measured is the largest |ratio of the solves - 2|"}};
}

/// The gain of energy with the step that has the price; infinite if it was not asked.
double gain_at(const PrecisionScene& scene, const PrecisionCurve& curve, double wanted) {
  const double step = price_of(scene, curve, wanted).step;
  const LongerRun* run = longer_run_of(curve.longer, step);
  return run ? energy_gain(*run) : INFINITY;
}

/// By work and by seconds, at each wanted error.
NamedFinding cheapest_steps_last(const std::vector<PrecisionScene>& scenes) {
  constexpr double most = 2;
  Table steps("scene [1]; error [1]; by [1]; method [1]; its step [s]; energy gain [1]");
  for (const PrecisionScene& scene : scenes)
    for (const double wanted : wanted_errors)
      for (const Currency& currency : currencies)
        for (const size_t k : podium(scene, wanted, currency).contenders) {
          const PrecisionCurve& curve = scene.curves[k];
          const double gain = gain_at(scene, curve, wanted);
          // clocks name other contenders from run to run: those that last are left out
          if (currency.name == "seconds" && gain <= most) continue;
          steps.row(scene.problem.description, wanted, currency.name, curve.method,
                    price_of(scene, curve, wanted).step, gain);
        }
  return {"work-precision.cheapest-steps-last",
          "The steps of the cheapest methods, of those tied with them and of the next are stable "
          "in a run three times as long, too.",
          judge_worst(
              std::move(steps), most,
              "an unstable mode grows with every step until it is most of the motion; without one "
              "the energy is that of half the step, but for an error that is small where positions "
              "are right",
              "measured is the largest kinetic energy of the added time over that with half the "
              "step and a ten-thousandth of the largest; infinite if the run comes to no end")};
}

/// Where damping is light or each mode is resolved, order counts.
NamedFinding C_loses_at_small_errors(const std::vector<PrecisionScene>& scenes) {
  const double wanted = wanted_errors.back();
  Table shares(
      "scene [1]; cheapest other method [1]; its operator applications [1]; operator applications "
      "of C [1]; work of the cheapest over C's [1]");
  for (const PrecisionScene& scene : scenes) {
    if (scene.problem.name != "damped-hinge" && scene.problem.name != "light-sheet") continue;
    const auto work = [&](const PrecisionCurve& curve) {
      const double applications = price_of(scene, curve, wanted).applications;
      return std::isnan(applications) ? INFINITY : applications;
    };
    const PrecisionCurve* cheapest = nullptr;
    for (const PrecisionCurve& curve : scene.curves)
      if (curve.method != "C" && (!cheapest || work(curve) < work(*cheapest))) cheapest = &curve;
    const double c = work(curve_of(scene, "C"));
    shares.row(scene.problem.description, cheapest->method, work(*cheapest), c,
               work(*cheapest) / c);
  }
  return {"work-precision.C-costs-more-than-twice-at-small-errors",
          "On the damped hinge and the lightly damped sheet another method reaches a tenth of a "
          "percent with less than half of C's work.",
          judge_worst(std::move(shares), 0.5,
                      "with half of C's work, C costs twice as much: what its second solve a step "
                      "costs beside A and B",
                      "measured is the largest share of C's work; counted, not timed")};
}

}  // namespace

std::vector<NamedFinding> precision_findings(const std::vector<PrecisionScene>& scenes) {
  std::vector<NamedFinding> findings;
  for (const PrecisionScene& scene : scenes) {
    findings.push_back(reference_is_known(scene));
    findings.push_back(errors_fall(scene));
    if (scene.problem.name != "heavy-sheet") continue;
    findings.push_back(mixed_steps_are_larger(scene));
    findings.push_back(within_the_limit(scene));
    findings.push_back(C_needs_shorter_steps(scene));
  }
  findings.push_back(cheapest_steps_last(scenes));
  findings.push_back(one_more_solve(scenes));
  findings.push_back(C_loses_at_small_errors(scenes));
  return findings;
}

}  // namespace foldproof
