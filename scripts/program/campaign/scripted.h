// The commands that a campaign can run, as a table.
#pragma once

#include <string>
#include <vector>

#include "convergence/campaigns/campaign.h"

namespace foldproof {

/// A command line, and the file that it writes its JSON to.
struct ScriptedCommand {
  std::vector<std::string> words;  // the first is a path
  std::string answer;
};

/// Names of commands that a campaign's `run` can be.
std::vector<std::string> campaign_commands();

/// What the answers of a script depend on beside the program and what it is asked: seeded faults
/// and tests. "" for a command of the program.
std::string script_digest(const std::string& run);

/// folder: for its output. Throws InputError for another command, and for scripts that an installed
/// program does not have.
ScriptedCommand scripted_command(const std::string& run, const std::vector<Assignment>& set,
                                 const std::string& folder);

}  // namespace foldproof
