// verdicts.json and junit.xml, entry by entry.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "reference/mesh/text_file.h"
#include "verification/files/verdicts_file.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

namespace {

using nlohmann::json;

Record law(const std::string& name, std::optional<Outcome> outcome, double measured) {
  Record record;
  record.name = name, record.kind = "check", record.claim = "It is " + name + ".";
  record.finding.verdict = {measured, 4.5, 0.125, "mm", "by hand"};
  record.outcome = outcome;
  return record;
}

Record full_record() {
  Record record = law("law.full", Outcome::fails, 123456.75);
  record.kind = "study", record.study = "of-steps", record.source = "BMF03 section 7";
  record.finding.note = "seen <once>", record.finding.headline = "too far";
  record.finding.verdict.why_bound = "empirical: twice the largest";
  record.seconds = 6.5, record.faults = {"first-fault", "second-fault"};
  return record;
}

ClaimRecord claim(const std::string& id, Ruling recorded, Ruling is) {
  Claim claim{"BMF03", id, "7.3", id + " & more", {}, recorded, "if dry", "because"};
  claim.decided_by = {{"law.full", Role::limits}, {"law.bare", Role::contradicts}};
  claim.cited = {4, "We saw", "a + b", "a - b"};
  claim.missing = "a lab", claim.paper_title = "Folds (2003)";
  return {claim, {"fails", "missing"}, is};
}

RunRecord run_of(const std::vector<Record>& records) {
  RunRecord run;
  run.provenance = {"v3",  "c4",    "dirty",      "gcc",       "-O7",
                    "Odd", "a cpu", "a \"date\"", "a command", 5};
  run.tier = "full", run.subject = "a solver", run.seed = 37, run.seconds = 12.25;
  run.records = records;
  return run;
}

/// junit.xml of a run; `changes` since a baseline, or none.
std::string junit_of(const RunRecord& run, const BaselineChanges* changes = nullptr) {
  const ScratchFolder folder;
  changes ? write_verdicts_since(folder.file("."), run, *changes)
          : write_verdicts(folder.file("."), run);
  CHECK(read_text_file(folder.file("verdicts.json"), table_text_limits) == verdicts_json(run));
  return read_text_file(folder.file("junit.xml"), table_text_limits);
}

/// The whole file: its counts and its cases.
std::string suite(const std::string& counts, const std::string& cases) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"foldproof\" " + counts +
         " time=\"12.250\" timestamp=\"a &quot;date&quot;\">\n" + cases + "</testsuite>\n";
}

std::string case_of(const std::string& head, const std::string& time, const std::string& kind,
                    const std::string& message) {
  const std::string begin = "  <testcase " + head + " time=\"" + time + "\"";
  if (kind.empty()) return begin + "/>\n";
  return begin + ">\n    <" + kind + " message=\"" + message + "\"/>\n  </testcase>\n";
}

std::string check_case(const std::string& name, const std::string& kind,
                       const std::string& message) {
  return case_of("classname=\"check\" name=\"" + name + "\"", "0.000", kind, message);
}

/// Of law(): what was measured, and its claim.
std::string said(const std::string& name, const std::string& measured) {
  return "measured " + measured + ", uncertainty 0.125, bound 4.5 [mm]. It is " + name + ". ";
}

}  // namespace

