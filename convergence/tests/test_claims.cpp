// The ledger: rulings that follow from outcomes, and numbers in its texts.
#include <catch2/catch.hpp>
#include <regex>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "verification/checks.h"
#include "verification/claims/read_claims.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/subjects/reference_subject.h"

using namespace foldproof;

namespace {

using Said = std::optional<Outcome>;
constexpr Outcome holds = Outcome::holds, fails = Outcome::fails;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Record finding(const std::string& name, Said outcome, double measured = 0.25) {
  Record record;
  record.name = name;
  record.outcome = outcome;
  record.finding.verdict = {measured, 0.5, 0, "kg", "a reason"};
  return record;
}

const Decider support{"support", Role::supports}, another{"another", Role::supports},
    limit{"limit", Role::limits}, contra{"contra", Role::contradicts};

Ruling with(Said first, Said second, Said limits, Said contradicts) {
  return ruling({support, another, limit, contra},
                {finding("support", first), finding("another", second), finding("limit", limits),
                 finding("contra", contradicts)});
}

ClaimRecord ruled(Ruling recorded, const std::string& why, const std::vector<Record>& records) {
  return rule_claim({"BMF03", "X1", "3", "A sentence.", {support}, recorded, "", why}, records);
}

}  // namespace

TEST_CASE("a claim waits for findings that only the full tier has, and is not confirmed before") {
  const Decider full{"long", Role::supports, true}, quick{"long", Role::supports};
  const Record held = finding("support", holds), failed = finding("support", fails);
  const auto outcome = [](const Decider& last, const std::vector<Record>& records) {
    const ClaimRecord record = rule_claim(
        {"BMF03", "X1", "3", "A sentence.", {support, last}, Ruling::confirmed, "", ""}, records);
    return std::tuple(record.ruling, outcome_of(record), waits_for_full_tier(record));
  };
  CHECK(outcome(full, {held}) == std::tuple(Ruling::undecided, Outcome::inconclusive, true));
  CHECK(outcome(full, {held, finding("long", holds)}) ==
        std::tuple(Ruling::confirmed, holds, false));
  CHECK(outcome(full, {held, finding("long", fails)}) ==
        std::tuple(Ruling::undecided, fails, false));
  CHECK(outcome(full, {failed}) == std::tuple(Ruling::undecided, fails, false));
  CHECK(outcome(quick, {held}) == std::tuple(Ruling::undecided, fails, false));
}

TEST_CASE("a limit that holds makes a claim conditional; one that fails does not confirm it") {
  const Record held = finding("support", holds);
  CHECK(ruling({support, another}, {held, finding("another", holds)}) == Ruling::confirmed);
  CHECK(ruling({support, limit}, {held, finding("limit", holds)}) == Ruling::conditional);
  CHECK(ruling({support, limit}, {held, finding("limit", fails)}) == Ruling::undecided);
}

TEST_CASE("a contradiction that fails leaves a claim undecided: it does not confirm it") {
  for (const Outcome limits : {holds, fails}) {
    CHECK(with(holds, holds, limits, fails) == Ruling::undecided);
    for (const Outcome first : {holds, fails})  // one that holds refutes
      CHECK(with(first, holds, limits, holds) == Ruling::refuted);
  }
}

TEST_CASE("one failed support of several leaves a claim undecided, neither confirmed nor refuted") {
  for (const Outcome limits : {holds, fails}) {
    CHECK(with(fails, holds, limits, fails) == Ruling::undecided);
    CHECK(with(holds, fails, limits, fails) == Ruling::undecided);
  }
}

TEST_CASE("a finding that says nothing, in any role, leaves a claim undecided") {
  for (const Said silent : {Said(Outcome::inconclusive), Said(Outcome::not_applicable), Said()}) {
    CHECK(with(silent, holds, holds, fails) == Ruling::undecided);
    CHECK(with(holds, holds, silent, fails) == Ruling::undecided);
    CHECK(with(holds, holds, holds, silent) == Ruling::undecided);
    CHECK(with(silent, holds, holds, holds) == Ruling::undecided);
  }
  const std::vector<Record> held = {finding("support", holds), finding("another", holds)};
  CHECK(ruling({support, another, contra}, held) == Ruling::undecided);
  CHECK(ruling({support, limit}, held) == Ruling::undecided);
}

TEST_CASE("a finding without a number has said nothing: the rest does not refute either") {
  const Record held = finding("contra", holds);
  CHECK(ruling({support, contra}, {finding("support", fails, not_a_number), held}) ==
        Ruling::undecided);
  CHECK(ruling({support, contra}, {finding("support", fails), held}) == Ruling::refuted);
}

