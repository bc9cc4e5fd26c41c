// The ledger: what follows from which outcomes, and that its texts name only what there is.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <regex>
#include <set>

#include "convergence/studies.h"
#include "verification/checks.h"
#include "verification/claims/read_claims.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/subjects/reference_subject.h"

using namespace foldproof;

namespace {

constexpr Outcome holds = Outcome::holds, fails = Outcome::fails;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Record finding(const std::string& name, std::optional<Outcome> outcome, double measured = 0.25) {
  Record record;
  record.name = name;
  record.outcome = outcome;
  record.finding.verdict = {measured, 0.5, 0, "kg", "a reason"};
  return record;
}

const std::vector<Decider> all_roles = {{"support", Role::supports},
                                        {"another", Role::supports},
                                        {"limit", Role::limits},
                                        {"contra", Role::contradicts}};

Ruling with(std::optional<Outcome> support, std::optional<Outcome> another,
            std::optional<Outcome> limit, std::optional<Outcome> contra) {
  return ruling(all_roles, {finding("support", support), finding("another", another),
                            finding("limit", limit), finding("contra", contra)});
}

Claim small_claim(Ruling recorded, const std::string& why) {
  return {"BMF03", "X1", "3", "A sentence.", {{"support", Role::supports}}, recorded, "", why};
}

const std::vector<Claim>& written_claims() {
  static const std::vector<Claim> claims = read_claims(CLAIMS_FOLDER);
  return claims;
}

bool is_known(const std::string& name) {
  static const std::set<std::string> checks = [] {
    std::set<std::string> names;
    for (const Check& check : all_checks()) names.insert(check.name);
    return names;
  }();
  const std::vector<Study> studies = all_studies();
  return checks.count(name) > 0 || name.starts_with("case.") ||
         std::any_of(studies.begin(), studies.end(),
                     [&](const Study& study) { return name.starts_with(study.name + "."); });
}

}  // namespace

TEST_CASE("a finding of the full tier decides if it ran, and is not missed if it did not") {
  const std::vector<Decider> deciders = {{"support", Role::supports},
                                         {"long", Role::supports, true}};
  Record held, failed;
  held.name = "support";
  held.outcome = Outcome::holds;
  failed.name = "long";
  failed.outcome = Outcome::fails;
  failed.finding.verdict = {3, 2, 0, "1", ""};
  CHECK(ruling(deciders, {held}) == Ruling::confirmed);
  CHECK(ruling(deciders, {held, failed}) == Ruling::undecided);
  CHECK(ruling({{"support", Role::supports}, {"long", Role::supports}}, {held}) ==
        Ruling::undecided);
}

TEST_CASE(
    "every claim that was looked up names the paragraph and the first words of its sentence") {
  for (const Claim& claim : written_claims()) {
    INFO(claim.id << ": " << claim.cited.begins);
    if (claim.cited.begins.empty()) {
      CHECK(claim.paper != "BMF03");
      CHECK(claim.cited.paragraph == 0);
      continue;
    }
    CHECK(claim.cited.paragraph >= 1);
    const auto blanks = std::ranges::count(claim.cited.begins, ' ');
    CHECK(blanks >= 3);   // enough words to find the sentence
    CHECK(blanks <= 11);  // and no more than a citation
    CHECK(claim.cited.printed.empty() == claim.cited.restored.empty());
  }
}

TEST_CASE("a claim is confirmed when all its findings hold and all support it") {
  const std::vector<Decider> deciders = {{"support", Role::supports}, {"another", Role::supports}};
  CHECK(ruling(deciders, {finding("support", holds), finding("another", holds)}) ==
        Ruling::confirmed);
}

TEST_CASE("a limit that holds makes a claim conditional; one that fails does not confirm it") {
  const std::vector<Decider> deciders = {{"support", Role::supports}, {"limit", Role::limits}};
  CHECK(ruling(deciders, {finding("support", holds), finding("limit", holds)}) ==
        Ruling::conditional);
  CHECK(ruling(deciders, {finding("support", holds), finding("limit", fails)}) ==
        Ruling::undecided);
}

TEST_CASE("a contradiction that fails leaves a claim undecided: it does not confirm it") {
  for (const Outcome limit : {holds, fails})
    CHECK(with(holds, holds, limit, fails) == Ruling::undecided);
}

TEST_CASE("a contradiction that holds refutes, regardless of all other findings") {
  for (const Outcome support : {holds, fails})
    for (const Outcome limit : {holds, fails})
      CHECK(with(support, holds, limit, holds) == Ruling::refuted);
}

TEST_CASE("one failed support of several leaves a claim undecided, neither confirmed nor refuted") {
  for (const Outcome limit : {holds, fails}) {
    CHECK(with(fails, holds, limit, fails) == Ruling::undecided);
    CHECK(with(holds, fails, limit, fails) == Ruling::undecided);
  }
}

