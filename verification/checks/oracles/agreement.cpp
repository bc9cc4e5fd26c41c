#include "verification/checks/oracles/agreement.h"

#include <algorithm>
#include <cmath>

namespace foldproof {

namespace {

const char* const apart = "apart, of that";

double apart_by_uncertainty(const oracles::Estimate& one, const oracles::Estimate& other) {
  const double difference = std::abs(one.value - other.value);
  return difference == 0 ? 0 : difference / (one.uncertainty + other.uncertainty);
}

}  // namespace

Table no_answers() {
  return {
      {"point", ""}, {"one way", ""}, {"other way", ""}, {"uncertainty of both", ""}, {apart, "1"}};
}

void compare(Table& answers, const std::string& point, const oracles::Estimate& one,
             const oracles::Estimate& other) {
  answers.row(point, one.value, other.value, one.uncertainty + other.uncertainty,
              apart_by_uncertainty(one, other));
}

void compare_worst(Table& answers, const std::string& point,
                   const std::vector<std::pair<oracles::Estimate, oracles::Estimate>>& pairs) {
  const std::pair<oracles::Estimate, oracles::Estimate>* worst = nullptr;
  for (const auto& pair : pairs) {
    const double ratio = apart_by_uncertainty(pair.first, pair.second);
    if (!worst || !(ratio <= apart_by_uncertainty(worst->first, worst->second))) worst = &pair;
    if (std::isnan(ratio)) break;
  }
  if (worst) compare(answers, point, worst->first, worst->second);
}

void compare_exact(Table& answers, const std::string& point, double one, double other) {
  compare(answers, point, {one, 0}, {other, 0});
}

Finding judged_agreement(const Table& answers) {
  const double measured = answers.rows() < 2 ? nan : answers.worst(apart);
  return {{measured, 1, 0, "1",
           "the truth lies within each answer's uncertainty, so two answers are no further apart "
           "than both together"},
          answers,
          ""};
}

double largest_uncertainty(const Table& answers) {
  const std::vector<double>&one = answers.numbers("one way"), &other = answers.numbers("other way");
  const std::vector<double>& uncertainty = answers.numbers("uncertainty of both");
  Worst worst;
  for (std::size_t i = 0; i < answers.rows(); ++i)
    worst.observe(uncertainty[i] / std::max({std::abs(one[i]), std::abs(other[i]), 1.0}));
  return answers.rows() == 0 ? nan : worst.value();
}

}  // namespace foldproof
