#include "convergence/damping/artificial_damping.h"

#include <algorithm>
#include <cmath>

namespace foldproof {

namespace {

constexpr double heavy = 10;  // h c/2 of the fastest damped mode

struct OneSided {
  std::string method, damped;
  double worst;  // |change of amplitude per period| of the undamped modes
};

OneSided one_sided(const Subject& subject, const VibratingSheet& sheet, const Integrator& method,
                   ModeKind damped) {
  const double h = sheet.limit / 2;
  double fastest = 0;
  for (const SheetMode& mode : sheet.modes)
    if (mode.kind == damped) fastest = std::max(fastest, mode.frequency);
  const double relaxation = 2 * heavy / (h * fastest * fastest);
  const bool springs = damped == ModeKind::stretch;
  const std::vector<oracles::Factors> factors =
      factors_of(subject, sheet, method, {springs ? relaxation : 0, springs ? 0 : relaxation}, h);
  Worst worst;
  for (size_t i = 0; i < sheet.modes.size(); ++i)
    if (sheet.modes[i].kind != damped)
      worst.observe(std::abs(loss_per_period(sheet.modes[i], factors[i], h)));
  return {std::string(method.name), springs ? "springs" : "hinges", worst.value()};
}

Table evidence_of(const OneSided& springs, const OneSided& hinges) {
  Table evidence{{"damped", "1"}, {"change of the undamped modes", "of the amplitude, a period"}};
  for (const OneSided& one : {springs, hinges}) evidence.row(one.damped, one.worst);
  return evidence;
}

NamedFinding spares_the_undamped(const OneSided& springs, const OneSided& hinges) {
  return {"artificial-damping.undamped-parts-stay-undamped." + springs.method,
          "Scheme " + springs.method +
              " adds no damping to bending when springs alone are damped heavily, nor to stretch "
              "when hinges are.",
          judge_worst(evidence_of(springs, hinges), 100 * factor_noise,
                      "the slowest mode takes a hundred steps for a period; of each step, " +
                          std::string(why_factor_noise),
                      "h c/2 is 10 for the fastest damped mode, the step half the elastic limit")};
}

/// The same measure of backward Euler, which must be large: the claim's other half.
NamedFinding damps_everything(const OneSided& springs, const OneSided& hinges) {
  Worst worst;
  for (const OneSided& one : {springs, hinges}) worst.observe(0.1 / one.worst);
  return {"artificial-damping.damps-every-motion.backward-euler",
          "Backward Euler damps undamped motions: at half the elastic limit the fastest of them "
          "loses more than a tenth of its amplitude in a period.",
          {{worst.value(), 1, 0, "1",
            "measured is a tenth over the loss; the derived loss is pi omega h"},
           evidence_of(springs, hinges),
           ""}};
}

Table one_sided_table(const std::vector<OneSided>& rows) {
  Table table{{"method", "1"}, {"damped", "1"}, {"of the amplitude, a period", "1"}};
  for (const OneSided& row : rows) table.row(row.method, row.damped, row.worst);
  return {"one-sided",
          "Largest change of an undamped mode while the others are damped heavily (h c/2 up to 10)",
          table};
}

}  // namespace

void add_one_sided_damping(const Subject& subject, const VibratingSheet& sheet,
                           StudyResult& result) {
  std::vector<OneSided> rows;
  for (const Integrator& method : integrators()) {
    if (method.family == Family::fully_explicit) continue;  // unstable at this damping
    const OneSided springs = one_sided(subject, sheet, method, ModeKind::stretch);
    const OneSided hinges = one_sided(subject, sheet, method, ModeKind::bending);
    rows.push_back(springs);
    rows.push_back(hinges);
    if (method.family == Family::mixed)
      result.findings.push_back(spares_the_undamped(springs, hinges));
    if (method.name == "backward-euler")
      result.findings.push_back(damps_everything(springs, hinges));
  }
  result.tables.push_back(one_sided_table(rows));
}

}  // namespace foldproof