TEST_CASE("a finding that says nothing, in any role, leaves a claim undecided") {
  for (const std::optional<Outcome> silent :
       {std::optional(Outcome::inconclusive), std::optional(Outcome::not_applicable),
        std::optional<Outcome>()}) {
    CHECK(with(silent, holds, holds, fails) == Ruling::undecided);
    CHECK(with(holds, holds, silent, fails) == Ruling::undecided);
    CHECK(with(holds, holds, holds, silent) == Ruling::undecided);
    CHECK(with(silent, holds, holds, holds) == Ruling::undecided);
  }
  CHECK(ruling(all_roles, {finding("support", holds), finding("another", holds),
                           finding("limit", fails)}) == Ruling::undecided);
  const std::vector<Decider> conditional = {{"support", Role::supports}, {"limit", Role::limits}};
  CHECK(ruling(conditional, {finding("support", holds)}) == Ruling::undecided);
}

TEST_CASE("a finding without a number has said nothing: the rest does not refute either") {
  const std::vector<Decider> deciders = {{"support", Role::supports},
                                         {"contra", Role::contradicts}};
  CHECK(ruling(deciders, {finding("support", fails, not_a_number), finding("contra", holds)}) ==
        Ruling::undecided);
  CHECK(ruling(deciders, {finding("support", fails), finding("contra", holds)}) == Ruling::refuted);
}

TEST_CASE("without support nothing is confirmed") {
  CHECK(ruling({}, {}) == Ruling::undecided);
  CHECK(ruling({{"limit", Role::limits}}, {finding("limit", holds)}) == Ruling::undecided);
  CHECK(ruling({{"contra", Role::contradicts}}, {finding("contra", fails)}) == Ruling::undecided);
  CHECK(ruling({{"contra", Role::contradicts}}, {finding("contra", holds)}) == Ruling::refuted);
}

TEST_CASE(
    "numbers in a text come from the findings, with unit, three digits and the row asked for") {
  Record record = finding("mass", holds, 0.123456);
  record.finding.evidence = {{"case", "", std::vector<std::string>{"heavy", "light"}},
                             {"|m|/2", "g", std::vector<double>{7, 3}},
                             {"share", "1", std::vector<double>{0.5, not_a_number}}};
  const std::vector<Record> records = {record};
  CHECK(fill_placeholders("{mass} of {mass|bound}", records) == "0.123 kg of 0.5 kg");
  CHECK(fill_placeholders("{mass||m|/2|light}, {mass||m|/2|1}, {mass||m|/2|last}", records) ==
        "3 g, 7 g, 3 g");
  CHECK(fill_placeholders("{mass||m|/2|smallest} to {mass||m|/2|largest}", records) ==
        "3 g to 7 g");
  CHECK(fill_placeholders("{mass|share|first}", records) == "0.5");
  CHECK(fill_placeholders("{mass|case|first}, {mass|case|last}", records) == "heavy, light");
  for (const char* wrong :
       {"{mess}", "{mass|share|3}", "{mass|share|0}", "{mass|share|heavily}", "{mass|volume|1}",
        "{mass|share|last}", "{mass|share|largest}", "{mass", "{mass|case|1}"})
    CHECK_THROWS_WITH(fill_placeholders(wrong, records), Catch::Contains("placeholder {mass") ||
                                                             Catch::Contains("placeholder {mess}"));
}

TEST_CASE(
    "a number may stand without its unit, and for the largest of several; powers of ten are "
    "written as such") {
  const std::vector<Record> records = {
      finding("small", holds, 5.9217e-5), finding("large", holds, 1.9949e7),
      finding("plain", holds, 123456),    finding("unknown", fails, not_a_number),
      finding("none", holds, 0),          finding("below", holds, -0.00123456)};
  CHECK(fill_placeholders("{small}, {large}, {plain}, {none}", records) ==
        "5.92×10⁻⁵ kg, 1.99×10⁷ kg, 123000 kg, 0 kg");
  CHECK(fill_placeholders("{bare: small} and {bare: below}", records) == "5.92×10⁻⁵ and -0.00123");
  CHECK(fill_placeholders("{largest of: small, plain, none}", records) == "123000 kg");
  CHECK(fill_placeholders("{bare: largest of: small, none|bound}", records) == "0.5");
  CHECK_THROWS_WITH(fill_placeholders("{largest of: small, unknown}", records),
                    Catch::Contains("largest of: small, unknown"));
  CHECK_THROWS_WITH(fill_placeholders("{largest of: unknown, small}", records),
                    Catch::Contains("not a number"));
  std::vector<Record> mixed = records;
  mixed.front().finding.verdict.unit = "m";
  CHECK_THROWS_WITH(fill_placeholders("{largest of: small, plain}", mixed),
                    Catch::Contains("different units"));
}

