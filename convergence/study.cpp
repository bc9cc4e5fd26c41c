#include "convergence/study.h"

#include <stdexcept>

namespace foldproof {

namespace {

/// "The sentence rests on: exponent, is-two-over-omega." or nothing.
std::string words_of_headline(const Study& study) {
  std::string names;
  for (const std::string& family : study.rests_on) names += (names.empty() ? "" : ", ") + family;
  return names.empty() ? "" : " The sentence rests on the findings " + names + ".";
}

void require_headline_findings(const Study& study, const std::vector<NamedFinding>& findings) {
  for (const std::string& family : study.rests_on) {
    const std::string name = study.name + "." + family;
    const bool is_measured = std::ranges::any_of(findings, [&](const NamedFinding& finding) {
      return finding.name == name || finding.name.starts_with(name + ".");
    });
    if (!is_measured)
      throw std::logic_error(study.name + ": its sentence rests on " + name +
                             ", which it does not measure");
  }
}

/// Of each curve, as where the quick tier has two meshes: its table says as much.
bool shows_two_points(const Figure& figure) {
  return std::ranges::all_of(figure.curves, [](const Curve& one) { return one.x.size() <= 2; });
}

}  // namespace

std::pair<std::vector<Record>, StudyRecord> run_study(const Study& study, const Subject& subject,
                                                      Tier tier, const Progress& progress) {
  StudyRecord whole{study.name, study.claim, study.source, study.about + words_of_headline(study),
                    0,          {},          {},           {}};
  std::vector<Record> records;
  const Record blank{study.name, study.kind, study.name, study.claim, study.source,
                     {},         {},         "",         0,           {}};
  StudyResult result;
  const Record run = judge(blank, [&] {
    result = study.run(subject, tier, progress);
    require_headline_findings(study, result.findings);
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
  std::erase_if(result.figures, shows_two_points);
  whole.figures = std::move(result.figures);
  whole.maps = std::move(result.maps);
  whole.tables = std::move(result.tables);
  whole.seconds = run.seconds;
  return {records, whole};
}

}  // namespace foldproof
