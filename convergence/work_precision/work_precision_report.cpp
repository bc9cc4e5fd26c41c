// Figures and tables of the work-precision study.
#include <algorithm>
#include <cmath>

#include "convergence/work_precision/work_precision.h"

namespace foldproof {

namespace {

constexpr double percent = 100;

const char* const caption =
    "Largest position error at the end over the largest motion. In the strip at the top: runs that "
    "diverged or err by more than the motion; a diverged run is placed at the cost of all its "
    "steps. The floor is the uncertainty of the reference solution; runs below it are faint.";

/// Which curves have fewer than five runs that err more than the reference, and why.
std::string short_curves(const PrecisionScene& scene) {
  constexpr int enough = 5;
  std::string list;
  for (const PrecisionCurve& curve : scene.curves) {
    const auto seen = std::ranges::count_if(
        curve.runs, [&](const PrecisionRun& run) { return run.error > scene.truth.uncertainty; });
    if (seen >= enough || curve.runs.empty()) continue;
    const bool is_fine = curve.runs.back().error <= wanted_errors.back();
    list += (list.empty() ? " " : ", ") + curve.method + " (" + std::to_string(seen) +
            (is_fine ? ": exact enough from its longest stable steps on)"
                     : ": shorter steps exceed the budget)");
  }
  return list.empty() ? "" : " Curves with fewer than five runs above the floor:" + list + ".";
}

std::string tied(const PrecisionScene& scene, const Podium& podium) {
  std::string names;
  for (const size_t k : podium.contenders)
    if (const std::string& name = scene.curves[k].method;
        name != podium.first && name != podium.second)
      names += (names.empty() ? "" : ", ") + name;
  return names;
}

Table cheapest(const std::vector<PrecisionScene>& scenes) {
  Table table(
      "scene [1]; error wanted [%]; by [1]; cheapest method [1]; its step [s]; step over bound of "
      "elastic limit [1]; step limited by [1]; operator applications [1]; processor time [s]; C "
      "costs this many times as much [1]; next best [1]; it costs this many times as much [1]; "
      "tied [1]");
  for (const PrecisionScene& scene : scenes)
    for (double wanted : wanted_errors)
      for (const Currency& currency : currencies) {
        const Podium at = podium(scene, wanted, currency);
        const Price& best = at.best;
        table.row(scene.problem.description, percent * wanted, currency.name, at.first, best.step,
                  best.step / scene.truth.elastic_limit, name_of(best.limit), best.applications,
                  best.seconds, at.scheme_C.*currency.cost / best.*currency.cost, at.second,
                  at.next.*currency.cost / best.*currency.cost, tied(scene, at));
      }
  return {"cheapest",
          "The cheapest method for a wanted position error, by counted work and by seconds; tied "
          "are those that cost more by less than the ratio of two steps that were tried; the next "
          "best is the cheapest of the others",
          table};
}

Table prices(const std::vector<PrecisionScene>& scenes) {
  Table table(
      "scene [1]; error wanted [%]; method [1]; largest step [s]; step over bound of elastic limit "
      "[1]; step limited by [1]; operator applications [1]; processor time [s]; unfinished solves "
      "[1]; asked whether it lasts [1]");
  for (const PrecisionScene& scene : scenes)
    for (double wanted : wanted_errors)
      for (const PrecisionCurve& curve : scene.curves) {
        const Price price = price_of(scene, curve, wanted);
        table.row(scene.problem.description, percent * wanted, curve.method, price.step,
                  price.step / scene.truth.elastic_limit, name_of(price.limit), price.applications,
                  price.seconds, price.unfinished,
                  longer_run_of(curve.longer, price.step) ? "yes" : "no");
      }
  return {"prices", "What a position error costs with each method", table};
}

Table scales(const std::vector<PrecisionScene>& scenes) {
  Table table(
      "scene [1]; particles [1]; end [s]; largest motion [m]; reference off by at most [%]; "
      "elastic limit, the solver's bound [s]; 2/omega, fastest mode [s]; 2/c, fastest damping rate "
      "[s]");
  for (const auto& [problem, truth, curves] : scenes)
    table.row(problem.description, problem.scene.mesh.particles(), problem.end, truth.motion,
              percent * truth.uncertainty, truth.elastic_limit, truth.two_over_omega,
              truth.two_over_c);
  return {"scenes", "The motions, and how well their ends are known", table};
}

/// How much of every curve there is to see.
Table coverage(const std::vector<PrecisionScene>& scenes) {
  Table table(
      "scene [1]; method [1]; runs [1]; measured [1]; that err more than the reference [1]; with "
      "unfinished solves [1]; diverged [1]");
  for (const PrecisionScene& scene : scenes)
    for (const PrecisionCurve& curve : scene.curves) {
      int measured = 0, seen = 0, unfinished = 0;
      for (const PrecisionRun& run : curve.runs) {
        measured += !std::isnan(run.error);
        seen += run.error > scene.truth.uncertainty;
        unfinished += mark_of(run) == Mark::unfinished;
      }
      table.row(scene.problem.description, curve.method, curve.runs.size(), measured, seen,
                unfinished, int(curve.runs.size()) - measured);
    }
  return {"coverage", "How many runs each curve has", table};
}

Table all_runs(const std::vector<PrecisionScene>& scenes) {
  Table table(
      "scene [1]; method [1]; steps [1]; error [%]; elastic evaluations [1]; damping preparations "
      "[1]; damping products [1]; stiffness preparations [1]; stiffness products [1]; operator "
      "applications [1]; unfinished solves [1]; processor time [s]");
  for (const PrecisionScene& scene : scenes)
    for (const PrecisionCurve& curve : scene.curves)
      for (const PrecisionRun& run : curve.runs) {
        const Work& w = run.work;
        table.row(scene.problem.description, curve.method, run.steps, percent * run.error,
                  w.elastic_evaluations, w.damping_preparations, w.damping_products,
                  w.stiffness_preparations, w.stiffness_products, run.applications,
                  w.unfinished_solves, run.seconds);
      }
  return {"runs", "Every run; no error where it diverged", table};
}

/// Every step that was asked whether it lasts.
Table longer_runs(const std::vector<PrecisionScene>& scenes) {
  Table table(
      "scene [1]; method [1]; step [s]; step over bound of elastic limit [1]; largest kinetic "
      "energy of the added time [J]; with half the step [J]; at any time [J]; energy gain [1]; "
      "lasts [1]");
  for (const PrecisionScene& scene : scenes)
    for (const PrecisionCurve& curve : scene.curves)
      for (const LongerRun& run : curve.longer)
        table.row(scene.problem.description, curve.method, run.step,
                  run.step / scene.truth.elastic_limit, run.with_step.added, run.with_half.added,
                  run.with_half.largest, energy_gain(run), lasts(run) ? "yes" : "no");
  return {"longer-runs",
          "Every step that was tried in a run three times as long; those that do not last get no "
          "price. The gain is the energy over that with half the step; no energy: the run came to "
          "no end",
          table};
}

}  // namespace

Podium podium(const PrecisionScene& scene, double wanted, const Currency& currency) {
  Podium podium;
  std::vector<double> costs;
  for (const PrecisionCurve& curve : scene.curves) {
    const Price price = price_of(scene, curve, wanted);
    if (curve.method == "C") podium.scheme_C = price;
    const double cost = costs.emplace_back(price.*currency.cost);
    if (std::isnan(cost) || cost >= podium.best.*currency.cost) continue;
    podium.best = price;
    podium.first = curve.method;
  }
  const double tied_below = scene.problem.ratio * (podium.best.*currency.cost);
  for (size_t k = 0; k < costs.size(); ++k) {
    const double cost = costs[k];
    if (!(cost > tied_below) || cost >= podium.next.*currency.cost) continue;
    podium.next = price_of(scene, scene.curves[k], wanted);
    podium.second = scene.curves[k].method;
  }
  for (size_t k = 0; k < costs.size(); ++k)
    if (costs[k] <= tied_below || scene.curves[k].method == podium.second)
      podium.contenders.push_back(k);
  return podium;
}

std::vector<Figure> precision_figures(const PrecisionScene& scene) {
  std::vector<CostAxis> axes = cost_axes();
  axes[1].name = "seconds";
  axes[2].axis = {"step over bound of elastic limit", "1", Scale::log};
  axes[2].unit = scene.truth.elastic_limit;
  std::vector<Figure> figures;
  for (const CostAxis& cost : axes) {
    Figure figure{scene.problem.name + "-" + cost.name,
                  "Error against " + cost.words + ": " + scene.problem.description,
                  cost.axis,
                  {"position error over the motion", "%", Scale::log},
                  nan,
                  caption,
                  {}};
    for (const PrecisionCurve& curve : scene.curves) {
      Curve points = error_curve(curve, cost, scene.problem.end, scene.truth.uncertainty);
      if (points.x.empty())
        figure.caption += " No run of " + points.label + " ended within its budget.";
      else
        figure.curves.push_back(std::move(points));
    }
    figure.caption += short_curves(scene);
    figures.push_back(std::move(figure));
  }
  return figures;
}

std::vector<Table> precision_tables(const std::vector<PrecisionScene>& scenes) {
  return {cheapest(scenes), prices(scenes),   longer_runs(scenes),
          scales(scenes),   coverage(scenes), all_runs(scenes)};
}

}  // namespace foldproof