TEST_CASE(
    "a ruled claim has its numbers; one that asks for a number that is not there is refused by "
    "name") {
  const std::vector<Record> records = {finding("support", holds)};
  CHECK(rule_claim(small_claim(Ruling::confirmed, "It is {support}."), records).claim.why ==
        "It is 0.25 kg.");
  CHECK_THROWS_WITH(rule_claim(small_claim(Ruling::confirmed, "It is {other}."), records),
                    Catch::Contains("claim X1"));
}

TEST_CASE("a ruling other than the recorded one fails; an open question stays open") {
  const std::vector<Record> held = {finding("support", holds)},
                            failed = {finding("support", fails)};
  CHECK(outcome_of(rule_claim(small_claim(Ruling::confirmed, ""), held)) == holds);
  CHECK(outcome_of(rule_claim(small_claim(Ruling::confirmed, ""), failed)) == fails);
  CHECK(outcome_of(rule_claim(small_claim(Ruling::confirmed, ""), {})) == fails);
  CHECK(outcome_of(rule_claim(small_claim(Ruling::refuted, ""), held)) == fails);
  CHECK(outcome_of(rule_claim(small_claim(Ruling::undecided, ""), held)) == fails);
  CHECK(outcome_of(rule_claim(small_claim(Ruling::undecided, ""), {})) == Outcome::inconclusive);
}

TEST_CASE(
    "the ledger has every claim of sections 2, 3, 4 and 6 once, and claims of section 5 in their "
    "order") {
  std::vector<std::string> ids, expected;
  std::vector<int> objects;
  for (const Claim& claim : written_claims()) {
    if (claim.paper != "BMF03") continue;
    claim.id.starts_with("C") ? objects.push_back(std::stoi(claim.id.substr(1)))
                              : ids.push_back(claim.id);
  }
  for (int k = 1; k <= 22; ++k) expected.push_back("T" + std::to_string(k));
  for (int k = 1; k <= 13; ++k) expected.push_back("B" + std::to_string(k));
  for (int k = 1; k <= 6; ++k) expected.push_back("S" + std::to_string(k));
  CHECK(ids == expected);
  for (size_t k = 0; k < objects.size(); ++k) {
    CHECK((objects[k] >= 1 && objects[k] <= 17));
    if (k > 0) CHECK(objects[k - 1] < objects[k]);
  }
}

TEST_CASE("the other papers have all their claims, and each undecided one says what is missing") {
  std::map<std::string, int> count;
  for (const Claim& claim : written_claims()) {
    ++count[claim.paper];
    INFO(claim.id);
    CHECK((claim.recorded == Ruling::undecided) == !claim.missing.empty());
  }
  CHECK(count["BFA02"] == 13);
  CHECK(count["BW98"] == 5);
  CHECK(count["CK02"] == 3);
  CHECK(count["GHDS03"] == 4);
  CHECK(count["BWHZG06"] == 1);
  CHECK(count.size() == 6);
}

TEST_CASE("the paper of the page for authors of claims is read, and ruled by checks that run") {
  std::ifstream file(std::string(CLAIMS_FOLDER) + "/README.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const std::size_t begin = page.find("```toml\n") + 8;
  const ScratchFolder folder;
  std::ofstream(folder.file("abc99.toml")) << page.substr(begin, page.find("```", begin) - begin);
  const std::vector<Claim> claims = read_claims(folder.file("."));
  REQUIRE(claims.size() == 2);
  std::vector<Record> records;
  for (const Check& check : all_checks())
    for (const Decider& decider : claims[0].decided_by)
      if (check.name == decider.finding) records.push_back(run_check(check, reference_subject()));
  const ClaimRecord decided = rule_claim(claims[0], records), open = rule_claim(claims[1], records);
  CHECK(decided.ruling == Ruling::confirmed);
  CHECK(outcome_of(decided) == holds);
  CHECK(decided.claim.why.find('{') == std::string::npos);
  CHECK(outcome_of(open) == Outcome::inconclusive);
  CHECK(is_out_of_reach(open));
  CHECK(!is_out_of_reach(decided));
  CHECK(place_of(claims[0]) == "ABC99 section 3");
  CHECK(place_of(claims[1]) == "ABC99, knots");
  CHECK(!is_covered(claims[1], records));
}

TEST_CASE("every decided claim names only findings that there are") {
  for (const Claim& claim : written_claims()) {
    INFO("claim " << claim.id);
    CHECK(claim.statement.ends_with("."));
    if (claim.recorded == Ruling::undecided) continue;
    for (const std::string& name : findings_named_in(claim)) {
      INFO(name);
      CHECK(is_known(name));
    }
  }
}

TEST_CASE("no claim's text has a measured number typed into it") {
  const std::regex placeholder("\\{[^}]*\\}"), number("[0-9][.,][0-9]|[0-9]e-?[0-9]|[0-9] ?%");
  for (const Claim& claim : written_claims()) {
    INFO("claim " << claim.id);
    CHECK(!std::regex_search(std::regex_replace(claim.why + claim.condition, placeholder, ""),
                             number));
  }
}
