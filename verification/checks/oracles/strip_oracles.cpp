// Oracles of folds, ribbons and chains, checked by other oracles.
#include <fmt/format.h>

#include "verification/checks/oracles/agreement.h"
#include "verification/oracles/chains_and_ribbons.h"
#include "verification/oracles/folds.h"
#include "verification/oracles/homogenised_bending.h"
#include "verification/oracles/sheets/clamped_stress.h"
#include "verification/oracles/sheets/deep_wrinkles.h"
#include "verification/oracles/sheets/hung_cone.h"
#include "verification/oracles/sheets/sagging_plate.h"
#include "verification/oracles/sheets/stretched_wrinkles.h"

namespace foldproof {

namespace {

void free_folds_agree(Answers& answers) {
  const oracles::FreeFold one = oracles::free_fold_by_shooting(),
                          other = oracles::free_fold_by_collocation();
  answers.compare("height", one.height, other.height);
  answers.compare("lifted length", one.lifted, other.lifted);
  answers.compare("push at the lift-off", one.push, other.push);
}

void tipping_ribbons_agree(Answers& answers) {
  answers.compare("load, series and shooting", oracles::tipping_load_by_series(),
                  oracles::tipping_load_by_shooting());
  answers.compare("load of a column, series and shooting", oracles::self_buckling_load_by_series(),
                  oracles::self_buckling_load_by_shooting());
  // a ribbon's two edges lower its rigidity equally at any width: more rows add the sheet's own
  const double edge = 0.7, added = 20 * edge * std::sqrt(0.75);
  const oracles::RibbonRigidity narrow = oracles::equilateral_ribbon(edge, 40),
                                wide = oracles::equilateral_ribbon(edge, 60);
  const Eigen::Matrix3d R = oracles::relaxed_rigidity(oracles::equilateral_triangles(edge));
  constexpr double off = 1e-10;  // sums of some ten thousand products, over a difference
  answers.compare("bending, ribbon and cell", {(wide.bending - narrow.bending) / added, off},
                  {oracles::strip_rigidity(R, 0), off});
  answers.compare("twisting, ribbon and cell", {(wide.twisting - narrow.twisting) / added, off},
                  {4 * R(2, 2), off});
}

void hung_cones_agree(Answers& answers) {
  const std::array<double, 3> places{0, 0.3, 1.1};
  for (const auto& [folds, weight] : {std::pair{2, 3.3}, {3, 7.0}, {5, 11.0}}) {
    const std::string at = ", folds " + std::to_string(folds);
    const oracles::HungCone one = oracles::hung_cone_by_series(folds, weight, places),
                            other = oracles::hung_cone_by_shooting(folds, weight, places);
    answers.compare("energy" + at, one.energy, other.energy);
    answers.compare("depth" + at, one.depth, other.depth);
    for (std::size_t i = 0; i < places.size(); ++i)
      answers.compare("height " + std::to_string(i) + at, {one.heights[i], one.uncertainty},
                      {other.heights[i], other.uncertainty});
    // under little weight: energy -pi (weight/folds)^2, up to terms of its next even power
    const double little = 3e-4;
    const oracles::HungCone gentle = oracles::hung_cone_by_series(folds, little, {});
    answers.compare("energy of small slopes" + at, {gentle.energy.value / (little * little), 1e-9},
                    {-pi / (folds * folds), 10 * little * little});
  }
}

/// The energy per area that springs under tension add to a wave of amplitude 1 across, over k^4/4:
/// edge by edge, over a whole number of waves.
double rigidity_of_springs(double T, double edge, int edges_a_wave) {
  const double k = 2 * pi / (edges_a_wave * edge), spacing = std::sqrt(0.75) * edge;
  const double slanting = T * edge / std::sqrt(3), across = -slanting / 2;  // N
  const auto height = [&](double x) { return std::cos(k * x); };
  double energy = 0;
  for (int i = 0; i < edges_a_wave; ++i) {
    const double x = i * edge;
    energy += across / edge * std::pow(height(x + edge) - height(x), 2) / 2;
    for (const double side : {-0.5, 0.5})
      energy += slanting / edge * std::pow(height(x + side * edge) - height(x), 2) / 2;
  }
  return energy / (edges_a_wave * edge * spacing) * 4 / std::pow(k, 4);
}

void stretched_wrinkles_agree(Answers& answers) {
  for (const double reach : {0.07, 0.011, 0.0013, 0.0003}) {
    const oracles::Wrinkles one = oracles::wrinkles_by_functions(reach),
                            other = oracles::wrinkles_by_series(reach);
    const std::string at = ", reach " + std::to_string(reach);
    answers.compare("wavelength" + at, one.wavelength, other.wavelength);
    answers.compare("compression" + at, one.compression, other.compression);
  }
  // the clamps shorten the length by two reaches; bending along adds terms of the next power
  const double small = 1e-4;
  answers.compare("wavelength over the law's",
                  {oracles::wrinkles_by_functions(small).wavelength.value /
                       oracles::wrinkles_by_scaling(small).wavelength.value,
                   0},
                  {1 - small, 5 * small * small});
  const double T = 3.7, edge = 0.6;
  for (const int edges_a_wave : {70, 120}) {
    const double k = 2 * pi / (edges_a_wave * edge), next_term = std::pow(k * edge, 2);
    const oracles::Estimate rigidity = oracles::rigidity_under_tension(0, T, edge, k);
    // its uncertainty is the first term that it leaves out
    answers.compare("rigidity by tension, " + std::to_string(edges_a_wave) + " edges a wave",
                    {rigidity.value - rigidity.uncertainty, next_term * rigidity.uncertainty},
                    {rigidity_of_springs(T, edge, edges_a_wave), 1e-12});
  }
}

void deep_wrinkles_agree(Answers& answers) {
  const auto at = [](const oracles::DeepWrinkles& w) {
    return ", reach " + std::to_string(w.reach) + ", compression " + std::to_string(w.compression);
  };
  for (const oracles::DeepWrinkles& wrinkles :
       {oracles::DeepWrinkles{0.11, 1.1, 1.3}, {0.085, 0.9, 7.3}, {0.14, 1.6, 3.7}}) {
    const oracles::DeepWrinkleHeight series = oracles::deep_wrinkles_by_series(wrinkles, {});
    answers.compare("height" + at(wrinkles), series.middle,
                    oracles::deep_wrinkles_by_shooting(wrinkles, series));
  }
  // far beyond the onset the middle is level and does not feel the clamps
  const oracles::DeepWrinkles deep{0.023, 0.52, 6.1};
  const double k = 2 * pi / deep.wavelength;
  answers.compare("height far beyond" + at(deep), oracles::deep_wrinkles_by_series(deep, {}).middle,
                  {std::sqrt(1 - std::pow(deep.reach * k, 2) / deep.compression), 1e-8});
}

void clamped_stresses_agree(Answers& answers) {
  const std::array<double, 4> places{0.1, 0.25, 0.4, 0.5};
  for (const oracles::ClampedRectangle& sheet :
       {oracles::ClampedRectangle{1.3, 0.45}, {2, 1.0 / 3}, {3.7, 0.2}}) {
    const auto one = oracles::clamped_stress_by_stresses(sheet, places),
               other = oracles::clamped_stress_by_displacements(sheet, places);
    for (std::size_t i = 0; i < places.size(); ++i)
      answers.compare("at " + std::to_string(places[i]) + " of a length of " +
                          std::to_string(sheet.length_over_width) + " widths",
                      one[i], other[i]);
  }
  // without Poisson contraction the clamps restrain nothing
  answers.compare("no Poisson effect",
                  oracles::clamped_stress_by_stresses({2, 0}, std::array<double, 1>{0.2})[0],
                  {0, 1e-12});
}

void sagging_rings_agree(Answers& answers) {
  for (const oracles::RingPlate& ring :
       {oracles::RingPlate{0.61, 0.31}, {0.43, -0.36}, {0.72, 0.93}}) {
    const oracles::Estimate formula = oracles::sag_of_ring_by_formula(ring),
                            energy = oracles::sag_of_ring_by_energy(ring);
    answers.compare(
        fmt::format("sag, inner radius {}, Poisson's ratio {}", ring.inner, ring.poisson),
        {1, formula.uncertainty / formula.value},
        {energy.value / formula.value, energy.uncertainty / formula.value});
  }
}

void hung_chains_agree(Answers& answers) {
  for (const int n : {1, 2, 3, 5})
    answers.compare("frequency of mode " + std::to_string(n), oracles::chain_frequency_by_series(n),
                    oracles::chain_frequency_by_shooting(n));
  const std::array<double, 3> s{.13, .58, .9};
  for (const oracles::HungChain& chain :
       {oracles::HungChain{.8, 0}, oracles::HungChain{.45, .3}, oracles::HungChain{.7, -.2}}) {
    const oracles::Catenary one = oracles::catenary(chain, s),
                            other = oracles::catenary_by_shooting(chain, s);
    Pairs pairs{{one.pull_across, other.pull_across}, {one.pull_up, other.pull_up}};
    for (std::size_t i = 0; i < s.size(); ++i) {
      pairs.push_back(
          {{one.points[i].across, one.uncertainty}, {other.points[i].across, other.uncertainty}});
      pairs.push_back(
          {{one.points[i].up, one.uncertainty}, {other.points[i].up, other.uncertainty}});
    }
    answers.compare_worst("catenary across " + std::to_string(chain.across), pairs);
  }
}

}  // namespace

std::vector<Comparison> strip_comparisons() {
  return {
      {"oracle.free-folds-agree",
       "The oracle's free fold by shooting from its lift-off is that by collocation between "
       "clamps.",
       free_folds_agree},
      {"oracle.tipping-ribbons-agree",
       "The oracle's load under which a ribbon on edge tips over is the same by power series and "
       "by "
       "GSL, and ribbons of more rows gain the rigidity of a periodic cell.",
       tipping_ribbons_agree},
      {"oracle.stretched-wrinkles-agree",
       "The oracle's wrinkles of a stretched sheet by functions are those by a series, and tend to "
       "the scaling law; the rigidity that tension adds is that of a lattice of springs.",
       stretched_wrinkles_agree},
      {"oracle.deep-wrinkles-agree",
       "The oracle's heights of wrinkles beyond their onset are the same by a series and by "
       "shooting, and tend to a closed form far beyond it.",
       deep_wrinkles_agree},
      {"oracle.clamped-stresses-agree",
       "The oracle's stress across a stretched, clamped sheet is the same from stresses of least "
       "complementary energy and from displacements of least strain energy.",
       clamped_stresses_agree, 5e-4},
      {"oracle.hung-cones-agree",
       "The oracle's cone that hangs from its tip is the same by a series and by shooting, and "
       "tends "
       "to that of small slopes.",
       hung_cones_agree},
      {"oracle.sagging-rings-agree",
       "The oracle's ring of plate that is clamped along its inner edge sags as far by a formula "
       "as "
       "by least energy.",
       sagging_rings_agree},
      {"oracle.hung-chains-agree",
       "The oracle's hanging chains are the same by functions, by power series and by GSL: shapes, "
       "pulls and frequencies.",
       hung_chains_agree}};
}

}  // namespace foldproof
