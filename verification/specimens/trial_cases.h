// Small case files, written on the spot, and what differs between what they say and what is read.
#pragma once

#include <cmath>
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

/// The sheet, some tables, the time. path: of the case file, beside or below which its meshes lie.
Scene read_case(const std::string& tables, const std::vector<std::string>& overrides = {},
                const std::string& path = "trial.toml");

/// Tables that have to be refused, and words of the message.
struct Refused {
  std::string tables;
  std::vector<std::string> words;
};

/// How many are accepted, or refused without file and line or one of the words.
Finding refused_cases(const std::vector<Refused>& cases, const std::string& path = "trial.toml");

/// The positions of that sheet, 3 x N [m].
PerParticle3 plain_positions();

/// Differences between what was read and what was written, each in its own words and over its own size.
class Differences {
 public:
  /// size: the difference's scale, in the same unit.
  void see(const std::string& what, double difference, double size) {
    names_.push_back(what);
    values_.push_back(std::abs(difference) / (epsilon * size));
    worst_.see(values_.back());
  }

  /// A statement without a size: 0 if it is right, else infinite.
  void is(const std::string& what, bool right) { see(what, right ? 0 : INFINITY, 1); }

  Finding finding(double bound, const std::string& why) const {
    return {{names_.empty() ? NAN : worst_.value(), bound, 0, "epsilon of the size", why},
            {{"what", "1", names_}, {"difference", "epsilon of the size", values_}},
            "Each difference is over the size of what is compared; a wrong statement counts as infinite."};
  }

 private:
  std::vector<std::string> names_;
  std::vector<double> values_;
  Worst worst_;
};

}  // namespace foldproof