TEST_CASE("verdicts: verdicts.json has every entry of a finding") {
  Record bare = law("law.bare", Outcome::not_applicable, std::nan(""));
  bare.finding.verdict.bound = std::numeric_limits<double>::infinity();
  bare.finding.verdict.uncertainty = 0;
  const json is = json::parse(verdicts_json(run_of({full_record(), bare})));
  const json expected = json::parse(R"({"schema": 1, "program": {"name": "foldproof",
    "version": "v3", "commit": "c4", "tree": "dirty", "compiler": "gcc", "flags": "-O7",
    "cpu": "a cpu", "date": "a \"date\"", "command": "a command", "tier": "full", "seed": 37,
    "subject": "a solver"}, "findings": [
   {"name": "law.full", "kind": "study", "study": "of-steps", "claim": "It is law.full.",
    "source": "BMF03 section 7", "measured": 123456.75, "uncertainty": 0.125, "bound": 4.5,
    "unit": "mm", "why_bound": "empirical: twice the largest", "basis": "empirical",
    "scope": "specific", "certainty": "estimated", "outcome": "fails", "note": "seen <once>",
    "seconds": 6.5, "faults": ["first-fault", "second-fault"], "headline": "too far"},
   {"name": "law.bare", "kind": "check", "study": "", "claim": "It is law.bare.", "source": "",
    "measured": null, "uncertainty": 0.0, "bound": null, "unit": "mm", "why_bound": "by hand",
    "basis": "reasoned", "scope": "specific", "certainty": "computed",
    "outcome": "not applicable", "note": "", "seconds": 0.0, "faults": []}]})");
  CHECK(is.dump(2) == expected.dump(2));
}

TEST_CASE("verdicts: verdicts.json has the declaration, the parts and the claims of a run") {
  RunRecord run = run_of({});
  run.declared = Declared{3, "f4", 5, 1e-7, {"held", "planes"}};
  run.origins = {{"0123456789abcdef", "clean", "day 1", 12}};
  run.claims = {claim("stiff", Ruling::refuted, Ruling::conditional)};
  const json is = json::parse(verdicts_json(run));
  const json declaration = json::parse(R"({"level": 3, "precision": "f4", "order": 5,
    "solve_tolerance": 1e-7, "capabilities": ["held", "planes"]})");
  CHECK(is.at("declaration") == declaration);
  CHECK(is.at("program").at("parts") == "12 jobs on 0123456789 (clean), begun day 1");
  const json expected = json::parse(R"json([{"name": "claim.stiff", "kind": "claim", "id": "stiff",
    "section": "7.3", "source": "BMF03 section 7.3", "paper": "BMF03",
    "paper_title": "Folds (2003)", "paragraph": 4, "begins": "We saw", "printed": "a + b",
    "restored": "a - b", "statement": "stiff & more", "ruling": "confirmed under a condition",
    "recorded": "refuted", "outcome": "fails", "condition": "if dry", "why": "because",
    "missing": "a lab", "decided_by": [
      {"finding": "law.full", "role": "limits", "outcome": "fails"},
      {"finding": "law.bare", "role": "contradicts", "outcome": "missing"}]
}])json");
  CHECK(is.at("findings").dump(2) == expected.dump(2));
}

TEST_CASE("verdicts: verdicts.json is indented by one blank, and replaces invalid UTF-8") {
  RunRecord run = run_of({});
  run.subject = "a \xff solver \u00e9";
  const std::string text = verdicts_json(run);
  CHECK_THAT(text, Catch::StartsWith("{\n \"findings\": [],\n \"program\": {\n  \"command\""));
  CHECK_THAT(text, Catch::EndsWith(" \"schema\": 1\n}\n"));
  CHECK_THAT(text, Catch::Contains("\"a \uFFFD solver \u00e9\""));
}

TEST_CASE("verdicts: junit.xml counts what fails, what did not run and what is skipped") {
  Record unrun = law("unrun", std::nullopt, std::nan(""));
  Record bench = law("bench", std::nullopt, 2.5);
  bench.kind = "bench", bench.seconds = 1.0625;
  unrun.finding.verdict.why_bound = "";
  RunRecord run = run_of({law("good", Outcome::holds, 0.25), full_record(), unrun, bench,
                          law("maybe", Outcome::inconclusive, 4.5),
                          law("other", Outcome::not_applicable, 1e-9)});
  run.claims = {claim("stiff", Ruling::refuted, Ruling::conditional),
                claim("soft", Ruling::refuted, Ruling::refuted),
                claim("open", Ruling::undecided, Ruling::undecided),
                claim("shut", Ruling::undecided, Ruling::undecided)};
  CHECK(junit_of(run) ==
        suite("tests=\"10\" failures=\"3\" errors=\"1\" skipped=\"3\"",
              check_case("good", "", "") +
                  case_of("classname=\"study\" name=\"law.full\"", "6.500", "failure",
                          "fails: too far; measured 123457, uncertainty 0.125, bound 4.5 [mm]. It "
                          "is law.full. seen &lt;once&gt;") +
                  check_case("unrun", "error", "did not run: no number. It is unrun. ") +
                  case_of("classname=\"bench\" name=\"bench\"", "1.062", "", "") +
                  check_case("maybe", "failure", "inconclusive: " + said("maybe", "4.5")) +
                  check_case("other", "skipped", "not applicable: " + said("other", "1e-09")) +
                  case_of(
                      "classname=\"claim\" name=\"stiff\"", "0", "failure",
                      "ruling: confirmed under a condition; recorded: refuted. stiff &amp; more") +
                  case_of("classname=\"claim\" name=\"soft\"", "0", "", "") +
                  case_of("classname=\"claim\" name=\"open\"", "0", "skipped",
                          "ruling: undecided; recorded: undecided. open &amp; more") +
                  case_of("classname=\"claim\" name=\"shut\"", "0", "skipped",
                          "ruling: undecided; recorded: undecided. shut &amp; more")));
}

