// cantilever: a clamped strip under its own weight or a load on its tip, against the elastica.
#include <cmath>

#include "convergence/order.h"
#include "convergence/bending/row_strip.h"
#include "convergence/bending/studies.h"
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

/// How far a strip's tip is from the elastica's, and why it may be.
struct TipError {
  double drop, reach;  // over L, signed [1]
  double off;          // stretch, unfinished solve and the oracle's uncertainty [1]
};

/// `length`: what counts as the strip's length L, over the one from half a cell before
/// the hinges [1].
TipError tip_error(const LoadCase& load, const StripAtRest& rest, double length) {
  const double L = length * strip_length;
  return {rest.drop / L - load.drop.value, rest.reach / L - load.reach.value,
          rest.strain + rest.last_step + load.drop.uncertainty + load.reach.uncertainty};
}

/// Errors of one load over the panels' length.
struct Refined {
  LoadCase load;
  std::vector<double> spacings, drops, reaches;  // m, over L
  Convergence drop, reach;                       // |error| over L
  double strain = 0;                             // largest of all
};

Refined refine(const Subject& subject, const LoadCase& load, const StripPattern& pattern,
               const std::vector<int>& sizes) {
  Refined refined{load, {}, {}, {}, {}, {}};
  for (const int panels : sizes) {
    const RowStrip strip(subject, pattern, panels, load.load);
    const StripAtRest rest = at_rest(strip, level(strip));
    const TipError error = tip_error(load, rest, 1);
    refined.drops.push_back(rest.drop / strip_length);
    refined.reaches.push_back(rest.reach / strip_length);
    for (Convergence* convergence : {&refined.drop, &refined.reach}) {
      convergence->steps.push_back(strip.spacing());
      update_worst(convergence->floor, error.off);
    }
    refined.drop.errors.push_back(std::abs(error.drop));
    refined.reach.errors.push_back(std::abs(error.reach));
    update_worst(refined.strain, rest.strain);
  }
  return refined;
}

/// Drop and reach together: either may pass through zero by chance as the load grows,
/// their distance not.
Convergence distance(const Refined& refined) {
  Convergence tip{refined.drop.steps, {}, std::hypot(refined.drop.floor, refined.reach.floor)};
  for (size_t i = 0; i < refined.drop.errors.size(); ++i)
    tip.errors.push_back(std::hypot(refined.drop.errors[i], refined.reach.errors[i]));
  return tip;
}

NamedFinding order_of(const Refined& refined) {
  const Convergence tip = distance(refined);
  const Estimate deviation = order_deviation(tip, 2, 1);
  std::vector<double> orders = pair_orders(tip);
  orders.insert(orders.begin(), nan);
  const Verdict verdict{deviation.value, 0.1, deviation.uncertainty, "1",
                        "a whole order would be off by 1; the third term of the error is smaller "
                        "than the second by the panels' number"};
  return {"cantilever.is-second-order." + refined.load.name,
          "The tip of a strip held cylindrical, " + refined.load.words +
              ", tends to the elastica's with second order.",
          {verdict,
           {{"spacing of the rows", "m", tip.steps},
            {"drop of the tip over L", "1", refined.drops},
            {"error of the drop", "1", refined.drop.errors},
            {"reach of the tip over L", "1", refined.reaches},
            {"error of the reach", "1", refined.reach.errors},
            {"distance from the elastica's tip over L", "1", tip.errors},
            {"order of the distance", "1", orders}},
           "measured is |order - 2| of the last pair; the springs' strain and the solve's last "
           "step make the uncertainty"}};
}

NamedFinding within_one_percent(const std::vector<Refined>& all) {
  Worst worst, uncertainty;
  std::vector<std::string> names;
  std::vector<double> drops, reaches, exact_drops, exact_reaches, strains;
  for (const Refined& refined : all) {
    const LoadCase& load = refined.load;
    names.push_back(load.words);
    drops.push_back(refined.drops.back());
    reaches.push_back(refined.reaches.back());
    exact_drops.push_back(load.drop.value);
    exact_reaches.push_back(load.reach.value);
    strains.push_back(refined.strain);
    worst.observe(refined.drop.errors.back() / load.drop.value);
    worst.observe(refined.reach.errors.back() / load.reach.value);
    uncertainty.observe(refined.drop.floor / load.drop.value);
  }
  const Verdict verdict{
      worst.value(), 0.01, uncertainty.value(), "1",
      "what a fabric laboratory's bending test resolves: a hundredth of the length"};
  return {"cantilever.matches-the-elastica",
          "At the finest mesh, drop and reach of every clamped strip are the elastica's within one "
          "percent, with the rigidity that the homogenised mesh has.",
          {verdict,
           {{"load", "", names},
            {"drop over L", "1", drops},
            {"drop of the elastica", "1", exact_drops},
            {"reach over L", "1", reaches},
            {"reach of the elastica", "1", exact_reaches},
            {"largest strain of a panel", "1", strains}},
           "D = ke/4 comes from the homogenised cell"}};
}

