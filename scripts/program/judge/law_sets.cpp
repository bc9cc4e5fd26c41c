#include "scripts/program/judge/law_sets.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "scripts/program/command_line/suggestions.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/provenance.h"
#include "verification/files/content_key.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;

fs::path folder_of_sets() { return data_folder() + "/verification/subjects/law_sets"; }

std::vector<std::string> law_set_names() {
  std::vector<std::string> names;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_of_sets(), none))
    if (entry.path().extension() == ".tsv") names.push_back(entry.path().stem());
  std::ranges::sort(names);
  return names;
}

SolverCommand this_program(const std::string& words) {
  SolverCommand command;
  command.command = fmt::format("exec '{}' {}", program_file(), words);
  return command;
}

/// A hash of the scenes, each known by its own.
std::string hash_of(const std::vector<std::pair<std::string, std::string>>& mapping) {
  ContentKey key;
  for (const auto& [what, hash] : mapping) key.add(hash.data(), hash.size());
  return key.text();
}

std::string bound_of(const Record& record) {
  const Verdict& verdict = record.finding.verdict;
  return std::isnan(verdict.bound) ? "" : fmt::format("{:.3g} {}", verdict.bound, verdict.unit);
}

}  // namespace

std::string newest_law_set() {
  const std::vector<std::string> names = law_set_names();
  return names.empty() ? "" : names.back();
}

std::vector<FrozenLaw> read_law_set(const std::string& name) {
  const std::vector<std::string> known = law_set_names();
  if (std::ranges::find(known, name) == known.end())
    throw InputError(
        fmt::format("there is no law set '{}'; known: {}", name, fmt::join(known, ", ")));
  std::ifstream file(folder_of_sets() / (name + ".tsv"));
  std::vector<FrozenLaw> laws;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#")) continue;
    const std::vector<std::string> cells = suite::split(line, "\t");
    if (cells.size() != 3) throw InputError(fmt::format("law set {}: '{}'", name, line));
    laws.push_back({cells[0], cells[1], cells[2] == "-" ? "" : cells[2]});
  }
  return laws;
}

std::vector<FrozenLaw> scenes_of(const std::vector<Law>& laws) {
  std::vector<FrozenLaw> found;
  for (const Law& law : laws) {
    const Judgement one = judge_solver(this_program("serve --still"), {law}, TrialWatch{});
    found.push_back({law.name, hash_of(one.mapping), ""});
  }
  return found;
}

std::string law_set_text(const std::string& name) {
  const std::vector<Law> laws = portable_laws();
  const std::vector<Record> records =
      judge_solver(this_program("serve"), laws, TrialWatch{}).records;
  std::string text = fmt::format(
      "# law set {}: name, hash of scenes, bound for the reference. By `foldproof list laws "
      "--freeze {}`\n",
      name, name);
  const std::vector<FrozenLaw> now = scenes_of(laws);
  for (size_t k = 0; k < laws.size(); ++k) {
    const std::string bound = bound_of(records[k]);
    text += fmt::format("{}\t{}\t{}\n", now[k].name, now[k].scenes, bound.empty() ? "-" : bound);
  }
  return text;
}

LawSetUse keep_laws_of_set(const std::string& name, std::vector<Law>& laws) {
  std::map<std::string, std::string> frozen;
  for (const FrozenLaw& law : read_law_set(name)) frozen.emplace(law.name, law.scenes);
  LawSetUse use{name, {}, {}};
  std::set<std::string> known;
  for (const Law& law : portable_laws()) known.insert(law.name);
  for (const auto& [law, scenes] : frozen)
    if (!known.contains(law)) use.gone.push_back(law);
  std::erase_if(laws, [&](const Law& law) { return !frozen.contains(law.name); });
  for (const FrozenLaw& now : scenes_of(laws))
    if (now.scenes != frozen.at(now.name)) use.changed.push_back(now.name);
  return use;
}

std::string text_of(const LawSetUse& use, size_t laws) {
  const std::string text = fmt::format("laws {}: {} laws", use.name, laws);
  if (use.changed.empty() && use.gone.empty()) return text + ", as frozen\n";
  return fmt::format("{}{}{}\n", text,
                     use.changed.empty() ? ""
                                         : fmt::format("; CHANGED since, not comparable: {}",
                                                       fmt::join(use.changed, ", ")),
                     use.gone.empty() ? "" : fmt::format("; gone: {}", fmt::join(use.gone, ", ")));
}

}  // namespace foldproof
