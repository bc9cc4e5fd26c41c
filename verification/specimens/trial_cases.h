// Small case files written by code, and differences between their text and the scene read.
#pragma once

#include <string>
#include <vector>

#include "reference/scene/scene.h"
#include "verification/evidence.h"
#include "verification/verdict.h"

namespace foldproof {

inline const std::string small_sheet = R"(
[cloth]
shape = "sheet"
pattern = "alternating"
width = 0.6
height = 0.43
columns = 4
rows = 3
density = 0.23
)";

inline const std::string short_time = R"(
[time]
end = 0.3
frames_per_second = 40
integrator = "A"
step = 0.003
)";

/// The sheet, some tables, the time. path: of the case file; its meshes lie beside or below it.
Scene trial_scene(const std::string& tables, const std::vector<std::string>& overrides = {},
                  const std::string& path = "trial.toml");

/// Tables that must be refused, and words of the error message.
struct RejectedCase {
  std::string tables;
  std::vector<std::string> words;
};

/// Counts the cases that are accepted and built, or refused without file and line or one of the
/// words.
Finding rejected_cases(const std::vector<RejectedCase>& cases,
                       const std::string& path = "trial.toml");

/// The positions of that sheet, 3 x N [m].
PerParticle3 plain_positions();

/// Differences between what was read and what was written, one per row.
class Differences {
 public:
  /// A statement without a magnitude: 0 if it is right, else infinite.
  void is(const std::string& what, bool right);

  /// In roundings of `size`, which has the unit of `difference`.
  void is_near(const std::string& what, double difference, double size = 1);

  Finding judged(double bound, const std::string& why_bound) const;

 private:
  Table table_{{"what", "1"}, {"difference", "epsilon of the size"}};
};

}  // namespace foldproof
