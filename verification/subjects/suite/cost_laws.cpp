// How the cost of a step grows with the number of particles.

#include <chrono>
#include <optional>

#include "verification/oracles/estimate.h"
#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr int ladder[] = {4, 8, 16, 32, 64, 128};  // cells a side; four times the particles each
constexpr int most_readings = 7;
constexpr double enough_seconds = 0.3;  // of readings at one size
constexpr double seconds_a_reading = 0.01;
constexpr double longest_step = 0.2;  // s; the ladder ends at a slower one
constexpr size_t quadruplings = 2;    // the last of the ladder are judged

/// Of the same cells whatever their number, so that its steps are the same problem.
PortableScene sheet_of(int cells) {
  PortableScene scene = sheet_of_cells(cells);
  scene.name = fmt::format("moving sheet of {} cells", cells);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const Vector3 p = scene.mesh.rest.col(i);
    scene.x.col(i) << 1.04 * p[0], 1.06 * p[1], 0.03 * std::sin(7 * p[0]) * std::cos(5 * p[1]);
    scene.v.col(i) << 0, 0, 0.3 * std::cos(6 * p[0]);
  }
  return scene;
}

/// A size of the sheet, and the readings of a step there, ascending [s].
struct Rung {
  long particles, steps;                          // steps a reading
  std::vector<double> clock, processor, waiting;  // waiting: for the processor, others being at it
};

void take_reading(WatchedSolver& solver, double dt, Rung& rung) {
  using Clock = std::chrono::steady_clock;
  const double steps = double(rung.steps);
  const ProcessorTime before = solver.processor_time();
  const Clock::time_point start = Clock::now();
  solver.advance(dt, rung.steps);
  rung.clock.push_back(std::chrono::duration<double>(Clock::now() - start).count() / steps);
  const ProcessorTime after = solver.processor_time();
  rung.processor.push_back((after.computing - before.computing) / steps);
  rung.waiting.push_back((after.waiting - before.waiting) / steps);
}

Rung climb(Trial& trial, int cells) {
  const PortableScene scene = sheet_of(cells);
  trial.prepare(scene);
  WatchedSolver& solver = trial.solver();
  solver.advance(scene.dt, 1);  // it may set up its solver
  Rung rung{scene.x.cols(), 1, {}, {}, {}};
  take_reading(solver, scene.dt, rung);
  const double first = rung.clock.front();
  rung = {scene.x.cols(), std::clamp(std::lround(seconds_a_reading / first), 1L, 200L), {}, {}, {}};
  double spent = 0;
  for (int k = 0; k < most_readings && (k < 2 || spent < enough_seconds); ++k) {
    take_reading(solver, scene.dt, rung);
    spent += rung.clock.back() * double(rung.steps);
  }
  for (std::vector<double>* readings : {&rung.clock, &rung.processor, &rung.waiting})
    std::ranges::sort(*readings);
  return rung;
}

struct Climb {
  std::vector<Rung> rungs;
  std::string note;  // why it ended early; may be empty
};

/// Ends at a slow step, or at a size that the solver refuses, if there are sizes enough below it.
Climb climbed(Trial& trial) {
  Climb climb_to;
  std::vector<Rung>& rungs = climb_to.rungs;
  for (const int cells : ladder) {
    const bool has_enough = rungs.size() > quadruplings;
    try {
      rungs.push_back(climb(trial, cells));
    } catch (const SolverFailure& failure) {
      if (!has_enough || failure.cause != "error") throw;
      trial.restart();
      climb_to.note = fmt::format("it fails at {} cells a side: {}", cells, failure.what());
      break;
    } catch (const NotOffered& refusal) {
      if (!has_enough) throw;
      climb_to.note = fmt::format("it declines {} cells a side: {}", cells, refusal.operation);
      break;
    }
    if (rungs.back().clock.front() > longest_step) break;
  }
  if (rungs.size() <= quadruplings)
    throw NotOffered{fmt::format("steps short enough: one of {} particles takes {:.2g} s",
                                 rungs.back().particles, rungs.back().clock.front())};
  return climb_to;
}

