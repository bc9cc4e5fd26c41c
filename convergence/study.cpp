#include "convergence/study.h"

namespace foldproof {

std::pair<std::vector<Record>, StudyRecord> run_study(const Study& study, const Subject& subject,
                                                      Tier tier, const Progress& progress) {
  StudyRecord whole{study.name, study.claim, study.source, study.about, 0, {}, {}, {}};
  std::vector<Record> records;
  const Record blank{study.name, study.kind, study.name, study.claim, study.source,
                     {},         {},         "",         0,           {}};
  StudyResult result;
  const Record run = judge(blank, [&] {
    result = study.run(subject, tier, progress);
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
