#include "convergence/stability/stability_sheet.h"

#include <cmath>

#include "convergence/stability/stable_step.h"
#include "convergence/stability/step_matrix.h"
#include "reference/dynamics/integrator.h"
#include "verification/oracles/stability.h"

namespace foldproof {

namespace {

constexpr double bending = 0.0071;  // ke [J]
// cells a side, of the mesh on which a material's damping ratio is counted
constexpr int coarsest = 4;

/// Stiffness and damping of the sheet's springs. The hinges are unchanged, so that on soft springs
/// and narrow cells they decide the fastest mode.
struct Springs {
  std::string name, words;
  double stiffness;  // Y [N/m]
};

std::vector<Springs> kinds_of_springs() {
  return {{"soft", "Y = 29 N/m", 29}, {"stiff", "Y = 2900 N/m", 2900}};
}

/// Springs and hinges with one relaxation time (damping over stiffness) [s]: every mode is an
/// oscillator of its own, whose damping ratio is relaxation omega/2.
Scene relaxing_sheet(const Springs& springs, int cells, double relaxation) {
  Scene scene = flat_sheet(cells);
  scene.stretch = StretchMaterial{springs.stiffness, relaxation * springs.stiffness, 1};
  // K = (ke/2) c u u^T and -D = kd c u u^T at a flat hinge
  scene.bending = BendingMaterial{bending, relaxation * bending / 2, Weighting::rest,
                                  DampingFactor::edge_squared_over_area};
  scene.solver.tolerance = 1e-12;
  return scene;
}

/// One mesh and its fastest mode, which is the same at any damping.
struct MeshMode {
  int cells;
  FastestMode mode;
};

/// Everything but the method.
struct MappedSheet {
  Springs springs;
  std::vector<MeshMode> modes;    // the coarsest mesh first
  std::vector<double> materials;  // damping ratio of the fastest mode on the coarsest mesh [1]

