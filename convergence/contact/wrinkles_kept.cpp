// wrinkle-preservation: how much of the wrinkles inside an object survives the projection?

#include "convergence/study.h"
#include "convergence/contact/wrinkle_measure.h"
#include "reference/mesh/shapes.h"
#include "reference/post/fold_projection.h"

namespace foldproof {

namespace {

constexpr double width = 0.4, height = 0.06;            // of the sheet [m]
constexpr int columns = 240, rows = 6;                  // of its cells
constexpr double wavelength = 0.04, amplitude = 0.006;  // of the wrinkles [m]
constexpr double sunk = 0.004;                          // mean depth [m]
constexpr double deepest = 0.014;  // t^: a little more than sunk + amplitude + the long wave [m]
constexpr double ball_radius = 0.31, tube_radius = 0.09, ring_radius = 0.4;  // m

/// Height of the wrinkled sheet over the surface at the arc length s [m]: wrinkles on a long wave.
double height_at(double s) {
  return amplitude * std::sin(2 * pi * s / wavelength + 0.7) +
         0.002 * std::sin(2 * pi * s / 0.2 + 0.3) - sunk;
}

/// A body with a wrinkled sheet half inside it: particle by particle at height_at over the surface.
struct SunkCloth {
  std::string name;
  Solid solid;
  PerParticle3 x;  // m
};

/// s along the wrinkles' direction, from the sheet's middle, w across [m].
Vector3 placed_over(const std::string& name, double s, double w) {
  const double h = height_at(s);
  if (name == "half space") return {s, w, h};
  if (name == "ball") {
    const double a = s / ball_radius, b = w / ball_radius, r = ball_radius + h;
    return r * Vector3(std::sin(a) * std::cos(b), std::sin(b), std::cos(a) * std::cos(b));
  }
  const double a = w / tube_radius, b = s / ring_radius,
               r = tube_radius + h;  // on top of the torus, along its ring
  return {(ring_radius + r * std::sin(a)) * std::cos(b),
          (ring_radius + r * std::sin(a)) * std::sin(b), r * std::cos(a)};
}

std::vector<SunkCloth> sunk_sheets(const TriangleMesh& sheet) {
  std::vector<SunkCloth> all = {{"half space", HalfSpace{}, {}},
                                {"ball", Sphere{ball_radius}, {}},
                                {"torus", Torus{ring_radius, tube_radius}, {}}};
  for (SunkCloth& one : all) {
    one.x.resize(3, sheet.particles());
    for (int i = 0; i < sheet.particles(); ++i)
      one.x.col(i) =
          placed_over(one.name, sheet.rest(0, i) - width / 2, sheet.rest(1, i) - height / 2);
  }
  return all;
}

ProjectedCloth project(const SunkCloth& cloth, const std::string& map, double reach) {
  const std::vector<Object> objects = {{cloth.name, RigidObject{cloth.solid, {}, Motion{}}, 0}};
  return project_folds(objects, cloth.x, 0,
                       {map, {0, reach, deepest}, PinchedPoints::left_alone, 1e-12, 50});
}

/// The row of particles through the middle, in the order of s.
std::vector<double> middle_row(const PerParticle& phi) {
  const Eigen::Index first = (rows / 2) * (columns + 1);
  return {phi.data() + first, phi.data() + first + columns + 1};
}

const std::string deviation_column = "deviation of depths that were inside",
                  share_column = "share of it that is left",
                  wavelength_column = "dominant wavelength";

/// Share of the wrinkles left, of points that began inside, over tau.
Table measure_kept(const SunkCloth& cloth, const std::string& map,
                   const std::vector<double>& reaches) {
  Table kept{{"tau", "m"}, {deviation_column, "m"}, {share_column, "1"}, {wavelength_column, "m"}};
  for (const double reach : reaches) {
    const ProjectedCloth after = project(cloth, map, reach);
    const auto is_inside = [&](Eigen::Index i) { return after.before[i] < 0; };
    const double was = deviation_where(after.before, is_inside),
                 is = deviation_where(after.after, is_inside);
    kept.row(reach, is, is / was, dominant_wavelength(middle_row(after.after), width / columns));
  }
  return kept;
}

using AllKept = std::vector<std::pair<std::string, Table>>;  // body, what is kept over tau

Table evidence(const AllKept& all) { return stacked({"over", ""}, all); }

NamedFinding plain_flattens(const AllKept& plain) {
  return {"wrinkle-preservation.plain-flattens-wrinkles",
          "Plain projection leaves nothing of the depths that were inside: all lie on the surface.",
          judge_worst(evidence(plain), deviation_column, 1e-12,
                      "points arrive within 1e-12 m of the surface")};
}

/// The least slope of the blend, by which no two depths come closer than.
double least_slope(double reach) {
  const double w = reach / 2;
  return (reach - w / 2) / (reach + deepest - w / 2);
}

NamedFinding blend_keeps_its_share(const AllKept& blend) {
  Worst worst;
  for (const auto& [name, kept] : blend)
    for (size_t k = 0; k < kept.rows(); ++k)
      worst.observe(least_slope(kept.numbers("tau")[k]) / kept.numbers(share_column)[k]);
  return {
      "wrinkle-preservation.blend-keeps-a-share-of-depths",
      "The blend leaves at least (tau - w/2)/(tau + t^ - w/2) of the deviation of depths that were "
      "inside.",
      {{worst.value(), 1 + 1e-9, 0, "1",
        "its slope is nowhere less, so the distance of two depths never shrinks by more than that "
        "factor; 1e-9 allows for the tolerance of 1e-12 m over deviations of a millimetre"},
       evidence(blend),
       "measured is that share over the one found"}};
}

/// Of the deeper half of the penetrations.
double share_of_the_deep(const SunkCloth& cloth, const std::string& map, double reach) {
  const ProjectedCloth after = project(cloth, map, reach);
  const auto is_deep = [&](Eigen::Index i) { return after.before[i] < -deepest / 2; };
  return deviation_where(after.after, is_deep) / deviation_where(after.before, is_deep);
}

NamedFinding power_crushes_the_deep(const std::vector<SunkCloth>& sheets) {
  const std::string by_power = "share left by the power law", by_blend = "share left by the blend";
  Table shares{{"over", ""}, {by_power, "1"}, {by_blend, "1"}};
  for (const SunkCloth& cloth : sheets)
    shares.row(cloth.name, share_of_the_deep(cloth, "power", deepest / 5),
               share_of_the_deep(cloth, "blend", deepest / 5));
  return {"wrinkle-preservation.power-crushes-deep-wrinkles",
          "With tau a fifth of the deepest penetration the power law leaves the deeper half of the "
          "wrinkles less than a tenth of what the blend leaves.",
          {{largest_ratio(shares, by_power, by_blend), 0.1, 0, "1",
            "the power law's slope is at most (tau/(tau + t^)) p u^(p-1) = 0.0126 from the middle "
            "depth down, with p = 6 and u = 5/12; the blend's is 0.1304 there"},
           shares}};
}

NamedFinding wavelength_stays(const std::string& map, const AllKept& kept) {
  Worst worst;
  for (const auto& [name, one] : kept)
    for (double length : one.numbers(wavelength_column))
      worst.observe(std::abs(length - wavelength));
  return {"wrinkle-preservation.wavelength-is-preserved." + map,
          "The dominant wavelength of the depths stays that of the wrinkles.",
          {{worst.value(), wavelength * wavelength / width, 0, "m",
            "the spacing of wavelengths that fit the sheet's length: lambda^2 over that length"},
           evidence(kept),
           "as found after the projection by map '" + map + "'"}};
}

/// The middle row seen from the side [m].
Curve profile(const std::string& label, const PerParticle3& x) {
  Curve curve{label};
  const Eigen::Index first = (rows / 2) * (columns + 1);
  for (int k = 60; k <= 180; ++k) curve.point(x(0, first + k), x(2, first + k));
  return curve;
}

Curve outline() {
  Curve curve{"the ball"};
  for (int k = -50; k <= 50; ++k) {
    const double a = 0.34 * k / 50;
    curve.point(ball_radius * std::sin(a), ball_radius * std::cos(a));
  }
  return curve;
}

/// Figure 2 of the paper: the same wrinkles before and after, one map a figure.
Figure before_and_after(const SunkCloth& cloth, const DepthMap& map, double reach) {
  const std::string words(map.title);
  return {"profile-" + std::string(map.name),
          "Before and after: " + words,
          {"x", "m"},
          {"z", "m"},
          "A strip half inside a ball, seen from the side; tau = 6 mm, eps = 0 (BMF03 figure 2).",
          {outline(), profile("before", cloth.x),
           profile("after", project(cloth, std::string(map.name), reach).x)}};
}

Figure shares(const std::vector<std::pair<std::string, AllKept>>& by_map) {
  Figure figure{
      "share",
      "What is left of the wrinkles that were inside",
      {"tau over t^", "1", Scale::log},
      {"deviation of their depths, after over before", "1"},
      "Half inside a ball. t^, the deepest penetration that the map still resolves, is 14 mm."};
  for (const auto& [map, all] : by_map) {
    Curve curve{
        std::string(depth_map_named(map).title), {}, all[1].second.numbers(share_column), nan, {}};
    for (double reach : all[1].second.numbers("tau")) curve.x.push_back(reach / deepest);
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

/// A circle in the plane y = 0 about (x, 0) [m].
Curve circle(const std::string& label, double x, double radius) {
  Curve curve{label};
  for (int k = 0; k <= 96; ++k)
    curve.point(x + radius * std::cos(2 * pi * k / 96), radius * std::sin(2 * pi * k / 96));
  return curve;
}

/// The signed distance that the projection follows where two balls overlap: inside, too shallow;
/// between them, highest on the surface that is as deep in both.
Map slice_of_union() {
  constexpr int across = 121, up = 81;
  const auto ball = [](double x, double radius) {
    return Object{
        "ball", RigidObject{Sphere{radius}, {Eigen::Quaterniond::Identity(), {x, 0, 0}}, Motion{}},
        0};
  };
  const std::vector<Object> balls = {ball(-0.15, 0.24), ball(0.17, 0.2)};
  Map map{"slice-of-phi",
          "Signed distance to two balls that overlap",
          {"x", "m"},
          {"z", "m"},
          {},
          {},
          {},
          "phi",
          "m",
          Scale::linear,
          "A slice through the centres. Points inside both balls are pinched: N points out of the "
          "ball in which they are deeper, and reverses across the surface between; the projection "
          "leaves them alone.",
          {circle("first ball", -0.15, 0.24), circle("second ball", 0.17, 0.2)}};
  for (int i = 0; i < across; ++i) map.x_values.push_back(-0.45 + 0.9 * i / (across - 1));
  for (int k = 0; k < up; ++k) map.y_values.push_back(-0.3 + 0.6 * k / (up - 1));
  for (const double z : map.y_values)
    for (const double x : map.x_values)
      map.values.push_back(nearest_objects(balls, {x, 0, z}, {0, 0, 0}).first.phi);
  return map;
}

StudyResult run_wrinkles_kept(const Subject&, Tier tier, const Progress& progress) {
  const TriangleMesh sheet = make_sheet({SheetPattern::one_diagonal, width, height, columns, rows});
  const std::vector<SunkCloth> sheets = sunk_sheets(sheet);
  std::vector<double> reaches;
  for (double reach = deepest / 16; reach < 4.1 * deepest;
       reach *= tier == Tier::quick ? 2 : std::sqrt(2.0))
    reaches.push_back(reach);

  StudyResult result;
  std::vector<std::pair<std::string, AllKept>> by_map;
  for (const DepthMap& map : depth_maps()) {
    AllKept all;
    for (const SunkCloth& cloth : sheets)
      all.emplace_back(cloth.name, measure_kept(cloth, std::string(map.name), reaches));
    if (map.name != "plain")
      result.findings.push_back(wavelength_stays(std::string(map.name), all));
    result.figures.push_back(before_and_after(sheets[1], map, 0.006));
    by_map.emplace_back(std::string(map.name), std::move(all));
    progress(double(by_map.size()) / double(depth_maps().size()));
  }
  result.add({plain_flattens(by_map[0].second), blend_keeps_its_share(by_map[2].second),
              power_crushes_the_deep(sheets)});
  result.figures.push_back(shares(by_map));
  result.maps.push_back(slice_of_union());
  return result;
}

}  // namespace

Study wrinkles_kept_study() {
  return {"wrinkle-preservation",
          "Plain projection flattens wrinkles; maps of depth keep their wavelength. The blend "
          "keeps at least a derived share of their depths; the power law crushes the deepest if "
          "tau is small compared with them.",
          {"plain-flattens-wrinkles", "wavelength-is-preserved", "blend-keeps-a-share-of-depths",
           "power-crushes-deep-wrinkles"},
          "BMF03 section 5.3, figure 2",
          "Wrinkled strips lie half inside a half space, a ball and a torus, and are projected by "
          "each map over a range of tau. Of the particles that were inside, the standard deviation "
          "of the signed distance is compared before and after; the wavelength is where the "
          "spectrum of the distances along the strip's middle is largest.",
          run_wrinkles_kept};
}

}  // namespace foldproof
