#include "convergence/stability/stability_sheet.h"

#include <cmath>

#include "convergence/stability/stable_step.h"
#include "convergence/stability/step_matrix.h"
#include "reference/dynamics/integrator.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/stability.h"

namespace foldproof {

namespace {

Scene damped_sheet(int cells, const Damping& damping) {
  Scene scene = flat_sheet(cells);
  if (damping.springs > 0) scene.stretch = StretchMaterial{29, damping.springs, 1};
  if (damping.bending > 0) scene.bending = BendingMaterial{0.0071, damping.bending};
  return scene;
}

/// The largest eigenvalue of -M^{-1} D [1/s]; from below.
double largest_damping_rate(const Subject& subject, const Scene& scene) {
  return largest_eigenvalue(scene, damping_operator(subject, scene)).value;
}

NamedFinding damping_exponent(const Damping& damping, Table limits, double exponent) {
  const Convergence rates = convergence_of(limits, "2/rate of damping");
  limits.add({"exponent", "1", row_orders(rates)});
  return {
      "stability-sheet.damping-limit-exponent." + damping.name,
      "With " + damping.words +
          ", where damping decides, the largest stable step of a fully explicit method is "
          "proportional to the cells' width to the power " +
          (exponent == 2 ? "two." : "three."),
      {order_verdict(
           rates, exponent, 1, 0.1,
           "another whole exponent is off by 1; the border's effect on the fastest mode vanishes "
           "as the number of cells grows"),
       std::move(limits),
       "measured is |exponent - expected| of the last pair; 2/rate is forward Euler's and "
       "RK2's limit, where damping decides"}};
}

}  // namespace

std::vector<Damping> dampings() {
  return {{"springs", "damped springs", 0.3, 0},
          {"bending", "damped bending", 0, 0.01},
          {"both", "springs and bending both damped", 0.3, 0.01}};
}

void add_refinement(const Subject& subject, Tier tier, StudyResult& result) {
  std::vector<int> meshes = {4, 8, 16, 32};
  if (tier == Tier::full) meshes.push_back(64);
  Figure figure{"over-width",
                "What limits a step as the cells become small",
                {"width of a cell", "m", Scale::log},
                {"largest stable step", "s", Scale::log},
                "2/omega limits schemes A and B, and C where nothing is damped; 2/rate of damping "
                "limits forward Euler and explicit midpoint."};
  Curve elastic{"2/omega, springs", {}, {}, nan, {}, 1};
  for (const int cells : meshes)
    elastic.point(flat_side / cells,
                  2 / fastest_mode(subject, damped_sheet(cells, dampings()[0])).omega);
  figure.curves.push_back(std::move(elastic));
  for (const auto& [damping, exponent] :
       {std::pair(dampings()[0], 2.0), std::pair(dampings()[1], 3.0)}) {
    const Table limits =
        refine({{"width of a cell", "m"}, {"2/rate of damping", "s"}}, meshes, [&](int cells) {
          return std::tuple{flat_side / cells,
                            2 / largest_damping_rate(subject, damped_sheet(cells, damping))};
        });
    result.findings.push_back(damping_exponent(damping, limits, exponent));
    Curve curve = curve_of("2/rate, " + damping.words, convergence_of(limits, "2/rate of damping"));
    curve.slope = exponent;
    figure.curves.push_back(std::move(curve));
  }
  result.figures.push_back(std::move(figure));
}

namespace {

// ---- the paper's example: cells of a tenth

/// A sheet of side 1 whose modulus, damping and density are 1: steps over one unit of time.
Scene unit_sheet(int cells) {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::union_jack, 1, 1, cells, cells}), 1);
  scene.stretch = StretchMaterial{1, 1, 1};
  return scene;
}

/// Steps a unit of time takes, by method: mixed and three explicit ones.
Table step_counts(const Subject& subject, const std::vector<int>& meshes) {
  const auto count = [&](int cells) {
    const Scene scene = unit_sheet(cells);
    const double omega = fastest_mode(subject, scene).omega;
    const auto rates =
        oracles::oscillator_rates(omega, largest_damping_rate(subject, scene) / (2 * omega));
    const auto steps = [&](int order) {
      return 1 / oracles::largest_runge_kutta_step(order, rates).value;
    };
    return std::tuple{1. / cells, omega / 2, steps(1), steps(2), steps(4)};
  };
  return refine({{"width of a cell", "1"},
                 {"schemes A and B", "1"},
                 {"forward Euler", "1"},
                 {"explicit midpoint", "1"},
                 {"classical Runge-Kutta 4", "1"}},
                meshes, count);
}

