// foldproof bench: speed and memory.

#include "scripts/program/bench/bench.h"
#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/listing.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_all.h"
#include "verification/files/verdicts_file.h"

namespace foldproof {

namespace {

struct BenchOptions : Options {
  bool quick = false;  // up to 100k particles instead of a million
};

int run_bench(const BenchOptions& options) {
  const OutFolder folder(options.out);
  RunRecord run = bench(options.quick ? 110'000 : 1'100'000);
  run.provenance = provenance(options.command);
  write_run(options.out + "/bench.h5", run);
  if (options.json)
    fmt::print("{}", verdicts_json(run));
  else
    fmt::print("{}", listing(run));
  return all_hold;
}

constexpr const char* below_bench =
    R"(Examples:
  foldproof bench --quick

Exit codes:
  0    measured; the numbers do not matter
  2    bad input, or a file that cannot be written)";

}  // namespace

void add_bench_command(CLI::App& app, Program& program) {
  auto [speed, options] = add_command(
      app, program, {"bench", "Measure speed and memory; writes bench.h5", below_bench}, run_bench);
  add_switch(speed, "--quick", options.quick, "Up to 100k particles instead of a million");
  add_folder(speed, options, "Folder for results")->capture_default_str();
  add_json(speed, options);
}

}  // namespace foldproof
