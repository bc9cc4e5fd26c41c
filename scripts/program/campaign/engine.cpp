#include "scripts/program/campaign/engine.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "reference/types.h"
#include "scripts/program/campaign/slurm.h"
#include "verification/files/shard_file.h"

namespace foldproof {

namespace {

/// "HOST PID START": a process's number alone may be another's by now.
std::string process_mark(pid_t process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string text;
  std::getline(file, text);
  size_t at = text.rfind(')');  // the name may hold anything
  for (int field = 2; field < 22 && at != std::string::npos; ++field) at = text.find(' ', at + 1);
  if (at == std::string::npos) return "";
  return fmt::format("{} {} {}", host_name(), process,
                     text.substr(at + 1, text.find(' ', at + 1) - at - 1));
}

void run_locally(Batch& batch, const EngineSettings& settings,
                 const std::function<void(size_t)>& show) {
  batch.handle = process_mark(getpid());
  write_terms(batch);
  for (size_t slice = 0; slice < batch.slices; ++slice)
    work_through(batch, slice, read_slice(batch, slice), settings.work, show);
}

pid_t process_of(const Batch& batch) {
  const size_t space = batch.handle.find(' ');
  return space == std::string::npos ? 0 : pid_t(std::stol(batch.handle.substr(space + 1)));
}

/// On another machine its mark decides.
BatchState ask_locally(const Batch& batch) {
  if (!batch.handle.starts_with(host_name() + " "))
    return is_marked_alive(batch) ? BatchState::runs : BatchState::has_ended;
  return process_mark(process_of(batch)) == batch.handle ? BatchState::runs : BatchState::has_ended;
}

void cancel_locally(const Batch& batch) {
  if (process_mark(process_of(batch)) == batch.handle)
    kill(process_of(batch), SIGTERM);
  else if (ask_locally(batch) == BatchState::runs)
    throw InputError(batch.handle + ": runs this batch; cancel it there");
}

}  // namespace

const std::vector<Engine>& engines() {
  static const std::vector<Engine> table = {
      {"local", "all cores of this machine", [] { return std::string(); }, 100'000,
       [](size_t jobs, double, const EngineSettings&) { return jobs; }, run_locally, ask_locally,
       cancel_locally},
      {"slurm", "job arrays of a Slurm cluster", slurm_missing, 1'000'000, slurm_jobs_a_slice,
       slurm_submit, slurm_ask, slurm_cancel},
  };
  return table;
}

const Engine& engine_named(const std::string& name) {
  std::vector<std::string> names;
  for (const Engine& engine : engines()) {
    if (name == engine.name) return engine;
    names.emplace_back(engine.name);
  }
  throw InputError(fmt::format("--on {}: no such engine; known: {}", name, fmt::join(names, ", ")));
}

}  // namespace foldproof
