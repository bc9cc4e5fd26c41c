// Determinism, state, observed order, the error of the step and its cost, precision.

#include "verification/oracles/estimate.h"
#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr long steps = 20;

/// Numbers that differ; none where the solver declares that its sums have no fixed order, and
/// positions differ by no more than the rounding of two runs.
long differing(Trial& trial, const PortableScene& scene, const Snapshot& a, const Snapshot& b) {
  const double rounding = 2 * rounding_error(scene, steps, trial.declaration()) * largest(scene.x);
  if (!trial.declaration().is_deterministic && largest(a.x - b.x) <= rounding) return 0;
  return (a.x.array() != b.x.array()).count() + (a.v.array() != b.v.array()).count();
}

Finding count_differences(Trial& trial, const Snapshot& a, const Snapshot& b, const char* why) {
  Table measured{{"numbers", "1"}, {"numbers that differ", "1"}};
  measured.row(2 * a.x.size(), differing(trial, moving_sheet(), a, b));
  return judge_worst(measured, 0, why);
}

Finding same_in_a_fresh_process(Trial& trial) {
  trial.restart();
  const Snapshot first = trial.after(moving_sheet(), steps);
  trial.restart();
  return count_differences(trial, first, trial.after(moving_sheet(), steps),
                           "the same program, input and machine: the same bits");
}

Finding second_scene_starts_afresh(Trial& trial) {
  trial.restart();
  const Snapshot first = trial.after(moving_sheet(), steps);
  trial.after(falling_sheet(), steps);
  return count_differences(trial, first, trial.after(moving_sheet(), steps),
                           "nothing of an earlier scene may be left");
}

/// Ten times and a hundred times as stiff, in steps of 5 ms, which many solvers must divide.
Finding stiff_scene_after_a_soft_one(Trial& trial) {
  constexpr long count = 6;  // no more: what explodes must not exceed single precision
  Table measured = table_of("Young's modulus [N/m] | numbers [1] | numbers that differ [1]");
  for (const double stiffer : {10.0, 100.0}) {
    PortableScene scene = moving_sheet();
    scene.name = "stiff moving sheet";
    scene.material.young *= stiffer, scene.dt = 0.005;
    trial.restart();
    const Snapshot first = trial.after(scene, count);
    if (!(largest(first.x - scene.x) < largest(scene.x))) continue;  // it needs shorter steps
    trial.restart();
    PortableScene soft = moving_sheet();
    soft.material.young *= 0.01;
    trial.after(soft, count);
    const Snapshot after = trial.after(scene, count);
    measured.row(scene.material.young, 2 * first.x.size(), differing(trial, scene, first, after));
  }
  if (measured.rows() == 0) throw NotOffered{"steps of 5 ms for stiff sheets"};
  return judge_worst(measured, 0, "nothing of an earlier scene may be left");
}

Finding step_depends_on_its_state_alone(Trial& trial) {
  Table measured("scene; numbers [1]; numbers that differ [1]");
  std::vector<PortableScene> scenes{moving_sheet()};
  if (trial.declaration().offers("damping")) scenes.push_back(damped_moving_sheet());
  for (const PortableScene& scene : scenes) {
    trial.prepare(scene);
    const std::vector<Snapshot> start{{scene.x, scene.v}};
    const Snapshot first = trial.solver().step(start, {0}, scene.dt);
    trial.solver().advance(scene.dt, steps);
    const Snapshot again = trial.solver().step(start, {0}, scene.dt);
    measured.row(scene.name, 2 * scene.x.size(), differing(trial, scene, first, again));
  }
  return judge_worst(measured, 0, "the state that was set is all that a step depends on");
}

/// The scene, whose `steps` steps are divided into so many of the same total time.
PortableScene in_steps(PortableScene scene, long count) {
  scene.dt *= double(steps) / double(count);
  return scene;
}

/// Neighbours move against each other, so that dampers take much from the first step on.
PortableScene damped_rough_sheet() {
  PortableScene scene = damped_moving_sheet();
  scene.name = "damped sheet of neighbours that move apart";
  for (Eigen::Index i = 0; i < scene.v.size(); ++i)
    scene.v.data()[i] += 0.3 * std::sin(2.7 * double(i));
  return scene;
}

PerParticle3 positions_after(Trial& trial, const PortableScene& scene, long count) {
  return trial.after(in_steps(scene, count), count).x;
}

