// The map of errors over settings: from frames, in words, and as evidence.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/settings_map.h"
#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

/// The cloth whose frames are measured.
struct SettingsCloth {
  PerParticle mass;         // N, of any unit; 0 where the motion is prescribed
  std::vector<Edge> edges;  // none: strains are not measured
  Eigen::VectorXd lengths;  // of the edges at rest [m]
  Vector3 up = Vector3::UnitZ();
};

/// Positions [m]; sag, by which the lowest point has sunk [m]; height at the end, from the lowest
/// to the highest point [m]; and with edges the largest strain in any frame [1].
std::vector<SettingsQuantity> settings_quantities(const SettingsCloth& cloth, double floor);

/// Measures frames, the start first, each 3 x N [m].
SettingsRun measured_run(const SettingsPair& at, const std::vector<PerParticle3>& frames,
                         const SettingsCloth& cloth);

/// The answer of a map for one quantity.
struct QuantityAnswer {
  OwnLimit limit;
  std::vector<PricedPair> pairs;
  PairError in_use;
  std::string ends;                 // end_of_refinement
  double gap = nan, gap_bar = nan;  // of the limit from the truth, over the scale [1]
};

/// A material number at the pair in use, over that at the cheapest pair of the finest error.
struct ApparentMaterial {
  std::string name;
  double in_use = nan, converged = nan;  // in `unit`
  std::string unit;
};

struct SettingsAnswer {
  SettingsMap map;
  std::string scene, solver;
  SettingsPair in_use;
  std::vector<double> wanted;              // 1
  std::vector<QuantityAnswer> quantities;  // as the map's
  std::vector<ApparentMaterial> material = {};
  std::string step_check = {};  // half the step against half the substeps, in words; or ""
};

/// Reads the runs of the map.
SettingsAnswer settings_answer(SettingsMap map, const SettingsPair& in_use,
                               const std::vector<double>& wanted);

std::string pair_text(const SettingsMap& map, const SettingsPair& at);  // "4 x 8"
std::string_view name_of(Regime regime);

/// ", 0.21 of the cost of a full grid" of doubled values; "" if a tunable's price is not known.
std::string cost_in_words(const SettingsMap& map);

/// For the user, a sentence each: the error of the pair in use, what it is made of, and the pairs.
std::vector<std::string> settings_sentences(const SettingsAnswer& answer);

/// The study "converge.CASE.SOLVER.settings": the error of positions over both tunables, with the
/// contours of the wanted errors, lines of equal cost, and the pairs; and tables.
StudyRecord settings_study(const SettingsAnswer& answer);

}  // namespace foldproof