using Readings = std::vector<double> Rung::*;

/// The power of the number of particles by which the least reading grew between two rungs. Its
/// uncertainty: by how much the second least readings differ from the least.
oracles::Estimate exponent_between(const Rung& small, const Rung& large, Readings of) {
  const std::vector<double>&a = small.*of, &b = large.*of;
  const double growth = std::log(double(large.particles) / double(small.particles));
  return {std::log(b[0] / a[0]) / growth, std::log(a[1] / a[0] * b[1] / b[0]) / growth};
}

/// The lesser of the last two: a sheet outgrows a cache of the machine once, and one reading may be
/// disturbed, but a square is seen at each size.
oracles::Estimate lesser_exponent(const std::vector<Rung>& rungs, Readings of) {
  const size_t last = rungs.size() - 1;
  const oracles::Estimate before = exponent_between(rungs[last - 2], rungs[last - 1], of),
                          now = exponent_between(rungs[last - 1], rungs[last], of);
  return before.value < now.value ? before : now;
}

/// Processor time, which other programs on the machine change little, unless most of the clock's
/// time is spent otherwise: asleep, or at a processor that is not asked here.
Readings readings_to_judge(const Rung& largest) {
  const bool computes = largest.processor[0] + largest.waiting[0] > largest.clock[0] / 2;
  return computes ? &Rung::processor : &Rung::clock;
}

Table costs_of(const std::vector<Rung>& rungs, Readings of) {
  Table costs = table_of(
      "particles [1] | steps a reading [1] | seconds a step by the clock [s] | "
      "seconds of the processor [s] | second least over the least [1] | "
      "exponent from the size before [1]");
  for (size_t k = 0; k < rungs.size(); ++k) {
    const std::vector<double>& judged = rungs[k].*of;
    costs.row(rungs[k].particles, rungs[k].steps, rungs[k].clock[0], rungs[k].processor[0],
              judged[1] / judged[0],
              k == 0 ? nan : exponent_between(rungs[k - 1], rungs[k], of).value);
  }
  return costs;
}

Finding finding_of(const Climb& found) {
  const Rung& largest = found.rungs.back();
  const Readings of = readings_to_judge(largest);
  Table measured{{"particles", "1"}, {"lesser exponent of the last two sizes", "1"}};
  measured.row(largest.particles, lesser_exponent(found.rungs, of));
  std::string note = of == &Rung::processor ? "by processor time" : "by the clock";
  if (!found.note.empty()) note += "; " + found.note;
  Finding finding =
      judge_worst(measured, 1.75,
                  "halfway between 3/2, of a direct solver that dissects a sheet or of conjugate "
                  "gradients, and 2, of anything that asks all pairs; dense solvers have 3",
                  note);
  finding.evidence = costs_of(found.rungs, of);
  return finding;
}

/// What seems too steep is measured again, for the machine may be busy: it counts if it is seen
/// twice. Throws NotOffered if the readings spread too far to tell.
Finding cost_grows_slowly(Trial& trial) {
  Finding finding = finding_of(climbed(trial));
  if (outcome_of(finding.verdict) == Outcome::holds) return finding;
  finding = finding_of(climbed(trial));
  const Verdict& verdict = finding.verdict;
  if (outcome_of(verdict) == Outcome::inconclusive)
    throw NotOffered{fmt::format("steady seconds: the exponent is {:.2f}, +- {:.2f}",
                                 verdict.measured, verdict.uncertainty)};
  return finding;
}

}  // namespace

std::vector<Law> cost_laws() {
  return {
      {"cost.growth-is-below-quadratic",
       "Per step, a larger sheet of the same triangles costs less than the square of its size.",
       "nested dissection (George 1973)", cost_grows_slowly, "L1"},
  };
}

}  // namespace foldproof