TEST_CASE("without support nothing is confirmed") {
  CHECK(ruling({}, {}) == Ruling::undecided);
  CHECK(ruling({limit}, {finding("limit", holds)}) == Ruling::undecided);
  CHECK(ruling({contra}, {finding("contra", fails)}) == Ruling::undecided);
  CHECK(ruling({contra}, {finding("contra", holds)}) == Ruling::refuted);
}

TEST_CASE(
    "numbers in a text come from the findings, with unit, three digits and the row asked for") {
  Record record = finding("mass", holds, 0.123456);
  record.finding.evidence = {{"case", "", std::vector<std::string>{"heavy", "light"}},
                             {"|m|/2", "g", std::vector<double>{7, 3}},
                             {"share", "1", std::vector<double>{0.5, not_a_number}}};
  for (const auto& [text, filled] : std::map<std::string, std::string>{
           {"{mass} of {mass|bound}", "0.123 kg of 0.5 kg"},
           {"{mass||m|/2|light}, {mass||m|/2|1}, {mass||m|/2|last}", "3 g, 7 g, 3 g"},
           {"{mass||m|/2|smallest} to {mass||m|/2|largest}", "3 g to 7 g"},
           {"{mass|share|first}", "0.5"},
           {"{mass|case|first}, {mass|case|last}", "heavy, light"}})
    CHECK(fill_placeholders(text, {record}) == filled);
  for (const char* wrong :
       {"{mess}", "{mass|share|3}", "{mass|share|0}", "{mass|share|heavily}", "{mass|volume|1}",
        "{mass|share|last}", "{mass|share|largest}", "{mass", "{mass|case|1}"})
    CHECK_THROWS_WITH(fill_placeholders(wrong, {record}), Catch::Contains("placeholder {m"));
}

TEST_CASE(
    "a number may stand without its unit, and for the largest of several; powers of ten are "
    "written as such") {
  std::vector<Record> records = {
      finding("small", holds, 5.9217e-5), finding("large", holds, 1.9949e7),
      finding("plain", holds, 123456),    finding("unknown", fails, not_a_number),
      finding("none", holds, 0),          finding("below", holds, -0.00123456)};
  CHECK(fill_placeholders("{small}, {large}, {plain}, {none}", records) ==
        "5.92×10⁻⁵ kg, 1.99×10⁷ kg, 123000 kg, 0 kg");
  CHECK(fill_placeholders("{bare: small} and {bare: below}", records) == "5.92×10⁻⁵ and -0.00123");
  CHECK(fill_placeholders("{largest of: small, plain, none}", records) == "123000 kg");
  CHECK(fill_placeholders("{bare: largest of: small, none|bound}", records) == "0.5");
  for (const char* wrong : {"{largest of: small, unknown}", "{largest of: unknown, small}"})
    CHECK_THROWS_WITH(fill_placeholders(wrong, records), Catch::Contains("not a number"));
  records.front().finding.verdict.unit = "m";
  CHECK_THROWS_WITH(fill_placeholders("{largest of: small, plain}", records),
                    Catch::Contains("different units"));
}

TEST_CASE("a ruling other than the recorded one fails; an open question stays open") {
  const std::vector<Record> held = {finding("support", holds)},
                            failed = {finding("support", fails)};
  CHECK(outcome_of(ruled(Ruling::confirmed, "", held)) == holds);
  CHECK(outcome_of(ruled(Ruling::confirmed, "", failed)) == fails);
  CHECK(outcome_of(ruled(Ruling::confirmed, "", {})) == fails);
  CHECK(outcome_of(ruled(Ruling::refuted, "", held)) == fails);
  CHECK(outcome_of(ruled(Ruling::undecided, "", held)) == fails);
  CHECK(outcome_of(ruled(Ruling::undecided, "", {})) == Outcome::inconclusive);
  CHECK(ruled(Ruling::confirmed, "It is {support}.", held).claim.why == "It is 0.25 kg.");
  CHECK_THROWS_WITH(ruled(Ruling::confirmed, "{other}", held), Catch::Contains("claim X1"));
}

TEST_CASE("the paper of the page for authors of claims is read, and ruled by checks that run") {
  std::ifstream file(std::string(CLAIMS_FOLDER) + "/README.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const std::size_t begin = page.find("```toml\n") + 8;
  const ScratchFolder folder;
  folder.write("abc99.toml", page.substr(begin, page.find("```", begin) - begin));
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

TEST_CASE("no claim's text has a measured number typed into it") {
  const std::regex placeholder("\\{[^}]*\\}");
  const std::regex number("[0-9][.,][0-9]|[0-9]e-?[0-9]|[0-9] ?%");
  for (const Claim& claim : read_claims(CLAIMS_FOLDER)) {
    INFO("claim " << claim.id);
    const std::string words = std::regex_replace(claim.why + claim.condition, placeholder, "");
    CHECK_FALSE(std::regex_search(words, number));
  }
}
