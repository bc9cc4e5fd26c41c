#include "verification/subjects/suite/headlines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

namespace foldproof {

const std::vector<HeadlineColumns>& headline_columns() {
  static const std::vector<HeadlineColumns> all{
      {"rest.no-force-no-motion-on-any-pattern",
       "over rounding",
       {"pattern", "largest displacement"}},
      {"rest.curved-sheet-keeps-its-rest-angles", "over rounding", {"largest displacement"}},
      {"inertia.free-sheet-keeps-its-velocity", "over rounding", {"of", "error"}},
      {"gravity.speed-grows-by-g-t", "error over rounding", {"of the mean velocity", "error"}},
      {"momentum.angular-drift-falls-with-the-step",
       "fine over coarse",
       {"drift at dt/2", "drift at dt/4"}},
      {"order.observed-is-as-claimed", "short of the claim", {"observed", "claimed"}},
      {"order.with-damping-is-as-claimed", "short of the claim", {"observed", "claimed"}},
      {"forces.weight-is-mass-times-g", "error of the net force", {"net force", "weight"}},
      {"calibration.young-s-modulus-is-the-scene-s",
       "difference from the scene's",
       {"along", "Young's modulus"}},
      {"calibration.bending-rigidity-is-the-scene-s",
       "difference from the scene's",
       {"bending rigidity"}},
      {"vibration.undamped-goes-on", "difference", {"of", "extrapolated", "expected"}},
      {"vibration.damped-decays-as-its-damping-says",
       "difference",
       {"of", "extrapolated", "expected"}},
      {"buckling.upright-strip-falls-at-greenhill-s-load",
       "outside of both",
       {"stands under", "falls under", "as a beam", "as a plate"}},
      {"buckling.strip-on-edge-tips-at-its-load",
       "outside of both",
       {"stands under", "tips under", "at least", "at most"}},
      {"drape.stiff-ring-sags-as-a-plate",
       "distance from their middle and moves, over half the range",
       {"extrapolated", "of the plate, at least", "at most"}},
      {"wrinkles.grow-as-tension-and-rigidity-say",
       "of the difference, over what is allowed",
       {"half waves", "stiffness to it", "of a plate"}},
      {"floor.pressed-strip-slips-as-the-elastica",
       "outside of both",
       {"compression", "mu that just holds", "at least", "at most"}},
      {"floor.clamped-fold-stands-as-high-as-the-elastica",
       "outside of both and last move, over what is allowed",
       {"of the fold", "measured", "at least", "at most"}},
      {"contact.sheet-rests-on-a-plane",
       "largest distance over what is allowed",
       {"deepest", "highest"}},
      {"contact.slides-as-coulomb-says",
       "difference",
       {"slope", "mu", "distance down", "by Coulomb's law"}},
      {"contact.slips-at-coulomb-s-slope",
       "difference",
       {"mu", "slope that slips", "by Coulomb's law"}},
      {"ball.slides-as-coulomb-says", "difference", {"mu", "distance down", "by Coulomb's law"}},
      {"capstan.slips-at-euler-s-ratio",
       "difference",
       {"heavy over light end", "mu that just holds", "by Euler's law"}},
  };
  return all;
}

namespace {

/// "observed 0.98": of a column, in this row.
std::string cell_text(const Column& column, size_t row) {
  if (const auto* texts = std::get_if<std::vector<std::string>>(&column.values))
    return fmt::format("{} {}", column.name, texts->at(row));
  const std::string unit = column.unit.empty() || column.unit == "1" ? "" : " " + column.unit;
  const double value = std::get<std::vector<double>>(column.values).at(row);
  if (!std::isfinite(value)) return column.name + " no number";
  return fmt::format("{} {:.4g}{}", column.name, value, unit);
}

}  // namespace

std::string headline_of(std::string_view law, const Finding& finding) {
  const auto of = std::ranges::find(headline_columns(), law, &HeadlineColumns::law);
  if (of == headline_columns().end() || finding.evidence.rows() == 0) return "";
  const std::vector<double>& judged = finding.evidence.numbers(of->judged);
  size_t row = 0;
  for (size_t k = 1; k < judged.size(); ++k)
    if (!(judged[k] <= judged[row])) row = k;
  std::string text;
  for (const std::string_view name : of->shown)
    text += (text.empty() ? "" : ", ") + cell_text(finding.evidence.column(name), row);
  return text.starts_with("of ") ? text.substr(3) : text;  // "of the fold height"
}

std::string found_text(const std::array<double, 2>& found, const std::array<double, 2>& tried) {
  if (found[1] == tried[1]) return fmt::format(">= {:.4g}, the most that is tried", tried[1]);
  if (found[0] == tried[0]) return fmt::format("<= {:.4g}, the least that is tried", tried[0]);
  return fmt::format("{:.4g}", (found[0] + found[1]) / 2);
}

}  // namespace foldproof
