#include "verification/specimens/trial_cases.h"

#include <algorithm>

#include "reference/bodies/makers.h"
#include "reference/mesh/shapes.h"

namespace foldproof {

Scene trial_scene(const std::string& tables, const std::vector<std::string>& overrides,
                  const std::string& path) {
  return read_scene_text(small_sheet + tables + short_time, path, overrides);
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

Finding refused_cases(const std::vector<Refused>& cases, const std::string& path) {
  std::vector<std::string> messages, faults;
  for (const Refused& refused : cases) {
    std::string message;
    try {
      build(trial_scene(refused.tables, {}, path), computing_makers());
    } catch (const InputError& error) {
      message = error.what();
    }
    messages.push_back(message.empty() ? "accepted: " + refused.tables : message.substr(0, 200));
    std::string lacks = message.starts_with(path + ":") ? "" : "file and line";
    for (const std::string& word : refused.words)
      if (message.find(word) == std::string::npos) lacks += " '" + word + "'";
    faults.push_back(lacks);
  }
  const double wrong =
      double(std::count_if(faults.begin(), faults.end(), [](const auto& f) { return !f.empty(); }));
  return {{wrong, 0, 0, "cases", "each must be refused with file, line and what is known"},
          {{"message", "", messages}, {"lacks", "", faults}},
          ""};
}

}  // namespace foldproof
