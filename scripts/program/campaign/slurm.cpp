#include "scripts/program/campaign/slurm.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "reference/types.h"
#include "scripts/program/command_line/typed_command.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"

namespace foldproof {

namespace {

constexpr double seconds_a_slice = 120;  // long against the second or two that Slurm takes to start
constexpr size_t usual_slice = 50;       // jobs, where their time is not known

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

/// Elements of one array: MaxArraySize is one more than the highest index.
size_t largest_array() {
  const std::string text = output_of("scontrol show config").text;
  const size_t at = text.find("MaxArraySize");
  const size_t equals = at == std::string::npos ? at : text.find('=', at);
  return equals == std::string::npos ? 1000 : size_t(std::max(1L, std::atol(&text[equals + 1])));
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

}  // namespace

std::string slurm_missing() {
  const Output output = output_of("command -v sbatch squeue scancel scontrol");
  return output.code == 0 ? "" : "sbatch, squeue, scancel or scontrol is not installed here";
}

size_t slurm_jobs_a_slice(size_t jobs, double seconds) {
  const double of_time =
      seconds > 0 ? std::max(1.0, std::floor(seconds_a_slice / seconds)) : double(usual_slice);
  // a million jobs of a millisecond are still a thousand slices
  return size_t(std::clamp(of_time, std::max(1.0, double(jobs) / 100'000), 10'000.0));
}

void slurm_submit(Batch& batch, const EngineSettings& settings,
                  const std::function<void(size_t)>& show) {
  const std::string path = batch.folder + "/slurm.sh";
  if (!(std::ofstream(path) << script_of(batch, settings)).flush())
    throw std::runtime_error(path + ": cannot be written");
  const size_t most = largest_array();
  for (size_t first = 0; first < batch.slices; first += most) {
    const size_t count = std::min(most, batch.slices - first);
    batch.handle += (batch.handle.empty() ? "" : ",") + submit_array(batch, settings, first, count);
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
  for (std::string line; std::getline(lines, line); is_there = true)
    // an element whose node failed at its start waits for someone to release it
    if (line.find("held") != std::string::npos || line.find("Held") != std::string::npos)
      static_cast<void>(output_of("scontrol release " + line.substr(0, line.find(' '))));
  return is_there ? BatchState::runs : BatchState::has_ended;
}

void slurm_cancel(const Batch& batch) {
  const Output output = output_of("scancel --name=" + shell_word(job_name(batch)));
  if (output.code != 0)
    throw InputError("scancel: " + output.text.substr(0, output.text.find('\n')));
}

}  // namespace foldproof
