#include "verification/checks/oracles/agreement.h"

namespace foldproof {

namespace {

double apart_by_uncertainty(const oracles::Estimate& one, const oracles::Estimate& other) {
  const double difference = std::abs(one.value - other.value);
  return difference == 0 ? 0 : difference / (one.uncertainty + other.uncertainty);
}

}  // namespace

void Answers::compare(const std::string& point, const oracles::Estimate& one,
                      const oracles::Estimate& other) {
  table_.row(point, one.value, other.value, one.uncertainty + other.uncertainty,
             apart_by_uncertainty(one, other));
}

void Answers::compare_worst(const std::string& point, const Pairs& pairs) {
  const std::pair<oracles::Estimate, oracles::Estimate>* worst = nullptr;
  for (const auto& pair : pairs) {
    const double ratio = apart_by_uncertainty(pair.first, pair.second);
    if (!worst || !(ratio <= apart_by_uncertainty(worst->first, worst->second))) worst = &pair;
    if (std::isnan(ratio)) break;
  }
  if (worst) compare(point, worst->first, worst->second);
}

void Answers::compare_exact(const std::string& point, double one, double other) {
  compare(point, {one, 0}, {other, 0});
}

Finding Answers::judged_agreement() const {
  const double measured = table_.rows() < 2 ? nan : table_.worst("apart, of that");
  return {{measured, 1, 0, "1",
           "the truth lies within each answer's uncertainty, so two answers are no further apart "
           "than both together"},
          table_};
}

double Answers::largest_uncertainty() const {
  const std::vector<double>&one = table_.numbers("one way"), &other = table_.numbers("other way");
  const std::vector<double>& uncertainty = table_.numbers("uncertainty of both");
  Worst worst;
  for (std::size_t i = 0; i < table_.rows(); ++i)
    worst.observe(uncertainty[i] / std::max({std::abs(one[i]), std::abs(other[i]), 1.0}));
  return table_.rows() == 0 ? nan : worst.value();
}

}  // namespace foldproof
