#include "verification/files/verdicts_file.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "verification/files/atomic_file.h"
#include "verification/finding_kinds.h"

namespace foldproof {

namespace {

nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

nlohmann::json to_json(const Record& record) {
  const Verdict& verdict = record.finding.verdict;
  nlohmann::json row = {{"name", record.name},
                        {"kind", record.kind},
                        {"study", record.study},
                        {"claim", record.claim},
                        {"source", record.source},
                        {"measured", number(verdict.measured)},
                        {"uncertainty", number(verdict.uncertainty)},
                        {"bound", number(verdict.bound)},
                        {"unit", verdict.unit},
                        {"why_bound", verdict.why_bound},
                        {"basis", has_empirical_bound(record) ? "empirical" : "reasoned"},
                        {"scope", name_of(scope_of(record))},
                        {"certainty", name_of(certainty_of(record))},
                        {"outcome", outcome_text(record)},
                        {"note", record.finding.note},
                        {"seconds", record.seconds},
                        {"faults", record.faults}};
  if (!record.finding.headline.empty()) row["headline"] = record.finding.headline;
  return row;
}

nlohmann::json to_json(const Table& table) {
  nlohmann::json columns = nlohmann::json::array();
  for (const Column& column : table.columns()) {
    columns.push_back({{"name", column.name}, {"unit", column.unit}});
    std::visit([&](const auto& values) { columns.back()["values"] = values; }, column.values);
  }
  return columns;
}

nlohmann::json to_json(const Declared& d) {
  return {{"level", d.level},
          {"precision", d.precision},
          {"order", d.order},
          {"solve_tolerance", d.solve_tolerance},
          {"capabilities", d.capabilities}};
}

nlohmann::json to_json(const ClaimRecord& record) {
  const Claim& claim = record.claim;
  nlohmann::json deciders = nlohmann::json::array();
  for (size_t k = 0; k < claim.decided_by.size(); ++k)
    deciders.push_back({{"finding", claim.decided_by[k].finding},
                        {"role", name_of(claim.decided_by[k].role)},
                        {"outcome", record.outcomes[k]}});
  return {{"name", "claim." + claim.id},
          {"kind", "claim"},
          {"id", claim.id},
          {"section", claim.section},
          {"source", place_of(claim)},
          {"paper", claim.paper},
          {"paper_title", claim.paper_title},
          {"paragraph", claim.cited.paragraph},
          {"begins", claim.cited.begins},
          {"printed", claim.cited.printed},
          {"restored", claim.cited.restored},
          {"statement", claim.statement},
          {"ruling", name_of(record.ruling)},
          {"recorded", name_of(claim.recorded)},
          {"outcome", name_of(outcome_of(record))},
          {"condition", claim.condition},
          {"why", claim.why},
          {"missing", claim.missing},
          {"decided_by", deciders}};
}

/// What JUnit makes of a finding: "" where it holds or was only measured.
///   changes   since a baseline; nullptr: there is none
const char* junit_kind(const Record& record, const BaselineChanges* changes) {
  if (did_not_run(record)) return "error";
  if (changes && changes->worse_names.contains(record.name)) return "failure";
  if (!record.outcome || record.outcome == Outcome::holds) return "";
  return changes || record.outcome == Outcome::not_applicable ? "skipped" : "failure";
}

/// What was measured and allowed; without a number, what was required.
std::string numbers_of(const Record& record) {
  const Verdict& v = record.finding.verdict;
  if (std::isnan(v.measured))
    return v.why_bound.empty() ? "no number" : "no number; required: " + v.why_bound;
  const std::string judged = fmt::format("measured {:.6g}, uncertainty {:.3g}, bound {:.6g} [{}]",
                                         v.measured, v.uncertainty, v.bound, v.unit);
  return record.finding.headline.empty() ? judged : record.finding.headline + "; " + judged;
}

std::string junit_case(const Record& record, const BaselineChanges* changes) {
  std::string text = fmt::format("  <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"",
                                 record.kind, xml_text(record.name), record.seconds);
  const std::string message =
      xml_text(fmt::format("{}. {} {}", numbers_of(record), record.claim, record.finding.note));
  const std::string kind = junit_kind(record, changes);
  if (kind.empty()) return text + "/>\n";
  const bool is_known = changes && kind == "skipped" && record.outcome != Outcome::not_applicable;
  return text + fmt::format(">\n    <{} message=\"{}{}: {}\"/>\n  </testcase>\n", kind,
                            outcome_text(record), is_known ? ", no worse than the baseline" : "",
                            message);
}

std::string junit_case(const ClaimRecord& record) {
  const Outcome outcome = outcome_of(record);
  const std::string text =
      fmt::format("  <testcase classname=\"claim\" name=\"{}\" time=\"0\"", record.claim.id);
  if (outcome == Outcome::holds) return text + "/>\n";
  return text +
         fmt::format(">\n    <{} message=\"ruling: {}; recorded: {}. {}\"/>\n  </testcase>\n",
                     outcome == Outcome::fails ? "failure" : "skipped", name_of(record.ruling),
                     name_of(record.claim.recorded), xml_text(record.claim.statement));
}

std::string junit_xml(const RunRecord& run, const BaselineChanges* changes) {
  size_t failures = 0, errors = 0, skipped = 0;
  std::string cases;
  for (const Record& record : run.records) {
    const std::string kind = junit_kind(record, changes);
    failures += kind == "failure", errors += kind == "error", skipped += kind == "skipped";
    cases += junit_case(record, changes);
  }
  for (const ClaimRecord& claim : run.claims) {
    failures += outcome_of(claim) == Outcome::fails;
    skipped += outcome_of(claim) == Outcome::inconclusive;
    cases += junit_case(claim);
  }
  const size_t laws = run.records.size() + run.claims.size();
  const bool is_looser = changes && !changes->looser.empty();
  if (is_looser) {
    ++failures;
    cases += fmt::format(
        "  <testcase classname=\"declaration\" name=\"declaration\" time=\"0\">\n    <failure "
        "message=\"{}\"/>\n  </testcase>\n",
        xml_text(fmt::format("{}", fmt::join(changes->looser, "; "))));
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"foldproof\" tests=\"{}\" "
      "failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{:.3f}\" "
      "timestamp=\"{}\">\n{}</testsuite>\n",
      laws + is_looser, failures, errors, skipped, run.seconds, xml_text(run.provenance.date),
      cases);
}

}  // namespace

std::string verdicts_json(const RunRecord& run) {
  const Provenance& p = run.provenance;
  nlohmann::json json = {{"schema", 1},
                         {"program",
                          {{"name", "foldproof"},
                           {"version", p.version},
                           {"commit", p.commit},
                           {"tree", p.tree},
                           {"compiler", p.compiler},
                           {"flags", p.flags},
                           {"cpu", p.cpu},
                           {"date", p.date},
                           {"command", p.command},
                           {"tier", run.tier},
                           {"seed", run.seed},
                           {"subject", run.subject}}},
                         {"findings", nlohmann::json::array()}};
  if (run.declared) json["declaration"] = to_json(*run.declared);
  if (!run.origins.empty()) json["program"]["parts"] = origins_text(run);
  for (const Record& record : run.records) {
    nlohmann::json row = to_json(record);
    if (run.declared) row["evidence"] = to_json(record.finding.evidence);
    json["findings"].push_back(std::move(row));
  }
  for (const ClaimRecord& claim : run.claims) json["findings"].push_back(to_json(claim));
  return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string xml_text(const std::string& text) {
  using nlohmann::json;
  const std::string quoted = json(text).dump(-1, ' ', false, json::error_handler_t::replace);
  std::string out;
  for (const char c : json::parse(quoted).get<std::string>()) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&apos;";
        break;
      case '\n':
        out += "&#10;";  // in an attribute a plain one becomes a blank
        break;
      default:
        out += static_cast<unsigned char>(c) < 32 && c != '\t' ? ' ' : c;
    }
  for (const char* const none : {"\uFFFE", "\uFFFF"})  // the two that are UTF-8 and no XML
    for (std::size_t at = out.find(none); at != std::string::npos; at = out.find(none, at))
      out.replace(at, 3, "\uFFFD");
  return out;
}

void write_verdicts(const std::string& folder, const RunRecord& run) {
  write_text(folder + "/verdicts.json", verdicts_json(run));
  write_text(folder + "/junit.xml", junit_xml(run, nullptr));
}

void write_verdicts_since(const std::string& folder, const RunRecord& run,
                          const BaselineChanges& changes) {
  write_text(folder + "/verdicts.json", verdicts_json(run));
  write_text(folder + "/junit.xml", junit_xml(run, &changes));
}

}  // namespace foldproof
