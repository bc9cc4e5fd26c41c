// foldproof subject: whether an adapter keeps to the protocol.

#include <fmt/format.h>

#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/typed_solver.h"
#include "verification/subjects/suite/conformance.h"

namespace foldproof {

namespace {

int check_subject(const Options& options) {
  const char* const words[] = {"kept", "declined", "BROKEN"};
  bool is_broken = false;
  for (const ConformanceRow& row : check_conformance(solver_command(options))) {
    fmt::print("{:<9} {:<44} {}\n", words[int(row.conformity)], row.demand, row.note);
    is_broken |= row.conformity == Conformity::broken;
  }
  fmt::print("{}\n", is_broken ? "the adapter does not keep to the protocol"
                               : "the adapter keeps to the protocol");
  return is_broken ? some_fail : all_hold;
}

constexpr const char* below_subject =
    R"(Calls each operation of the declared level once, on a small sheet.

Examples:
  foldproof subject --check "/usr/bin/python3 verification/subjects/adapters/toy_solver.py"
  (in a clone; needs the Debian package python3-numpy)

Exit codes:
  0    the adapter keeps to the protocol
  1    the adapter breaks the protocol; the message names the first violation
  2    bad input)";

}  // namespace

void add_subject_command(CLI::App& app, Program& program) {
  auto [subject, options] =
      add_command(app, program,
                  {"subject", "Test whether a solver's adapter keeps to the protocol of `judge`",
                   below_subject},
                  check_subject);
  add_value(subject, "--check CMD", options.solver, "Command that starts the adapter",
            some_text("a command"))
      ->required();
  add_solver_options(subject, options);
}

}  // namespace foldproof
