#include "scripts/program/campaign/slurm.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>

#include "reference/types.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/provenance.h"
#include "verification/files/atomic_file.h"

namespace foldproof {

namespace {

// of work for each core [s]: long against the second or two that Slurm takes to start a slice
constexpr double shortest_slice = 30, longest_slice = 120;
constexpr double usual_slice = 50;  // jobs for each core, where their time is not known
constexpr std::chrono::seconds until_a_ghost(120);

struct Output {
  int code;
  std::string text;  // of both streams
};

Output output_of(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe) throw std::runtime_error(command + ": cannot be started");
  Output output{0, ""};
  char piece[4096];
  for (size_t count; (count = fread(piece, 1, sizeof piece, pipe)) > 0;)
    output.text.append(piece, count);
  const int status = pclose(pipe);
  output.code = WIFEXITED(status) ? WEXITSTATUS(status) : 255;
  return output;
}

/// Throws InputError with the first line of what it says, unless it exits with 0.
void require(const std::string& command, const std::string& hint = "") {
  const Output output = output_of(command);
  if (output.code != 0)
    throw InputError(command.substr(0, command.find(' ')) + ": " +
                     output.text.substr(0, output.text.find('\n')) + hint);
}

/// A number of Slurm's configuration.
double configured(const std::string& name, double otherwise) {
  const std::string text = output_of("scontrol show config").text;
  const size_t at = text.find("\n" + name + " ");
  const size_t equals = at == std::string::npos ? at : text.find('=', at);
  return equals == std::string::npos ? otherwise : std::max(1.0, std::atof(&text[equals + 1]));
}

/// What an option of sbatch is given, as --name=VALUE, --name VALUE, -nVALUE or -n VALUE; "" if
/// it is not there.
std::string value_of_option(const std::string& options, const std::string& name,
                            const std::string& letter) {
  std::istringstream words(options);
  for (std::string word, next; words >> word;) {
    if (word == name || word == letter) return words >> next ? next : "";
    if (word.starts_with(name + "=")) return word.substr(name.size() + 1);
    if (word.starts_with(letter) && !word.starts_with("--")) return word.substr(letter.size());
  }
  return "";
}

struct Cores {
  double all = 0, of_a_slice = 1;
};

/// Of the partition that the options name, or of all that is there; of nodes of different sizes the
/// smallest counts.
Cores cores_for(const std::string& options) {
  const std::string partition = value_of_option(options, "--partition", "-p");
  const Output output =
      output_of("sinfo -h -o '%D %c'" + (partition.empty() ? "" : " -p " + shell_word(partition)));
  Cores cores;
  double smallest = 0;
  std::istringstream lines(output.code == 0 ? output.text : "");
  for (std::string line; std::getline(lines, line);) {
    long nodes = 0, cores_of_one = 0;
    if (std::sscanf(line.c_str(), "%ld %ld", &nodes, &cores_of_one) != 2 || cores_of_one < 1)
      continue;
    cores.all += double(nodes * cores_of_one);
    smallest = smallest == 0 ? double(cores_of_one) : std::min(smallest, double(cores_of_one));
  }
  cores.all = std::max(cores.all, 1.0);
  const double asked = std::atof(value_of_option(options, "--cpus-per-task", "-c").c_str());
  if (asked > 0)
    cores.of_a_slice = asked;
  else if (options.find("--exclusive") != std::string::npos && smallest > 0)
    cores.of_a_slice = smallest;
  return cores;
}

std::string job_name(const Batch& batch) { return shell_word("foldproof:" + batch.name); }

/// What each element runs.
std::string script_of(const Batch& batch, const SlurmSettings& settings) {
  std::string work = fmt::format(
      "{} campaign work {} --slice $SLURM_ARRAY_TASK_ID --threads \"${{SLURM_CPUS_ON_NODE:-1}}\"",
      shell_word(program_file()), shell_word(batch.folder));
  if (!settings.cache.empty()) work += " --cache " + shell_word(settings.cache);
  if (!settings.scratch.empty()) work += " --scratch " + shell_word(settings.scratch);
  return "#!/bin/sh\nexec " + work + "\n";
}

/// Whether no one has worked on a slice for a while, though Slurm has it as running or completing:
/// where a slice's process and what would report its end die together, Slurm may not notice, nor
/// ever be rid of it.
bool is_a_ghost(const Batch& batch, size_t slice) {
  static std::map<std::string, std::chrono::steady_clock::time_point> idle_since;
  const std::string lock = lock_of_slice(batch, slice);
  const auto now = std::chrono::steady_clock::now();
  if (!FileLock::is_held(lock))
    return now - idle_since.try_emplace(lock, now).first->second > until_a_ghost;
  idle_since.erase(lock);
  return false;
}

}  // namespace

std::string slurm_missing() {
  const Output output = output_of("command -v sbatch squeue scancel scontrol");
  return output.code == 0 ? "" : "sbatch, squeue, scancel or scontrol is not installed here";
}

size_t slurm_most_slices() {
  return size_t(std::max(
      1.0, std::min(configured("MaxArraySize", 1000), configured("MaxJobCount", 10'000) / 2)));
}

size_t slurm_jobs_a_slice(size_t jobs, double seconds, const std::string& options) {
  const Cores cores = cores_for(options);
  const double each = double(jobs) / cores.all;  // jobs of a core, shared out evenly
  double a_core = std::min(usual_slice, each);
  if (seconds > 0) a_core = std::clamp(each, shortest_slice / seconds, longest_slice / seconds);
  // jobs for every core of a slice, and slices that fit into one array
  const double least = std::max(cores.of_a_slice, double(jobs) / double(slurm_most_slices()));
  return size_t(std::max({1.0, std::ceil(least), std::round(a_core * cores.of_a_slice)}));
}

void slurm_submit(const Batch& batch, const SlurmSettings& settings) {
  const std::string script = batch.folder + "/slurm.sh";
  write_text(script, script_of(batch, settings));
  require(fmt::format("sbatch --parsable --requeue --open-mode=append --signal=B:TERM@30 "
                      "--job-name={} --output={} --array=0-{} {} {}",
                      job_name(batch), shell_word(batch.folder + "/slurm-%a.log"), batch.slices - 1,
                      settings.options, shell_word(script)),
          "; does `sinfo` show a partition that is up?");
}

bool slurm_has(const Batch& batch) {
  const Output output = output_of("squeue -h -r -o '%i %K %T %r' --name=" + job_name(batch));
  if (output.code != 0) return true;
  std::istringstream lines(output.text);
  size_t alive = 0;
  for (std::string line; std::getline(lines, line);) {
    std::string element, state;
    size_t slice = 0;
    std::istringstream(line) >> element >> slice >> state;
    // an element whose node failed at its start waits for someone to release it
    if (line.find("held") != std::string::npos || line.find("Held") != std::string::npos)
      static_cast<void>(output_of("scontrol release " + element));
    const bool is_placed = state == "RUNNING" || state == "COMPLETING";
    if (!is_placed || !is_a_ghost(batch, slice)) ++alive;
  }
  if (alive == 0 && !output.text.empty()) slurm_cancel(batch);  // none may wake later
  return alive > 0;
}

void slurm_cancel(const Batch& batch) { require("scancel --name=" + job_name(batch)); }

}  // namespace foldproof
