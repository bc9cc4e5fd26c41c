#include "scripts/program/pages/report_script.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "scripts/program/data_folder.h"
#include "scripts/program/options.h"
#include "scripts/program/progress.h"

namespace foldproof {

namespace {

constexpr int not_started = 127;  // as a shell says it

/// Debian's, or that of the wheel. It is called by its full path: from a bare name it would look
/// for its packages beside the first python3 on the PATH.
std::string python_file() {
  const char* const of_wheel = std::getenv("FOLDPROOF_PYTHON");
  return of_wheel ? of_wheel : "/usr/bin/python3";
}

}  // namespace

int run_report_script(const std::string& makes, const std::string& script,
                      const std::vector<std::string>& arguments, bool compares) {
  const std::string path = data_folder() + "/reports/" + script;
  const std::string python = python_file();
  std::vector<char*> words = {const_cast<char*>(python.c_str()), const_cast<char*>(path.c_str())};
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    execv(words[0], words.data());
    _exit(not_started);
  }
  int status = 0;
  const bool has_ended = child > 0 && waitpid(child, &status, 0) > 0 && WIFEXITED(status);
  if (has_ended && WEXITSTATUS(status) == all_hold) return all_hold;
  if (has_ended && compares && WEXITSTATUS(status) == some_fail) return some_fail;
  if (has_ended && WEXITSTATUS(status) == bad_input) return bad_input;  // it said why
  log_line("the " + makes + " could not be made: " +
           (has_ended && WEXITSTATUS(status) == not_started
                ? python + " is missing; install the Debian package python3"
                : path + " did not finish"));
  return bad_input;
}

void add_option(std::vector<std::string>& arguments, const std::string& option,
                const std::string& value) {
  if (value.empty()) return;
  arguments.push_back(option);
  arguments.push_back(value);
}

}  // namespace foldproof
