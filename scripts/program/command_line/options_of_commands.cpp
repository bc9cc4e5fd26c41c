#include "scripts/program/command_line/options_of_commands.h"

namespace foldproof {

CLI::App* add_subcommand(CLI::App& app, const CommandText& text) {
  CLI::App* command = app.add_subcommand(text.name, text.what);
  command->footer(text.below);
  command->group("Commands");
  return command;
}

void add_json(CLI::App* command, Options& options) {
  command->add_flag("--json", options.json, "Print JSON on standard output")
      ->disable_flag_override();
}

void add_seams(CLI::App* command, double& distance) {
  add_value(command, "--seams D", distance, "Join vertices of meshes within this distance [m]",
            positive_number());
}

CLI::Option* add_switch(CLI::App* command, const std::string& name, bool& value,
                        const std::string& what) {
  return command->add_flag(name, value, what)->disable_flag_override();
}

CLI::Option* add_folder(CLI::App* command, Options& options, const std::string& what) {
  return add_value(command, "--out DIR", options.out, what, some_text("a folder"));
}

void add_tier(CLI::App* command, Options& options) {
  add_value(command, "--tier TIER", options.tier, "quick (minutes) or full (hours)",
            one_of({"quick", "full"}))
      ->capture_default_str();
}

void add_overrides(CLI::App* command, Options& options) {
  add_value(command, "--set TABLE.KEY=VALUE", options.overrides,
            "Override a key of the case file, such as time.end=2, or unset it, such as "
            "object.fit=; may be given again",
            some_text("table.key=value"))
      ->allow_extra_args(false);
}

void add_cache(CLI::App* command, Options& options) {
  add_value(command, "--cache DIR", options.cache,
            "Keep the level sets of meshes in this folder for later runs; the results are "
            "the same to the bit",
            some_text("a folder"));
}

std::vector<CLI::Option*> add_frame_times(CLI::App* command, Options& options) {
  CLI::Option* times = command->add_option("--times", options.times,
                                           "Times of the frames [s], one a line (default: what "
                                           "a cache says, times.txt beside the frames, or what PLY "
                                           "files say)");
  times->type_name("FILE")->check(some_text("a file of times"));
  CLI::Option* rate = command->add_option("--rate", options.rate,
                                          "Frames a second; no number of a file may be missing");
  rate->type_name("FPS")->check(positive_number())->excludes(times);
  CLI::Option* start =
      command->add_option("--start", options.first_time, "Time of the first frame [s]");
  start->type_name("TIME")->check(finite_number())->needs(rate)->capture_default_str();
  return {times, rate, start};
}

void add_threads(CLI::App* command, Options& options, const std::string& what) {
  add_value(command, "--threads N", options.running.threads, what, whole_number(1, 1024));
}

void add_running(CLI::App* command, Options& options) {
  add_value(command, "--seed N", options.seed_shift,
            "Shift the seeds of all random samples, 0 to 1000000000; official results use 0",
            whole_number(0, 1'000'000'000))
      ->capture_default_str();
  add_threads(command, options, jobs_at_a_time);
  add_value(command, "--order N", options.running.order,
            "Shuffle the jobs, with N as the seed (default: the longest first)",
            whole_number(0, 1'000'000'000));
  add_resuming(command, options);
}

void add_resuming(CLI::App* command, Options& options) {
  CLI::Option* resume = add_switch(
      command, "--resume", options.resumes,
      "Go on with an interrupted run in the same folder; what it finished is not run again");
  add_switch(command, "--restart", options.restarts,
             "Start over; deletes what an interrupted run had finished")
      ->excludes(resume);
}

void add_out_if_typed(CLI::App* command, Options& options, const std::string& what) {
  add_folder(command, options, what);
  command->parse_complete_callback([&options, command] {
    if (command->count("--out") == 0) options.out = "";
  });
}

void add_solver_options(CLI::App* command, Options& options) {
  add_value(command, "--seconds S", options.patience,
            "Longest time without output during a call [s]", positive_number())
      ->capture_default_str();
  add_value(command, "--settings KEY=VALUE", options.settings,
            "Passed to the solver in every scene; may be given again", some_text("KEY=VALUE"))
      ->allow_extra_args(false);
}

CLI::Option* add_length(CLI::App* command, const std::string& name, double& value,
                        const std::string& what) {
  return command->add_option(name, value, what)->type_name("LENGTH")->check(finite_number());
}

/// The integrators to run; `usual` are those of a command without the option.
void add_method(CLI::App* command, Options& options, const std::string& usual) {
  add_value(command, "--method METHODS", options.methods,
            "Integrators: a list such as A,C,RK4, or all (default: " + usual + ")",
            some_text("integrators, or all"))
      ->delimiter(',')
      ->allow_extra_args(false);
}

void add_errors(CLI::App* command, Options& options, const std::string& what) {
  add_value(command, "--errors ERRORS", options.errors, what, positive_number())
      ->delimiter(',')
      ->allow_extra_args(false);
}

/// Another solver, whose steps are halved beside the reference's.
CLI::Option* add_other_solver(CLI::App* command, Options& options, const std::string& words) {
  CLI::Option* solver =
      add_value(command, "--solver CMD", options.solver, words, some_text("a command"));
  add_solver_options(command, options);
  for (const char* of_solver : {"--seconds", "--settings"})
    command->get_option(of_solver)->needs("--solver");
  return solver;
}

}  // namespace foldproof
