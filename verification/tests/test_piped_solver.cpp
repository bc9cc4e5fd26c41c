// Solvers that break, lie or are wrong: each is named by its cause, and none brings us down.
#include <catch2/catch.hpp>

#include <fstream>
#include <iterator>

#include "verification/specimens/scratch_folder.h"
#include "verification/subjects/suite/conformance.h"
#include "verification/tests/wrong_solvers.h"

namespace foldproof {

using Catch::Matchers::Contains;

namespace {

void require_failure(const std::string& kind, const std::string& cause, const std::string& words) {
  INFO(kind);
  const SolverFailure failure = failure_of(broken(kind));
  CHECK(failure.cause == cause);
  CHECK_THAT(failure.what(), Contains(words));
}

}  // namespace

TEST_CASE("subject: a solver that ends is told by signal or exit code, with its last words") {
  require_failure("crash", "crash", "signal 11");
  require_failure("crash", "crash", "about to touch address 0");
  require_failure("exit_3", "exit", "code 3");
  require_failure("exit_3", "exit", "giving up");
  require_failure("exception", "error", "ValueError: a matrix is singular");
  require_failure("fork_and_exit", "exit", "code 4");
}

TEST_CASE("subject: a command without a program is refused, one that starts and ends is judged") {
  for (const char* command : {"/nowhere/solver", "/etc/passwd"}) {
    const SolverFailure failure = failure_of({command, {}, {}});
    CHECK(failure.cause == "start");
    CHECK_THAT(failure.what(), Catch::StartsWith(std::string("cannot start ") + command));
    CHECK_THROWS_AS(judge_solver({command, {}, {}}, portable_laws(), ignore), InputError);
  }
  const Judgement judgement = judge_solver({"exit 2", {}, {}}, portable_laws(), ignore);
  CHECK(judgement.records.front().outcome == Outcome::fails);
}

TEST_CASE("subject: a hang is reported when its time is up") {
  // long enough for a loaded machine to start Python
  const SolverFailure failure = failure_of(broken("hang", 8));
  CHECK(failure.cause == "hang");
  CHECK_THAT(failure.what(),
             Contains("did not answer within 8 s (--seconds)") && Contains("last words: thinking"));
}

TEST_CASE("subject: answers of a wrong length, shape, number or header are told") {
  require_failure("truncated", "truncated", "in the middle of an answer");
  require_failure("short_array", "truncated", "shape [9,3] instead of [10,3]");
  require_failure("oversized", "oversized", "shape [1000000000000,3]");
  require_failure("too_many_bytes", "oversized", "more bytes than its last answer says");
  require_failure("wrong_shape", "shape", "shape [10,2] instead of [10,3]");
  require_failure("nan", "nan", "sent nan for particle 1, z coordinate, of array 'x'");
  require_failure("invalid_json", "header", "no JSON object");
  require_failure("noise_on_the_pipe", "header", "iteration 1: residual 0.3");
  require_failure("endless_header", "header", "longer than");
  require_failure("wrong_id", "header", "without the id");
}

TEST_CASE("subject: a capability that there is not is told by its name") {
  nlohmann::json header = nlohmann::json::parse(R"({"protocol": 1, "name": "n", "version": "1",
    "level": "L1", "precision": "f8", "scheme": {"name": "s", "order": 1},
    "capabilities": ["spheres", "held"]})");
  CHECK(read_declaration(header).offers("spheres"));
  CHECK_THROWS_AS(read_declaration(header).offers("sphere"), std::logic_error);
  header["capabilities"].push_back("sphere");
  CHECK_THROWS_WITH(read_declaration(header), Contains("'sphere', which is no capability"));
}

TEST_CASE("subject: a tunable has a kind, and a value in its range") {
  nlohmann::json header = nlohmann::json::parse(R"({"protocol": 2, "name": "n", "version": "1",
    "level": "L1", "precision": "f8", "scheme": {"name": "s", "order": 1}, "capabilities": [],
    "tunables": {"sweeps": {"kind": "iterations", "range": [3, 50], "value": 7}}})");
  const Tunable sweeps = read_declaration(header).tunables.at(0);
  CHECK((sweeps.name == "sweeps" && sweeps.kind == TunableKind::iterations));
  CHECK((sweeps.least == 3 && sweeps.most == 50 && sweeps.value == 7 && !sweeps.is_proportional));
  header["tunables"]["sweeps"]["value"] = 51;
  CHECK_THROWS_WITH(read_declaration(header), Contains("'sweeps' with a value outside its range"));
  header["tunables"]["sweeps"]["kind"] = "sweeps";
  CHECK_THROWS_WITH(read_declaration(header), Contains("'sweeps' of no kind"));
}

