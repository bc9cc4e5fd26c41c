// Small case files, written on the spot, and what differs between what they say and what is read.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "reference/scene/scene.h"
#include "verification/check.h"

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

/// The sheet, some tables, the time.
Scene read_case(const std::string& tables, const std::vector<std::string>& overrides = {});

/// The positions of that sheet, 3 x N [m].
PerParticle3 plain_positions();

/// Differences between what was read and what was written, each in its own words.
class Differences {
 public:
  void see(const std::string& what, double difference) {
    names_.push_back(what);
    values_.push_back(std::abs(difference));
    worst_.see(std::abs(difference));
  }

  Finding finding(double bound, const std::string& why) const {
    return {{names_.empty() ? NAN : worst_.value(), bound, 0, "SI", why},
            {{"what", "1", names_}, {"difference", "SI", values_}},
            ""};
  }

 private:
  std::vector<std::string> names_;
  std::vector<double> values_;
  Worst worst_;
};

}  // namespace foldproof
