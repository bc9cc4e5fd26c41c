#include "scripts/program/campaign/scripted.h"

#include <fmt/format.h>

#include <filesystem>

#include "convergence/campaigns/job_keys.h"
#include "scripts/program/campaign/run_job.h"
#include "scripts/program/provenance.h"

namespace foldproof {

namespace {

enum class Answers { on_output, in_file };

/// A row: the command, and where its answer goes.
struct CampaignCommand {
  const char* name;
  bool is_script;  // of scripts/, not of the program
  Answers answers;
  bool needs_folder;  // writes files, which are not kept
};

constexpr CampaignCommand commands[] = {
    {"simulate", false, Answers::on_output, true},  {"converge", false, Answers::on_output, true},
    {"precision", false, Answers::on_output, true}, {"check", false, Answers::on_output, false},
    {"study", false, Answers::on_output, false},    {"judge", false, Answers::on_output, false},
    {"ablate", false, Answers::on_output, true},    {"faults", true, Answers::in_file, false},
    {"mutate", true, Answers::in_file, false},
};

std::string script(const std::string& name) {
  const std::string path = source_folder() + "/scripts/" + name;
  if (!std::filesystem::exists(path))
    throw InputError(path + ": is missing; a campaign of '" + name + "' needs the source tree");
  return path;
}

}  // namespace

std::vector<std::string> campaign_commands() {
  std::vector<std::string> names;
  for (const CampaignCommand& command : commands) names.emplace_back(command.name);
  return names;
}

std::string script_digest(const std::string& run) {
  std::string digest;
  for (const CampaignCommand& command : commands)
    if (run == command.name && command.is_script)
      for (const char* folder : {"/verification/faults", "/scripts", "/scripts/tests"})
        digest += folder_digest(source_folder() + folder);
  return digest;
}

ScriptedCommand scripted_command(const std::string& run, const std::vector<Assignment>& set,
                                 const std::string& folder) {
  for (const CampaignCommand& command : commands) {
    if (run != command.name) continue;
    std::vector<std::string> words = words_of(run, set);
    words[0] = run;
    if (command.is_script)
      words[0] = script(run);
    else
      words.insert(words.begin(), program_file());
    if (command.needs_folder) words.insert(words.end(), {"--out", folder + "/files"});
    if (command.answers == Answers::on_output) {
      words.push_back("--json");
      return {words, folder + "/out"};
    }
    words.insert(words.end(), {"--out", folder + "/answer.json"});
    return {words, folder + "/answer.json"};
  }
  throw InputError(fmt::format("run = \"{}\": no command of a campaign; known: {}", run,
                               fmt::join(campaign_commands(), ", ")));
}

}  // namespace foldproof