TEST_CASE("verdicts: junit.xml since a baseline fails what is worse and skips what was as bad") {
  const RunRecord run =
      run_of({law("good", Outcome::holds, 0.25), law("worse", Outcome::fails, 7),
              law("known", Outcome::fails, 8), law("lost", Outcome::not_applicable, 3),
              law("other", Outcome::not_applicable, 2), law("maybe", Outcome::inconclusive, 4.5)});
  BaselineChanges changes;
  changes.worse_names = {"worse", "lost"};
  const std::string cases =
      check_case("good", "", "") + check_case("worse", "failure", "fails: " + said("worse", "7")) +
      check_case("known", "skipped", "fails, no worse than the baseline: " + said("known", "8")) +
      check_case("lost", "failure", "not applicable: " + said("lost", "3")) +
      check_case("other", "skipped", "not applicable: " + said("other", "2")) +
      check_case("maybe", "skipped",
                 "inconclusive, no worse than the baseline: " + said("maybe", "4.5"));
  CHECK(junit_of(run, &changes) ==
        suite("tests=\"6\" failures=\"2\" errors=\"0\" skipped=\"3\"", cases));
  changes.looser = {"it is < so", "and so"};
  CHECK(junit_of(run, &changes) ==
        suite("tests=\"7\" failures=\"3\" errors=\"0\" skipped=\"3\"",
              cases + case_of("classname=\"declaration\" name=\"declaration\"", "0", "failure",
                              "it is &lt; so; and so")));
}

TEST_CASE("verdicts: junit.xml says what was required where there is no number") {
  Record record = law("lost", Outcome::fails, std::nan(""));
  record.finding.headline = "a headline", record.finding.note = "stopped";
  CHECK(junit_of(run_of({record})) ==
        suite("tests=\"1\" failures=\"1\" errors=\"0\" skipped=\"0\"",
              check_case("lost", "failure",
                         "fails: no number; required: by hand. It is lost. stopped")));
}

TEST_CASE("verdicts: text is escaped for XML, and keeps only what XML allows") {
  CHECK(xml_text("a&b<c>d\"e'f\ng") == "a&amp;b&lt;c&gt;d&quot;e&apos;f&#10;g");
  CHECK(xml_text(std::string("0\0|\x01|\t|\r|\x1f|\x20|\x7f|~", 16)) == "0 | |\t| | | |\x7f|~");
  CHECK(xml_text("\u00e9\u4e2d\U0001F600") == "\u00e9\u4e2d\U0001F600");
  CHECK(xml_text("a\xffz") == "a\uFFFDz");
  CHECK(xml_text("\uFFFE") == "\uFFFD");
  CHECK(xml_text("a\uFFFEb\uFFFE\uFFFEc") == "a\uFFFDb\uFFFD\uFFFDc");
  CHECK(xml_text("a\uFFFFb\uFFFF\uFFFFc\uFFFE") == "a\uFFFDb\uFFFD\uFFFDc\uFFFD");
}

}  // namespace foldproof
