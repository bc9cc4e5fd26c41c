// Solvers of wrong materials and wrong contact: each is found by the law that it breaks. And what a
// trial says: where a solver failed, when its time is up, what cannot be told, what was measured.
#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <set>
#include <string>
#include <vector>

#include "verification/subjects/suite/headlines.h"
#include "verification/subjects/suite/scenes.h"
#include "verification/tests/wrong_solvers.h"

namespace foldproof {

TEST_CASE("subject: parameters that mean something else are found", "[long]") {
  const std::string young = "calibration.young-s-modulus-is-the-scene-s",
                    refined = "calibration.modulus-survives-refinement";
  const std::vector<Law> laws = laws_of({"calibration"});
  CHECK(failing_laws("springs_of_one_stiffness", laws).contains(young));
  CHECK(failing_laws("springs_per_length", laws) == std::set<std::string>{young, refined});
  CHECK(failing_laws("weft_per_length", laws) == std::set<std::string>{refined});
  CHECK(failing_laws("bends_upright_only", laws_of({"calibration", "cantilever"})) ==
        std::set<std::string>{"cantilever.heavy-strip-hangs-as-the-elastica"});
  CHECK(failing_laws("bends_fourfold", laws) ==
        std::set<std::string>{"calibration.bending-rigidity-is-the-scene-s"});
}

TEST_CASE("subject: bending that nobody asked for, and springs that only pull, are found",
          "[long]") {
  require_law_fails("bends_unasked", "chain.limp-strip-sags-as-a-catenary");
  require_law_fails("springs_pull_alone", "buckling.upright-strip-falls-at-greenhill-s-load");
  // four times the rigidity carries four times the weight, in shorter steps: no false alarm
  CHECK(outcome_of_law("bends_fourfold", "buckling") == Outcome::holds);
}

TEST_CASE("subject: a strip without bending hangs limp, and the law says so in numbers") {
  const SolverCommand command = python("bad/wrong.py bends_not_at_all");
  const Record record = judge_solver(command, laws_of({"cantilever"}), ignore).records.at(0);
  INFO(record.finding.note);
  CHECK(record.outcome == Outcome::fails);
  CHECK(record.finding.verdict.measured > 0.2);
  CHECK(record.finding.verdict.measured < 1);
  CHECK(record.finding.note.find("It does not resist bending") == 0);
  CHECK(record.finding.note.find("limp, 1.00 of its length low") != std::string::npos);
}

TEST_CASE("subject: bending with play is found by strips of little weight, no other ones",
          "[long]") {
  CHECK(failing_laws("gives_at_small_angles", laws_of({"calibration", "cantilever"})) ==
        std::set<std::string>{"cantilever.heavy-strip-hangs-as-the-elastica"});
}

TEST_CASE("subject: a strip without bending fails the laws of bent strips, and they say why") {
  const SolverCommand command = python("bad/wrong.py bends_not_at_all");
  const std::vector<Record> records =
      judge_solver(command,
                   laws_of({"strip", "buckling", "drape.stiff", "drape.heavier-ring",
                            "drape.heavier-disc", "wrinkles"}),
                   ignore)
          .records;
  CHECK(records.size() == 10);
  for (const Record& record : records) {
    INFO(record.name << ": " << record.finding.note);
    CHECK(record.outcome == Outcome::fails);
    CHECK(record.finding.note.find("the strip does not resist bending: ") == 0);
    CHECK(record.finding.verdict.why_bound.find("rigidity") != std::string::npos);
  }
}

TEST_CASE("subject: bent strips raise no alarm for bending of another kind or rigidity", "[long]") {
  for (const char* kind : {"bends", "bends_fourfold"}) {
    INFO(kind);
    CHECK(failing_laws(kind, laws_of({"strip"})) == std::set<std::string>{});
  }
}

TEST_CASE("subject: bending that is wrong where a sheet is turned over, or sharply bent, is found",
          "[long]") {
  const std::string loops = "strip.loops-hang-as-the-elastica",
                    rings = "strip.rings-take-the-elastica-s-shape",
                    wrinkles = "strip.wrinkles-take-the-elastica-s-shape",
                    fold = "strip.folds-take-the-elastica-s-shape";
  const std::vector<Law> laws = laws_of({"calibration", "cantilever", "strip"});
  CHECK(failing_laws("bends_face_up_alone", laws) == std::set<std::string>{loops, rings, fold});
  CHECK(failing_laws("stiffens_when_sharp", laws) ==
        std::set<std::string>{"calibration.rigidity-survives-refinement",
                              "cantilever.heavy-strip-hangs-as-the-elastica", loops, rings,
                              wrinkles, fold});
}

TEST_CASE("subject: dampers that slow the whole sheet are found, no other ones") {
  const std::vector<Law> laws = laws_of({"momentum", "order.with", "vibration"});
  CHECK(failing_laws("damped", laws) == std::set<std::string>{});
  CHECK(failing_laws("damps_all_motion", laws) ==
        std::set<std::string>{"momentum.linear-under-damping-is-conserved"});
}

TEST_CASE("subject: dampers of the wrong edges, or of the step before, are found, no other ones") {
  const std::vector<Law> laws = laws_of({"momentum", "repeat", "order", "damping", "vibration"});
  CHECK(failing_laws("damped", laws) == std::set<std::string>{});
  CHECK(failing_laws("damped_backward_euler", laws_of({"damping"})) == std::set<std::string>{});
  CHECK(failing_laws("mean_dampers", laws) ==
        std::set<std::string>{"damping.edges-damp-in-proportion-to-their-stiffness"});
  CHECK(failing_laws("damps_late", laws) ==
        std::set<std::string>{"repeat.step-depends-on-its-state-alone"});
}

TEST_CASE("subject: springs in turn depend on their numbers as their step explains: no alarm") {
  CHECK(failing_laws("in_turn", laws_of({"symmetry", "order", "momentum", "vibration"})) ==
        std::set<std::string>{});
}

TEST_CASE(
    "subject: one sweep over the springs is too few for the step of a game, and it is found") {
  const std::string stretch = "game-step.static-stretch-is-that-of-short-steps";
  CHECK(outcome_of_law("backward_euler", stretch) == Outcome::holds);
  CHECK(outcome_of_law("none", stretch) == Outcome::not_applicable);
  require_law_fails("in_turn", stretch);
}

TEST_CASE("subject: stated forces and energies that are not those of the motion are found") {
  const std::vector<Law> laws = laws_of({"momentum", "forces", "damping", "vibration"});
  const auto fails = [&](const char* kind) { return failing_laws(kind, laws); };
  using Names = std::set<std::string>;
  CHECK(fails("states_unbalanced_damping") == Names{"damping.stated-forces-sum-to-zero"});
  CHECK(fails("states_twice_the_damping") ==
        Names{"damping.stated-forces-are-those-of-the-motion"});
  CHECK(fails("energy_without_weight") == Names{"forces.are-minus-the-energy-gradient"});
  for (const char* kind : {"states_stale_forces", "forgets_what_is_set"})
    CHECK(fails(kind) == Names{"forces.are-those-of-the-present-state"});
}

TEST_CASE("subject: springs that tear beyond a strain of a tenth are found") {
  CHECK(failing_laws("springs_tear", laws_of({"calibration"})) ==
        std::set<std::string>{"calibration.tension-grows-with-strain"});
}

TEST_CASE("subject: a plane that throws a sheet higher than it fell is found, no other one") {
  const std::string gains = "contact.fall-gains-no-energy";
  const std::vector<Law> laws = laws_of({"contact"});
  CHECK(failing_laws("on_planes", laws) == std::set<std::string>{});
  CHECK(failing_laws("bounces_too_high", laws) == std::set<std::string>{gains});
  CHECK(failing_laws("bounces_too_high_when_fast", laws) == std::set<std::string>{gains});
}

TEST_CASE("subject: bodies that throw back what comes fast are found, no other ones") {
  const std::string box = "box.fall-gains-no-energy", ball = "ball.fall-gains-no-energy",
                    capsule = "capsule.fall-gains-no-energy";
  CHECK(failing_laws("on_boxes", laws_of({"box"})) == std::set<std::string>{});
  CHECK(failing_laws("boxes_throw_back", laws_of({"box", "tunnelling"})) ==
        std::set<std::string>{box});
  CHECK(failing_laws("on_round_bodies", laws_of({ball, capsule})) == std::set<std::string>{});
  CHECK(failing_laws("throws_back_when_fast", laws_of({"ball", "capsule"})) ==
        std::set<std::string>{ball, capsule});
}

TEST_CASE("subject: planes whose point or normal is ignored are found") {
  const std::string rests = "contact.sheet-rests-on-a-plane",
                    slides = "contact.slides-as-coulomb-says";
  for (const char* kind : {"planes_are_level", "planes_pass_the_origin"}) {
    INFO(kind);
    const std::set<std::string> failing = failing_laws(kind, laws_of({"contact"}));
    CHECK(failing.contains(rests));
    CHECK(failing.contains(slides));
  }
}

TEST_CASE("subject: friction with a limit for each axis, or beside the motion, is found") {
  const std::string slides = "contact.slides-as-coulomb-says",
                    slips = "contact.slips-at-coulomb-s-slope";
  const std::vector<Law> laws = laws_of({"contact"});
  CHECK(failing_laws("friction_per_axis", laws) == std::set<std::string>{slides, slips});
  CHECK(failing_laws("friction_turns", laws).contains(slides));
}

TEST_CASE("subject: a strip on edge that tips too late or too early is found, no other one",
          "[long]") {
  const std::string tips = "buckling.strip-on-edge-tips-at-its-load";
  for (const char* kind : {"bends", "bends_fourfold"})
    CHECK(outcome_of_law(kind, tips) == Outcome::holds);
  require_law_fails("springs_pull_alone", tips);
  CHECK(failing_laws("held_strips_weigh_twice", laws_of({"buckling"})) ==
        std::set<std::string>{tips, "buckling.upright-strip-falls-at-greenhill-s-load"});
}

TEST_CASE(
    "subject: a drape that sags too far, or no lower under more weight, is found, no other one",
    "[long]") {
  const std::string sags = "drape.stiff-ring-sags-as-a-plate",
                    lower = "drape.heavier-ring-hangs-lower",
                    disc = "drape.heavier-disc-hangs-lower";
  CHECK(failing_laws("bends", laws_of({sags, lower, disc})) == std::set<std::string>{});
  for (const char* kind : {"bends_fourfold", "clamps_where_held"})
    CHECK(outcome_of_law(kind, sags) == Outcome::holds);
  require_law_fails("held_strips_weigh_a_tenth_more", sags);
  CHECK(failing_laws("bends_one_way_alone", laws_of({"calibration", sags})) ==
        std::set<std::string>{"calibration.rigidity-survives-refinement", sags});
  for (const std::string& law : {lower, disc}) require_law_fails("bends_with_limited_weight", law);
}

TEST_CASE("subject: tension that does not straighten a stretched sheet is found, no other one",
          "[long]") {
  const std::string waves = "wrinkles.grow-as-tension-and-rigidity-say";
  for (const char* kind : {"bends", "bends_fourfold"})
    CHECK(outcome_of_law(kind, waves) == Outcome::holds);
  CHECK(failing_laws("springs_keep_their_directions", laws_of({"calibration", waves})) ==
        std::set<std::string>{"calibration.bending-rigidity-is-the-scene-s", waves});
}

TEST_CASE("subject: a limp drape that hangs no lower under more weight is found, no other one") {
  const std::string limp = "drape.heavier-limp-ring-hangs-lower";
  for (const char* kind : {"none", "single"}) CHECK(outcome_of_law(kind, limp) == Outcome::holds);
  require_law_fails("weight_is_limited", limp);
}

TEST_CASE(
    "subject: forces and energies of bending that disagree, or leave a net force, are found") {
  const std::vector<Law> laws = laws_of({"forces"});
  CHECK(failing_laws("bends", laws) == std::set<std::string>{});
  CHECK(failing_laws("bending_energy_tripled", laws) ==
        std::set<std::string>{"forces.of-a-bent-sheet-are-minus-the-energy-gradient"});
  CHECK(failing_laws("bending_pulls_one_corner_less", laws) ==
        std::set<std::string>{"forces.of-a-bent-sheet-sum-to-zero",
                              "forces.of-a-bent-sheet-exert-no-torque",
                              "forces.of-a-bent-sheet-are-minus-the-energy-gradient"});
}

/// A quantity that is the scene's times a factor: the law allows one, and finds the other.
struct Slip {
  const char *law, *quantity, *allowed, *found;
};

TEST_CASE(
    "subject: laws find slips of a few per cent, or of a few roundings, and allow smaller ones",
    "[long]") {
  for (const Slip& slip : {
           Slip{"gravity.speed-grows-by-g-t", "gravity", "1.0000000000001", "1.000000000001"},
           {"momentum.linear-is-conserved", "one_end", "1.00000000001", "1.0000000001"},
           {"forces.sum-to-zero", "one_end", "1.0000000000001", "1.000000000001"},
           {"calibration.young-s-modulus-is-the-scene-s", "young", "1.02", "1.08"},
           {"calibration.young-s-modulus-is-the-scene-s", "young", "0.98", "0.92"},
           {"calibration.bending-rigidity-is-the-scene-s", "rigidity", "1.02", "1.08"},
           {"calibration.bending-rigidity-is-the-scene-s", "rigidity", "0.97", "0.92"},
           {"damping.edges-damp-in-proportion-to-their-stiffness", "damping", "1.03", "1.07"},
           {"damping.edges-damp-in-proportion-to-their-stiffness", "damping", "0.97", "0.94"},
           {"vibration.damped-decays-as-its-damping-says", "damping", "1.02", "1.05"},
           {"vibration.damped-decays-as-its-damping-says", "damping", "0.98", "0.95"},
           {"contact.slides-as-coulomb-says", "friction", "1.05", "1.1"},
           {"contact.slides-as-coulomb-says", "friction", "0.95", "0.9"},
           {"contact.slips-at-coulomb-s-slope", "friction", "1.02", "1.04"},
           {"contact.slips-at-coulomb-s-slope", "friction", "0.98", "0.96"},
           {"ball.sheet-comes-to-rest", "radius", "0.998", "0.99"},
       }) {
    const std::string scaled = std::string("scaled ") + slip.quantity + " ";
    INFO(slip.law << " " << scaled << slip.allowed << " " << slip.found);
    CHECK(outcome_of_law(scaled + slip.allowed, slip.law) == Outcome::holds);
    CHECK(outcome_of_law(scaled + slip.found, slip.law) == Outcome::fails);
  }
}

TEST_CASE("subject: a sheet of another stiffness may decay and vibrate as its own says") {
  for (const char* kind : {"scaled damped_young 0.8", "scaled damped_young 1.3"})
    CHECK(failing_laws(kind, laws_of({"vibration"})) == std::set<std::string>{});
}

TEST_CASE("subject: bending that refinement changes is found") {
  CHECK(failing_laws("bends_by_long_springs", laws_of({"calibration"})) ==
        std::set<std::string>{"calibration.bending-rigidity-is-the-scene-s",
                              "calibration.rigidity-survives-refinement"});
}

TEST_CASE("subject: a strip whose rigidity is lost in rounding is judged by no law") {
  for (const char* law : {"cantilever", "strip.wrinkles", "buckling.strip", "wrinkles"}) {
    INFO(law);
    CHECK(outcome_of_law("bends_in_substeps_of_single", law) == Outcome::not_applicable);
  }
}

TEST_CASE("subject: rest angles that are ignored are found, and declined ones are no failure") {
  const std::string stays = "rest.curved-sheet-keeps-its-rest-angles";
  CHECK(failing_laws("bends_to_flat", laws_of({"rest"})) == std::set<std::string>{stays});
  CHECK(outcome_of_law("bends", stays) == Outcome::not_applicable);
}

TEST_CASE("subject: wrong contact is found") {
  const std::string rests = "contact.sheet-rests-on-a-plane",
                    still = "contact.resting-sheet-is-still",
                    slides = "contact.slides-as-coulomb-says",
                    slips = "contact.slips-at-coulomb-s-slope";
  const std::vector<Law> laws = laws_of({"contact"});
  CHECK(failing_laws("sinks_in", laws).contains(rests));
  CHECK(failing_laws("jitters", laws).contains(still));
  CHECK(failing_laws("friction_beyond_the_cone", laws) == std::set<std::string>{slides, slips});
  CHECK(failing_laws("on_boxes_now_and_then") ==
        std::set<std::string>{"tunnelling.thin-box-stops-a-slow-sheet"});
  CHECK(failing_laws("particles_repel_alone") ==
        std::set<std::string>{"self-collision.folded-sheet-never-passes-through-itself"});
  CHECK(failing_laws("friction_halved", laws) == std::set<std::string>{slides, slips});
  CHECK(failing_laws("friction_creeps", laws) == std::set<std::string>{slips});
}

TEST_CASE("subject: a strip that is pressed on a floor and slips too late or too early is found",
          "[long]") {
  const std::string slips = "floor.pressed-strip-slips-as-the-elastica";
  CHECK(outcome_of_law("bends_on_planes", slips) == Outcome::holds);
  CHECK(outcome_of_law("on_planes", slips) == Outcome::not_applicable);
  require_law_fails("bends_on_planes_friction_halved", slips);
  CHECK(failing_laws("bends_on_planes_friction_of_weight", laws_of({"contact", slips})) ==
        std::set<std::string>{slips});
}

TEST_CASE("subject: a floor that holds a fold down is found, no other one", "[long]") {
  const std::string stands = "floor.clamped-fold-stands-as-high-as-the-elastica";
  CHECK(outcome_of_law("bends_on_planes", stands) == Outcome::holds);
  CHECK(outcome_of_law("on_planes", stands) == Outcome::not_applicable);
  CHECK(failing_laws("bends_on_planes_that_hold_down", laws_of({"contact", stands})) ==
        std::set<std::string>{stands});
}

TEST_CASE("subject: wrong contact with balls is found", "[long]") {
  const std::string outside = "ball.falling-sheet-stays-outside",
                    gains = "ball.fall-gains-no-energy", rests = "ball.sheet-comes-to-rest",
                    slides = "ball.slides-as-coulomb-says";
  const std::vector<Law> laws = laws_of({"ball"});
  CHECK(failing_laws("radius_too_small", laws) == std::set<std::string>{outside, rests, slides});
  CHECK(failing_laws("radius_too_large", laws) == std::set<std::string>{outside, rests, slides});
  CHECK(failing_laws("stops_from_above", laws).contains(outside));
  CHECK(failing_laws("throws_back", laws).contains(gains));
  CHECK(failing_laws("round_bodies_turn", laws) == std::set<std::string>{rests, slides});
  CHECK(failing_laws("round_bodies_without_friction", laws).contains(slides));
  CHECK(failing_laws("round_bodies_stick", laws) == std::set<std::string>{slides});
}

TEST_CASE("subject: wrong contact with capsules is found", "[long]") {
  const std::string lies = "capstan.strip-lies-on-the-capsule",
                    slips = "capstan.slips-at-euler-s-ratio";
  const std::vector<Law> laws = laws_of({"capstan"});
  CHECK(failing_laws("radius_too_small", laws) == std::set<std::string>{lies});
  CHECK(failing_laws("capsules_are_balls", laws).contains(lies));
  CHECK(failing_laws("round_friction_halved", laws) == std::set<std::string>{slips});
  CHECK(failing_laws("round_friction_is_drag", laws) == std::set<std::string>{slips});
  CHECK(failing_laws("round_bodies_stick", laws) == std::set<std::string>{slips});
}

TEST_CASE("subject: a sheet that stands still has passed no test of collisions") {
  require_law_fails("starts_from_rest", "inertia.free-sheet-keeps-its-velocity");
  for (const char* law : {"tunnelling.thin-box-stops-a-slow-sheet",
                          "self-collision.folded-sheet-never-passes-through-itself"})
    CHECK(outcome_of_law("starts_from_rest", law) == Outcome::not_applicable);
}

TEST_CASE("subject: correct contact with round bodies raises no alarm", "[long]") {
  for (const char* kind : {"on_round_bodies", "on_round_bodies_single"}) {
    INFO(kind);
    CHECK(failing_laws(kind, laws_of({"ball", "capstan"})) == std::set<std::string>{});
  }
  // a slow one
  const std::vector<Law> laws = laws_of({"ball.falling", "capstan.strip"});
  CHECK(failing_laws("on_round_bodies_backward_euler", laws) == std::set<std::string>{});
}

TEST_CASE("subject: a failure names its operation, scene, step and the steps before it") {
  CHECK_THAT(
      failure_of(broken("crash")).what(),
      Catch::Matchers::Contains(
          "during 'advance' by 2 steps of 0.001 s, after 0 steps, in the scene 'small sheet'"));
  Trial trial(broken("late_crash"));
  try {
    trial.motion(suite::moving_sheet(), {5, 10, 20});
    FAIL("it crashes");
  } catch (const SolverFailure& failure) {
    CHECK_THAT(failure.what(),
               Catch::Matchers::Contains("during 'advance' by 10 steps of 0.002 s, after 10 of 20 "
                                         "steps, in the scene 'moving sheet'"));
    CHECK(failure.kind == "the solver crashed with signal 11 (Segmentation fault)");
  }
}

TEST_CASE("subject: a solver that tells its progress may take longer than the limit of silence") {
  SolverCommand command = broken("tells_progress");
  command.limits.seconds = 2;
  CHECK(failure_of(command).cause == "none");
}

TEST_CASE("subject: last words keep their lines, the last ten of them") {
  const SolverFailure failure = failure_of(broken("last_lines"));
  const std::string text = failure.what();
  CHECK(text.find("its last words:\n    line 3\n    line 4\n") != std::string::npos);
  CHECK(text.ends_with("\n    line 11\n      indented"));
  CHECK(failure.in_one_line().find('\n') == std::string::npos);
}

TEST_CASE("subject: laws that the time of the trial does not reach did not run") {
  SolverCommand command = python("bad/wrong.py sleeps");
  command.limits.end = std::chrono::steady_clock::now() + std::chrono::milliseconds(700);
  const auto start = std::chrono::steady_clock::now();
  const Judgement judgement = judge_solver(command, portable_laws(), ignore);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
  const Record& last = judgement.records.back();
  CHECK(
      (did_not_run(last) && last.finding.note.starts_with("the time of the trial was up during")));
  CHECK(std::ranges::none_of(judgement.records, [](const Record& record) {
    return record.outcome == Outcome::fails || record.outcome == Outcome::inconclusive;
  }));
}

TEST_CASE("subject: nothing follows from bounds that a declared tolerance makes too wide") {
  const std::vector<Record> records =
      judge_solver(python("bad/wrong.py stands_still_to_half"),
                   laws_of({"rest.no", "inertia", "gravity", "momentum.linear-is", "symmetry",
                            "vibration.undamped"}),
                   ignore)
          .records;
  CHECK(records.size() == 12);
  for (const Record& record : records) {
    INFO(record.name << ": " << record.finding.note);
    CHECK(record.outcome == Outcome::inconclusive);
    CHECK(record.finding.note.find("solve_tolerance 0.5") != std::string::npos);
  }
}

TEST_CASE("subject: the headline of a law is what it measured") {
  Finding slide;
  slide.evidence =
      Table{{"mu", "1"}, {"distance down", "m"}, {"by Coulomb's law", "m"}, {"difference", "1"}};
  slide.evidence.row(0.1, 1, 1.01, 0.01);
  slide.evidence.row(0.2, 3, 4.5, 0.5);
  CHECK(headline_of("ball.slides-as-coulomb-says", slide) ==
        "mu 0.2, distance down 3 m, by Coulomb's law 4.5 m");
  CHECK(headline_of("held.particles-stay", slide).empty());
  std::vector<Law> laws;
  for (const HeadlineColumns& one : headline_columns())
    laws.push_back(laws_of({std::string(one.law)}).at(0));
  long with_evidence = 0;
  for (const char* kind : {"none", "on_planes", "damped"})
    for (const Record& record :
         judge_solver(python(std::string("bad/wrong.py ") + kind), laws, ignore).records) {
      const bool has_evidence = record.finding.evidence.rows() > 0;
      with_evidence += has_evidence;
      CHECK(record.finding.headline.empty() == !has_evidence);
    }
  CHECK(with_evidence > 15);
  const auto headline = [](const char* kind, const char* law) {
    return judge_solver(python(std::string("bad/wrong.py ") + kind), laws_of({law}), ignore)
        .records.at(0)
        .finding.headline;
  };
  CHECK_THAT(headline("first_order_as_second", "order.observed"),
             Catch::Matchers::Contains("observed 1.0") && Catch::Matchers::EndsWith("claimed 2"));
  CHECK_THAT(headline("sticks_to_planes", "contact.slips"),
             Catch::Matchers::Contains(", the most that is tried"));
}

}  // namespace foldproof
