// bending-scaling: is the bending damping a property of the material? Dissipation at a given rate
// of curvature under refinement.

#include "convergence/study.h"
#include "reference/mesh/shapes.h"
#include "verification/subject.h"

namespace foldproof {

namespace {

constexpr double width = 0.37;      // m
constexpr double curvature = 2.3;   // 1/m
constexpr double rate = 0.9;        // of the curvature [1/(m s)]
constexpr double damping = 0.0019;  // kd [N s] or [J s]

/// One factor of the damping force.
struct Factor {
  std::string finding, words;
  DampingFactor factor;
  double expected;  // order of the dissipation in the width of a cell
};

std::vector<Factor> factors() {
  return {{"edge-factor-vanishes-with-cell-width", "|E|", DampingFactor::edge, 1},
          {"edge-squared-over-area-factor-tends-to-a-constant", "|E|^2/(|N1| + |N2|)",
           DampingFactor::edge_squared_over_area, 0}};
}

/// A square sheet rolled on a cylinder whose curvature k grows: x = (sin(k s)/k, y, (1 - cos(k
/// s))/k) with s measured from the middle, and dx/dt at the given dk/dt.
Scene rolling_sheet(int cells, DampingFactor factor) {
  Scene scene =
      scene_at_rest(make_sheet({SheetPattern::one_diagonal, width, width, cells, cells}), 0.13);
  scene.bending = BendingMaterial{0, damping, Weighting::rest, factor};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  const double k = curvature;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double s = scene.mesh.rest(0, i) - width / 2, sine = std::sin(k * s),
                 cosine = std::cos(k * s);
    scene.x.col(i) = Vector3(sine / k, scene.mesh.rest(1, i), (1 - cosine) / k);
    scene.v.col(i) =
        rate * Vector3((s * cosine - sine / k) / k, 0, (s * sine - (1 - cosine) / k) / k);
  }
  return scene;
}

/// Power that the damping takes, -v.D v, per area of the sheet and squared rate of curvature
/// [J s or N m s].
double dissipation(const Subject& subject, int cells, DampingFactor factor) {
  const Scene scene = rolling_sheet(cells, factor);
  const auto prepared = require_offered(subject.prepare, "prepare")(scene);
  const State s{0, scene.x, scene.v};
  const PerParticle3 force =
      require_offered(subject.damping_forces, "damping_forces")(*prepared, s, s.v);
  return -force.cwiseProduct(s.v).sum() / (width * width * rate * rate);
}

/// The dissipation of ever finer sheets.
Table refined(const Subject& subject, const Factor& factor, int finest) {
  return refine({{"width of a cell", "m"}, {"dissipation per area and squared rate", "N m s"}},
                doubling_range(6, finest), [&](int cells) {
                  return std::tuple{width / cells, dissipation(subject, cells, factor.factor)};
                });
}

NamedFinding finding_of(const Factor& factor, Table measured, const Convergence& errors) {
  measured.add({"order of the pair", "1", row_orders(errors)});
  const Verdict verdict = order_verdict(
      errors, factor.expected, 1, 0.05,
      "the border has no hinges, so about one cell of the sheet's width is missing: on the finest "
      "meshes that share, and the order's error with it, is below a twentieth");
  Finding finding{verdict, std::move(measured), "measured is |order - expected| of the last pair"};
  const std::string claim = factor.expected == 1
                                ? "With the factor |E| as printed, the dissipation at a given rate "
                                  "of curvature falls in proportion to the cells' width."
                                : "With the factor |E|^2/(|N1| + |N2|), the dissipation at a given "
                                  "rate of curvature tends to a constant.";
  return {"bending-scaling." + factor.finding, claim, std::move(finding)};
}

StudyResult run_bending_scaling(const Subject& subject, Tier tier, const Progress& progress) {
  const int finest = tier == Tier::quick ? 96 : 192;
  StudyResult result;
  Figure figure{"dissipation",
                "Dissipation of the bending damping at a given rate of curvature",
                {"width of a cell", "m", Scale::log},
                {"dissipation per area and squared rate", "N m s", Scale::log},
                1,
                "A material property would be level. The slope is that of the factor as printed."};
  double done = 0;
  for (const Factor& factor : factors()) {
    const Table measured = refined(subject, factor, finest);
    const Convergence errors = convergence_of(measured, "dissipation per area and squared rate");
    progress(++done / double(factors().size()));
    result.findings.push_back(finding_of(factor, measured, errors));
    figure.curves.push_back(curve_of("factor " + factor.words, errors));
  }
  result.figures.push_back(std::move(figure));
  return result;
}

}  // namespace

Study bending_scaling_study() {
  return {
      "bending-scaling",
      "The printed factor |E| does not make the bending damping a property of the material; "
      "|E|^2/(|N1| + |N2|) does.",
      {"edge-factor-vanishes-with-cell-width", "edge-squared-over-area-factor-tends-to-a-constant"},
      "BMF03 section 4",
      "A square sheet is rolled on a cylinder whose curvature grows at a given rate, so that "
      "every mesh deforms alike. The power that the bending damping dissipates is compared "
      "between meshes, for both factors.",
      run_bending_scaling};
}

}  // namespace foldproof
