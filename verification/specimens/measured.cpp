#include "verification/specimens/measured.h"

#include <cmath>

namespace foldproof {

void Measured::see(const std::string& name, double value) { see(name, oracles::Estimate{value, 0}); }

void Measured::see(const std::string& name, const oracles::Estimate& value) {
  names_.push_back(name);
  values_.push_back(value.value);
  worst_.see(value.value);
  uncertainty_.see(value.uncertainty);
}

Finding Measured::judged(double bound, const std::string& why_bound) const {
  const double worst = values_.empty() ? nan : worst_.value();
  return {{worst, bound, uncertainty_.value(), unit_, why_bound},
          {{"case", "", names_}, {quantity_, unit_, values_}},
          ""};
}

Measured roundings_of(const std::string& scale) { return {"measured", "epsilon " + scale}; }

double signed_largest(const std::vector<double>& values) {
  if (values.empty()) return NAN;
  double largest = values.front();
  for (const double value : values)
    if (!std::isnan(largest) && !(value <= largest)) largest = value;
  return largest;
}

}  // namespace foldproof