TEST_CASE("subject: memory and files are limited, and noise on standard output does no harm") {
  SolverCommand filling = broken("fill_memory"), writing = broken("fill_disk");
  filling.limits.memory_bytes = 768L << 20;
  CHECK_THAT(failure_of(filling).what(), Contains("Unable to allocate"));
  writing.limits.bytes_per_file = 8L << 20;
  CHECK_THAT(failure_of(writing).what(), Contains("File too large"));
  CHECK(failure_of(broken("noise_on_stdout")).cause == "none");
}

TEST_CASE("subject: a solver that never starts fails the first law, and the others do not run") {
  const std::vector<Law> laws = portable_laws();
  const Judgement judgement = judge_solver(broken("silent_start", 0.5), laws, ignore);
  REQUIRE(judgement.records.size() == laws.size());
  CHECK(!judgement.smoke_holds);
  CHECK(judgement.declaration.name.empty());
  CHECK(judgement.records.front().outcome == Outcome::fails);
  for (size_t k = 1; k < laws.size(); ++k) {
    CHECK((judgement.records[k].name == laws[k].name && did_not_run(judgement.records[k])));
    CHECK(judgement.records[k].finding.note == "the trial ended during " + laws.front().name);
  }
}

TEST_CASE("subject: after a third hang the laws that are left do not run") {
  const Judgement judgement =
      judge_solver(broken("hang", 1), laws_of({"smoke", "inertia", "gravity", "held"}), ignore);
  CHECK(judgement.declaration.name == "toy springs (Python)");  // it started
  REQUIRE(judgement.records.size() > 3);
  for (size_t k = 0; k < judgement.records.size(); ++k)
    CHECK(did_not_run(judgement.records[k]) == (k > 2));
}

TEST_CASE("subject: a start that failed is not tried again") {
  const ScratchFolder folder;
  const std::string starts = folder.file("starts");
  const Judgement judgement =
      judge_solver({"echo start >> '" + starts + "'; exit 3", {}, {}}, portable_laws(), ignore);
  CHECK_THAT(judgement.records.front().finding.note, Contains("exited with code 3"));
  std::ifstream file(starts);
  CHECK(std::count(std::istreambuf_iterator<char>(file), {}, '\n') == 1);
}

TEST_CASE("subject: after a failure the next law goes on") {
  const auto records = judge_solver(broken("too_many_bytes"), portable_laws(), ignore).records;
  CHECK(std::ranges::count(records, Outcome::fails, &Record::outcome) >= 15);
  CHECK(std::ranges::find(records, "forces.rest-is-force-free", &Record::name)->outcome ==
        Outcome::holds);
}

TEST_CASE("subject: a correct solver raises no alarm, in single precision", "[long][alarm]") {
  require_found({"backward_euler_single"}, {""}, {});
}

TEST_CASE("subject: correct solvers raise no alarm, in single and double precision", "[long]") {
  require_found({"none", "single", "damped", "backward_euler"}, {""}, {});
  require_found({"bends", "on_boxes", "on_planes", "on_planes_single", "on_planes_backward_euler",
                 "on_planes_backward_euler_single"},
                {"smoke", "calibration", "cantilever", "buckling", "contact", "tunnelling"}, {});
  require_found({"trapezoidal"},
                {"smoke", "rest", "inertia", "gravity", "momentum", "held", "symmetry.r", "order",
                 "vibration"},
                {});
  require_found({"damped_backward_euler", "damped_trapezoidal"}, {"order", "vibration"}, {});
}

TEST_CASE("subject: wrong masses and gravity are found, in single precision, too") {
  require_law_fails("wrong_mass", "momentum.linear-is-conserved");
  require_found({"own_masses_ignored"}, {""}, {"momentum.linear-of-unequal-masses-is-conserved"});
  require_found({"gravity_scaled"}, {""},
                {"gravity.is-that-of-the-scene", "gravity.speed-grows-by-g-t",
                 "gravity.fall-is-as-exact-as-the-order-claims", "forces.weight-is-mass-times-g"});
  require_law_fails("gravity_scaled_single", "gravity.speed-grows-by-g-t");
  require_law_fails("gravity_scaled_single", "gravity.fall-is-as-exact-as-the-order-claims");
}

