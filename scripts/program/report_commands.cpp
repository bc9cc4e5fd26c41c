#include "scripts/program/report_commands.h"

#include <sys/wait.h>
#include <unistd.h>

#include "scripts/program/commands.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/progress.h"

namespace foldproof {

namespace {

constexpr int not_started = 127;  // as a shell says it

void add(std::vector<std::string>& arguments, const std::string& option, const std::string& value) {
  if (value.empty()) return;
  arguments.push_back(option);
  arguments.push_back(value);
}

}  // namespace

int run_report_script(const std::string& makes, const std::string& script,
                      const std::vector<std::string>& arguments) {
  const std::string path = data_folder() + "/reports/" + script;
  std::vector<char*> words = {const_cast<char*>("python3"), const_cast<char*>(path.c_str())};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    execv("/usr/bin/python3", words.data());
    _exit(not_started);
  }
  int status = 0;
  const bool has_ended = child > 0 && waitpid(child, &status, 0) > 0 && WIFEXITED(status);
  if (has_ended && WEXITSTATUS(status) == all_hold) return all_hold;
  if (has_ended && WEXITSTATUS(status) == bad_input) return bad_input;  // it said why
  say("the " + makes + " could not be made: " +
      (has_ended && WEXITSTATUS(status) == not_started ? "/usr/bin/python3 cannot be started"
                                                       : path + " did not come to its end"));
  return bad_input;
}

int make_report(const Options& options) {
  std::vector<std::string> arguments = options.names;
  if (options.pdf) arguments.push_back("--pdf");
  if (options.papers) arguments.push_back("--papers");
  return run_report_script("report", "make_report.py", arguments);
}

int make_film(const Options& options) {
  std::vector<std::string> arguments = {options.file};
  add(arguments, "--out", options.out);
  add(arguments, "--field", options.field);
  add(arguments, "--size", options.size);
  add(arguments, "--fps", options.fps);
  return run_report_script("film", "make_film.py", arguments);
}

int export_frames(const Options& options) {
  return run_report_script("files", "export.py",
                           {options.file, "--format", options.kind, "--out", options.out});
}

}  // namespace foldproof