/// Measures what rounding leaves in the positions after a run [m], as a norm, or several times
/// that. The run is repeated some metres away, where positions are rounded at least four times as
/// coarsely. The two runs differ by rounding alone, mostly that of the one far away. This includes
/// substeps, and velocities from differences of positions, which no bound on the steps covers.
/// Solves may add their tolerance a step. A solver that depends on the place looks rounded here,
/// and fails symmetry.translation.
double rounding_of(Trial& trial, PortableScene scene, long count, const PerParticle3& x) {
  const Vector3 shift(2.3, -2.9, 2.7);  // m; no coordinate of the sheet is beyond 0.7 m
  const double solves = double(count) * trial.declaration().solve_tolerance;
  const double unfinished = solves * (x - scene.x).norm();
  scene.mesh.rest.colwise() += shift;
  scene.x.colwise() += shift;
  return ((positions_after(trial, scene, count).colwise() - shift) - x).norm() + unfinished;
}

/// The difference that halving the step makes, and the rounding in that difference: norms [m].
struct Change {
  double size, rounding;
};

/// A run to 0.04 s.
struct Run {
  long count;
  PerParticle3 x;
  double rounding;  // m, as a norm
  double seconds;   // the least of several readings of the clock
};

Change change_between(const Run& coarse, const Run& fine) {
  return {(fine.x - coarse.x).norm(), coarse.rounding + fine.rounding};
}

/// The order that a change and the next one show, and what rounding may move it by; infinite or NaN
/// where a change is not beyond its rounding.
oracles::Estimate order_of(const Change& coarse, const Change& fine) {
  const double kept =
      (1 - coarse.rounding / coarse.size) * std::max(0.0, 1 - fine.rounding / fine.size);
  return {std::log2(coarse.size / fine.size), -std::log2(kept)};
}

/// Halves the step of the scene three times.
Finding order_is_as_claimed(Trial& trial, const PortableScene& scene) {
  const int claimed = trial.declaration().order;
  std::vector<Run> runs;
  const long usual = steps * parts_of_step(scene.dt, trial.declaration());
  for (const long count : {usual, 2 * usual, 4 * usual, 8 * usual}) {
    const PerParticle3 x = positions_after(trial, scene, count);
    runs.push_back({count, x, rounding_of(trial, scene, count, x), nan});
  }
  std::vector<Change> changes;
  for (size_t k = 1; k < runs.size(); ++k) changes.push_back(change_between(runs[k - 1], runs[k]));
  constexpr double allowed = 0.35, clear = allowed / 2;  // of an order; the rest is the scheme's
  const oracles::Estimate coarse = order_of(changes[0], changes[1]),
                          fine = order_of(changes[1], changes[2]);
  if (!(coarse.uncertainty <= clear))
    throw NotOffered{
        fmt::format("enough digits: halving the step changes its positions by {:.2g} m, its "
                    "rounding by up to {:.2g} m",
                    changes[1].size, changes[1].rounding)};
  const oracles::Estimate& observed = fine.uncertainty <= clear ? fine : coarse;
  Table measured = table_of(
      "observed [1] | observed on coarser steps [1] | claimed [1] | short of the claim [1]");
  measured.row(observed, coarse, claimed,
               oracles::Estimate{double(claimed) - observed.value, observed.uncertainty});
  return judge_worst(measured, "short of the claim", allowed,
                     "the next term of the series shifts the observed order by at most a third");
}

constexpr int most_readings = 5;
constexpr double enough_seconds = 0.2;  // of readings; slow solvers are read once

Run timed_run(Trial& trial, long count) {
  Run run{count, {}, nan, std::numeric_limits<double>::infinity()};
  double spent = 0;
  for (int k = 0; k < most_readings && spent < enough_seconds; ++k) {
    run.x = positions_after(trial, moving_sheet(), count);
    spent += trial.seconds_of_motion();
    run.seconds = std::min(run.seconds, trial.seconds_of_motion());
  }
  run.rounding = rounding_of(trial, moving_sheet(), count, run.x);
  return run;
}

/// The solver's own limit, as the step goes to 0, by the claimed order, or by 1. It is extrapolated
/// from the two neighbours that differ least: at steps below theirs, rounding has taken over.
PerParticle3 limit_of(const std::vector<Run>& runs, const Declaration& declared) {
  const auto change = [&](size_t k) { return (runs[k].x - runs[k - 1].x).norm(); };
  size_t least = 1;
  for (size_t k = 2; k < runs.size(); ++k)
    if (change(k) <= change(least)) least = k;
  const PerParticle3 &fine = runs[least].x, &coarse = runs[least - 1].x;
  return fine + (fine - coarse) / (std::pow(2.0, std::max(1, declared.order)) - 1);
}

