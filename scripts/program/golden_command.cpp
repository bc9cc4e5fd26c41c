// foldproof golden: inputs and outputs of the paper's formulas, for unit tests of other codes.

#include <nlohmann/json.hpp>

#include "scripts/program/command_line/options_of_commands.h"
#include "verification/oracles/golden.h"

namespace foldproof {

namespace {

struct GoldenOptions : Options {
  int count = 10;     // rows
  unsigned seed = 1;  // of the inputs
};

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

int print_golden_values(const GoldenOptions& options) {
  const GoldenTable table = golden_values(options.file, options.count, options.seed);
  options.json ? print_json(table) : print_csv(table);
  return all_hold;
}

constexpr const char* below_golden =
    R"(Prints a heading, then rows of numbers to 17 digits; a vector has three columns, NAME_x, NAME_y and
NAME_z. --json adds the formula, and each column's meaning and unit. All outputs are computed with
50 digits and rounded once. verification/GOLDEN.md has examples in Python and C++.

Examples:
  foldproof golden friction --count 100
  foldproof golden bending --count 5 --seed 3 --json

Exit codes:
  0    printed
  2    bad input)";

}  // namespace

void add_golden_command(CLI::App& app, Program& program) {
  auto [golden, options] = add_command(
      app, program,
      {"golden", "Print inputs and correctly rounded outputs of a formula, for your unit tests",
       below_golden},
      print_golden_values);
  golden
      ->add_option("TABLE", options.file,
                   "bending, springs, integrator, forecast, friction, projection or sticking")
      ->required()
      ->check(one_of(golden_names()));
  add_value(golden, "--count N", options.count, "Rows", whole_number(1, 1'000'000'000))
      ->capture_default_str();
  add_value(golden, "--seed N", options.seed,
            "Seed of the inputs; the same seed gives the same rows", whole_number(0, 4'294'967'295))
      ->capture_default_str();
  add_json(golden, options);
}

}  // namespace foldproof
