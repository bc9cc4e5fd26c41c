#include "verification/cases/judge.h"

#include <fmt/format.h>

#include <limits>

namespace foldproof {

namespace {

/// A quantity to be reached is judged by what it lacks.
Verdict verdict_of(const Quantity& quantity, const Expectation& expectation, double value) {
  if (quantity.sense == Sense::at_most)
    return {value, expectation.bound, 0, quantity.unit, expectation.why};
  const std::string unit = quantity.unit;
  const std::string lacks =
      fmt::format("{}short of {:.6g}", unit == "1" ? "" : unit + " ", expectation.bound);
  return {expectation.bound - value, 0, 0, lacks, expectation.why};
}

std::string note_of(const Quantity& quantity, const Expectation& expectation, double value) {
  if (quantity.sense == Sense::at_most) return "";
  return fmt::format("reached {:.6g} {}; measured is what is missing from {:.6g}", value,
                     quantity.unit, expectation.bound);
}

}  // namespace

/// Beyond 180 degrees an angle goes on from the other side, and the energy of its hinge jumps.
void CaseJudge::watch_hinges(const State& frame) {
  if (!case_.scene.bending || !frame.x.allFinite()) return;
  std::vector<double> angles = hinge_angles(case_.scene.mesh, frame.x);
  for (size_t k = 0; k < angles_.size(); ++k)
    if (std::abs(angles[k] - angles_[k]) > pi) ++folded_through_;
  angles_ = std::move(angles);
}

void CaseJudge::record(const State& frame) {
  watch_hinges(frame);
  for (size_t k = 0; k < observed_.size(); ++k) {
    if (!case_.expectations[k].not_asked.empty()) continue;  // of this shape it may have no meaning
    if (const Quantity& quantity = *find_quantity(case_.expectations[k].key); !quantity.of_run)
      observed_[k].observe(value_at(quantity, case_.scene, objects_, frame));
  }
}

Finding CaseJudge::finding_of(size_t k, const RunView& run) const {
  const Expectation& expectation = case_.expectations[k];
  const Quantity& quantity = *find_quantity(expectation.key);
  if (!expectation.not_asked.empty())
    return {verdict_of(quantity, expectation, nan), {}, expectation.not_asked};
  const RunResult& result = run.result;
  double value = quantity.of_run ? quantity.of_run(run) : observed_[k].value();
  std::string note = note_of(quantity, expectation, value);
  if (result.stop) note = "the run stopped: " + describe(*result.stop);
  const bool is_end = expectation.key == "runs_to_its_end";
  if (result.stop && !is_end) value = std::numeric_limits<double>::quiet_NaN();
  const Verdict verdict = verdict_of(quantity, expectation, value);
  if (expectation.key.starts_with("energy_") && folded_through_ > 0 &&
      verdict.measured > verdict.bound)
    note += fmt::format(
        "{}{} times a hinge folded through 180 degrees from one frame to the next: there its angle "
        "goes on from the other side, and the energy jumps",
        note.empty() ? "" : "; ", folded_through_);
  return {verdict, {}, note};
}

std::vector<Record> CaseJudge::records(const RunResult& result) const {
  std::vector<Record> records;
  const RunView run{case_.scene, summary_, result, repetition_, objects_};
  for (size_t k = 0; k < observed_.size(); ++k) {
    const Expectation& expectation = case_.expectations[k];
    Record record;
    record.name = finding_name(case_.scene, expectation);
    record.kind = "check";
    record.claim = find_quantity(expectation.key)->claim;
    record.source = case_.scene.title;
    record.finding = finding_of(k, run);
    record.outcome = expectation.not_asked.empty() ? outcome_of(record.finding.verdict)
                                                   : Outcome::not_applicable;
    records.push_back(std::move(record));
  }
  return records;
}

std::string describe(const Stop& stop) {
  const std::string who = stop.particle < 0 ? "" : fmt::format(", particle {}", stop.particle);
  return fmt::format("{} (step {}, after t = {:.9g} s{})", stop.reason, stop.step, stop.time, who);
}

}  // namespace foldproof
