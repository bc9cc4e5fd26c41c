// A job that is a command of the program or a script, in a process of its own.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "convergence/campaigns/job_keys.h"
#include "scripts/program/campaign/run_job.h"
#include "scripts/program/provenance.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr size_t most_values = 2000;

/// A row: the command, and where it writes.
struct CampaignCommand {
  const char* name;
  bool is_script;     // of scripts/, which writes its answer with --out; not of the program
  bool writes_files;  // which are not kept
};

constexpr CampaignCommand commands[] = {
    {"simulate", false, true}, {"converge", false, true}, {"precision", false, true},
    {"check", false, false},   {"study", false, false},   {"judge", false, false},
    {"ablate", false, true},   {"faults", true, false},   {"mutate", true, false}};

const CampaignCommand& command_named(const std::string& name) {
  return *std::ranges::find(commands, name, &CampaignCommand::name);
}

/// The words of the command, the first a path. folder: for its output.
std::vector<std::string> words_of(const CampaignCommand& command,
                                  const std::vector<Assignment>& set, const std::string& folder) {
  std::vector<std::string> words = {program_file(), command.name}, options;
  if (command.is_script) words = {source_folder() + "/scripts/" + command.name};
  if (!fs::exists(words[0]))
    throw InputError(fmt::format("{}: is missing; a campaign of '{}' needs the source tree",
                                 words[0], command.name));
  for (const Assignment& a : set) {
    if (a.key == "case" || a.key == "name")
      words.push_back(a.value);
    else if (a.key.starts_with("settings."))
      options.insert(options.end(), {"--settings", a.key.substr(9) + "=" + a.value});
    else if (a.key.find('.') != std::string::npos)
      options.insert(options.end(), {"--set", a.key + "=" + a.value});
    else
      options.insert(options.end(), {"--" + a.key, a.value});
  }
  words.insert(words.end(), options.begin(), options.end());
  if (command.writes_files) words.insert(words.end(), {"--out", folder + "/files"});
  if (command.is_script)
    words.insert(words.end(), {"--out", folder + "/answer.json"});
  else
    words.push_back("--json");
  return words;
}

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
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
  for (const auto& [name, descriptor] : {std::pair("/out", 1), {"/err", 2}})
    dup2(open((folder + name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), descriptor);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  _exit(127);
}

}  // namespace

std::vector<std::string> campaign_commands() {
  std::vector<std::string> names;
  for (const CampaignCommand& command : commands) names.emplace_back(command.name);
  return names;
}

std::string script_digest(const std::string& run) {
  std::string digest;
  if (command_named(run).is_script)
    for (const char* folder : {"/verification/faults", "/scripts", "/scripts/tests"})
      digest += folder_digest(source_folder() + folder);
  return digest;
}

JobAnswer command_job(const BatchTerms& terms, const BatchJob& job) {
  const std::string folder =
      fs::temp_directory_path() / fmt::format("foldproof-{}-{}", job.key, getpid());
  fs::create_directories(folder);
  const CampaignCommand& command = command_named(terms.run);
  const std::vector<std::string> words = words_of(command, job.set, folder);
  const pid_t child = fork();
  if (child == 0) become(words, folder);
  int status = 0;
  struct rusage use = {};
  if (child < 0 || wait4(child, &status, 0, &use) != child)
    throw std::runtime_error("no process can be made for a job");
  JobAnswer answer;
  JobResult& result = answer.result;
  result.seconds = double(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
                   1e-6 * double(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
  const std::string errors = text_in(folder + "/err"),
                    printed = text_in(folder + (command.is_script ? "/answer.json" : "/out"));
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
