// foldproof golden: inputs and outputs of the paper's formulas, for unit tests of other codes.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scripts/program/commands.h"
#include "verification/oracles/golden.h"

namespace foldproof {

namespace {

void print_csv(const GoldenTable& table) {
  std::string heading;
  for (const GoldenColumn& column : table.columns)
    heading += (heading.empty() ? "" : ",") + column.name;
  fmt::print("{}\n", heading);
  for (const std::vector<double>& row : table.rows) fmt::print("{:.17g}\n", fmt::join(row, ","));
}

/// Numbers are those of the CSV: the shortest that read back to the same double.
void print_json(const GoldenTable& table) {
  nlohmann::json columns = nlohmann::json::array();
  for (const GoldenColumn& column : table.columns)
    columns.push_back({{"name", column.name},
                       {"unit", column.unit},
                       {"kind", column.is_input ? "input" : "output"}});
  fmt::print(
      "{}\n",
      nlohmann::json{
          {"table", table.name}, {"about", table.about}, {"columns", columns}, {"rows", table.rows}}
          .dump(1));
}

}  // namespace

int print_golden_values(const Options& options) {
  const GoldenTable table = golden_values(options.file, options.count, options.seed);
  options.json ? print_json(table) : print_csv(table);
  return all_hold;
}

}  // namespace foldproof
