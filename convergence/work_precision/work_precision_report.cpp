// Figures and tables of the work-precision study.
#include <algorithm>
#include <cmath>

#include "convergence/work_precision/work_precision.h"

namespace foldproof {

namespace {

constexpr double percent = 100;

/// Horizontal axis for a run. A run that diverged on the way stands where all of its steps would
/// have cost as much as those that it took.
struct CostAxis {
  std::string name, words;
  Axis axis;
  double (*of)(const PrecisionScene& scene, const PrecisionRun& run);
};

std::vector<CostAxis> cost_axes() {
  return {
      {"work",
       "work",
       {"applications of force operators", "1", Scale::log},
       [](const PrecisionScene&, const PrecisionRun& run) { return run.applications / run.part; }},
      {"seconds",
       "time",
       {"processor time", "s", Scale::log},
       [](const PrecisionScene&, const PrecisionRun& run) { return run.seconds / run.part; }},
      {"step",
       "step",
       {"step over bound of elastic limit", "1", Scale::log},
       [](const PrecisionScene& scene, const PrecisionRun& run) {
         return scene.problem.end / run.steps / scene.truth.elastic_limit;
       }}};
}

Curve curve_of(const PrecisionScene& scene, const PrecisionCurve& curve, const CostAxis& cost) {
  Curve points{std::string(curve.integrator.name), {}, {}, percent * scene.truth.uncertainty, {}};
  for (const PrecisionRun& run : curve.runs) {
    points.x.push_back(cost.of(scene, run));
    points.y.push_back(percent * run.error);
    points.marks.push_back(mark_of(run));
  }
  return points;
}

const char* const caption =
    "Largest position error at the end over the largest motion. In the strip at the top: runs that "
    "diverged or err by more than the motion, where all of their steps would have cost as much as "
    "those that they took. The floor is the uncertainty of the reference solution; runs below it "
    "are faint.";

/// Which curves have fewer than five runs that err more than the reference, and why.
std::string short_curves(const PrecisionScene& scene) {
  constexpr int enough = 5;
  std::string list;
  for (const PrecisionCurve& curve : scene.curves) {
    const auto seen = std::ranges::count_if(
        curve.runs, [&](const PrecisionRun& run) { return run.error > scene.truth.uncertainty; });
    if (seen >= enough || curve.runs.empty()) continue;
    const bool is_fine = curve.runs.back().error <= wanted_errors.back();
    list += (list.empty() ? " " : ", ") + std::string(curve.integrator.name) + " (" +
            std::to_string(seen) +
            (is_fine ? ": exact enough from its longest stable steps on)"
                     : ": shorter steps exceed the budget)");
  }
  return list.empty() ? "" : " Fewer than five such runs:" + list + ".";
}

/// A cost that two methods are compared by.
struct Currency {
  std::string name;
  double Price::*cost;
};

const std::array<Currency, 2> currencies = {
    {{"work", &Price::applications}, {"seconds", &Price::seconds}}};

/// The two best of a scene.
struct Podium {
  std::string first = "none", second = "none";
  Price best{LimitedBy::not_reached, nan, nan, nan, nan}, next = best, scheme_C = best;
};

Podium podium(const PrecisionScene& scene, double wanted, const Currency& currency) {
  Podium podium;
  for (const PrecisionCurve& curve : scene.curves) {
    const Price price = price_at(curve, scene.problem.end, wanted);
    const std::string name(curve.integrator.name);
    if (name == "C") podium.scheme_C = price;
    const double cost = price.*currency.cost;
    if (std::isnan(cost)) continue;
    if (!(cost >= podium.best.*currency.cost)) {
      podium.next = podium.best;
      podium.second = podium.first;
      podium.best = price;
      podium.first = name;
    } else if (!(cost >= podium.next.*currency.cost)) {
      podium.next = price;
      podium.second = name;
    }
  }
  return podium;
}

Table cheapest(const std::vector<PrecisionScene>& scenes) {
  std::vector<std::string> things, by, first, limits, second;
  std::vector<double> errors, steps, relative, work, seconds, against_C, against_next;
  for (const PrecisionScene& scene : scenes) {
    for (double wanted : wanted_errors) {
      for (const Currency& currency : currencies) {
        const Podium best = podium(scene, wanted, currency);
        things.push_back(scene.problem.description);
        errors.push_back(percent * wanted);
        by.push_back(currency.name);
        first.push_back(best.first);
        limits.emplace_back(name_of(best.best.limit));
        steps.push_back(best.best.step);
        relative.push_back(best.best.step / scene.truth.elastic_limit);
        work.push_back(best.best.applications);
        seconds.push_back(best.best.seconds);
        against_C.push_back(best.scheme_C.*currency.cost / best.best.*currency.cost);
        second.push_back(best.second);
        against_next.push_back(best.next.*currency.cost / best.best.*currency.cost);
      }
    }
  }
  return {"cheapest",
          "The cheapest method for a wanted position error, by counted work and by seconds",
          {{"scene", "1", things},
           {"error wanted", "%", errors},
           {"by", "1", by},
           {"cheapest method", "1", first},
           {"its step", "s", steps},
           {"step over bound of elastic limit", "1", relative},
           {"step limited by", "1", limits},
           {"operator applications", "1", work},
           {"processor time", "s", seconds},
           {"C costs this many times as much", "1", against_C},
           {"next best", "1", second},
           {"it costs this many times as much", "1", against_next}}};
}

Table prices(const std::vector<PrecisionScene>& scenes) {
  std::vector<std::string> things, methods, limits;
  std::vector<double> errors, steps, relative, work, seconds, unfinished;
  for (const PrecisionScene& scene : scenes) {
    for (double wanted : wanted_errors) {
      for (const PrecisionCurve& curve : scene.curves) {
        const Price price = price_at(curve, scene.problem.end, wanted);
        things.push_back(scene.problem.description);
        errors.push_back(percent * wanted);
        methods.emplace_back(curve.integrator.name);
        steps.push_back(price.step);
        relative.push_back(price.step / scene.truth.elastic_limit);
        limits.emplace_back(name_of(price.limit));
        work.push_back(price.applications);
        seconds.push_back(price.seconds);
        unfinished.push_back(price.unfinished);
      }
    }
  }
  return {"prices",
          "What a position error costs with each method",
          {{"scene", "1", things},
           {"error wanted", "%", errors},
           {"method", "1", methods},
           {"largest step", "s", steps},
           {"step over bound of elastic limit", "1", relative},
           {"step limited by", "1", limits},
           {"operator applications", "1", work},
           {"processor time", "s", seconds},
           {"unfinished solves", "1", unfinished}}};
}

Table scales(const std::vector<PrecisionScene>& scenes) {
  std::vector<std::string> things;
  std::vector<double> particles, ends, motions, uncertainties, limits, elastic, damping;
  for (const PrecisionScene& scene : scenes) {
    things.push_back(scene.problem.description);
    particles.push_back(double(scene.problem.scene.mesh.particles()));
    ends.push_back(scene.problem.end);
    motions.push_back(scene.truth.motion);
    uncertainties.push_back(percent * scene.truth.uncertainty);
    limits.push_back(scene.truth.elastic_limit);
    elastic.push_back(scene.truth.two_over_omega);
    damping.push_back(scene.truth.two_over_c);
  }
  return {"scenes",
          "The motions, and how well their ends are known",
          {{"scene", "1", things},
           {"particles", "1", particles},
           {"end", "s", ends},
           {"largest motion", "m", motions},
           {"reference off by at most", "%", uncertainties},
           {"elastic limit, the solver's bound", "s", limits},
           {"2/omega, fastest mode", "s", elastic},
           {"2/c, fastest damping rate", "s", damping}}};
}

/// How much of every curve there is to see.
Table coverage(const std::vector<PrecisionScene>& scenes) {
  std::vector<std::string> things, methods;
  std::array<std::vector<double>, 5> numbers;
  for (const PrecisionScene& scene : scenes) {
    for (const PrecisionCurve& curve : scene.curves) {
      things.push_back(scene.problem.description);
      methods.emplace_back(curve.integrator.name);
      std::array<double, 5> row = {};
      for (const PrecisionRun& run : curve.runs) {
        const bool is_measured = !std::isnan(run.error);
        const std::array<bool, 5> counts = {true, is_measured, run.error > scene.truth.uncertainty,
                                            mark_of(run) == Mark::unfinished, !is_measured};
        for (size_t k = 0; k < row.size(); ++k) row[k] += counts[k];
      }
      for (size_t k = 0; k < row.size(); ++k) numbers[k].push_back(row[k]);
    }
  }
  return {"coverage",
          "How many runs each curve has",
          {{"scene", "1", things},
           {"method", "1", methods},
           {"runs", "1", numbers[0]},
           {"measured", "1", numbers[1]},
           {"that err more than the reference", "1", numbers[2]},
           {"with unfinished solves", "1", numbers[3]},
           {"diverged", "1", numbers[4]}}};
}

Table all_runs(const std::vector<PrecisionScene>& scenes) {
  std::vector<std::string> things, methods;
  std::array<std::vector<double>, 10> numbers;
  for (const PrecisionScene& scene : scenes) {
    for (const PrecisionCurve& curve : scene.curves) {
      for (const PrecisionRun& run : curve.runs) {
        const Work& w = run.work;
        things.push_back(scene.problem.description);
        methods.emplace_back(curve.integrator.name);
        const std::array<double, 10> row = {double(run.steps),
                                            percent * run.error,
                                            double(w.elastic_evaluations),
                                            double(w.damping_preparations),
                                            double(w.damping_products),
                                            double(w.stiffness_preparations),
                                            double(w.stiffness_products),
                                            run.applications,
                                            double(w.unfinished_solves),
                                            run.seconds};
        for (size_t k = 0; k < row.size(); ++k) numbers[k].push_back(row[k]);
      }
    }
  }
  return {"runs",
          "Every run; no error where it diverged",
          {{"scene", "1", things},
           {"method", "1", methods},
           {"steps", "1", numbers[0]},
           {"error", "%", numbers[1]},
           {"elastic evaluations", "1", numbers[2]},
           {"damping preparations", "1", numbers[3]},
           {"damping products", "1", numbers[4]},
           {"stiffness preparations", "1", numbers[5]},
           {"stiffness products", "1", numbers[6]},
           {"operator applications", "1", numbers[7]},
           {"unfinished solves", "1", numbers[8]},
           {"processor time", "s", numbers[9]}}};
}

}  // namespace

std::vector<Figure> precision_figures(const PrecisionScene& scene) {
  std::vector<Figure> figures;
  for (const CostAxis& cost : cost_axes()) {
    Figure figure{scene.problem.name + "-" + cost.name,
                  "Error against " + cost.words + ": " + scene.problem.description,
                  cost.axis,
                  {"position error over the motion", "%", Scale::log},
                  nan,
                  caption,
                  {}};
    for (const PrecisionCurve& curve : scene.curves) {
      Curve points = curve_of(scene, curve, cost);
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
  return {cheapest(scenes), prices(scenes), scales(scenes), coverage(scenes), all_runs(scenes)};
}

}  // namespace foldproof
