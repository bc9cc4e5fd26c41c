#include "verification/evidence.h"

#include <cmath>

namespace foldproof {

void Worst::see(double value) {
  if (!std::isnan(worst_) && !(value <= worst_)) worst_ = value;
}

}  // namespace foldproof