  double faster(const MeshMode& one) const { return one.mode.omega / modes.front().mode.omega; }
};

MappedSheet mapped_sheet(const Subject& subject, const Springs& springs, Tier tier) {
  const bool quick = tier == Tier::quick;
  MappedSheet sheet{springs, {}, geometric_range(0.03, 30, quick ? 5 : 10)};
  for (const int cells :
       quick ? std::vector{coarsest, 8, 16} : std::vector{coarsest, 6, 8, 12, 16, 24, 32})
    sheet.modes.push_back({cells, fastest_mode(subject, relaxing_sheet(springs, cells, 0))});
  return sheet;
}

/// Largest stable step of an oscillator over 2/omega, at its damping ratio [1].
double known_ratio(const Integrator& method, double zeta) {
  if (method.name == "C") return zeta + std::sqrt(1 + zeta * zeta);
  if (method.family == Family::mixed) return 1;
  constexpr double omega = 2;
  return oracles::largest_runge_kutta_step(method.order, oracles::oscillator_rates(omega, zeta))
      .value;
}

/// The same of the sheet's fastest mode, by stepping the whole sheet along it.
double tried_ratio(const Subject& subject, const Integrator& method, Scene scene,
                   const FastestMode& mode, double expected) {
  constexpr double growth = 1e-6;
  const double h = expected * 2 / mode.omega;
  return largest_constant_step(
             stepped_motion(subject, motion_along(std::move(scene), mode.shape, mode.omega),
                            method.name),
             {h / 2, 4 * h, growth, 9}) *
         mode.omega / 2;
}

/// One row a point of the map.
Table points_of(const Subject& subject, const Integrator& method, const MappedSheet& sheet) {
  Table points(
      "damping ratio on the coarsest mesh [1]; width of a cell [m]; damping ratio of the fastest "
      "mode [1]; largest stable step over 2/omega [1]; as derived [1]");
  for (const MeshMode& one : sheet.modes)
    for (const double material : sheet.materials) {
      const double relaxation = 2 * material / sheet.modes.front().mode.omega,
                   zeta = material * sheet.faster(one), known = known_ratio(method, zeta);
      points.row(material, flat_side / one.cells, zeta,
                 tried_ratio(subject, method, relaxing_sheet(sheet.springs, one.cells, relaxation),
                             one.mode, known),
                 known);
    }
  return points;
}

/// The damping ratio at which the known ratio takes a value, on a mode `faster` times as fast as
/// that on which the ratio counts; NaN if it takes it nowhere between the ends of the map.
double ratio_at_level(const Integrator& method, double level, double faster,
                      std::pair<double, double> ends) {
  auto [low, high] = ends;
  const auto above = [&](double zeta) { return known_ratio(method, zeta * faster) - level; };
  if (!(above(low) * above(high) < 0)) return nan;
  const bool rises = above(high) > 0;
  for (int i = 0; i < 50; ++i) {
    const double middle = std::sqrt(low * high);
    ((above(middle) > 0) == rises ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

/// Where the known limit is a tenth, a hundredth, ten times or a hundred times the elastic one, as
/// far as that is inside the map.
std::vector<Curve> level_curves(const Integrator& method, const MappedSheet& sheet) {
  std::vector<Curve> curves;
  if (method.name == "A" || method.name == "B") return curves;
  for (const auto& [level, words] : {std::pair(0.01, "1/100"), std::pair(0.1, "1/10"),
                                     std::pair(10., "10"), std::pair(100., "100")}) {
    Curve curve{std::string("derived: ") + words};
    for (const MeshMode& one : sheet.modes) {
      const double zeta = ratio_at_level(method, level, sheet.faster(one),
                                         {sheet.materials.front(), sheet.materials.back()});
      if (std::isnan(zeta)) continue;
      curve.point(zeta, one.cells);
    }
    if (curve.x.size() > 1) curves.push_back(std::move(curve));
  }
  return curves;
}

std::string caption_of(const Integrator& method) {
  if (method.name == "A" || method.name == "B") return "Derived: the elastic limit everywhere.";
  if (method.name == "C")
    return "Derived: zeta + sqrt(1 + zeta^2) of the fastest mode, whose zeta refinement raises.";
  return "Derived: where damping decides, the step falls as 1/zeta of the fastest mode. Refinement "
         "raises zeta as one over the cells' width where springs decide that mode, and as one over "
         "its square where hinges do.";
}

Map map_of(const Integrator& method, const MappedSheet& sheet, const Table& points) {
  Map map{"map-" + sheet.springs.name + "-" + std::string(method.name),
          "Largest stable step of " + std::string(method.title) + ", " + sheet.springs.words,
          {"damping ratio of the fastest mode on cells of a quarter of the side", "1", Scale::log},
          {"cells a side", "1", Scale::log},
          sheet.materials,
          {},
          points.numbers("largest stable step over 2/omega"),
          "largest stable step over elastic limit",
          "1",
          Scale::log,
          "A column is one material, a row one mesh. The elastic limit is 2/omega of the mesh's "
          "fastest mode. " +
              caption_of(method),
          level_curves(method, sheet)};
  for (const MeshMode& one : sheet.modes) map.y_values.push_back(one.cells);
  return map;
}

NamedFinding as_derived(const Integrator& method, const Springs& springs, const Table& points) {
  const double worst =
      points.rows() == 0
          ? nan
          : largest_deviation(points, "largest stable step over 2/omega", "as derived");
  return {"stability-sheet.map-follows-the-fastest-mode." + springs.name + "." +
              std::string(method.name),
          "Over damping and resolution, with " + springs.words + ", the largest stable step of " +
              std::string(method.title) +
              " is that of an oscillator with the fastest mode's frequency and damping.",
          {{worst, 0.01, 0, "1",
            "the bisection ends at a relative width of 3e-4; beyond the limit of A and B, where "
            "the radius grows most slowly, it exceeds 1 by a few thousandths of the step's "
            "relative excess, and 1e-6 counts as growth; a limit with another scaling would be off "
            "by a large factor"},
           points,
           "measured is the largest relative deviation over the map"}};
}

}  // namespace

void add_stability_maps(const Subject& subject, Tier tier, StudyResult& result) {
  for (const Springs& springs : kinds_of_springs()) {
    const MappedSheet sheet = mapped_sheet(subject, springs, tier);
    for (const char* name : {"A", "B", "C", "RK4"}) {
      const Integrator& method = integrator_named(name);
      const Table points = points_of(subject, method, sheet);
      result.maps.push_back(map_of(method, sheet, points));
      result.findings.push_back(as_derived(method, sheet.springs, points));
    }
  }
}

}  // namespace foldproof
