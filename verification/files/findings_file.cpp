#include "verification/files/findings_file.h"

#include "verification/files/hdf5_file.h"
#include "verification/finding_kinds.h"

namespace foldproof {

namespace {

void write_record(const Hdf5& parent, const Record& record, int order) {
  const Hdf5 here = parent.group(record.name);
  const Verdict& verdict = record.finding.verdict;
  here.attribute("order", order);
  here.attribute("kind", record.kind);
  here.attribute("study", record.study);
  here.attribute("claim", record.claim);
  here.attribute("source", record.source);
  here.attribute("measured", verdict.measured);
  here.attribute("bound", verdict.bound);
  here.attribute("uncertainty", verdict.uncertainty);
  here.attribute("unit", verdict.unit);
  here.attribute("why_bound", verdict.why_bound);
  here.attribute("basis", std::string(has_empirical_bound(record) ? "empirical" : "reasoned"));
  here.attribute("scope", std::string(name_of(scope_of(record))));
  here.attribute("certainty", std::string(name_of(certainty_of(record))));
  here.attribute("outcome", std::string(outcome_text(record)));
  here.attribute("note", record.finding.note);
  if (!record.finding.headline.empty()) here.attribute("headline", record.finding.headline);
  here.attribute("seconds", record.seconds);
  here.attribute("faults", record.faults);
  if (!record.better.empty()) here.attribute("better", record.better);
  const std::vector<Column>& evidence = record.finding.evidence.columns();
  if (!evidence.empty()) write_columns(here.group("evidence"), evidence);
}

}  // namespace

void write_columns(const Hdf5& parent, const std::vector<Column>& columns) {
  int order = 0;
  for (const Column& column : columns) {
    const Hdf5 set = std::visit(
        [&](const auto& values) { return parent.dataset(column.name, values); }, column.values);
    set.attribute("order", order++);
    set.attribute("unit", column.unit);
  }
}

void write_findings(const Hdf5& file, const std::vector<Record>& records) {
  const Hdf5 findings = file.group("findings");
  for (size_t k = 0; k < records.size(); ++k) write_record(findings, records[k], int(k));
}

}  // namespace foldproof
