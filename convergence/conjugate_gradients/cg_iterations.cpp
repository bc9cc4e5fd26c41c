// cg-iterations: what the implicit velocity costs, in iterations of conjugate gradients a solve.

#include "convergence/study.h"
#include "reference/forces/bending.h"
#include "reference/mesh/shapes.h"
#include "verification/subject.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

/// Parameters that determine the cost of a solve.
struct Setting {
  double tolerance;  // 1
  double ratio;      // damping ratio of the fastest mode [1]
  double step;       // h over the elastic limit [1]
  int cells;         // along each side
  ResidualScale scale;
};

/// Cost of the solves of some steps with A and with B, which have one solve a step each: A at its
/// end, B at its start. C has both.
struct Cost {
  double mean = 0;     // iterations a solve
  double largest = 0;  // iterations of one solve
  double unfinished = 0;
};

constexpr int steps = 4;
constexpr double side = 0.9;        // m
constexpr double stiffness = 41;    // Y [N/m]
constexpr double bending = 2.3e-4;  // ke [J]

/// Waves and noise: every mode of the mesh takes part, so that no solve is easy by its start.
void set_motion(Scene& scene) {
  Random random(914);
  const auto noise = [&random] { return random.uniform(-0.5, 0.5); };
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double a = scene.mesh.rest(0, i) / side, b = scene.mesh.rest(1, i) / side;
    scene.x(2, i) += 0.06 * std::sin(5.3 * a + 1.7 * b);
    scene.v.col(i) = Vector3(0.3 * std::cos(2.9 * b) + 0.2 * noise(), 0.2 * noise(),
                             std::cos(4.7 * a - 2.2 * b) + 0.2 * noise());
  }
}

Scene elastic_sheet(int cells) {
  Scene scene =
      scene_at_rest(make_sheet({SheetPattern::alternating, side, side, cells, cells}), 0.15);
  scene.gravity = Vector3(0, -9.81, 0);
  scene.stretch = StretchMaterial{stiffness, 0, 1};
  add_flat_hinges(scene, bending, 0);
  set_motion(scene);
  for (int particle = cells * (cells + 1); particle < int(scene.x.cols()); ++particle)
    scene.prescribed.push_back({particle, scene.x.col(particle), {}});
  return scene;
}

/// Mean over the hinges of c/|E| at rest [1/m]: kd |E| is to ke c as kd is to ke times this.
double weight_over_edge(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Hinge& hinge : mesh.hinges) {
    const auto [i1, i2, i3, i4] = hinge.particles;
    const HingeShape shape =
        hinge_shape(mesh.rest.col(i1), mesh.rest.col(i2), mesh.rest.col(i3), mesh.rest.col(i4));
    sum += shape.edge / shape.area_sum;
  }
  return sum / double(mesh.hinges.size());
}

