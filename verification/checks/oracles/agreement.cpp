#include "verification/checks/oracles/agreement.h"

#include <algorithm>
#include <cmath>

namespace foldproof {

namespace {

double apart_by_uncertainty(const oracles::Estimate& one, const oracles::Estimate& other) {
  const double apart = std::abs(one.value - other.value);
  return apart == 0 ? 0 : apart / (one.uncertainty + other.uncertainty);
}

}  // namespace

void Agreement::see(const std::string& point, const oracles::Estimate& one, const oracles::Estimate& other) {
  points_.push_back(point);
  one_.push_back(one.value);
  other_.push_back(other.value);
  uncertainty_.push_back(one.uncertainty + other.uncertainty);
  ratio_.push_back(apart_by_uncertainty(one, other));
}

void Agreement::see_worst(const std::string& point,
                          const std::vector<std::pair<oracles::Estimate, oracles::Estimate>>& pairs) {
  const std::pair<oracles::Estimate, oracles::Estimate>* worst = nullptr;
  for (const auto& pair : pairs) {
    const double ratio = apart_by_uncertainty(pair.first, pair.second);
    if (!worst || !(ratio <= apart_by_uncertainty(worst->first, worst->second))) worst = &pair;
    if (std::isnan(ratio)) break;
  }
  if (worst) see(point, worst->first, worst->second);
}

void Agreement::see_exact(const std::string& point, double one, double other) {
  see(point, {one, 0}, {other, 0});
}

Finding Agreement::judged() const {
  Worst worst;
  for (const double ratio : ratio_) worst.see(ratio);
  const double measured = points_.size() < 2 ? nan : worst.value();
  return {{measured, 1, 0, "1",
           "the truth lies within each answer's uncertainty, so two answers are no further apart than both "
           "together"},
          {{"point", "", points_},
           {"one way", "", one_},
           {"other way", "", other_},
           {"uncertainty of both", "", uncertainty_},
           {"apart, of that", "1", ratio_}},
          ""};
}

double Agreement::largest_uncertainty() const {
  Worst worst;
  for (std::size_t i = 0; i < points_.size(); ++i)
    worst.see(uncertainty_[i] / std::max({std::abs(one_[i]), std::abs(other_[i]), 1.0}));
  return points_.empty() ? nan : worst.value();
}

}  // namespace foldproof
