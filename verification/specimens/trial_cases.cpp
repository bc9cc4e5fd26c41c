#include "verification/specimens/trial_cases.h"

#include <cmath>

#include "reference/bodies/level_set_provider.h"
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

Table no_differences() { return {{"what", "1"}, {"difference", "epsilon of the size"}}; }

double in_roundings(double difference, double size) {
  return std::abs(difference) / (epsilon * size);
}

double infinite_unless(bool right) { return right ? 0 : INFINITY; }

Finding judged_differences(const Table& differences, double bound, const std::string& why_bound) {
  return judge_worst(differences, bound, why_bound,
                     "Each difference is over the size of what is compared; a wrong statement "
                     "counts as infinite.");
}

Finding rejected_cases(const std::vector<RejectedCase>& cases, const std::string& path) {
  Table answers{{"message", ""}, {"lacks", ""}};
  double wrong = 0;
  for (const RejectedCase& rejected : cases) {
    std::string message;
    try {
      build(trial_scene(rejected.tables, {}, path), computing_provider());
    } catch (const InputError& error) {
      message = error.what();
    }
    std::string lacks = message.starts_with(path + ":") ? "" : "file and line";
    for (const std::string& word : rejected.words)
      if (message.find(word) == std::string::npos) lacks += " '" + word + "'";
    answers.row(message.empty() ? "accepted: " + rejected.tables : message.substr(0, 200), lacks);
    wrong += !lacks.empty();
  }
  return {{wrong, 0, 0, "cases", "each must be refused with file, line and what is known"},
          answers,
          ""};
}

}  // namespace foldproof
