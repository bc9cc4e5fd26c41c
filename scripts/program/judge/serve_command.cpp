// foldproof serve: the reference behind the protocol of `judge`.

#include "scripts/program/command_line/options_of_commands.h"
#include "verification/subjects/served/reference_server.h"

namespace foldproof {

namespace {

struct ServeOptions : Options {
  std::string integrator = "C", precision = "f8";
  bool stands_still = false;
};

int serve(const ServeOptions& options) {
  if (options.stands_still) return serve_still();
  return serve_reference({options.integrator, options.precision == "f4"});
}

constexpr const char* below_serve =
    R"(Started by `judge`, `subject` or another program that speaks verification/subjects/PROTOCOL.md: it
reads from the descriptor FOLDPROOF_IN and writes to FOLDPROOF_OUT.

Examples:
  foldproof judge --solver "foldproof serve"
  foldproof judge --solver "foldproof serve --integrator A --precision f4"

Exit codes:
  0    asked to stop
  2    bad input, or no other program has started it)";

}  // namespace

void add_serve_command(CLI::App& app, Program& program) {
  auto [served, options] =
      add_command(app, program,
                  {"serve", "Answer the protocol of `judge` as the reference: `judge` starts this",
                   below_serve},
                  serve);
  add_value(served, "--integrator NAME", options.integrator, "One of `foldproof list integrators`",
            some_text("an integrator"))
      ->capture_default_str();
  add_value(served, "--precision TYPE", options.precision, "Number format of its answers: f8 or f4",
            one_of({"f8", "f4"}))
      ->capture_default_str();
  add_switch(served, "--still", options.stands_still,
             "Never move, and map each scene to its hash: what `list laws --freeze` keeps");
}

}  // namespace foldproof
