#include "verification/specimens/trial_cases.h"

#include <cmath>

#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/check.h"

namespace foldproof {

Scene trial_scene(const std::string& tables, const std::vector<std::string>& overrides,
                  const std::string& path) {
  return read_scene_text(small_sheet + tables + short_time, path, overrides);
}

PerParticle3 plain_positions() {
  return make_sheet({SheetPattern::alternating, 0.6, 0.43, 4, 3}).rest;
}

void Differences::is(const std::string& what, bool right) {
  table_.row(what, right ? 0 : INFINITY);
}

void Differences::is_near(const std::string& what, double difference, double size) {
  table_.row(what, std::abs(difference) / (epsilon * size));
}

Finding Differences::judged(double bound, const std::string& why_bound) const {
  return judge_worst(table_, bound, why_bound,
                     "Each difference is over the size of what is compared; a wrong statement "
                     "counts as infinite.");
}

Finding rejected_cases(const std::vector<RejectedCase>& cases, const std::string& path) {
  Table answers{{"message", ""}, {"lacks", ""}};
  double wrong = 0;
  for (const RejectedCase& rejected : cases) {
    const std::string message = rejection_message(
        [&] { build(trial_scene(rejected.tables, {}, path), computing_provider()); });
    std::string lacks = message.starts_with(path + ":") ? "" : "file and line";
    for (const std::string& word : rejected.words)
      if (message.find(word) == std::string::npos) lacks += " '" + word + "'";
    answers.row(message.empty() ? "accepted: " + rejected.tables : message.substr(0, 200), lacks);
    wrong += !lacks.empty();
  }
  return {{wrong, 0, 0, "cases", "each must be refused with file, line and what is known"},
          answers};
}

}  // namespace foldproof
