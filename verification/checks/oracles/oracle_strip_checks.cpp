// Oracles of folds, ribbons and chains, checked by oracles.
#include <array>
#include <cmath>
#include <string>

#include "verification/checks/oracles/oracle_checks.h"
#include "verification/evidence.h"
#include "verification/oracles/chains_and_ribbons.h"
#include "verification/oracles/folds.h"
#include "verification/oracles/homogenised_bending.h"

namespace foldproof {

Table free_folds_agree() {
  Table answers = no_answers();
  const oracles::FreeFold one = oracles::free_fold_by_shooting(),
                          other = oracles::free_fold_by_collocation();
  compare(answers, "height", one.height, other.height);
  compare(answers, "lifted length", one.lifted, other.lifted);
  compare(answers, "push at the lift-off", one.push, other.push);
  return answers;
}

Table tipping_ribbons_agree() {
  Table answers = no_answers();
  compare(answers, "load, series and shooting", oracles::tipping_load_by_series(),
          oracles::tipping_load_by_shooting());
  compare(answers, "load of a column, series and shooting", oracles::self_buckling_load_by_series(),
          oracles::self_buckling_load_by_shooting());
  // a ribbon's two edges cost it the same, however wide it is: more rows add the sheet's own
  const double edge = 0.7, added = 20 * edge * std::sqrt(0.75);
  const oracles::RibbonRigidity narrow = oracles::equilateral_ribbon(edge, 40),
                                wide = oracles::equilateral_ribbon(edge, 60);
  const Eigen::Matrix3d R = oracles::relaxed_rigidity(oracles::equilateral_triangles(edge));
  constexpr double off = 1e-10;  // sums of some ten thousand products, over a difference
  compare(answers, "bending, ribbon and cell", {(wide.bending - narrow.bending) / added, off},
          {oracles::strip_rigidity(R, 0), off});
  compare(answers, "twisting, ribbon and cell", {(wide.twisting - narrow.twisting) / added, off},
          {4 * R(2, 2), off});
  return answers;
}

Table hung_chains_agree() {
  Table answers = no_answers();
  for (const int n : {1, 2, 3, 5})
    compare(answers, "frequency of mode " + std::to_string(n),
            oracles::chain_frequency_by_series(n), oracles::chain_frequency_by_shooting(n));
  const std::array<double, 3> s{.13, .58, .9};
  for (const oracles::HungChain& chain :
       {oracles::HungChain{.8, 0}, oracles::HungChain{.45, .3}, oracles::HungChain{.7, -.2}}) {
    const oracles::Catenary one = oracles::catenary(chain, s),
                            other = oracles::catenary_by_shooting(chain, s);
    std::vector<std::pair<oracles::Estimate, oracles::Estimate>> pairs{
        {one.pull_across, other.pull_across}, {one.pull_up, other.pull_up}};
    for (std::size_t i = 0; i < s.size(); ++i) {
      pairs.push_back(
          {{one.points[i].across, one.uncertainty}, {other.points[i].across, other.uncertainty}});
      pairs.push_back(
          {{one.points[i].up, one.uncertainty}, {other.points[i].up, other.uncertainty}});
    }
    compare_worst(answers, "catenary across " + std::to_string(chain.across), pairs);
  }
  return answers;
}

}  // namespace foldproof