TEST_CASE("subject: lost momentum and hidden damping are found") {
  require_law_fails("momentum_dropped", "momentum.linear-is-conserved");
  require_law_fails("hidden_damping", "inertia.free-sheet-keeps-its-velocity");
  // its rate is in seconds
  require_found({"spin_damped"}, {""},
                {"momentum.angular-drift-falls-with-the-step", "symmetry.units"});
}

TEST_CASE("subject: damping that nobody asked for, and half of what was asked, are found",
          "[long]") {
  require_found({"damped_unasked"}, {""}, {"vibration.undamped-goes-on"});
  require_found({"damping_halved"}, {""},
                {"damping.edges-damp-in-proportion-to-their-stiffness",
                 "damping.edges-of-held-particles-damp-as-the-others",
                 "vibration.damped-decays-as-its-damping-says"});
}

TEST_CASE("subject: false claims of precision and order are found") {
  require_law_fails("single_for_double", "precision.results-need-the-declared-digits");
  require_found({"first_order_as_second"}, {""},
                {"gravity.fall-is-as-exact-as-the-order-claims", "order.observed-is-as-claimed",
                 "vibration.undamped-goes-on"});
  require_law_fails("first_order_as_second_single", "order.observed-is-as-claimed");
}

TEST_CASE("subject: an order that damping lowers is found, by its own law") {
  const std::string order = "order.with-damping-is-as-claimed";
  require_found({"damped_verlet"}, {""},
                {order, "order.with-damping-of-rough-motion-is-as-claimed"});
  require_law_fails("damped_verlet_single", order);
  require_outcome({"damped", "damped_backward_euler", "damped_trapezoidal"}, order, Outcome::holds);
  require_outcome({"none"}, order, Outcome::not_applicable);
}

TEST_CASE("subject: an order is judged where errors of the step stand out of rounding alone") {
  const std::string order = "order.observed-is-as-claimed";
  require_outcome({"substeps_in_single"}, order, Outcome::not_applicable);
  require_outcome({"single", "backward_euler_single"}, order, Outcome::holds);
}

TEST_CASE("subject: a motion without a limit is found") {
  const std::string approaches = "order.halved-steps-approach-a-limit";
  require_law_fails("stiffens_with_small_steps", approaches);
  require_law_fails("stiffens_a_little_single", approaches);
  require_outcome({"single"}, approaches, Outcome::holds);
  // its changes grow, too, but may be rounding: neither an alarm nor a proof
  require_outcome({"substeps_in_single"}, approaches, Outcome::not_applicable);
}

TEST_CASE("subject: the clock of a law is that of its solver, and errors fall as its order says") {
  // it sleeps for a millisecond a step
  const Table slow = records_of("sleeps", {"order.halved-steps"}).front().finding.evidence;
  for (size_t k = 0; k < slow.rows(); ++k)
    CHECK(slow.numbers("seconds by the clock")[k] >= 1e-3 * slow.numbers("steps")[k]);
  const std::vector<double> errors = slow.numbers("error");
  REQUIRE(errors.size() == 4);
  for (size_t k = 1; k < errors.size(); ++k) CHECK(std::abs(errors[k] / errors[k - 1] - 0.5) < 0.1);
}

TEST_CASE("subject: a cost that grows as the square is found, by processor or by the clock") {
  const std::string growth = "cost.growth-is-below-quadratic";
  const auto is_found = [&](const char* kind) {  // a busy machine may hide it once
    int tries = 3;
    while (tries > 0 && outcome_of_law(kind, growth) != Outcome::fails) --tries;
    return tries > 0;
  };
  CHECK(is_found("asks_all_pairs"));
  CHECK(is_found("waits_for_all_pairs"));
  CHECK(outcome_of_law("sleeps", growth) == Outcome::holds);
}

TEST_CASE("subject: processor time is that of the solver and its children") {
  for (const char* shell : {"exec ", "cd . ; "}) {  // itself, and a child of the shell
    const std::string python = "/usr/bin/python3 " SUBJECTS_FOLDER "/";
    PipedSolver idle({shell + python + "bad/wrong.py sleeps", {}, {}});
    PipedSolver busy({shell + python + "bad/wrong.py asks_all_pairs", {}, {}});
    const auto spent = [](PipedSolver& solver) {
      const PortableScene scene = suite::moving_sheet();
      solver.prepare(scene);
      const double before = solver.processor_time().computing;
      solver.advance(scene.dt, 1000);
      return solver.processor_time().computing - before;
    };
    CHECK(spent(busy) > 1000 * 52 * 52 * 3e-9);  // a few ns a pair at least
    CHECK(spent(idle) < 0.5);                    // it sleeps for 1 s
  }
}

