#include "scripts/program/campaign/command_job.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "scripts/program/campaign/scripted.h"
#include "scripts/program/provenance.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr size_t most_values = 2000;

/// What depends on the machine and the moment, and is no value of the question.
bool is_circumstance(const std::string& name) {
  for (const char* one : {"seconds", "date", "program", "cpu", "command", "peak_memory", "cores"})
    if (name == one) return true;
  return false;
}

void add_numbers(const json& value, const std::string& name, std::map<std::string, double>& to) {
  if (to.size() >= most_values) return;
  if (value.is_number()) to[name] = value.get<double>();
  if (value.is_boolean()) to[name] = value.get<bool>();
  const std::string prefix = name.empty() ? "" : name + ".";
  if (value.is_object())
    for (const auto& [key, below] : value.items())
      if (!is_circumstance(key)) add_numbers(below, prefix + key, to);
  if (!value.is_array()) return;
  for (size_t k = 0; k < value.size(); ++k) {
    const bool is_named =
        value[k].is_object() && value[k].contains("name") && value[k]["name"].is_string();
    add_numbers(value[k],
                prefix + (is_named ? value[k]["name"].get<std::string>() : std::to_string(k)), to);
  }
}

std::string text_in(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string last_line_of(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

/// What a command that answered "1" found amiss: findings that do not hold, else its last words.
std::string failure_of(const json& answer, const std::string& errors) {
  std::string names;
  if (answer.is_object() && answer.contains("findings") && answer["findings"].is_array())
    for (const json& finding : answer["findings"])
      for (const char* outcome : {"fails", "inconclusive"})
        if (finding.is_object() && finding.value("outcome", json()) == outcome)
          names += (names.empty() ? "" : ", ") + finding.value("name", "");
  if (names.empty()) names = last_line_of(errors);
  return names.empty() ? "exit code 1" : names;
}

/// Becomes the command. Its output goes to files, for a pipe could fill up.
[[noreturn]] void become(const std::vector<std::string>& words, const std::string& folder) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const auto& [name, descriptor] : {std::pair("/out", 1), {"/err", 2}})
    dup2(open((folder + name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), descriptor);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  _exit(127);
}

int wait_for(pid_t child, const Progress& progress) {
  for (;;) {
    int status = 0;
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) return status;
    usleep(5000);
    try {
      progress(0);
    } catch (...) {  // interrupted: the command with it
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      throw;
    }
  }
}

double child_seconds() {
  struct rusage use = {};
  getrusage(RUSAGE_CHILDREN, &use);
  return double(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
         1e-6 * double(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
}

}  // namespace

JobAnswer command_job(const BatchTerms& terms, const BatchJob& job, const Progress& progress) {
  const std::string folder =
      (fs::temp_directory_path() / ("foldproof-" + job.key + "-" + std::to_string(getpid())))
          .string();
  fs::create_directories(folder);
  const ScriptedCommand command = scripted_command(terms.run, job.set, folder);
  const double before = child_seconds();
  const pid_t child = fork();
  if (child == 0) become(command.words, folder);
  if (child < 0) throw std::runtime_error("no process can be made for a job");
  const int status = wait_for(child, progress);
  JobAnswer answer;
  JobResult& result = answer.result;
  result.seconds = child_seconds() - before;
  const std::string errors = text_in(folder + "/err"), printed = text_in(command.answer);
  fs::remove_all(folder);
  if (WIFSIGNALED(status)) throw JobDied{};
  const int code = WEXITSTATUS(status);
  result.end = code == 0 ? JobEnd::holds : code == 1 ? JobEnd::fails : JobEnd::refused;
  const json values = json::parse(printed, nullptr, false);
  if (code != 0) result.reason = code == 1 ? failure_of(values, errors) : last_line_of(errors);
  if (!values.is_discarded()) add_numbers(values, "", result.values);
  result.values["exit_code"] = code;
  for (const auto& [name, value] : result.values) answer.units[name] = "1";
  return answer;
}

}  // namespace foldproof