/// A row for each step: what it costs, what halving it changed, and its error.
Table errors_and_costs(const std::vector<Run>& runs, const Declaration& declared) {
  const PerParticle3 limit = limit_of(runs, declared);
  const double motion = (limit - moving_sheet().x).norm();
  Table table = table_of(
      "steps [1] | step [s] | seconds by the clock [s] | change from twice the step [motion] | "
      "rounding [motion] | error [motion]");
  for (size_t k = 0; k < runs.size(); ++k)
    table.row(runs[k].count, in_steps(moving_sheet(), runs[k].count).dt, runs[k].seconds,
              k == 0 ? nan : (runs[k].x - runs[k - 1].x).norm() / motion, runs[k].rounding / motion,
              (runs[k].x - limit).norm() / motion);
  return table;
}

/// True if rounding cannot decide whether a change is smaller or larger than the one before.
bool is_clear(const Change& before, const Change& now) {
  return now.size + now.rounding < before.size - before.rounding ||
         now.size - now.rounding > before.size + before.rounding;
}

/// A row for each halving that rounding does not hide. Throws NotOffered if it hides all.
Table growth_of_changes(const std::vector<Run>& runs) {
  Table growth{{"steps", "1"}, {"change over the change before", "1"}};
  for (size_t k = 2; k < runs.size(); ++k) {
    const Change before = change_between(runs[k - 2], runs[k - 1]),
                 now = change_between(runs[k - 1], runs[k]);
    if (is_clear(before, now)) growth.row(runs[k].count, now.size / before.size);
  }
  if (growth.rows() > 0) return growth;
  const Change first = change_between(runs[0], runs[1]);
  throw NotOffered{
      fmt::format("enough digits: halving the step changes its positions by {:.2g} m, its rounding "
                  "by up to {:.2g} m, and by more in shorter steps",
                  first.size, first.rounding)};
}

Finding halved_steps_approach_a_limit(Trial& trial) {
  std::vector<Run> runs;
  const long usual = steps * parts_of_step(moving_sheet().dt, trial.declaration());
  for (const long count : {usual, 2 * usual, 4 * usual, 8 * usual})
    runs.push_back(timed_run(trial, count));
  Finding finding =
      judge_worst(growth_of_changes(runs), 1,
                  "an error that falls as any power of the step changes less at each halving; "
                  "halvings where rounding could hide growth or make it are left out");
  finding.evidence = errors_and_costs(runs, trial.declaration());
  return finding;
}

/// A question on the way, against none. A scheme that looks back on several states may begin anew
/// there: it errs by its step at most.
Finding questions_change_nothing(Trial& trial) {
  const bool is_damped = trial.declaration().offers("damping");
  const PortableScene scene = is_damped ? damped_moving_sheet() : moving_sheet();
  using Question = std::function<void(const Snapshot& now, double time)>;
  const auto asked = [&](const Question& question) {
    trial.prepare(scene);
    const Snapshot half = trial.solver().advance(scene.dt, steps / 2);
    question(half, double(steps / 2) * scene.dt);
    return trial.solver().advance(scene.dt, steps - steps / 2).x;
  };
  const PerParticle3 unasked = asked([](const Snapshot&, double) {});
  std::vector<std::pair<const char*, Question>> questions{
      {"state", [&](const Snapshot&, double) { trial.solver().get_state(); }},
      {"energy", [&](const Snapshot& now, double time) { trial.solver().energy(now, time); }},
      {"forces", [&](const Snapshot& now, double time) { trial.solver().forces(now, time); }}};
  if (is_damped)
    questions.emplace_back(
        "damping", [&](const Snapshot& now, double time) { trial.solver().damping(now, time); });
  const double rounding = largest(scene.x) * narrow_rounding(trial, scene, steps);
  Table measured = table_of(
      "asked for | difference of positions [m] | rounding [m] | error of the step [m] | beyond "
      "both [1]");
  for (const auto& [name, question] : questions) {
    const double off = largest(asked(question) - unasked),
                 error = off <= rounding
                             ? 0
                             : largest(positions_after(trial, scene, 2 * steps) - unasked);
    measured.row(name, off, rounding, error, off / (error + 2 * rounding));
  }
  return judge_worst(measured, 1, "forces, energy and state are read, not changed");
}

bool is_float(double number) { return double(float(number)) == number; }

