// Solvers of wrong materials and wrong contact: each is found by the law that it breaks. And what a
// trial says: where a solver failed, when its time is up, what cannot be told, what was measured.
#include <catch2/catch.hpp>
#include <chrono>

#include "verification/tests/wrong_solvers.h"

namespace foldproof {

using Catch::Matchers::Contains;

namespace {

const std::string young = "calibration.young-s-modulus-is-the-scene-s",
                  rigidity = "calibration.bending-rigidity-is-the-scene-s",
                  refined_rigidity = "calibration.rigidity-survives-refinement",
                  elastica = "cantilever.heavy-strip-hangs-as-the-elastica",
                  dampers = "damping.edges-damp-in-proportion-to-their-stiffness",
                  decay = "vibration.damped-decays-as-its-damping-says",
                  state = "repeat.step-depends-on-its-state-alone",
                  rests = "contact.sheet-rests-on-a-plane",
                  slides = "contact.slides-as-coulomb-says",
                  slips = "contact.slips-at-coulomb-s-slope";

// Laws of one large scene each; those of obstacles' sides have solvers of their own.
const std::vector<std::string> on_a_plane{rests, slides, slips, "contact.resting", "contact.fall"},
    on_a_ball{"ball.falling", "ball.fall-", "ball.sheet", "ball.slides"};

}  // namespace

TEST_CASE("subject: parameters that mean something else are found", "[long]") {
  const std::string refined = "calibration.modulus-survives-refinement";
  CHECK(failing_laws("springs_of_one_stiffness", {"calibration"}).contains(young));
  require_found({"springs_per_length"}, {"calibration"},
                {young, refined, "calibration.modulus-along-hypotenuses"});
  require_found({"weft_per_length"}, {"calibration"}, {refined});
  require_found({"bends_upright_only"}, {"calibration", "cantilever"}, {elastica});
  require_found({"bends_fourfold"}, {"calibration"}, {rigidity});
}

TEST_CASE("subject: bending that nobody asked for, and springs that only pull, are found",
          "[long]") {
  require_law_fails("bends_unasked", "chain.limp-strip-sags-as-a-catenary");
  require_law_fails("springs_pull_alone", "buckling.upright-strip-falls-at-greenhill-s-load");
  // four times the rigidity carries four times the weight, in shorter steps: no false alarm
  require_outcome({"bends_fourfold"}, "buckling", Outcome::holds);
}

TEST_CASE("subject: a strip without bending hangs limp, and the law says so in numbers") {
  const Record record = records_of("bends_not_at_all", {"cantilever"}).at(0);
  CHECK(record.outcome == Outcome::fails);
  CHECK(record.finding.verdict.measured > 0.2);
  CHECK(record.finding.verdict.measured < 1);
  CHECK_THAT(record.finding.note, Catch::StartsWith("It does not resist bending") &&
                                      Contains("limp, 1.00 of its length low"));
}

TEST_CASE("subject: bending with play is found by strips of little weight, no other ones",
          "[long]") {
  require_found({"gives_at_small_angles"}, {"calibration", "cantilever"}, {elastica});
}

TEST_CASE("subject: a strip without bending fails the laws of bent strips, and they say why") {
  const auto records = records_of(
      "bends_not_at_all",
      {"strip", "buckling", "drape.stiff", "drape.heavier-ring", "drape.heavier-disc", "wrinkles"});
  CHECK(!records.empty());
  for (const Record& record : records) {
    INFO(record.name);
    CHECK(record.outcome == Outcome::fails);
    CHECK_THAT(record.finding.note, Catch::StartsWith("the strip does not resist bending: "));
    CHECK_THAT(record.finding.verdict.why_bound, Contains("rigidity"));
  }
}

TEST_CASE("subject: bent strips raise no alarm for bending of another kind or rigidity", "[long]") {
  require_found({"bends", "bends_fourfold"}, {"strip"}, {});
}

TEST_CASE("subject: bending that is wrong where a sheet is turned over, or sharply bent, is found",
          "[long]") {
  const std::string loops = "strip.loops-hang-as-the-elastica",
                    rings = "strip.rings-take-the-elastica-s-shape",
                    wrinkles = "strip.wrinkles-take-the-elastica-s-shape",
                    fold = "strip.folds-take-the-elastica-s-shape";
  const std::vector<std::string> laws = {"calibration", "cantilever", "strip"};
  require_found({"bends_face_up_alone"}, laws, {loops, rings, fold});
  require_found({"stiffens_when_sharp"}, laws,
                {refined_rigidity, elastica, loops, rings, wrinkles, fold});
}

TEST_CASE(
    "subject: dampers of the room, of the wrong edges, or of the step before, are found, no other "
    "ones") {
  require_found({"damped"}, {"momentum", "order.with", "vibration"}, {});
  require_found({"damps_all_motion"}, {"momentum", "order.with", "vibration"},
                {"momentum.linear-under-damping-is-conserved",
                 "momentum.angular-under-damping-drifts-less-in-shorter-steps"});
  const std::vector<std::string> laws = {"momentum", "repeat", "order", "damping", "vibration"};
  require_found({"damped"}, laws, {});
  require_found({"damped_backward_euler"}, {"damping"}, {});
  require_found({"mean_dampers"}, laws,
                {dampers, "damping.edges-of-held-particles-damp-as-the-others"});
  require_found({"damps_late"}, laws, {state});
}

TEST_CASE("subject: springs in turn depend on their numbers as their step explains: no alarm") {
  require_found({"in_turn"}, {"symmetry", "order", "momentum", "vibration"}, {});
}

TEST_CASE(
    "subject: one sweep over the springs is too few for the step of a game, and it is found") {
  const std::string stretch = "game-step.static-stretch-is-that-of-short-steps";
  require_outcome({"backward_euler"}, stretch, Outcome::holds);
  require_outcome({"none"}, stretch, Outcome::not_applicable);
  require_law_fails("in_turn", stretch);
  require_law_fails("softens_in_long_steps", stretch);  // beyond 60 N/m
}

TEST_CASE("subject: stated forces and energies that are not those of the motion are found") {
  const std::vector<std::string> laws = {"momentum", "forces", "damping", "vibration"};
  require_found({"states_unbalanced_damping"}, laws, {"damping.stated-forces-sum-to-zero"});
  require_found({"states_twice_the_damping"}, laws,
                {"damping.stated-forces-are-those-of-the-motion"});
  require_found({"held_neighbours_state_nothing"}, laws,
                {"forces.of-a-held-sheet-are-those-of-a-free-one"});
  require_found({"energy_of_motion"}, laws, {"forces.and-energy-are-those-of-positions"});
  require_found({"sharp_hinges_have_no_energy"}, laws,
                {"forces.of-a-sharply-bent-sheet-are-minus-the-energy-gradient"});
  require_found({"energy_without_weight"}, laws, {"forces.are-minus-the-energy-gradient"});
  require_found({"energy_beside_held"}, laws,
                {"forces.energy-of-a-held-sheet-is-that-of-a-free-one"});
  require_found({"hinge_dampers_go_unsaid"}, {"damping"},
                {"damping.stated-forces-of-hinges-are-those-of-the-motion"});
  require_found({"states_stale_forces"}, laws, {"forces.are-those-of-the-present-state"});
  require_found(
      {"forgets_what_is_set"}, laws,
      {"forces.are-those-of-the-present-state", "forces.of-two-states-at-one-time-differ"});
}

TEST_CASE("subject: what a small scene, its first step or a free one does not show, is found") {
  require_found({"energy_of_the_first"}, {"size", "forces"}, {"size.energies-of-many-add-up"});
  require_found({"angles_of_the_first"}, {"size"},
                {"size.sheet-with-rest-angles-moves-alike-among-many"});
  require_found({"dampers_of_prepare"}, {"time"}, {"time.dt-of-advance-counts-for-dampers"});
  require_found({"held_move_for_dampers"}, {"damping.stated"},
                {"damping.stated-velocities-of-held-particles-do-not-count"});
  require_law_fails("scaled_springs_are_stiffer", "rest.scaled-lengths-keep-their-stiffness");
  require_found({"forces_of_the_time"}, {"forces.of-t"},
                {"forces.of-two-states-at-one-time-differ"});
  require_found({"slender_hinges_are_lost"}, {"bending.hinges", "bending.every"},
                {"bending.hinges-of-all-shapes-have-their-weights"});
  require_found({"hinges_slacken_when_squeezed"}, {"bending.h", "bending.s"},
                {"bending.squeezed-hinges-resist"});
  require_found({"energy_forgets_rest_angles"}, {"forces"},
                {"forces.of-a-sheet-of-other-rest-are-minus-the-energy-gradient"});
  require_found({"folds_are_not_damped"}, {"vibration", "damping.folded"},
                {"damping.folded-hinges-are-damped"});
  require_law_fails("boxes_have_no_edge", "box.what-slides-off-falls");
  require_law_fails("layers_inside_alone", "self-collision.aligned-layers-stop");
  require_outcome({"layers"}, "self-collision.aligned-layers-stop", Outcome::holds);
  require_law_fails("counts_parts_once", "time.long-steps-follow-short-ones");
  require_outcome({"divides_steps"}, "time.long-steps-follow-short-ones", Outcome::holds);
  require_law_fails("thickness_stays", "self-collision.thickness-goes-with-its-scene");
  require_law_fails("gravity_where_it_is_set", "together.steps-of-a-state-go-as-advance");
  require_law_fails("dampers_spare_contact", "contact.springs-and-dampers-act-in-contact");
  const std::vector<std::string> obstacles{"obstacles.f", "obstacles.many"};
  require_found({"first_at_each_place"}, obstacles, {"obstacles.many-keep-cloth-out"});
  require_found({"friction_above_one_glues"}, obstacles,
                {"obstacles.friction-above-one-is-coulomb-s"});
}

TEST_CASE("subject: springs that tear beyond a strain of a tenth are found") {
  require_found({"springs_tear"}, {"calibration"}, {"calibration.tension-grows-with-strain"});
}

TEST_CASE("subject: wrong contact is found") {
  const std::string box = "box.fall-gains-no-energy", ball = "ball.fall-gains-no-energy",
                    capsule = "capsule.fall-gains-no-energy";
  CHECK(failing_laws("sinks_in", on_a_plane).contains(rests));
  CHECK(failing_laws("jitters", on_a_plane).contains("contact.resting-sheet-is-still"));
  require_found({"friction_beyond_the_cone", "friction_halved"}, on_a_plane, {slides, slips});
  require_found({"friction_creeps"}, on_a_plane, {slips});
  require_found({"states_velocities_before_contact"}, on_a_plane,
                {"contact.resting-sheet-states-no-velocity"});
  require_found({"on_boxes_now_and_then"}, {"tunnelling", box},
                {"tunnelling.thin-box-stops-a-slow-sheet"});
  require_found({"particles_repel_alone"}, {"self-collision.folded"},
                {"self-collision.folded-sheet-never-passes-through-itself"});
  require_found({"on_planes"}, on_a_plane, {});
  require_found({"bounces_too_high", "bounces_too_high_when_fast"}, on_a_plane,
                {"contact.fall-gains-no-energy"});
  require_found({"on_boxes"}, {box}, {});
  require_found({"boxes_throw_back"}, {box, "tunnelling"}, {box});
  require_found({"on_round_bodies"}, {ball, capsule}, {});
  require_found({"throws_back_when_fast"}, {ball, capsule}, {ball, capsule});
  for (const char* kind : {"planes_are_level", "planes_pass_the_origin"}) {
    INFO(kind);
    CHECK(std::ranges::includes(failing_laws(kind, on_a_plane), Names{rests, slides}));
  }
  require_found({"friction_per_axis"}, on_a_plane, {slides, slips});
  CHECK(failing_laws("friction_turns", on_a_plane).contains(slides));
}

TEST_CASE("subject: a strip on edge that tips too late or too early is found, no other one",
          "[long]") {
  const std::string tips = "buckling.strip-on-edge-tips-at-its-load";
  require_outcome({"bends", "bends_fourfold"}, tips, Outcome::holds);
  require_law_fails("springs_pull_alone", tips);
  require_found({"held_strips_weigh_twice"}, {"buckling"},
                {tips, "buckling.upright-strip-falls-at-greenhill-s-load"});
}

TEST_CASE(
    "subject: a drape that sags too far, or no lower under more weight, is found, no other one",
    "[long]") {
  const std::string sags = "drape.stiff-ring-sags-as-a-plate",
                    lower = "drape.heavier-ring-hangs-lower",
                    disc = "drape.heavier-disc-hangs-lower";
  require_found({"bends"}, {sags, lower, disc}, {});
  require_outcome({"bends_fourfold", "clamps_where_held"}, sags, Outcome::holds);
  require_law_fails("held_strips_weigh_a_tenth_more", sags);
  require_found({"bends_one_way_alone"}, {"calibration", sags}, {refined_rigidity, sags});
  for (const std::string& law : {lower, disc}) require_law_fails("bends_with_limited_weight", law);
}

TEST_CASE("subject: tension that does not straighten a stretched sheet is found, no other one",
          "[long]") {
  const std::string waves = "wrinkles.grow-as-tension-and-rigidity-say";
  require_outcome({"bends", "bends_fourfold"}, waves, Outcome::holds);
  require_found({"springs_keep_their_directions"}, {"calibration", waves}, {rigidity, waves});
}

TEST_CASE("subject: a limp drape that hangs no lower under more weight is found, no other one") {
  const std::string limp = "drape.heavier-limp-ring-hangs-lower";
  require_outcome({"none", "single"}, limp, Outcome::holds);
  require_law_fails("weight_is_limited", limp);
}

TEST_CASE(
    "subject: forces and energies of bending that disagree, or leave a net force, are found") {
  const std::string of_bent = "forces.of-a-bent-sheet-";
  require_found({"bends"}, {"forces"}, {});
  const std::string of_sharp = "forces.of-a-sharply-bent-sheet-are-minus-the-energy-gradient";
  require_found({"bending_energy_tripled"}, {"forces"},
                {of_bent + "are-minus-the-energy-gradient", of_sharp});
  require_found({"bending_pulls_one_corner_less"}, {"forces"},
                {of_bent + "sum-to-zero", of_bent + "exert-no-torque",
                 of_bent + "are-minus-the-energy-gradient", of_sharp});
}

/// A quantity that is the scene's times a factor: the law allows one, and finds the other.
struct Slip {
  std::string law, quantity, allowed, found;
};

TEST_CASE(
    "subject: laws find slips of a few per cent, or of a few roundings, and allow smaller ones",
    "[long]") {
  for (const Slip& slip : {
           Slip{"gravity.speed-grows-by-g-t", "gravity", "1.0000000000001", "1.000000000001"},
           {"momentum.linear-is-conserved", "one_end", "1.00000000001", "1.0000000001"},
           {"forces.sum-to-zero", "one_end", "1.0000000000001", "1.000000000001"},
           {young, "young", "1.02", "1.08"},
           {young, "young", "0.98", "0.92"},
           {rigidity, "rigidity", "1.02", "1.08"},
           {rigidity, "rigidity", "0.97", "0.92"},
           {dampers, "damping", "1.03", "1.07"},
           {dampers, "damping", "0.97", "0.94"},
           {decay, "damping", "1.02", "1.05"},
           {decay, "damping", "0.98", "0.95"},
           {slides, "friction", "1.05", "1.1"},
           {slides, "friction", "0.95", "0.9"},
           {slips, "friction", "1.02", "1.04"},
           {slips, "friction", "0.98", "0.96"},
           {"ball.sheet-comes-to-rest", "radius", "0.998", "0.99"},
       }) {
    const std::string scaled = "scaled " + slip.quantity + " ";
    require_outcome({scaled + slip.allowed}, slip.law, Outcome::holds);
    require_outcome({scaled + slip.found}, slip.law, Outcome::fails);
  }
}

TEST_CASE("subject: a sheet of another stiffness may decay and vibrate as its own says") {
  require_found({"scaled damped_young 0.8", "scaled damped_young 1.3"}, {"vibration"}, {});
}

TEST_CASE("subject: bending that refinement changes is found") {
  require_found({"bends_by_long_springs"}, {"calibration"}, {rigidity, refined_rigidity});
}

TEST_CASE("subject: a strip whose rigidity is lost in rounding is judged by no law") {
  for (const char* law : {"cantilever", "strip.wrinkles", "buckling.strip", "wrinkles"})
    require_outcome({"bends_in_substeps_of_single"}, law, Outcome::not_applicable);
}

TEST_CASE("subject: rest angles that are ignored are found, and declined ones are no failure") {
  const std::string stays = "rest.curved-sheet-keeps-its-rest-angles";
  require_found({"bends_to_flat"}, {"rest"}, {stays});
  require_outcome({"bends"}, stays, Outcome::not_applicable);
}

TEST_CASE(
    "subject: a floor that lets a strip slip too late or too early, or holds a fold down, is found",
    "[long]") {
  const std::string pressed = "floor.pressed-strip-slips-as-the-elastica";
  require_outcome({"bends_on_planes"}, pressed, Outcome::holds);
  require_outcome({"on_planes"}, pressed, Outcome::not_applicable);
  require_law_fails("bends_on_planes_friction_halved", pressed);
  require_found({"bends_on_planes_friction_of_weight"}, {slides, pressed}, {pressed});
  const std::string stands = "floor.clamped-fold-stands-as-high-as-the-elastica";
  require_outcome({"bends_on_planes"}, stands, Outcome::holds);
  require_outcome({"on_planes"}, stands, Outcome::not_applicable);
  require_found({"bends_on_planes_that_hold_down"}, {slides, stands}, {stands});
}

TEST_CASE("subject: wrong contact with round bodies is found, and no other one", "[long]") {
  const std::string outside = "ball.falling-sheet-stays-outside",
                    at_rest = "ball.sheet-comes-to-rest", glides = "ball.slides-as-coulomb-says";
  require_found({"radius_too_small", "radius_too_large"}, on_a_ball, {outside, at_rest, glides});
  CHECK(failing_laws("stops_from_above", on_a_ball).contains(outside));
  CHECK(failing_laws("throws_back", on_a_ball).contains("ball.fall-gains-no-energy"));
  require_found({"round_bodies_turn"}, on_a_ball, {at_rest, glides});
  CHECK(failing_laws("round_bodies_without_friction", on_a_ball).contains(glides));
  require_found({"round_bodies_stick"}, on_a_ball, {glides});
  const std::string lies = "capstan.strip-lies-on-the-capsule";
  require_found({"radius_too_small"}, {"capstan"}, {lies});
  CHECK(failing_laws("capsules_are_balls", {"capstan"}).contains(lies));
  require_found({"round_friction_halved", "round_friction_is_drag", "round_bodies_stick"},
                {"capstan"}, {"capstan.slips-at-euler-s-ratio"});
  require_found({"on_round_bodies", "on_round_bodies_single"}, {"ball", "capsule", "capstan"}, {});
  // a slow one
  require_found({"on_round_bodies_backward_euler"}, {"ball.falling", "capstan.strip"}, {});
}

TEST_CASE("subject: a sheet that stands still has passed no test of collisions") {
  require_law_fails("starts_from_rest", "inertia.free-sheet-keeps-its-velocity");
  for (const char* law : {"tunnelling.thin-box-stops-a-slow-sheet",
                          "self-collision.folded-sheet-never-passes-through-itself"})
    require_outcome({"starts_from_rest"}, law, Outcome::not_applicable);
}

TEST_CASE("subject: a failure names its operation, scene, step and the steps before it") {
  CHECK_THAT(
      failure_of(broken("crash")).what(),
      Contains(
          "during 'advance' by 2 steps of 0.001 s, after 0 steps, in the scene 'small sheet'"));
  Trial trial(broken("late_crash"));
  CHECK_THROWS_WITH(trial.motion(suite::moving_sheet(), {5, 10, 20}),
                    Contains("signal 11 (Segmentation fault)") &&
                        Contains("during 'advance' by 10 steps of 0.002 s, after 10 of 20 "
                                 "steps, in the scene 'moving sheet'"));
}

TEST_CASE("subject: a solver that reports its progress may take longer than the limit of silence") {
  CHECK(failure_of(broken("tells_progress", 2)).cause == "none");
}

TEST_CASE("subject: last words keep their lines, the last ten of them") {
  const SolverFailure failure = failure_of(broken("last_lines"));
  CHECK_THAT(failure.what(), Contains("its last words:\n    line 3\n    line 4\n") &&
                                 Catch::EndsWith("\n    line 11\n      indented"));
  CHECK(failure.in_one_line().find('\n') == std::string::npos);
}

TEST_CASE("subject: laws that the time of the trial does not reach did not run") {
  SolverCommand command = python("bad/wrong.py sleeps");
  command.limits.end = std::chrono::steady_clock::now() + std::chrono::milliseconds(700);
  const Judgement judgement = judge_solver(command, portable_laws(), ignore);
  CHECK(did_not_run(judgement.records.back()));
  CHECK_THAT(judgement.records.back().finding.note,
             Catch::StartsWith("the time of the trial was up during"));
  for (const Record& record : judgement.records)
    CHECK((record.outcome != Outcome::fails && record.outcome != Outcome::inconclusive));
}

TEST_CASE("subject: nothing follows from bounds that a declared tolerance makes too wide") {
  const auto records =
      records_of("stands_still_to_half", {"rest.no", "inertia", "gravity.speed",
                                          "momentum.linear-is", "symmetry", "vibration.undamped"});
  CHECK(!records.empty());
  for (const Record& record : records) {
    if (record.outcome == Outcome::not_applicable) continue;  // of bending or dampers
    INFO(record.name);
    CHECK(record.outcome == Outcome::inconclusive);
    CHECK_THAT(record.finding.note, Contains("solve_tolerance 0.5"));
  }
}

TEST_CASE("subject: the headline of a law is what it measured") {
  const auto slides_twice = [](Trial&) {
    Table slide = suite::table_of("mu [1] | distance down [m] | by Coulomb's law [m] | error [1]");
    slide.row(0.1, 1, 1.01, 0.01);
    slide.row(0.2, 3, 4.5, 0.5);
    return judge_worst(slide, 1, "");
  };
  const Law law{"slides", "", "", slides_twice, "", "mu | distance down | by Coulomb's law"};
  CHECK(judge_solver(python("bad/wrong.py none"), {law}, ignore).records[0].finding.headline ==
        "mu 0.2, distance down 3 m, by Coulomb's law 4.5 m");
  std::vector<Law> laws = portable_laws();
  std::erase_if(laws, [](const Law& one) { return one.headline.empty(); });
  for (const std::string kind : {"none", "on_planes", "damped"})
    for (const Record& record : judge_solver(python("bad/wrong.py " + kind), laws, ignore).records)
      CHECK(record.finding.headline.empty() == (record.finding.evidence.rows() == 0));
  CHECK_THAT(records_of("first_order_as_second", {"order.observed"}).at(0).finding.headline,
             Contains("observed 1.0") && Catch::EndsWith("claimed 2"));
  CHECK_THAT(records_of("friction_beyond_the_cone", {"contact.slips"}).at(0).finding.headline,
             Contains(", the most that is tried"));
}

}  // namespace foldproof
