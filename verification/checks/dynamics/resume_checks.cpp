// Runs that go on from a checkpoint: they end with the bits of the run that was never interrupted.
#include "verification/checks/dynamics/dynamics_checks.h"
#include "verification/evidence.h"
#include "verification/specimens/followed_runs.h"

namespace foldproof {

namespace {

/// Numbers that differ, over all frames of the run at which it is interrupted; NaN for a run that
/// is not what it is meant to be.
double differences(const NamedRun& of) {
  const Integrator& integrator = integrator_named(of.integrator);
  Followed whole;
  whole.result = simulate(build_system(of.scene), integrator, start_state(of.scene),
                          of.scene.schedule, follower(whole));
  if (whole.checkpoints.size() < 5 || whole.checkpoints.size() != whole.frames.size()) return NAN;
  if (whole.result.stop.has_value() != of.stops) return NAN;
  Worst worst;
  for (std::size_t k = 0; k < whole.checkpoints.size(); ++k) {
    Followed rest;
    rest.result = resume(build_system(of.scene), integrator, whole.checkpoints[k],
                         of.scene.schedule, follower(rest));
    worst.observe(bits_that_differ(numbers_after(whole, k + 1, whole.rows_at[k], k + 1),
                                   numbers_after(rest, 0, 0, 0)));
  }
  return worst.value();
}

Finding same_bits_finding(const Subject&) {
  Table measured{{"case", ""}, {"numbers that differ", "1"}};
  for (const NamedRun& run : runs_of_all_parts())
    measured.row(run.name + ", " + run.integrator, differences(run));
  return judge_worst(
      measured, 0,
      "a checkpoint holds everything a run remembers: frames, diagnostics, later checkpoints, work "
      "and stop have the same bits, whichever frame the run resumes from");
}

}  // namespace

std::vector<Check> resume_checks() {
  return {
      {"dynamics.resumed-run-ends-with-the-same-bits",
       "A run of the reference that resumes from any of its checkpoints ends with the same bits.",
       "good practice", same_bits_finding}};
}

}  // namespace foldproof
