// foldproof evaluate: a formula on your numbers.

#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/options_of_commands.h"
#include "verification/subjects/bending_rows.h"
#include "verification/subjects/crossing_queries.h"

namespace foldproof {

namespace {

struct BendingOptions : Options {
  std::string rest_file;
};

struct QueryOptions : Options {
  std::string kind;    // of pair
  double keep = 1e-6;  // m
};

int evaluate_hinges(const BendingOptions& options) {
  require_input(options.file, table_kind);
  if (!options.rest_file.empty()) require_input(options.rest_file, table_kind);
  evaluate_bending(options.file, options.rest_file);
  return all_hold;
}

int evaluate_queries(const QueryOptions& options) {
  if (!std::filesystem::is_directory(options.file)) require_input(options.file, table_kind);
  return evaluate_crossings(options.file, options.kind, options.keep) ? all_hold : some_fail;
}

constexpr const char* below_evaluate =
    R"(Examples:
  foldproof evaluate bending cases/hinges.csv
  foldproof evaluate crossings --help                  the format of a file of queries

Exit codes:
  0    evaluated, and nothing disagrees
  1    crossings: something disagrees with the file
  2    bad input)";

constexpr const char* below_evaluate_bending =
    R"(Prints the bending forces of single hinges, for comparison with your code. Each row of FILE has 27
comma-separated numbers: x1 x2 x3 x4 (12 position components [m]), v1 v2 v3 v4 (12 velocity
components [m/s]), ke [J], kd [N s], theta0 [rad]. Output: 12 elastic and 12 damping force
components [N] to 17 digits. The weight |E|^2/(|N1|+|N2|) is computed at the current positions, or
with --rest at the rest positions, in rows of 12 numbers.

Examples:
  foldproof evaluate bending cases/hinges.csv

Exit codes:
  0    printed
  2    bad input; the line is named)";

constexpr const char* below_evaluate_crossings =
    R"(A row of FILE is a point, in integers: numerator and denominator of x, y and z, then 1 if the
features of this query meet, else 0. Eight rows are a query: four points at the start of a motion
along straight lines, then the same four at its end. vertex-face: the vertex, then the triangle's
corners. edge-edge: the ends of the first edge, then of the second.

Examples:
  foldproof evaluate crossings queries.csv --kind vertex-face
  foldproof evaluate crossings queries/edge-edge --keep 1e-5

Exit codes:
  0    the reference misses no meeting, and the exact judge agrees with the file
  1    the reference misses a meeting, or the exact judge disagrees with the file
  2    bad input; the line is named)";

void add_bending(CLI::App& evaluate, Program& program) {
  auto [bending, options] =
      add_command(evaluate, program,
                  {"bending", "Forces of single hinges from a CSV file", below_evaluate_bending},
                  evaluate_hinges);
  add_input(bending, "FILE", options.file, "CSV, 27 columns");
  add_value(bending, "--rest FILE", options.rest_file,
            "CSV, 12 columns: rest positions [m], for rest weighting", some_text("a file"));
}

void add_queries(CLI::App& evaluate, Program& program) {
  auto [queries, options] =
      add_command(evaluate, program,
                  {"crossings",
                   "Do moving features meet? Compare the reference and the exact judge with a file",
                   below_evaluate_crossings},
                  evaluate_queries);
  add_input(queries, "FILE,--ccd-data", options.file,
            "CSV file with 7 columns and 8 rows a query, or a folder of such files")
      ->type_name("FILE");
  add_value(queries, "--kind KIND", options.kind,
            "vertex-face or edge-edge (default: as the path says)",
            one_of({"vertex-face", "edge-edge"}));
  add_length(queries, "--keep", options.keep, "Clearance that the reference should keep [m]")
      ->capture_default_str();
}

}  // namespace

void add_evaluate_command(CLI::App& app, Program& program) {
  CLI::App* evaluate =
      add_subcommand(app, {"evaluate", "Evaluate a formula on your numbers", below_evaluate});
  evaluate->require_subcommand(0, 1);
  add_bending(*evaluate, program);
  add_queries(*evaluate, program);
}

}  // namespace foldproof