/// The same strips, with the length counted from the first line of hinges.
NamedFinding clamp_is_half_a_cell_before(const Refined& refined) {
  Convergence naive;
  naive.floor = refined.drop.floor;
  naive.steps = refined.drop.steps;
  const LoadCase& load = refined.load;
  std::vector<double> orders;
  for (size_t i = 0; i < refined.drops.size(); ++i) {
    // the load was made for L; a strip shorter by half a spacing has gamma (l/L)^3 and its
    // drop counts over l
    const double ratio = 1 - naive.steps[i] / 2 / strip_length;
    const double gamma =
        load.load.gravity * strip_density * std::pow(ratio * strip_length, 3) / strip_D;
    naive.errors.push_back(
        std::abs(refined.drops[i] / ratio - oracles::heavy_cantilever(gamma).drop.value));
  }
  orders = pair_orders(naive);
  orders.insert(orders.begin(), nan);
  const Estimate deviation = order_deviation(naive, 1, 1);
  const Verdict verdict{deviation.value, 0.1, deviation.uncertainty, "1",
                        "a whole order would be off by 1; the second term is smaller than the "
                        "first by the panels' number"};
  return {"cantilever.clamp-on-the-hinges-is-first-order",
          "With the length counted from the first line of hinges instead of half a cell before it, "
          "the same strip is first order only.",
          {verdict,
           {{"spacing of the rows", "m", naive.steps},
            {"error of the drop", "1", naive.errors},
            {"order", "1", orders}},
           ""}};
}

NamedFinding patterns_agree(const Subject& subject, const LoadCase& load) {
  constexpr int panels = 12;
  Worst spread, uncertainty;
  std::vector<std::string> names;
  std::vector<double> drops, reaches;
  for (const StripPattern& pattern : strip_patterns()) {
    const RowStrip strip(subject, pattern, panels, load.load);
    const StripAtRest rest = at_rest(strip, level(strip));
    names.push_back(pattern.words);
    drops.push_back(rest.drop / strip_length);
    reaches.push_back(rest.reach / strip_length);
    spread.observe(std::abs(drops.back() - drops.front()));
    spread.observe(std::abs(reaches.back() - reaches.front()));
    uncertainty.observe(rest.last_step);
  }
  const Verdict verdict{spread.value(), 10 * stretch_share, uncertainty.value(), "1",
                        "the patterns stretch differently, by a few times the strain that the "
                        "springs were made for; hinges across the strip are the same"};
  return {"cantilever.patterns-agree",
          "Held cylindrical, with rows of edges across it, a strip of any pattern hangs alike.",
          {verdict,
           {{"pattern", "", names}, {"drop over L", "1", drops}, {"reach over L", "1", reaches}},
           load.words}};
}

Figure error_figure(const std::string& name, const std::string& title) {
  return {name,
          title,
          {"spacing of the rows", "m", Scale::log},
          {"distance from the elastica's tip over L", "1", Scale::log},
          2,
          "Against the elastica with D = ke/4; the length counts from half a cell before the first "
          "hinges.",
          {}};
}

void show(const Refined& refined, Figure& figure) {
  const Convergence tip = distance(refined);
  figure.curves.push_back({refined.load.words, tip.steps, tip.errors, tip.floor, pair_orders(tip)});
}

StudyResult run_cantilever(const Subject& subject, Tier tier, const Progress& progress) {
  std::vector<int> sizes = {8, 16, 32};
  if (tier == Tier::full) sizes.insert(sizes.end(), {64, 128});
  StudyResult result;
  std::vector<Refined> all;
  Figure weight = error_figure("own-weight", "Tip of a strip under its own weight");
  Figure tip = error_figure("tip-load", "Tip of a strip under a load on its end");
  for (const double gamma : {1.0, 5.0, 10.0}) {
    all.push_back(refine(subject, heavy(gamma), strip_patterns()[0], sizes));
    show(all.back(), weight);
    progress(double(all.size()) / 7);
  }
  for (const double alpha : {1.0, 4.0, 10.0}) {
    all.push_back(refine(subject, load_case(alpha), strip_patterns()[1], sizes));
    show(all.back(), tip);
    progress(double(all.size()) / 7);
  }
  for (const Refined& refined : all) result.findings.push_back(order_of(refined));
  result.findings.push_back(within_one_percent(all));
  result.findings.push_back(clamp_is_half_a_cell_before(all[1]));
  result.findings.push_back(patterns_agree(subject, heavy(5)));
  result.figures.push_back(std::move(weight));
  result.figures.push_back(std::move(tip));
  return result;
}

}  // namespace

Study cantilever_study() {
  return {
      "cantilever",
      "A clamped strip under its own weight or a load on its tip takes the shape of the elastica "
      "with the mesh's own rigidity, to second order.",
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
