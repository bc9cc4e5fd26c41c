#include "verification/files/results_file.h"

#include <fmt/format.h>

#include "verification/files/findings_file.h"
#include "verification/files/hdf5_file.h"
#include "verification/files/studies_file.h"

namespace foldproof {

namespace {

void write_cases(const Hdf5& file, const std::vector<CaseRecord>& cases) {
  const Hdf5 parent = file.group("cases");
  int order = 0;
  for (const CaseRecord& record : cases) {
    const Hdf5 here = parent.group(record.name);
    here.attribute("order", order++);
    here.attribute("file", record.file);
    here.attribute("title", record.title);
    here.attribute("about", record.about);
    here.attribute("seconds", record.seconds);
    here.attribute("stopped", record.stopped);
  }
}

/// A column that holds texts even where there is no row.
Column texts(const char* name) { return {name, "", std::vector<std::string>()}; }

void write_faults(const Hdf5& file, const std::vector<Fault>& faults) {
  Table table{texts("name"),
              texts("file"),
              texts("find"),
              texts("replace"),
              texts("law"),
              texts("caught_by"),
              texts("caught_by_tests"),
              texts("outcome")};
  for (const Fault& fault : faults)
    table.row(fault.name, fault.file, fault.find, fault.replace, fault.law,
              fmt::format("{}", fmt::join(fault.caught_by, ", ")),
              fmt::format("{}", fmt::join(fault.caught_by_tests, "\n")), fault.outcome);
  write_columns(file.group("faults"), table.columns());
}

/// `/claims/<id>`: the ruling and what it rests on; the claim's findings and their roles in
/// the same order.
void write_claims(const Hdf5& file, const std::vector<ClaimRecord>& claims) {
  const Hdf5 parent = file.group("claims");
  int order = 0;
  for (const ClaimRecord& record : claims) {
    const Hdf5 here = parent.group(record.claim.id);
    std::vector<std::string> findings, roles;
    for (const Decider& decider : record.claim.decided_by) {
      findings.push_back(decider.finding);
      roles.emplace_back(name_of(decider.role));
    }
    here.attribute("order", order++);
    here.attribute("paper", record.claim.paper);
    here.attribute("paper_title", record.claim.paper_title);
    here.attribute("section", record.claim.section);
    here.attribute("paragraph", record.claim.cited.paragraph);
    here.attribute("begins", record.claim.cited.begins);
    here.attribute("printed", record.claim.cited.printed);
    here.attribute("restored", record.claim.cited.restored);
    here.attribute("statement", record.claim.statement);
    here.attribute("ruling", std::string(name_of(record.ruling)));
    here.attribute("recorded", std::string(name_of(record.claim.recorded)));
    here.attribute("condition", record.claim.condition);
    here.attribute("why", record.claim.why);
    here.attribute("missing", record.claim.missing);
    here.attribute("decided_by", findings);
    here.attribute("roles", roles);
    here.attribute("outcomes", record.outcomes);
  }
}

}  // namespace

std::string RunOrigin::text() const {
  return fmt::format("{} job{} on {} ({}), begun {}", jobs, jobs == 1 ? "" : "s",
                     commit.substr(0, 10), tree, date);
}

std::string origins_text(const RunRecord& run) {
  std::vector<std::string> texts;
  for (const RunOrigin& origin : run.origins) texts.push_back(origin.text());
  return fmt::format("{}", fmt::join(texts, "; "));
}

void write_run(const std::string& path, const RunRecord& run) {
  write_hdf5(path, [&](const Hdf5& file) {
    write_provenance(file, run.provenance);
    file.attribute("tier", run.tier);
    file.attribute("seed", int(run.seed));
    file.attribute("subject", run.subject);
    file.attribute("subject_version", run.subject_version);
    file.attribute("seconds", run.seconds);
    if (!run.origins.empty()) file.attribute("parts", origins_text(run));
    write_findings(file, run.records);
    write_studies(file, run.studies);
    write_cases(file, run.cases);
    write_claims(file, run.claims);
    if (!run.faults.empty()) write_faults(file, run.faults);
  });
}

}  // namespace foldproof
