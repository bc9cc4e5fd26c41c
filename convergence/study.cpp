#include "convergence/study.h"

#include "convergence/headlines.h"

namespace foldproof {

namespace {

/// "The sentence rests on: exponent, is-two-over-omega." or nothing.
std::string words_of_headline(const std::string& study) {
  std::string names;
  for (const std::string_view family : headline_families(study))
    names += (names.empty() ? "" : ", ") + std::string(family);
  return names.empty() ? "" : " The sentence rests on the findings " + names + ".";
}

std::vector<std::string> names_of(const std::vector<NamedFinding>& findings) {
  std::vector<std::string> names;
  for (const NamedFinding& named : findings) names.push_back(named.name);
  return names;
}

}  // namespace

std::pair<std::vector<Record>, StudyRecord> run_study(const Study& study, const Subject& subject,
                                                      Tier tier, const Progress& progress) {
  StudyRecord whole{
      study.name, study.claim, study.source, study.about + words_of_headline(study.name),
      0,          {},          {},           {}};
  std::vector<Record> records;
  const Record blank{study.name, study.kind, study.name, study.claim, study.source,
                     {},         {},         "",         0,           {}};
  StudyResult result;
  const Record run = judge(blank, [&] {
    result = study.run(subject, tier, progress);
    require_headline_findings(study.name, names_of(result.findings));
    return Finding{};
  });
  if (run.outcome != Outcome::holds) return {{run}, whole};  // it threw, or was not offered

  for (NamedFinding& named : result.findings) {
    Record record = blank;
    record.name = named.name;
    record.claim = named.claim;
    record.outcome = outcome_of(named.finding.verdict);
    record.finding = std::move(named.finding);
    records.push_back(std::move(record));
  }
  whole.figures = std::move(result.figures);
  whole.maps = std::move(result.maps);
  whole.tables = std::move(result.tables);
  whole.seconds = run.seconds;
  return {records, whole};
}

}  // namespace foldproof