/// The sheet with the damping that has the ratio, and its elastic limit [s].
///   zeta = (damping/stiffness) omega/2, which is kd_s/Y for springs and kd |E|/(ke c/2) for
///   hinges; omega is the bound on the fastest mode, 2 over the elastic limit
std::pair<Scene, double> damped_sheet(const Setting& setting) {
  Scene scene = elastic_sheet(setting.cells);
  const double limit = elastic_limit(build_system(scene), start_state(scene));
  const double omega = 2 / limit;
  scene.stretch->damping = stiffness * 2 * setting.ratio / omega;
  scene.bending->damping = bending / 2 * weight_over_edge(scene.mesh) * 2 * setting.ratio / omega;
  scene.solver = {setting.tolerance, 100'000, setting.scale};
  return {std::move(scene), limit};
}

/// Runs some steps of a hanging sheet that moves with waves and noise.
Cost cost_of(const Subject& subject, const Setting& setting) {
  auto [scene, limit] = damped_sheet(setting);
  Worst largest;
  Work all;
  for (const char* scheme : {"A", "B"}) {
    scene.integrator = scheme;
    const auto prepared = require_offered(subject.prepare, "prepare")(scene);
    State s = start_state(scene);
    for (int i = 0; i < steps; ++i) {
      Work one;
      s = require_offered(subject.step, "step")(*prepared, {&s, 1}, setting.step * limit, one);
      largest.observe(double(one.cg_iterations) / double(one.solves));
      all.cg_iterations += one.cg_iterations;
      all.solves += one.solves;
      all.unfinished_solves += one.unfinished_solves;
    }
  }
  return {double(all.cg_iterations) / double(all.solves), largest.value(),
          double(all.unfinished_solves)};
}

/// The most iterations of a solve whose residual is compared with the initial one. D is at most 2
/// zeta/omega times the elastic stiffness, so that the condition of I - h/2 M^{-1} D is at most
/// kappa = 1 + 2 zeta h/h_limit; then Chebyshev's bound on the energy norm, times the sqrt(kappa)
/// that it costs to speak of residuals:
///   2 sqrt(kappa) ((sqrt(kappa) - 1)/(sqrt(kappa) + 1))^n <= tolerance
double iterations_allowed(const Setting& setting) {
  const double root = std::sqrt(1 + 2 * setting.ratio * setting.step);
  return std::ceil(std::log(2 * root / setting.tolerance) / std::log((root + 1) / (root - 1)));
}

/// Number of particles of the sheet.
double particles_of(const Setting& setting) {
  return double(setting.cells + 1) * (setting.cells + 1);
}

constexpr Setting typical = {1e-4, 0.1, 0.5, 24, ResidualScale::momentum};

/// One thing is varied, the others stay as they are.
struct Sweep {
  std::string name, title, label, unit;
  std::vector<double> values;
  std::vector<Setting> settings;
  std::vector<Cost> costs;
};

Sweep vary(Sweep sweep, Setting from, const std::function<void(Setting&, double)>& set) {
  for (double value : sweep.values) {
    set(from, value);
    sweep.settings.push_back(from);
  }
  return sweep;
}

std::vector<Sweep> sweeps(Tier tier, ResidualScale scale) {
  Setting from = typical;
  from.scale = scale;
  std::vector<double> sizes = {12, 24, 48, 99};
  if (tier == Tier::full) sizes.push_back(315);
  std::vector<Sweep> all = {vary({"tolerance",
                                  "Iterations against tolerance",
                                  "tolerance",
                                  "1",
                                  {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12},
                                  {},
                                  {}},
                                 from, [](Setting& s, double value) { s.tolerance = value; }),
                            vary({"damping",
                                  "Iterations against damping ratio",
                                  "damping ratio",
                                  "1",
                                  {0.01, 0.1, 1, 10, 100},
                                  {},
                                  {}},
                                 from, [](Setting& s, double value) { s.ratio = value; }),
                            vary({"step",
                                  "Iterations against step",
                                  "step over elastic limit",
                                  "1",
                                  {0.1, 0.2, 0.4, 0.7, 1},
                                  {},
                                  {}},
                                 from, [](Setting& s, double value) { s.step = value; })};
  // with this and a small tolerance iterations are many enough that growth would show
  from.ratio = 3;
  from.tolerance = 1e-8;
  Sweep size{"mesh", "Iterations against mesh size", "particles", "1", {}, {}, {}};
  for (double value : sizes) {
    from.cells = int(value);
    size.settings.push_back(from);
    size.values.push_back(particles_of(from));
  }
  all.push_back(std::move(size));
  return all;
}

std::string words_of(ResidualScale scale) {
  return scale == ResidualScale::momentum ? "momentum" : "initial residual";
}

Table costs_table(const std::vector<Sweep>& measured) {
  Table table(
      "varied [1]; residual compared with [1]; tolerance [1]; damping ratio [1]; step over limit "
      "[1]; particles [1]; mean iterations [1]; largest [1]; unfinished solves [1]; allowed by "
      "Chebyshev [1]");
  for (const Sweep& sweep : measured)
    for (size_t i = 0; i < sweep.costs.size(); ++i) {
      const Setting& s = sweep.settings[i];
      const Cost& cost = sweep.costs[i];
      table.row(sweep.name, words_of(s.scale), s.tolerance, s.ratio, s.step, particles_of(s),
                cost.mean, cost.largest, cost.unfinished, iterations_allowed(s));
    }
  return table;
}

NamedFinding fewer_than_ten(const std::vector<Sweep>& measured) {
  // every tolerance at the typical damping and step: those that keep the order and error, too
  Table typical_costs(
      "residual compared with [1]; tolerance [1]; mean iterations [1]; largest [1]");
  for (const Sweep& sweep : measured) {
    for (size_t i = 0; i < sweep.costs.size(); ++i) {
      if (sweep.name != "tolerance") continue;
      typical_costs.row(words_of(sweep.settings[i].scale), sweep.values[i], sweep.costs[i].mean,
                        sweep.costs[i].largest);
    }
  }
  const Verdict verdict{typical_costs.worst("largest"), 9, 0, "iterations",
                        "fewer than ten, in the paper's words"};
  return {"cg-iterations.fewer-than-ten-in-the-typical-setting",
          "At damping ratio 0.1 and a step of half the elastic limit, no solve needs ten "
          "iterations, at any tolerance from 1e-2 to 1e-12.",
          {verdict, typical_costs,
           "the sheet's velocities hold noise of every wavelength; smooth motion needs fewer"}};
}

NamedFinding within_chebyshev(const std::vector<Sweep>& measured) {
  Worst worst;
  for (const Sweep& sweep : measured)
    for (size_t i = 0; i < sweep.costs.size(); ++i)
      if (sweep.settings[i].scale == ResidualScale::initial_residual)
        worst.observe(sweep.costs[i].largest / iterations_allowed(sweep.settings[i]));
  const Verdict verdict{worst.value(), 1, 0, "1",
                        "conjugate gradients cannot do worse than Chebyshev's polynomials"};
  return {"cg-iterations.stay-within-the-theoretical-bound",
          "No solve needs more iterations than the condition number 1 + 2 zeta h/h_limit of its "
          "matrix allows, over all settings.",
          {verdict, costs_table(measured),
           "measured is the largest ratio, with residuals compared with the initial one"}};
}

/// "Fewer than ten" is a matter of the setting.
NamedFinding ten_or_more_elsewhere(const std::vector<Sweep>& measured) {
  double most = 0;
  Table costs{{"mean iterations", "1"}, {"largest", "1"}};
  for (const Sweep& sweep : measured)
    for (const Cost& cost : sweep.costs) {
      costs.row(cost.mean, cost.largest);
      most = std::max(most, cost.mean);
    }
  const Verdict verdict{costs.rows() == 0 ? nan : 10 / most, 1, 0, "1",
                        "ten, in the paper's words"};
  return {"cg-iterations.ten-or-more-in-harder-settings",
          "In the hardest of the settings tried a solve takes ten iterations or more, on average.",
          {verdict, costs, "measured is ten over the largest mean of all settings"}};
}

NamedFinding no_growth_with_the_mesh(const std::vector<Sweep>& measured) {
  constexpr double largest_exponent = 0;
  double steepest = -std::numeric_limits<double>::infinity();
  Table meshes("residual compared with [1]; particles [1]; mean iterations [1]");
  for (const Sweep& sweep : measured) {
    if (sweep.name != "mesh") continue;
    Table growth{{"width of a cell", "1"}, {"mean iterations", "1"}};  // over what falls
    for (size_t i = 0; i < sweep.costs.size(); ++i) {
      growth.row(1 / std::sqrt(sweep.values[i]), sweep.costs[i].mean);
      meshes.row(words_of(sweep.settings[i].scale), sweep.values[i], sweep.costs[i].mean);
    }
    for (const double order : pair_orders(convergence_of(growth, "mean iterations")))
      if (!std::isnan(steepest) && !(0 - order <= steepest)) steepest = 0 - order;
  }
  const Verdict verdict{meshes.rows() == 0 ? nan : steepest, largest_exponent, 0, "1",
                        "no growth: the condition number is the same on every mesh; a count that "
                        "grew like its root, as on a fixed material, would have exponent 1/2"};
  return {"cg-iterations.do-not-grow-with-the-mesh",
          "At a fixed damping ratio and a fixed fraction of the elastic limit, no finer mesh takes "
          "more iterations.",
          {verdict, meshes,
           "measured is the largest exponent of the mean iterations in the number of cells along a "
           "side, between neighbouring meshes; negative: they fall"}};
}

/// One figure for each varied thing, with a pair of curves for each scale of the residual.
std::vector<Figure> figures_of(const std::vector<Sweep>& measured) {
  std::vector<Figure> figures;
  for (const Sweep& sweep : measured) {
    auto figure = std::find_if(figures.begin(), figures.end(),
                               [&](const Figure& f) { return f.name == sweep.name; });
    if (figure == figures.end()) {
      figures.push_back({sweep.name,
                         sweep.title,
                         {sweep.label, sweep.unit, Scale::log},
                         {"iterations a solve", "1"},
                         "Each curve names what its residual is compared with. Everything else is "
                         "as in the table."});
      figure = figures.end() - 1;
    }
    Curve mean{words_of(sweep.settings.front().scale) + ", mean", sweep.values, {}, nan, {}};
    Curve largest{words_of(sweep.settings.front().scale) + ", largest", sweep.values, {}, nan, {}};
    for (const Cost& cost : sweep.costs) {
      mean.y.push_back(cost.mean);
      largest.y.push_back(cost.largest);
    }
    figure->curves.push_back(std::move(mean));
    figure->curves.push_back(std::move(largest));
  }
  return figures;
}

StudyResult run_cg_iterations(const Subject& subject, Tier tier, const Progress& progress) {
  std::vector<Sweep> measured;
  for (ResidualScale scale : {ResidualScale::momentum, ResidualScale::initial_residual})
    for (Sweep& sweep : sweeps(tier, scale)) measured.push_back(std::move(sweep));
  double total = 0, done = 0;
  for (const Sweep& sweep : measured)
    for (const Setting& setting : sweep.settings) total += particles_of(setting);
  for (Sweep& sweep : measured) {
    for (const Setting& setting : sweep.settings) {
      sweep.costs.push_back(cost_of(subject, setting));
      progress((done += particles_of(setting)) / total);
    }
  }

  StudyResult result;
  result.findings = {fewer_than_ten(measured), within_chebyshev(measured),
                     ten_or_more_elsewhere(measured), no_growth_with_the_mesh(measured)};
  result.figures = figures_of(measured);
  result.tables.push_back(
      {"iterations", "Iterations of conjugate gradients a solve", costs_table(measured)});
  return result;
}

}  // namespace

Study cg_iterations_study() {
  return {
      "cg-iterations",
      "At a damping ratio of a tenth and half the elastic limit a solve for the implicit velocity "
      "takes fewer than ten iterations of conjugate gradients, at every tolerance tried; at a "
      "fixed damping ratio a finer mesh needs no more.",
      {"fewer-than-ten-in-the-typical-setting", "do-not-grow-with-the-mesh"},
      "BMF03 section 3",
      "A hanging sheet moves with waves and noise. Solves are counted under schemes A and B, which "
      "solve once a step; C solves twice. Tolerance, damping, step and mesh size are varied one at "
      "a time. The damping ratio is zeta = (damping/stiffness) omega/2, for springs kd_s/Y and for "
      "hinges kd |E|/(ke c/2), with omega from the elastic limit of the step.",
      run_cg_iterations};
}

}  // namespace foldproof
