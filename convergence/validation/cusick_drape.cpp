// cusick-drape: a disc of measured cloth between two smaller plates, in the
// laboratory's drape test.

#include <numbers>
#include <numeric>

#include "convergence/validation/comparison.h"
#include "convergence/validation/drape_test.h"
#include "convergence/study.h"

namespace foldproof {

namespace {

// "typically has a +-2% error margin": textura.ai/cusick-test-sed-0288
constexpr double resolution = 0.02;  // of the coefficient [1]

/// All drapes of a run.
struct Drapes {
  const Subject& subject;
  const Progress& progress;
  double expected;  // how many there will be
  Table table{"drapes",
              "Every drape of this run",
              {{"bending length", "mm"},
               {"rows of triangles", "1"},
               {"waves of the start", "1"},
               {"stretch stiffness over the weight", "1"},
               {"folds", "1"},
               {"drape coefficient", "1"},
               {"unbalanced force over the weight", "1"},
               {"crossings", "1"},
               {"largest strain", "1"},
               {"stable", ""}}};
  std::vector<std::pair<DrapeTest, Drape>> made = {};

  Drape operator()(const DrapeTest& test) {
    for (const auto& [known, result] : made)
      if (known == test) return result;
    const Drape result = drape(subject, test);
    made.emplace_back(test, result);
    table.row(1e3 * bending_length(test.fabric), test.rows, test.waves, test.stretch, result.folds,
              result.coefficient, result.unbalanced, result.crossings, result.largest_strain,
              result.stable ? "yes" : "no");
    progress(std::min(1.0, double(table.rows()) / expected));
    return result;
  }
};

DrapeFabric of_bending_length(const DrapeFabric& fabric, double factor) {
  return {fabric.name, fabric.rigidity * std::pow(factor, 3), fabric.density};
}

/// Wool on finer and finer meshes. A drape with another number of folds is another drape, and one
/// that is not stable is none: there is no error then.
struct MeshLadder {
  Table table{"rows of triangles [1]; folds [1]; drape coefficient [1]"};
  double error = 0;  // of the coarser meshes' results, in the quick tier; of the finest in the full
};

MeshLadder mesh_ladder(Drapes& drapes, Tier tier) {
  MeshLadder result;
  Ladder ladder;
  ladder.ratio = 1.4;  // between rows + 1/2 of neighbours, within 0.02
  bool all_stable = true;
  const std::vector<int> meshes =
      tier == Tier::quick ? std::vector{7, 10} : std::vector{7, 10, 14, 20};
  for (const int rows : meshes) {
    const Drape one = drapes({drape_fabrics()[0], rows});
    result.table.row(rows, one.folds, one.coefficient);
    ladder.values.push_back(one.coefficient);
    all_stable = all_stable && one.stable;
  }
  const std::vector<double>& folds = result.table.numbers("folds");
  if (!all_stable || std::ranges::any_of(folds, [&](double n) { return n != folds[0]; }))
    result.error = nan;
  else if (tier == Tier::full)
    result.error = error_bar(ladder).half_width;
  else  // two meshes show no order
    result.error = 3 * std::abs(ladder.values[1] - ladder.values[0]);
  return result;
}

/// In the full tier.
NamedFinding error_is_below_the_tests(const MeshLadder& ladder) {
  return {"cusick-drape.error-is-below-the-tests",
          "The mesh's error of wool's drape coefficient is at most two hundredths.",
          {{ladder.error, resolution, 0, "1", "the error margin that is quoted for the test"},
           ladder.table,
           "error bar of the finest mesh, all meshes with the same number of folds"}};
}

/// Wool on one mesh from starts with other numbers of waves.
struct Starts {
  Table table{"waves of the start [1]; folds at rest [1]; drape coefficient [1]"};
  std::vector<Drape> drapes;  // stable ones, one for each number of folds
  double spread = 0;          // of their coefficients
};

Starts from_starts(Drapes& drapes, Tier tier) {
  const std::vector<int> waves =
      tier == Tier::quick ? std::vector{7, 8, 10} : std::vector{3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  Starts starts;
  for (const int count : waves) {
    const Drape one = drapes({drape_fabrics()[0], tier == Tier::quick ? 7 : 10, count});
    starts.table.row(count, one.folds, one.coefficient);
    const bool known = std::ranges::any_of(
        starts.drapes, [&](const Drape& other) { return other.folds == one.folds; });
    if (one.stable && !known) starts.drapes.push_back(one);
  }
  if (starts.drapes.empty()) return starts;  // none is stable
  const auto [least, most] =
      std::ranges::minmax(starts.drapes, {}, [](const Drape& one) { return one.coefficient; });
  starts.spread = most.coefficient - least.coefficient;
  return starts;
}

NamedFinding fold_number_follows_the_start(const Starts& starts) {
  return {"cusick-drape.fold-number-follows-the-start",
          "The same wool has stable rests with three or more numbers of folds, by its start.",
          {{3.0 / double(starts.drapes.size()), 1, 0, "1",
            "repeated tests of one fabric give several numbers of folds, by its initial state "
            "(Jeong 1998, part I)"},
           starts.table,
           "three over the stable numbers of folds; stable: every pivot of the energy's Hessian is "
           "positive"}};
}

NamedFinding folds_change_the_coefficient(const Starts& starts, double error) {
  Table table = starts.table;
  return {"cusick-drape.folds-change-the-coefficient",
          "Drape coefficients of the same wool differ with the number of folds by more than the "
          "mesh's error.",
          {{error / starts.spread, 1, 0, "1",
            "drape values are influenced by the number of folds (Jeong 1998, part I)"},
           std::move(table),
           "the mesh's error over the spread of the coefficients"}};
}

/// The coefficient over the bending length, from wool's.
Table by_bending_length(Drapes& drapes, Tier tier) {
  const std::vector<double> factors = tier == Tier::quick
                                          ? std::vector{0.8, 1.0, 1.4, 2.0}
                                          : std::vector{0.8, 1.0, 1.2, 1.4, 1.7, 2.0, 2.5, 3.0};
  Table table("bending length [mm]; folds [1]; drape coefficient [1]");
  for (const double factor : factors) {
    const DrapeFabric fabric = of_bending_length(drape_fabrics()[0], factor);
    const Drape one = drapes({fabric, tier == Tier::quick ? 7 : 10});
    table.row(1e3 * bending_length(fabric), one.folds, one.stable ? one.coefficient : nan);
  }
  return table;
}

NamedFinding coefficient_grows(const Table& table, double error) {
  const std::vector<double>& coefficients = table.numbers("drape coefficient");
  double least = 1;
  for (std::size_t k = 1; k < coefficients.size() && !std::isnan(least); ++k) {
    const double growth = coefficients[k] - coefficients[k - 1];
    if (!(growth >= least)) least = growth;
  }
  return {"cusick-drape.coefficient-grows-with-bending-length",
          "The drape coefficient grows with the bending length.",
          {{least > 0 ? error / least : nan, 1, 0, "1",
            "stiffer or lighter cloth drapes less; growth below the error would not show"},
           table,
           "the mesh's error over the least growth between neighbours; no coefficient where the "
           "drape is not stable"}};
}

/// The measured fabrics as simulated. Their stretch is that of wool in every tier; in the full tier
/// also that whose shear is the fabric's own: the springs of equilateral triangles have G = 3/8 Y.
Table measured_fabrics(Drapes& drapes, Tier tier, double error) {
  Table table{"measured",
              "Measured drape coefficients, and simulated ones",
              {{"fabric", ""},
               {"bending length", "mm"},
               {"measured coefficient", "1"},
               {"simulated coefficient", "1"},
               {"simulated, with the measured shear", "1"},
               {"folds", "1"},
               {"comparison", ""}}};
  const int rows = tier == Tier::quick ? 7 : 10;
  for (const MeasuredDrape& of : measured_drapes()) {
    const Drape one = drapes({of.fabric, rows});
    const double weight = of.fabric.density * gravity * (specimen_radius - plate_radius);
    const double sheared =
        tier == Tier::quick ? nan
                            : drapes({of.fabric, rows, 8, 8 / 3.0 * of.shear / weight}).coefficient;
    const double apart = of.coefficient - one.coefficient;
    table.row(of.fabric.name, 1e3 * bending_length(of.fabric), of.coefficient,
              oracles::Estimate{one.coefficient, error}, sheared, one.folds,
              fmt::format("provisional: {:.2f} {}; read second-hand, without discs and scatter",
                          std::abs(apart), apart > 0 ? "too limp" : "too stiff"));
  }
  return table;
}

/// The share of the orders of n things that agree with another order at least as well as these
/// numbers do, by Spearman's sum of squared differences of ranks.
double chance_of_ranks(const std::vector<double>& one, const std::vector<double>& other) {
  const auto ranks = [](const std::vector<double>& values) {
    std::vector<int> all;
    for (const double value : values)
      all.push_back(int(std::ranges::count_if(values, [&](double v) { return v < value; })));
    return all;
  };
  const auto squares = [](const std::vector<int>& a, const std::vector<int>& b) {
    int sum = 0;
    for (size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
  };
  const std::vector<int> first = ranks(one);
  const int found = squares(first, ranks(other));
  std::vector<int> order(one.size());
  std::iota(order.begin(), order.end(), 0);
  int as_good = 0, all = 0;
  do {
    ++all;
    as_good += squares(first, order) <= found;
  } while (std::ranges::next_permutation(order).found);
  return double(as_good) / all;
}

NamedFinding ranks_as_measured(const Table& measured) {
  const double chance = chance_of_ranks(measured.numbers("measured coefficient"),
                                        measured.numbers("simulated coefficient"));
  return {"cusick-drape.ranks-fabrics-as-measured",
          "Simulated drape ranks six measured fabrics as the laboratory does.",
          {{chance, 0.05, 0, "1",
            "the usual level; with six fabrics only one in twenty orders agrees as well"},
           measured,
           "the share of all orders of the fabrics that agree at least as well (Spearman)"}};
}

NamedFinding is_at_rest(const Drapes& drapes) {
  Worst worst;
  int stable = 0;
  for (const auto& [test, one] : drapes.made) {
    if (!one.stable) continue;
    worst.observe(one.unbalanced);
    ++stable;
  }
  return {"cusick-drape.is-at-rest",
          "Every stable drape is at rest, to a millionth of a particle's weight.",
          {{stable > 0 ? worst.value() : nan, 1e-6, 0, "1", "the search ends at a hundredth of it"},
           drapes.table,
           "drapes that are not stable are left out"}};
}

NamedFinding never_crosses_itself(const Table& drapes) {
  return {"cusick-drape.never-crosses-itself",
          "No drape crosses itself, though nothing prevents it.",
          judge_worst(drapes, "crossings", 0,
                      "counted exactly; if folds met, their contact would have to be simulated")};
}

/// Outlines from above, and how far they reach in each direction.
std::vector<Figure> outlines_of(const std::vector<Drape>& drapes) {
  Figure seen{"outlines",
              "Wool from above, at rest from several starts",
              {"x", "m"},
              {"y", "m"},
              "The shadow's edge, to scale. Every one is stable."};
  Figure polar{"polar",
               "How far the shadow reaches around the plate",
               {"direction", "degrees"},
               {"distance from the axis", "m"},
               "The plate's radius is 0.09 m, that of the level cloth 0.15 m."};
  for (const Drape& one : drapes) {
    Curve outline{fmt::format("{} folds", one.folds)}, reach = outline;
    const std::size_t n = one.outline.size();
    for (std::size_t k = 0; k <= n; k += 4) {
      const double angle = 2 * std::numbers::pi * double(k) / double(n), r = one.outline[k % n];
      outline.point(r * std::cos(angle), r * std::sin(angle));
      reach.point(360 * double(k) / double(n), r);
    }
    seen.curves.push_back(std::move(outline));
    polar.curves.push_back(std::move(reach));
  }
  return {seen, polar};
}

Figure curve_over_bending_length(const Table& table) {
  return {"bending-length",
          "Drape coefficient by bending length",
          {"bending length", "mm"},
          {"drape coefficient", "1"},
          "One density and stretch stiffness; each start has eight waves.",
          {curve_of("simulated", table, "bending length", "drape coefficient")}};
}

/// In the full tier: all fabrics of the file, and wool that stretches more and less.
Table fabrics_and_stretch(Drapes& drapes, double error) {
  Table table{"fabrics",
              "Measured fabrics, and wool that is easier and harder to stretch",
              {{"fabric", ""},
               {"stretch stiffness over the weight", "1"},
               {"bending length", "mm"},
               {"folds", "1"},
               {"drape coefficient", "1"}}};
  const auto add = [&](const DrapeTest& test) {
    const Drape one = drapes(test);
    table.row(test.fabric.name, test.stretch, 1e3 * bending_length(test.fabric), one.folds,
              oracles::Estimate{one.coefficient, error});
  };
  for (const DrapeFabric& fabric : drape_fabrics()) add({fabric, 10});
  for (const double stretch : {100.0, 1000.0}) add({drape_fabrics()[0], 10, 8, stretch});
  return table;
}

StudyResult run_cusick_drape(const Subject& subject, Tier tier, const Progress& progress) {
  Drapes drapes{subject, progress, tier == Tier::quick ? 13.0 : 38.0};
  const MeshLadder ladder = mesh_ladder(drapes, tier);
  const Starts starts = from_starts(drapes, tier);
  const Table curve = by_bending_length(drapes, tier);
  StudyResult result;
  const Table measured = measured_fabrics(drapes, tier, ladder.error);
  result.tables = {measured};
  if (tier == Tier::full) result.tables.push_back(fabrics_and_stretch(drapes, ladder.error));
  if (tier == Tier::full) result.findings.push_back(error_is_below_the_tests(ladder));
  result.add({fold_number_follows_the_start(starts),
              folds_change_the_coefficient(starts, ladder.error),
              coefficient_grows(curve, ladder.error), is_at_rest(drapes),
              never_crosses_itself(drapes.table), ranks_as_measured(measured)});
  result.figures = outlines_of(starts.drapes);
  result.figures.push_back(curve_over_bending_length(curve));
  return result;
}

}  // namespace

Study cusick_drape_study() {
  return {
      "cusick-drape",
      "In the drape test the coefficient grows with the bending length. One fabric rests with "
      "several numbers of folds, depending on its start, and they change the coefficient.",
      {"coefficient-grows-with-bending-length", "fold-number-follows-the-start",
       "folds-change-the-coefficient"},
      "Cusick 1965; BS 5058; ISO 9073-9",
      "A disc of 30 cm is held between two plates of 18 cm, and its ring hangs. The drape "
      "coefficient is the area of the ring's shadow over that of the level ring. S is for the "
      "wool of cases/fabrics.toml, with the mean of its rigidities, on nearly equilateral "
      "triangles whose rigidity is the same in all directions. The shape depends on the "
      "bending length (B/(density g))^(1/3) and on the stretch stiffness, which no source of "
      "the file gives: it is 300 times the ring's weight per width. A rest is found without "
      "inertia, from waves around the ring, and its stability by the energy's Hessian. Six fabrics "
      "have weight, rigidity, shear and coefficient from one source (Petrak 2025, read second-"
      "hand): the order is the laboratory's, but all are simulated limper, by up to a "
      "quarter of the ring. Springs stiff enough for the measured shear take back a few "
      "hundredths of that. Six say nothing of the cause: bending that stiffens where the "
      "cloth is nearly flat (hysteresis), other discs, or the mean of two directions. "
      "The text of Jeong 1998 (J. Textile Inst. 89) that was read is the abstract.",
      run_cusick_drape,
      "validation"};
}

}  // namespace foldproof
