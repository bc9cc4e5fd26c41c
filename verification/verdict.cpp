#include "verification/verdict.h"

#include <chrono>
#include <cmath>
#include <exception>

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

}  // namespace

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

Finding judged_worst(Table evidence, std::string_view column, double bound, std::string why_bound,
                     std::string note) {
  const Column& judged = evidence.column(column);
  const Verdict verdict{evidence.worst(column), bound, judged.uncertainty, judged.unit, std::move(why_bound)};
  return {verdict, std::move(evidence), std::move(note)};
}

Finding judged_worst(Table evidence, double bound, std::string why_bound, std::string note) {
  const std::string last = evidence.columns().back().name;
  return judged_worst(std::move(evidence), last, bound, std::move(why_bound), std::move(note));
}

Record judged(Record record, const std::function<Finding()>& act) {
  const Clock clock;
  try {
    record.finding = act();
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

Record run_check(const Check& check, const Subject& subject) {
  Record record{check.name, "check", "", check.claim, check.source, {}, "", "", 0, {}};
  return judged(std::move(record), [&] { return check.run(subject); });
}

}  // namespace foldproof
