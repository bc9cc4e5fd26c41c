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

Finding finding_without_number(std::string why_bound, std::string note) {
  return {{nan, nan, nan, "1", std::move(why_bound)}, {}, std::move(note)};
}

Finding error_finding(const std::string& what) {
  return finding_without_number("it must run to its end", "stopped by an error: " + what);
}

}  // namespace

std::string_view name_of(Outcome outcome) {
  constexpr std::string_view names[] = {"holds", "fails", "inconclusive", "not applicable"};
  return names[size_t(outcome)];
}

Outcome outcome_of(const Verdict& verdict) {
  if (std::isnan(verdict.measured) || !(verdict.uncertainty >= 0) || !std::isfinite(verdict.bound))
    return Outcome::fails;
  if (verdict.measured + verdict.uncertainty <= verdict.bound) return Outcome::holds;
  if (verdict.measured - verdict.uncertainty > verdict.bound) return Outcome::fails;
  return Outcome::inconclusive;
}

bool did_not_run(const Record& record) { return !record.outcome && record.kind != "bench"; }

std::string_view outcome_text(const Record& record) {
  if (record.outcome) return name_of(*record.outcome);
  return did_not_run(record) ? "did not run" : "measured";
}

Check::Check(std::string name, std::string claim, std::string source, OfSubject run)
    : name(std::move(name)),
      claim(std::move(claim)),
      source(std::move(source)),
      run(std::move(run)) {}

Check::Check(std::string name, std::string claim, std::string source, std::function<Finding()> run)
    : Check(std::move(name), std::move(claim), std::move(source),
            OfSubject([run = std::move(run)](const Subject&) { return run(); })) {}

Finding judge_worst(Table evidence, std::string_view column, double bound, std::string why_bound,
                    std::string note) {
  const Column& judge = evidence.column(column);
  const Verdict verdict{evidence.worst(column), bound, judge.uncertainty, judge.unit,
                        std::move(why_bound)};
  return {verdict, std::move(evidence), std::move(note)};
}

Finding judge_worst(Table evidence, double bound, std::string why_bound, std::string note) {
  const std::string last = evidence.columns().back().name;
  return judge_worst(std::move(evidence), last, bound, std::move(why_bound), std::move(note));
}

Record judge(Record record, const std::function<Finding()>& act) {
  const Clock clock;
  try {
    record.finding = act();
    record.outcome = outcome_of(record.finding.verdict);
  } catch (const NotOffered& missing) {
    record.finding = finding_without_number("", "the subject does not offer " + missing.operation);
    record.outcome = Outcome::not_applicable;
  } catch (const std::exception& error) {
    record.finding = error_finding(error.what());
    record.outcome = Outcome::fails;
  }
  record.seconds = clock.seconds();
  return record;
}

Record run_check(const Check& check, const Subject& subject) {
  Record record{check.name, "check", "", check.claim, check.source, {}, {}, "", 0, {}};
  return judge(std::move(record), [&] { return check.run(subject); });
}

}  // namespace foldproof
