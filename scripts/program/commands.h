// The commands of the program, one function each; all return the exit code.
#pragma once

#include "scripts/program/options.h"

namespace foldproof {

int list(const Options& options);           // list_command.cpp
int simulate_case(const Options& options);  // simulate_command.cpp
int ablate(const Options& options);         // ablate_command.cpp
int converge(const Options& options);       // converge_command.cpp
int precision(const Options& options);      // precision_command.cpp
int project_run(const Options& options);    // project_command.cpp
int smooth_run(const Options& options);     // smooth_command.cpp
int inspect(const Options& options);        // inspect_command.cpp
int run_checks(const Options& options);
int run_studies(const Options& options);
int verify(const Options& options);
int make_report(const Options& options);  // report_commands.cpp, as the next three
int show_history(const Options& options);
int make_film(const Options& options);
int export_frames(const Options& options);
int evaluate_hinges(const Options& options);
int print_golden_values(const Options& options);
int run_bench(const Options& options);
int show_crossings(const Options& options);  // crossings_command.cpp
int compare_frames(const Options& options);  // compare_command.cpp
int evaluate_queries(const Options& options);
int judge_another_solver(const Options& options);    // judge_command.cpp, as the next two
int judge_frames_of_a_case(const Options& options);  // judge_frames_command.cpp
int check_subject(const Options& options);
int serve(const Options& options);
int show_claims(const Options& options);  // claims_command.cpp

}  // namespace foldproof