/// Steps on the mesh with ten cells a side, the second one.
double at_tenth(const Table& counts, std::string_view method) { return counts.numbers(method)[1]; }

NamedFinding an_order_of_magnitude(const Table& counts) {
  const double factor =
      at_tenth(counts, "classical Runge-Kutta 4") / at_tenth(counts, "schemes A and B");
  return {"stability-sheet.tenth-width.explicit-needs-ten-times-the-steps",
          "At a width of a tenth a fully explicit method needs at least ten times the steps of a "
          "mixed one.",
          {{10 / factor, 1, 0, "1", "the paper's example: 10 steps against 100"},
           counts,
           "measured is ten over the factor between classical Runge-Kutta, which steps furthest, "
           "and A"}};
}

NamedFinding factor_exponent(const Table& counts) {
  const std::vector<double>&widths = counts.numbers("width of a cell"),
        &mixed = counts.numbers("schemes A and B"),
        &classical = counts.numbers("classical Runge-Kutta 4");
  Table factors{{"width of a cell", "1"}, {"steps of RK4 over those of A", "1"}};
  for (size_t i = 0; i < widths.size(); ++i) factors.row(widths[i], classical[i] / mixed[i]);
  return {"stability-sheet.tenth-width.step-ratio-exponent",
          "The factor between the steps of explicit and mixed methods grows as one over the width "
          "of a cell.",
          {order_verdict(convergence_of(factors, "steps of RK4 over those of A"), -1, 1, 0.1,
                         "an exponent of 0, if the factor stayed, or of 2 is off by 1"),
           factors, "measured is |exponent + 1| of the last pair"}};
}

/// At a tenth the steps are also found by trying: runs of the whole sheet, and for A, which leaves
/// its limit too slowly for runs when damping is heavy, the matrix of the fastest mode.
NamedFinding by_trying(const Subject& subject, const Integrator& integrator, double expected) {
  Scene scene = unit_sheet(10);
  const FastestMode mode = fastest_mode(subject, scene);
  double steps = nan;
  if (integrator.family == Family::mixed) {
    const double h = 1 / expected;
    steps = 1 / largest_constant_step(
                    stepped_motion(subject, motion_along(scene, mode.shape, mode.omega),
                                   integrator.name),
                    {0.5 * h, 4 * h, 1e-6, 14});
  } else {
    scene.integrator = std::string(integrator.name);
    const double fraction = mode.omega / (2 * expected);
    steps =
        mode.omega / 2 /
        largest_stable_step(subject, scene, mode.omega, {0.9 * fraction, 1.1 * fraction, 7, 2400});
  }
  return {"stability-sheet.tenth-width.stepping-confirms." + std::string(integrator.name),
          "Stepping confirms the steps that " + std::string(integrator.title) +
              " needs at a width of a tenth.",
          {{std::abs(steps / expected - 1), 0.01, 0, "1",
            "from a third of a percent beyond the limit on, a disturbance grows a thousandfold in "
            "2400 steps; the bisection ends at a sixth of a percent"},
           Table{{"steps in a unit of time", "1"}, {"as known", "1"}}.with_row(steps, expected)}};
}

}  // namespace

void add_tenth(const Subject& subject, Tier tier, StudyResult& result) {
  std::vector<int> meshes = {5, 10, 20};
  if (tier == Tier::full) meshes.insert(meshes.end(), {40, 80});
  const Table counts = step_counts(subject, meshes);
  result.add({an_order_of_magnitude(counts), factor_exponent(counts)});
  for (const auto& [name, column] :
       {std::pair("A", "schemes A and B"), std::pair("forward-euler", "forward Euler"),
        std::pair("RK2", "explicit midpoint"), std::pair("RK4", "classical Runge-Kutta 4")})
    result.findings.push_back(by_trying(subject, integrator_named(name), at_tenth(counts, column)));
  result.tables.push_back(
      {"steps",
       "Steps in one unit of time of a sheet whose side, modulus, damping and density are 1",
       counts});
}

}  // namespace foldproof
