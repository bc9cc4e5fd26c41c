// foldproof claims: the ledger of a finished run, read from its verdicts.json.

#include <nlohmann/json.hpp>

#include "scripts/program/command_line/options_of_commands.h"
#include "reference/mesh/text_file.h"
#include "reference/types.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/json_text.h"

namespace foldproof {

namespace {

struct ClaimsOptions : Options {
  std::string paper;  // its key, or empty for all
};

using nlohmann::json;

std::string entry_of(const json& row, const char* key) { return row.value(key, std::string()); }

/// The findings of a finished run. Throws InputError if there is none, or it is of no use.
json findings_of(const std::string& folder) {
  const std::string path = folder + "/verdicts.json";
  if (!std::filesystem::exists(path))
    throw InputError(path + ": there is no finished run; make one with `" + program_command() +
                     " verify --out " + folder + "`, or name its folder with --out");
  const json whole = json::parse(
      read_text_file(path, {table_text_limits.bytes, table_text_limits.bytes}), nullptr, false);
  if (!whole.is_object() || !whole.contains("findings"))
    throw InputError(path + ": not the verdicts of a run; make them anew with `" +
                     program_command() + " verify`");
  const json& findings = whole["findings"];
  const bool are_rows = findings.is_array() && std::ranges::all_of(findings, [](const json& row) {
                          return row.is_object();
                        });
  if (!are_rows)
    throw InputError(path + ": its findings are not a list; write them again with `" +
                     program_command() + " verify`");
  return findings;
}

json claims_in(const json& findings, const std::string& folder) {
  json claims = json::array();
  for (const json& row : findings)
    if (entry_of(row, "kind") == "claim") claims.push_back(row);
  if (claims.empty())
    throw InputError(folder + "/verdicts.json: this run decided no claim; `" + program_command() +
                     " verify` decides all");
  return claims;
}

/// Those of one paper, if one is asked for.
json of_paper(const json& claims, const std::string& paper) {
  if (paper.empty()) return claims;
  json chosen = json::array();
  std::string known;
  for (const json& row : claims) {
    const std::string key = entry_of(row, "paper");
    if (key == paper) chosen.push_back(row);
    if (!key.empty() && known.find(key) == std::string::npos)
      known += (known.empty() ? "" : ", ") + key;
  }
  if (chosen.empty())
    throw InputError("there are no claims of '" + paper + "' in this run; papers: " + known);
  return chosen;
}

bool has_several_papers(const json& claims) {
  return std::ranges::any_of(claims, [&](const json& row) {
    return entry_of(row, "paper") != entry_of(claims.front(), "paper");
  });
}

json chosen_of(const json& claims, const std::vector<std::string>& ids) {
  if (ids.empty()) return claims;
  json chosen = json::array();
  for (const std::string& id : ids) {
    const auto found = std::find_if(claims.begin(), claims.end(),
                                    [&](const json& row) { return entry_of(row, "id") == id; });
    if (found == claims.end())
      throw InputError("there is no claim '" + id + "' in this run; `foldproof claims` shows all");
    chosen.push_back(*found);
  }
  return chosen;
}

void print_row(const json& claim) {
  const bool differs = entry_of(claim, "outcome") == "fails";
  fmt::print("{:<7} {:<27} {}{}\n", entry_of(claim, "id"), entry_of(claim, "ruling"),
             entry_of(claim, "statement"),
             differs ? "  [recorded: " + entry_of(claim, "recorded") + "]" : "");
}

/// One finding that decides a claim, with its numbers if the run has it.
void print_decider(const json& decider, const json& findings) {
  const std::string name = entry_of(decider, "finding");
  const auto found = std::find_if(findings.begin(), findings.end(),
                                  [&](const json& row) { return entry_of(row, "name") == name; });
  const auto number = [&](const char* key) {
    return found->value(key, json()).is_number()
               ? fmt::format("{:.4g}", (*found)[key].get<double>())
               : "nan";
  };
  std::string numbers;
  if (found != findings.end()) {
    const std::string unit = entry_of(*found, "unit");
    numbers = fmt::format("{} <= {}{}", number("measured"), number("bound"),
                          unit == "1" ? "" : " " + unit);
  }
  fmt::print("  {:<12} {:<14} {:<58} {}\n", entry_of(decider, "role"), entry_of(decider, "outcome"),
             name, numbers);
}

/// Where the paper says it; files of older programs do not know.
void print_place(const json& claim) {
  if (entry_of(claim, "begins").empty()) return;
  fmt::print("\n{}, paragraph {}: \"{} ...\"\n", entry_of(claim, "source"),
             claim.value("paragraph", 0), entry_of(claim, "begins"));
  if (!entry_of(claim, "printed").empty())
    fmt::print("printed:  {}\nrestored: {}\n", entry_of(claim, "printed"),
               entry_of(claim, "restored"));
}

void print_whole(const json& claim, const json& findings) {
  print_row(claim);
  print_place(claim);
  if (!entry_of(claim, "condition").empty())
    fmt::print("\nCondition: {}.\n", entry_of(claim, "condition"));
  if (!entry_of(claim, "why").empty()) fmt::print("\n{}\n", entry_of(claim, "why"));
  if (!entry_of(claim, "missing").empty())
    fmt::print("\nMissing: {}\n", entry_of(claim, "missing"));
  fmt::print("\n");
  for (const json& decider : claim.value("decided_by", json::array()))
    print_decider(decider, findings);
}

int show_claims(const ClaimsOptions& options) {
  const json findings = findings_of(options.out);
  const json claims =
      chosen_of(of_paper(claims_in(findings, options.out), options.paper), options.names);
  if (options.json) {
    fmt::print("{}\n", json_text(claims));
    return all_hold;
  }
  const bool has_headings = options.names.empty() && has_several_papers(claims);
  std::string paper;
  for (const json& claim : claims) {
    if (has_headings && entry_of(claim, "paper") != paper) {
      paper = entry_of(claim, "paper");
      fmt::print("{}: {}\n", paper, entry_of(claim, "paper_title"));
    }
    if (options.names.empty())
      print_row(claim);
    else
      print_whole(claim, findings);
  }
  return all_hold;
}

constexpr const char* below_claims =
    R"(Examples:
  foldproof claims B10                                 one claim: its ruling, and the findings
  foldproof claims --paper BFA02                       the claims of one paper

Exit codes:
  0    shown; the rulings do not matter
  2    bad input; there is no finished run, or no such claim)";

}  // namespace

void add_claims_command(CLI::App& app, Program& program) {
  auto [claims, options] = add_command(
      app, program,
      {"claims", "Show the rulings of a finished run on the papers' claims", below_claims},
      show_claims);
  claims->add_option(
      "ID", options.names,
      "One claim, such as T17: its ruling, the reason, and the findings that decide it");
  add_value(claims, "--paper KEY", options.paper, "Only the claims of one paper, such as BFA02");
  add_folder(claims, options, "Folder of the finished run")->capture_default_str();
  add_json(claims, options);
}

}  // namespace foldproof
