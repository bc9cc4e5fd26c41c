#include "verification/verdict.h"

#include <chrono>
#include <cmath>
#include <exception>
#include <stdexcept>

namespace foldproof {

namespace {

class Clock {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Finding broken(const std::string& what) {
  return {{nan, nan, nan, "1", "it must run to its end"}, {}, "stopped by an error: " + what};
}

/// The outcome of run(), which may throw.
template <class Run>
Record judged(Record record, const Run& run) {
  const Clock clock;
  try {
    record.finding = run();
    record.outcome = name_of(ruling(record.finding.verdict));
  } catch (const NotOffered& missing) {
    record.finding = broken("");
    record.finding.note = "the subject does not offer " + missing.operation;
    record.outcome = name_of(Ruling::not_applicable);
  } catch (const std::exception& error) {
    record.finding = broken(error.what());
    record.outcome = name_of(Ruling::fails);
  }
  record.seconds = clock.seconds();
  return record;
}

}  // namespace

void Worst::see(double value) {
  if (!std::isnan(worst_) && !(value <= worst_)) worst_ = value;
}

std::string_view name_of(Mark mark) {
  switch (mark) {
    case Mark::measured:
      return "measured";
    case Mark::unfinished:
      return "unfinished";
    case Mark::diverged:
      return "diverged";
  }
  throw std::logic_error("name_of: a mark without a name");
}

std::string_view name_of(Ruling ruling) {
  switch (ruling) {
    case Ruling::holds:
      return "holds";
    case Ruling::fails:
      return "fails";
    case Ruling::inconclusive:
      return "inconclusive";
    case Ruling::not_applicable:
      return "not applicable";
  }
  return "fails";
}

Ruling ruling(const Verdict& verdict) {
  if (std::isnan(verdict.measured) || !(verdict.uncertainty >= 0) || !std::isfinite(verdict.bound))
    return Ruling::fails;
  if (verdict.measured + verdict.uncertainty <= verdict.bound) return Ruling::holds;
  if (verdict.measured - verdict.uncertainty > verdict.bound) return Ruling::fails;
  return Ruling::inconclusive;
}

Record run_check(const Check& check, const Subject& subject) {
  Record record{check.name, "check", "", check.claim, check.source, {}, "", "", 0, {}};
  return judged(std::move(record), [&] { return check.run(subject); });
}

std::pair<std::vector<Record>, StudyRecord> run_study(const Study& study, const Subject& subject, Tier tier,
                                                      const Progress& progress) {
  const Clock clock;
  StudyRecord whole{study.name, study.claim, study.source, study.about, 0, {}, {}, {}};
  std::vector<Record> records;
  const Record blank{study.name, "study", study.name, study.claim, study.source, {}, "", "", 0, {}};
  StudyResult result;
  const Record run = judged(blank, [&] {
    result = study.run(subject, tier, progress);
    return Finding{};
  });
  if (run.outcome != name_of(Ruling::holds)) return {{run}, whole};  // it threw, or was not offered

  for (NamedFinding& named : result.findings) {
    Record record = blank;
    record.name = named.name;
    record.claim = named.claim;
    record.outcome = name_of(ruling(named.finding.verdict));
    record.finding = std::move(named.finding);
    records.push_back(std::move(record));
  }
  whole.figures = std::move(result.figures);
  whole.maps = std::move(result.maps);
  whole.tables = std::move(result.tables);
  whole.seconds = clock.seconds();
  return {records, whole};
}

}  // namespace foldproof