/// A sheet of large strains and folds, whose elastic law has no memory.
PortableScene crumpled_sheet() {
  PortableScene scene = moving_sheet();
  scene.name = "crumpled sheet";
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    scene.x(0, i) *= 1.25;
    scene.x(2, i) += 0.04 * std::sin(2.6 * double(i));
  }
  scene.dt = 0.001;
  return scene;
}

PortableScene crumpled_sheet_that_bends() {
  PortableScene scene = crumpled_sheet();
  scene.material.bending_rigidity = 0.002;
  return scene;
}

/// Goes on from a state, against a scene that starts with it. Schemes that look back on several
/// states, or that do not finish their solves, begin anew there: they err by their step at most.
Finding continues_from_its_state(Trial& trial, const PortableScene& scene) {
  constexpr long before = 30, after = 20;
  const std::vector<Snapshot> on = trial.motion(scene, {before, before + after});
  PortableScene anew = scene;
  anew.x = on[0].x, anew.v = on[0].v;
  const double off = largest(trial.after(anew, after).x - on[1].x),
               rounding = largest(scene.x) * narrow_rounding(trial, scene, before + after),
               error =
                   off <= rounding
                       ? 0
                       : largest(trial.after(in_steps(scene, 2 * steps), 2 * (before + after)).x -
                                 on[1].x);
  Table measured = table_of(
      "difference of positions [m] | rounding [m] | error of the step [m] | beyond both [1]");
  measured.row(off, rounding, error, off / (error + 2 * rounding));
  return judge_worst(measured, 1, "positions and velocities are the whole state of elastic cloth");
}

Finding results_need_their_digits(Trial& trial) {
  const Snapshot end = trial.after(moving_sheet(), steps);
  Table measured("of; numbers [1]; share that single precision holds [1]");
  for (const auto& [of, numbers] : {std::pair("positions", end.x), {"velocities", end.v}}) {
    const long floats = std::count_if(numbers.data(), numbers.data() + numbers.size(), is_float);
    measured.row(of, numbers.size(), double(floats) / double(numbers.size()));
  }
  return judge_worst(measured, 0.1, "a number in double precision is one of single with 2^-29");
}

}  // namespace

std::vector<Law> repeat_laws() {
  return {
      {"repeat.fresh-process-gives-the-same-bits", "The same scene gives the same bits again.",
       "determinism", same_in_a_fresh_process},
      {"repeat.second-scene-starts-afresh", "A scene gives the same bits after another one.",
       "determinism", second_scene_starts_afresh},
      {"repeat.stiff-scene-after-a-soft-one",
       "A stiff scene gives the same bits after a soft one: its steps are divided for itself.",
       "determinism", stiff_scene_after_a_soft_one, "", "Young's modulus | numbers that differ"},
      {"repeat.step-depends-on-its-state-alone", "A state that is set again gives the same step.",
       "determinism", step_depends_on_its_state_alone, "L1 set_state"},
      {"repeat.questions-change-nothing",
       "Reading the state, the energy or the forces on the way does not change the motion.",
       "protocol: 'forces'", questions_change_nothing, "L2", "asked for | difference of positions"},
      {"repeat.motion-goes-on-from-its-state",
       "A scene that starts from a state on the way goes on as the first did: nothing creeps.",
       "elastic cloth has no memory", in_scene(continues_from_its_state, crumpled_sheet)},
      {"repeat.motion-with-bending-goes-on-from-its-state",
       "A bent scene that starts from a state on the way goes on as the first did: no fold stays.",
       "elastic cloth has no memory", in_scene(continues_from_its_state, crumpled_sheet_that_bends),
       "bending"},
      {"order.observed-is-as-claimed", "Halving the step reduces the error as claimed.",
       "Richardson", in_scene(order_is_as_claimed, moving_sheet), "order", "observed | claimed"},
      {"order.with-damping-is-as-claimed",
       "Halving the step reduces the error as claimed where edges are damped, too.", "Richardson",
       in_scene(order_is_as_claimed, damped_moving_sheet), "damping order", "observed | claimed"},
      {"order.with-damping-of-rough-motion-is-as-claimed",
       "Halving the step reduces the error as claimed where what neighbours do is damped.",
       "Richardson", in_scene(order_is_as_claimed, damped_rough_sheet), "damping order",
       "observed | claimed"},
      {"order.halved-steps-approach-a-limit",
       "Each halving of the step changes the motion less than the one before.", "Cauchy",
       halved_steps_approach_a_limit},
      {"precision.results-need-the-declared-digits",
       "Positions and velocities declared as double are not just single-precision values.",
       "IEEE 754", results_need_their_digits, "f8"},
  };
}

}  // namespace foldproof
