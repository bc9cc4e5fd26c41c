// `foldproof list`: counts of checks, studies, laws, cases, claims; the names of one kind.

#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "scripts/program/command_line/options_of_commands.h"
#include "convergence/studies.h"
#include "reference/dynamics/integrator.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/json_text.h"
#include "scripts/program/judge/law_sets.h"
#include "scripts/program/ledger.h"
#include "scripts/program/run_case.h"
#include "verification/cases/frame_laws.h"
#include "verification/checks.h"
#include "verification/claims/read_claims.h"
#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

struct ListOptions : Options {
  std::string kind;    // of names; without it, counts
  std::string freeze;  // name of a law set; none if empty
};

/// A name, and a sentence; empty if the name says enough.
using Row = std::pair<std::string, std::string>;

/// One kind of thing that the program knows by name.
struct Kind {
  std::string name;  // the word after `list`
  std::string use;   // the command that takes such a name
  std::vector<Row> rows;
};

/// Of checks, studies or laws.
template <class Named>
std::vector<Row> names_and_claims(const std::vector<Named>& all) {
  std::vector<Row> rows;
  for (const Named& one : all) rows.emplace_back(one.name, one.claim);
  return rows;
}

/// Behind the sentence, what the law needs of a solver; trial: not in the newest law set.
std::vector<Row> laws_and_needs() {
  std::vector<Row> rows;
  std::set<std::string> frozen;
  if (const std::string set = newest_law_set(); !set.empty())
    for (const FrozenLaw& law : read_law_set(set)) frozen.insert(law.name);
  for (const Law& law : portable_laws()) {
    const std::string trial = frozen.contains(law.name) ? "" : " (trial)";
    rows.emplace_back(
        law.name, law.claim + trial + (law.needs.empty() ? "" : fmt::format(" [{}]", law.needs)));
  }
  return rows;
}

std::vector<Kind> kinds() {
  std::vector<Row> cases, claims, methods;
  for (const std::string& name : shipped_cases()) cases.emplace_back(name, "");
  for (const Claim& claim : read_claims(data_folder() + "/verification/claims"))
    claims.emplace_back(claim.id, claim.statement);
  for (const Integrator& i : integrators())
    methods.emplace_back(i.name, fmt::format("{} ({}), order {}", i.title, i.source, i.order));
  return {{"checks", "check NAME", names_and_claims(all_checks())},
          {"studies", "study NAME", names_and_claims(all_studies())},
          {"laws", "judge --solver COMMAND NAME", laws_and_needs()},
          {"frame-laws", "judge --frames FOLDER NAME", names_and_claims(frame_laws())},
          {"cases", "simulate NAME", cases},
          {"claims", "claims ID", claims},
          {"integrators", "simulate CASE --set time.integrator=NAME", methods}};
}

void print_counts(const std::vector<Kind>& all) {
  for (const Kind& kind : all)
    fmt::print("{:<12}{:>5}   foldproof {}\n", kind.name, kind.rows.size(), kind.use);
  fmt::print(
      "`foldproof list KIND` prints the names of one kind, such as `foldproof list cases`.\n"
      "Cases are {}/cases/NAME.toml.\n",
      data_folder());
}

void print_names(const Kind& kind) {
  size_t width = 0;
  for (const auto& [name, sentence] : kind.rows) width = std::max(width, name.size());
  for (const auto& [name, sentence] : kind.rows)
    fmt::print("{}\n", sentence.empty() ? name : fmt::format("{:<{}}  {}", name, width, sentence));
}

template <class Named>
nlohmann::json json_rows(const std::vector<Named>& all) {
  nlohmann::json rows = nlohmann::json::array();
  for (const Named& one : all)
    rows.push_back({{"name", one.name}, {"claim", one.claim}, {"source", one.source}});
  return rows;
}

nlohmann::json rows_of_laws() {
  const std::vector<Law> laws = portable_laws();
  nlohmann::json rows = json_rows(laws);
  for (size_t k = 0; k < laws.size(); ++k) rows[k]["needs"] = laws[k].needs;
  return rows;
}

std::vector<std::string> names_of_case_findings() {
  std::vector<std::string> names;
  for (const std::string& name : built_in_cases(Tier::full)) {
    const Case input_case = built_in_case(name);
    for (const Expectation& expectation : input_case.expectations)
      names.push_back(finding_name(input_case.scene, expectation));
  }
  return names;
}

nlohmann::json everything() {
  nlohmann::json json = {{"checks", json_rows(all_checks())},
                         {"studies", json_rows(all_studies())},
                         {"laws", rows_of_laws()},
                         {"frame_laws", json_rows(frame_laws())},
                         {"cases", built_in_cases(Tier::full)},
                         {"cases_folder", data_folder() + "/cases"},
                         {"long_cases", long_cases()},
                         {"integrators", nlohmann::json::array()},
                         {"case_findings", names_of_case_findings()},
                         {"claims", nlohmann::json::array()}};
  for (const Integrator& i : integrators())
    json["integrators"].push_back(
        {{"name", i.name}, {"title", i.title}, {"source", i.source}, {"order", i.order}});
  for (const Claim& claim : read_claims(data_folder() + "/verification/claims"))
    json["claims"].push_back({{"id", claim.id}, {"findings", findings_named_in(claim)}});
  return json;
}

int list(const ListOptions& options) {
  if (!options.freeze.empty()) {
    if (options.kind != "laws") throw InputError("--freeze is for `foldproof list laws`");
    fmt::print("{}", law_set_text(options.freeze));
    return all_hold;
  }
  if (options.json) {
    fmt::print("{}\n", json_text(everything()));
    return all_hold;
  }
  const std::vector<Kind> all = kinds();
  if (options.kind.empty()) print_counts(all);
  for (const Kind& kind : all)
    if (kind.name == options.kind) print_names(kind);
  return all_hold;
}

constexpr const char* below_list =
    R"(Examples:
  foldproof list cases                                 the names of the shipped cases
  foldproof list --json                                everything, also the findings of cases

Exit codes:
  0    listed
  2    bad input)";

}  // namespace

void add_list_command(CLI::App& app, Program& program) {
  auto [names, options] = add_command(
      app, program,
      {"list", "Show what there is: checks, studies, laws, cases, claims", below_list}, list);
  names->add_option("KIND", options.kind, "The names of one kind; without it, how many there are")
      ->check(CLI::IsMember(
          {"checks", "studies", "laws", "frame-laws", "cases", "claims", "integrators"}));
  add_value(
      names, "--freeze NAME", options.freeze,
      "Of laws: print the law set NAME, for `judge --laws`: a line a law with its scenes' hash",
      some_text("a name"));
  add_json(names, options);
}

}  // namespace foldproof
