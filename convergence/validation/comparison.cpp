#include "convergence/validation/comparison.h"

#include <fmt/format.h>

#include <cmath>

namespace foldproof {

double difference(const Comparison& comparison) {
  return comparison.simulated - comparison.should.value;
}

double combined_uncertainty(const Comparison& comparison) {
  return std::hypot(comparison.numerical, comparison.should.uncertainty);
}

Agreement agreement_of(const Comparison& comparison, double resolution) {
  const double d = std::abs(difference(comparison)), u = combined_uncertainty(comparison);
  if (!std::isfinite(d) || !std::isfinite(u)) return Agreement::cannot_tell;
  if (d > u) return Agreement::differs;
  return u <= resolution ? Agreement::agrees : Agreement::cannot_tell;
}

std::string words_of(const Comparison& comparison, double resolution) {
  const double d = difference(comparison), u = combined_uncertainty(comparison);
  switch (agreement_of(comparison, resolution)) {
    case Agreement::agrees:
      return fmt::format("agrees within {:.2g}", u);
    case Agreement::differs:
      return fmt::format("differs by {:.2g} +- {:.2g}", d, u);
    case Agreement::cannot_tell:
      break;
  }
  return fmt::format("cannot tell: u = {:.2g} is more than {:.2g}", u, resolution);
}

Comparison compare_ladder(const std::string& quantity, const Ladder& ladder,
                          const oracles::Estimate& should) {
  return {quantity, ladder.values.back(), error_bar(ladder).half_width, should};
}

Table no_comparisons(const std::string& unit) {
  return Table{{"quantity", ""},        {"simulated S", unit}, {"should be D", unit},
               {"S - D", unit},         {"numerical u", unit}, {"u of D", unit},
               {"size of S - D", unit}, {"comparison", ""}};
}

void add_comparison(Table& table, const Comparison& comparison, double resolution) {
  const oracles::Estimate size{std::abs(difference(comparison)), combined_uncertainty(comparison)};
  table.row(comparison.quantity, comparison.simulated, comparison.should.value,
            difference(comparison), comparison.numerical, comparison.should.uncertainty, size,
            words_of(comparison, resolution));
}

Finding judge_comparisons(Table table, double resolution, std::string why_resolution,
                          std::string note) {
  return judge_worst(std::move(table), "size of S - D", resolution, std::move(why_resolution),
                     std::move(note));
}

Finding judge_comparison(const Comparison& comparison, double resolution,
                         std::string why_resolution, std::string note) {
  Table table = no_comparisons("1");
  add_comparison(table, comparison, resolution);
  return judge_comparisons(std::move(table), resolution, std::move(why_resolution),
                           std::move(note));
}

}  // namespace foldproof
