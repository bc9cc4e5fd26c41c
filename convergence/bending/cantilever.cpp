// cantilever: a clamped strip under its own weight or a load on its tip, against the elastica.

#include "convergence/bending/row_strip.h"
#include "convergence/study.h"
#include "verification/oracles/heavy_cantilever.h"
#include "verification/oracles/tip_load.h"

namespace foldproof {

namespace {

// strain under the whole load that the springs are made for [1]
constexpr double stretch_share = 1e-8;

/// Weight or tip load, and what the elastica says.
struct LoadCase {
  std::string name, words;
  StripLoad load;
  oracles::Estimate drop, reach;  // over L
};

/// Springs so stiff that the whole load F [N/m] strains them by about stretch_share.
double stiff(double F) { return F / stretch_share; }

LoadCase heavy(double gamma) {
  const double gravity = gamma * strip_D / (strip_density * std::pow(strip_length, 3));
  const oracles::CantileverTip tip = oracles::heavy_cantilever(gamma);
  const std::string number = std::to_string(int(gamma));
  return {"heavy-" + number,
          "own weight, gamma = " + number,
          {gravity, 0, stiff(strip_density * gravity * strip_length)},
          tip.drop,
          tip.reach};
}

LoadCase load_case(double alpha) {
  const double load = alpha * strip_D / std::pow(strip_length, 2);
  const oracles::LoadedTip tip = oracles::tip_load(alpha);
  const std::string number = std::to_string(int(alpha));
  return {"tip-load-" + number,
          "load on the tip, alpha = " + number,
          {0, load, stiff(load)},
          tip.drop,
          tip.reach};
}

/// Errors of one load over the panels' length.
struct Refined {
  LoadCase load;
  Table tips;         // level by level
  double floor = 0;   // of drop and reach: stretch, unfinished solve, the oracle's uncertainty [1]
  double strain = 0;  // largest of all
};

const std::string spacing_column = "spacing of the rows", drop_column = "drop of the tip over L",
                  drop_error = "error of the drop", reach_column = "reach of the tip over L",
                  reach_error = "error of the reach",
                  distance_column = "distance from the elastica's tip over L";

/// Drop and reach together make the distance: either may pass through zero by chance as the load
/// grows, their distance not.
Refined refined_tip(const Subject& subject, const LoadCase& load, const StripPattern& pattern,
                    const std::vector<int>& sizes) {
  Refined refined{load, {}};
  const auto run = [&](int panels) {
    const RowStrip strip(subject, pattern, panels, load.load, {});
    const StripAtRest rest = at_rest(strip, level(strip));
    update_worst(refined.floor,
                 rest.strain + rest.last_step + load.drop.uncertainty + load.reach.uncertainty);
    update_worst(refined.strain, rest.strain);
    const double drop = std::abs(rest.drop / strip_length - load.drop.value),
                 reach = std::abs(rest.reach / strip_length - load.reach.value);
    return std::tuple{strip.spacing(), rest.drop / strip_length, drop, rest.reach / strip_length,
                      reach,           std::hypot(drop, reach)};
  };
  refined.tips = refine({{spacing_column, "m"},
                         {drop_column, "1"},
                         {drop_error, "1"},
                         {reach_column, "1"},
                         {reach_error, "1"},
                         {distance_column, "1"}},
                        sizes, run);
  return refined;
}

Convergence distance(const Refined& refined) {
  Convergence tip = convergence_of(refined.tips, distance_column);
  tip.floor = std::hypot(refined.floor, refined.floor);
  return tip;
}

NamedFinding order_of(const Refined& refined) {
  const Convergence tip = distance(refined);
  Table evidence = refined.tips;
  evidence.add({"order of the distance", "1", row_orders(tip)});
  const Verdict verdict =
      order_verdict(tip, 2, 1, 0.1,
                    "another order is off by 1; the third term of the error is smaller than "
                    "the second by the number of panels");
  return {"cantilever.is-second-order." + refined.load.name,
          "The tip of a strip held cylindrical, " + refined.load.words +
              ", tends to the elastica's with second order.",
          {verdict, std::move(evidence),
           "measured is |order - 2| of the last pair; the springs' strain and the solve's last "
           "step make the uncertainty"}};
}

NamedFinding within_one_percent(const std::vector<Refined>& all) {
  Worst worst, uncertainty;
  Table finest(
      "load; drop over L [1]; drop of the elastica [1]; reach over L [1]; reach of the elastica "
      "[1]; largest strain of a panel [1]");
  for (const Refined& refined : all) {
    const LoadCase& load = refined.load;
    const auto last = [&](const std::string& column) {
      return refined.tips.numbers(column).back();
    };
    finest.row(load.words, last(drop_column), load.drop.value, last(reach_column), load.reach.value,
               refined.strain);
    worst.observe(last(drop_error) / load.drop.value);
    worst.observe(last(reach_error) / load.reach.value);
    uncertainty.observe(refined.floor / load.drop.value);
  }
  const Verdict verdict{worst.value(), 0.01, uncertainty.value(), "1",
                        "a fabric laboratory's bending test resolves a hundredth of the length"};
  return {"cantilever.matches-the-elastica",
          "At the finest mesh, drop and reach of every clamped strip are the elastica's within one "
          "percent, with the rigidity that the homogenised mesh has.",
          {verdict, finest, "D = ke/4 comes from the homogenised cell"}};
}

/// The same strips, with the length counted from the first line of hinges.
NamedFinding clamp_is_half_a_cell_before(const Refined& refined) {
  const LoadCase& load = refined.load;
  const std::vector<double>&spacings = refined.tips.numbers(spacing_column),
        &drops = refined.tips.numbers(drop_column);
  Table naive{{spacing_column, "m"}, {drop_error, "1"}};
  for (size_t i = 0; i < drops.size(); ++i) {
    // the load was made for L; a strip shorter by half a spacing has gamma (l/L)^3 and its
    // drop counts over l
    const double ratio = 1 - spacings[i] / 2 / strip_length;
    const double gamma =
        load.load.gravity * strip_density * std::pow(ratio * strip_length, 3) / strip_D;
    naive.row(spacings[i],
              std::abs(drops[i] / ratio - oracles::heavy_cantilever(gamma).drop.value));
  }
  Convergence errors = convergence_of(naive, drop_error);
  errors.floor = refined.floor;
  naive.add({"order", "1", row_orders(errors)});
  const Verdict verdict =
      order_verdict(errors, 1, 1, 0.1,
                    "another order is off by 1; the second term is smaller than the first by "
                    "the number of panels");
  return {"cantilever.clamp-on-the-hinges-is-first-order",
          "With the length counted from the first line of hinges instead of half a cell before it, "
          "the same strip is first order only.",
          {verdict, naive}};
}

NamedFinding patterns_agree(const Subject& subject, const LoadCase& load) {
  constexpr int panels = 12;
  Worst spread, uncertainty;
  Table tips("pattern; drop over L [1]; reach over L [1]");
  for (const StripPattern& pattern : strip_patterns()) {
    const RowStrip strip(subject, pattern, panels, load.load, {});
    const StripAtRest rest = at_rest(strip, level(strip));
    tips.row(pattern.words, rest.drop / strip_length, rest.reach / strip_length);
    for (const char* column : {"drop over L", "reach over L"})
      spread.observe(std::abs(tips.numbers(column).back() - tips.numbers(column).front()));
    uncertainty.observe(rest.last_step);
  }
  const Verdict verdict{spread.value(), 10 * stretch_share, uncertainty.value(), "1",
                        "the patterns stretch differently, by a few times the strain that the "
                        "springs were chosen for; hinges across the strip are the same"};
  return {"cantilever.patterns-agree",
          "Held cylindrical, with rows of edges across it, a strip of any pattern hangs alike.",
          {verdict, tips, load.words}};
}

Figure error_figure(const std::string& name, const std::string& title) {
  return {name,
          title,
          {"spacing of the rows", "m", Scale::log},
          {"distance from the elastica's tip over L", "1", Scale::log},
          2,
          "Against the elastica with D = ke/4; the length counts from half a cell before the first "
          "hinges."};
}

void show(const Refined& refined, Figure& figure) {
  Curve curve = curve_of(refined.load.words, distance(refined));
  curve.floor = distance(refined).floor;
  figure.curves.push_back(std::move(curve));
}

StudyResult run_cantilever(const Subject& subject, Tier tier, const Progress& progress) {
  std::vector<int> sizes = {8, 16, 32};
  if (tier == Tier::full) sizes.insert(sizes.end(), {64, 128});
  StudyResult result;
  std::vector<Refined> all;
  Figure weight = error_figure("own-weight", "Tip of a strip under its own weight");
  Figure tip = error_figure("tip-load", "Tip of a strip under a load on its end");
  for (const double gamma : {1.0, 5.0, 10.0}) {
    all.push_back(refined_tip(subject, heavy(gamma), strip_patterns()[0], sizes));
    show(all.back(), weight);
    progress(double(all.size()) / 7);
  }
  for (const double alpha : {1.0, 4.0, 10.0}) {
    all.push_back(refined_tip(subject, load_case(alpha), strip_patterns()[1], sizes));
    show(all.back(), tip);
    progress(double(all.size()) / 7);
  }
  for (const Refined& refined : all) result.findings.push_back(order_of(refined));
  result.add({within_one_percent(all), clamp_is_half_a_cell_before(all[1]),
              patterns_agree(subject, heavy(5))});
  result.figures.push_back(std::move(weight));
  result.figures.push_back(std::move(tip));
  return result;
}

}  // namespace

Study cantilever_study() {
  return {
      "cantilever",
      "The tip of a clamped strip, under its own weight or a load, comes to where that of the "
      "elastica with the mesh's own rigidity is, to second order.",
      {"is-second-order", "matches-the-elastica"},
      "BMF03 section 4; Bisshopp and Drucker 1945 for the tip load",
      "The first two rows of vertices of a strip are held level. The strip is held cylindrical: "
      "each row moves as one, driven by the sum of the solver's forces on it, so that the rigidity "
      "is that of the homogenised cell, ke/4, and cannot relax across the strip. Springs are so "
      "stiff that stretch stays below the errors shown. Equilibrium is found by Newton's method; "
      "the elastica by GSL, and, for the tip load, by elliptic integrals. gamma is weight per area "
      "times L^3 over D, alpha load per width times L^2 over D.",
      run_cantilever};
}

}  // namespace foldproof
