#include "verification/checks/trial_cases.h"

#include "reference/mesh/shapes.h"

namespace foldproof {

Scene read_case(const std::string& tables, const std::vector<std::string>& overrides) {
  return read_scene_text(small_sheet + tables + short_time, "trial.toml", overrides);
}

PerParticle3 plain_positions() {
  Sheet sheet;
  sheet.pattern = SheetPattern::alternating;
  sheet.width = 0.6;
  sheet.height = 0.43;
  sheet.columns = 4;
  sheet.rows = 3;
  return make_sheet(sheet).rest;
}

}  // namespace foldproof