TEST_CASE("subject: a motion has seconds by the clock and of the processor") {
  const PortableScene scene = suite::moving_sheet();
  Trial sleeps(python("bad/wrong.py sleeps"));  // for a millisecond a step
  sleeps.after(scene, 500);
  CHECK(sleeps.seconds_of_motion() > 0.5);
  CHECK(sleeps.processor_seconds_of_motion() > 0);
  CHECK(sleeps.processor_seconds_of_motion() < sleeps.seconds_of_motion() - 0.4);
  Trial crashes(broken("crash"));
  CHECK_THROWS_AS(crashes.after(scene, 5), SolverFailure);
  CHECK(std::isnan(crashes.processor_seconds_of_motion()));
}

TEST_CASE("subject: states that are not restored are found") {
  require_found({"state_not_restored"}, {""}, {"repeat.step-depends-on-its-state-alone"});
  require_law_fails("scene_leaves_traces", "repeat.second-scene-starts-afresh");
  require_law_fails("random", "repeat.fresh-process-gives-the-same-bits");
}

TEST_CASE("subject: broken symmetries are found") {
  require_law_fails("knows_its_axes", "symmetry.rotation");
  require_law_fails("depends_on_numbers", "symmetry.renumbering");
  require_law_fails("knows_its_units", "symmetry.units");
  require_law_fails("knows_left_from_right", "symmetry.mirror");
}

TEST_CASE("subject: wrong forces and loosely held particles are found") {
  const std::string short_steps = "stability.small-steps-gain-no-energy",
                    drape = "drape.heavier-limp-ring-hangs-lower",
                    many_held = "held.many-in-any-order-and-no-other";
  require_found({"held_loosely"}, {""},
                {"held.particles-stay", many_held, "held.particles-stay-for-seconds", short_steps,
                 drape, "chain.limp-strip-sags-as-a-catenary",
                 "game-step.static-stretch-is-that-of-short-steps", "mixed.calls-may-be-divided"});
  require_found({"held_sheets_weigh_twice"}, {""},
                {many_held, short_steps, drape, "forces.of-a-held-sheet-are-those-of-a-free-one",
                 "mixed.pieces-move-as-they-do-alone"});
  require_found({"energy_halved"}, {""}, {"forces.are-minus-the-energy-gradient"});
  require_found({"pre_stressed"}, {"rest"},
                {"rest.no-force-no-motion", "rest.no-force-no-motion-on-any-pattern",
                 "rest.scaled-lengths-are-at-rest"});
  require_law_fails("rest_lengths_kept", "rest.no-force-no-motion-on-any-pattern");
  require_law_fails("pre_stressed", "forces.rest-is-force-free");
  require_law_fails("forces_unbalanced", "forces.sum-to-zero");
  require_law_fails("forces_unbalanced", "forces.torques-sum-to-zero");
}

TEST_CASE("subject: the conformance test tries obstacles that are declared") {
  for (const ConformanceRow& row : check_conformance(python("bad/wrong.py on_round_bodies")))
    CHECK(row.conformity == Conformity::kept);
  const auto chokes = check_conformance(python("bad/wrong.py chokes_on_round_bodies")).back();
  CHECK(chokes.conformity == Conformity::broken);
  CHECK(chokes.demand == "a sheet on a sphere is moved");
}

TEST_CASE("subject: the toy in C++ meets every law that it does not decline") {
  // no bending, and nothing to touch
  const Names offered{"L1", "L2", "order", "f8", "set_state", "held", "masses", "still"};
  const std::vector<Law> laws = portable_laws();
  const auto records = judge_solver({TOY_SOLVER, {}, {}}, laws, ignore).records;
  for (size_t k = 0; k < laws.size(); ++k) {
    INFO(records[k].name << " " << records[k].finding.note);
    const bool is_met =
        std::ranges::all_of(suite::split(laws[k].needs, " "),
                            [&](const std::string& need) { return offered.contains(need); }) &&
        !laws[k].name.starts_with("obstacles.") &&
        !laws[k].name.starts_with("game-step.") &&  // its longest stable step is shorter
        laws[k].name != "repeat.stiff-scene-after-a-soft-one";
    CHECK(records[k].outcome == (is_met ? Outcome::holds : Outcome::not_applicable));
  }
}

}  // namespace foldproof
