#include "scripts/program/campaign/slurm.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "reference/types.h"
#include "scripts/program/campaign/slice_mark.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"

namespace foldproof {

namespace {

// of work for each core [s]: long against the second or two that Slurm takes to start a slice
constexpr double shortest_slice = 30, longest_slice = 120;
constexpr std::chrono::seconds until_a_ghost(120);  // sixty renewals of a mark that did not come
constexpr size_t usual_slice = 50;  // jobs for each core, where their time is not known

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

/// A number of Slurm's configuration.
size_t configured(const std::string& name, size_t otherwise) {
  const std::string text = output_of("scontrol show config").text;
  const size_t at = text.find("\n" + name + " ");
  const size_t equals = at == std::string::npos ? at : text.find('=', at);
  return equals == std::string::npos ? otherwise
                                     : size_t(std::max(1L, std::atol(&text[equals + 1])));
}

/// Elements of one array: MaxArraySize is one more than the highest index.
size_t largest_array() { return configured("MaxArraySize", 1000); }

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

/// What a batch may count on.
struct Cluster {
  size_t cores = 1, cores_a_slice = 1;
  size_t most_slices = 100'000;
};

/// Of the partition that the options name, or of all that is there; of nodes of different sizes the
/// smallest counts. Half of the jobs that the controller keeps are left to others.
Cluster cluster_for(const std::string& options) {
  const std::string partition = value_of_option(options, "--partition", "-p");
  const Output output =
      output_of("sinfo -h -o '%D %c'" + (partition.empty() ? "" : " -p " + shell_word(partition)));
  Cluster cluster{
      0, 1, std::clamp(configured("MaxJobCount", 10'000) / 2, size_t(1), Cluster().most_slices)};
  size_t smallest = 0;
  std::istringstream lines(output.code == 0 ? output.text : "");
  for (std::string line; std::getline(lines, line);) {
    long nodes = 0, cores = 0;
    if (std::sscanf(line.c_str(), "%ld %ld", &nodes, &cores) != 2 || nodes < 1 || cores < 1)
      continue;
    cluster.cores += size_t(nodes * cores);
    smallest = smallest == 0 ? size_t(cores) : std::min(smallest, size_t(cores));
  }
  cluster.cores = std::max(cluster.cores, size_t(1));
  const long asked = std::atol(value_of_option(options, "--cpus-per-task", "-c").c_str());
  if (asked > 0)
    cluster.cores_a_slice = size_t(asked);
  else if (options.find("--exclusive") != std::string::npos && smallest > 0)
    cluster.cores_a_slice = smallest;
  return cluster;
}

std::string job_name(const Batch& batch) { return "foldproof:" + batch.name; }

/// What each element runs. The offset is where the array's first slice is.
std::string script_of(const Batch& batch, const EngineSettings& settings) {
  std::string work = fmt::format(
      "{} campaign work {} --slice $((SLURM_ARRAY_TASK_ID + $1)) --threads "
      "\"${{SLURM_CPUS_ON_NODE:-1}}\"",
      shell_word(program_file()), shell_word(batch.folder));
  if (!settings.work.cache.empty()) work += " --cache " + shell_word(settings.work.cache);
  if (!settings.scratch.empty()) work += " --scratch " + shell_word(settings.scratch);
  return "#!/bin/sh\nexec " + work + "\n";
}

std::string array_of(size_t count, size_t at_a_time) {
  const std::string all = fmt::format("0-{}", count - 1);
  return at_a_time > 0 ? fmt::format("{}%{}", all, at_a_time) : all;
}

/// Puts one array into the queue and returns its number.
std::string submit_array(const Batch& batch, const EngineSettings& settings, size_t first,
                         size_t count) {
  const Output output =
      output_of(fmt::format("sbatch --parsable --requeue --open-mode=append --signal=B:TERM@30 "
                            "--job-name={} --output={} --array={} {} {} {}",
                            shell_word(job_name(batch)), shell_word(batch.folder + "/slurm-%a.log"),
                            array_of(count, settings.at_a_time), settings.options,
                            shell_word(batch.folder + "/slurm.sh"), first));
  const std::string number = output.text.substr(0, output.text.find_first_of(";\n"));
  if (output.code != 0 || number.find_first_not_of("0123456789") != std::string::npos)
    throw InputError("sbatch: " + output.text.substr(0, output.text.find('\n')) +
                     "; does `sinfo` show a partition that is up?");
  return number;
}

/// The slice of an element, as 21_7 of the arrays 21+0,22+1000; none for another batch's.
std::optional<size_t> slice_of(const Batch& batch, const std::string& element) {
  long job = 0, index = 0;
  if (std::sscanf(element.c_str(), "%ld_%ld", &job, &index) != 2) return {};
  std::istringstream arrays(batch.handle);
  for (std::string array; std::getline(arrays, array, ',');) {
    long number = 0, first = 0;
    if (std::sscanf(array.c_str(), "%ld+%ld", &number, &first) == 2 && number == job)
      return size_t(first + index);
  }
  return {};
}

/// Whether Slurm believes that the element runs, though no one works on its slice: where a node's
/// daemon and a slice's process die together, and the controller with them, Slurm may not notice.
/// Remembers since when this process has seen each mark as it is.
bool is_a_ghost(const Batch& batch, const std::string& element) {
  struct Seen {
    std::string mark;
    std::chrono::steady_clock::time_point since;
  };
  static std::map<std::string, Seen> seen;
  const std::optional<size_t> slice = slice_of(batch, element);
  if (!slice) return false;
  const auto now = std::chrono::steady_clock::now();
  const std::string mark = mark_of_slice(batch, *slice);
  const auto [of, is_new] = seen.try_emplace(batch.name + " " + element, Seen{mark, now});
  if (is_new || of->second.mark != mark) of->second = {mark, now};
  if (now - of->second.since < until_a_ghost) return false;
  seen.erase(of);  // looked at anew after it was requeued
  return true;
}

}  // namespace

std::string slurm_missing() {
  const Output output = output_of("command -v sbatch squeue scancel scontrol");
  return output.code == 0 ? "" : "sbatch, squeue, scancel or scontrol is not installed here";
}

size_t slurm_jobs_a_slice(size_t jobs, double seconds, const EngineSettings& settings) {
  const Cluster cluster = cluster_for(settings.options);
  const double cores = double(cluster.cores_a_slice);
  const double each = double(jobs) / double(cluster.cores);  // jobs of a core, shared out evenly
  double a_core = std::min(double(usual_slice), each);
  if (seconds > 0) a_core = std::clamp(each, shortest_slice / seconds, longest_slice / seconds);
  // so many slices at most, and jobs for every core of a slice
  const double least = std::max(cores, double(jobs) / double(cluster.most_slices));
  return size_t(std::max({1.0, std::ceil(least), std::round(a_core * cores)}));
}

void slurm_submit(Batch& batch, const EngineSettings& settings,
                  const std::function<void(size_t)>& show) {
  const std::string path = batch.folder + "/slurm.sh";
  if (!(std::ofstream(path) << script_of(batch, settings)).flush())
    throw std::runtime_error(path + ": cannot be written");
  const size_t most = largest_array();
  for (size_t first = 0; first < batch.slices; first += most) {
    const size_t count = std::min(most, batch.slices - first);
    batch.handle += fmt::format("{}{}+{}", batch.handle.empty() ? "" : ",",
                                submit_array(batch, settings, first, count), first);
    write_terms(batch);
  }
  show(0);
}

BatchState slurm_ask(const Batch& batch) {
  const Output output =
      output_of("squeue -h -r -o '%i %T %r' --name=" + shell_word(job_name(batch)));
  if (output.code != 0) return BatchState::unknown;
  std::istringstream lines(output.text);
  bool is_there = false;
  for (std::string line; std::getline(lines, line); is_there = true) {
    const std::string element = line.substr(0, line.find(' '));
    // an element whose node failed at its start waits for someone to release it
    if (line.find("held") != std::string::npos || line.find("Held") != std::string::npos)
      static_cast<void>(output_of("scontrol release " + element));
    if (line.find(" RUNNING ") != std::string::npos && is_a_ghost(batch, element))
      static_cast<void>(output_of("scontrol requeue " + element));
  }
  return is_there ? BatchState::runs : BatchState::has_ended;
}

void slurm_cancel(const Batch& batch) {
  const Output output = output_of("scancel --name=" + shell_word(job_name(batch)));
  if (output.code != 0)
    throw InputError("scancel: " + output.text.substr(0, output.text.find('\n')));
}

}  // namespace foldproof
