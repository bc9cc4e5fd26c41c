// Limits, clocks, sizes, dampers, hinges and held particles of a solver's own: each is found by the
// law that names it, and by no other one of its kind.
#include <catch2/catch.hpp>

#include "verification/tests/wrong_solvers.h"

namespace foldproof {

namespace {

/// Those that ask for what no other law asks.
const std::vector<std::string> own = {"limits",   "gravity.is", "time", "held",      "bending",
                                      "momentum", "symmetry",   "rest", "vibration", "damping"};

void require_own(const std::string& kind, const Names& failing) {
  require_found({kind}, own, failing);
}

}  // namespace

TEST_CASE("subject: hinges and dampers as the protocol says raise no alarm", "[long]") {
  require_own("hinges", {});
  require_found({"hinges"}, {"repeat", "order", "calibration", "forces"}, {});
}

TEST_CASE("subject: limits of a solver's own are found by their names", "[long]") {
  const std::string speed = "limits.no-speed-is-too-fast", edge = "limits.no-edge-is-too-fast",
                    seconds = "limits.velocity-is-kept-for-thousands-of-steps";
  require_own("speed", {speed, edge, "symmetry.units"});
  require_own("edges_are_slow", {edge, "symmetry.units"});
  require_own("strain_is_limited",
              {"limits.no-strain-is-too-large", "held.particles-stay-for-seconds"});
  CHECK(failing_laws("scales_velocity_each_step", {"limits"}) ==
        Names{"limits.no-step-takes-velocity", seconds});
  require_own("knows_gravity", {"gravity.is-that-of-the-scene", "symmetry.units"});
  require_own("steps_are_short", {"time.steps-last-as-long-as-asked"});
  require_own("first_step_is_kept", {"time.each-call-has-its-step"});
  CHECK(failing_laws("step_of_prepare", {"time"}).contains("time.dt-of-advance-counts"));
  require_own("tires", {seconds});
  require_found({"divides_steps"}, {"time", "damping", "vibration"}, {});
  CHECK(failing_laws("loses_a_part", {"time"}).contains("time.steps-last-as-long-as-asked"));
  CHECK(failing_laws("damps_in_the_first_part", {"damping"})
            .contains("damping.long-steps-damp-as-short-ones"));
}

TEST_CASE("subject: a solver that treats many particles otherwise is found", "[long]") {
  const std::string size = "size.";
  require_found(
      {"many_stand_still"}, {"size"},
      {size + "sheet-moves-alike-among-many", size + "held-sheet-moves-alike-among-many"});
  require_found({"many_bend_freely"}, {"size"}, {size + "bent-sheet-moves-alike-among-many"});
  require_found({"many_are_not_damped"}, {"size"}, {size + "damped-sheet-moves-alike-among-many"});
}

TEST_CASE("subject: held particles that are not, and what is wrong beside them, are found",
          "[long]") {
  const std::string many = "held.many-in-any-order-and-no-other",
                    seconds = "held.particles-stay-for-seconds";
  require_own("holds_in_order_alone", {many, seconds});
  require_own("weighs_half_beside_held", {many});
  require_own("releases_after_a_second", {seconds});
  require_own("frees_held_when_set", {"held.particles-stay-in-steps-of-a-state"});
  require_own("dampers_spare_held", {"damping.edges-of-held-particles-damp-as-the-others"});
}

TEST_CASE("subject: rest lengths, creep, stiffening and hypotenuses of another kind are found",
          "[long]") {
  require_own("rest_is_never_scaled",
              {"rest.scaled-lengths-are-at-rest", "rest.scaled-lengths-keep-their-stiffness"});
  require_found({"creeps"}, {"repeat.motion"}, {"repeat.motion-goes-on-from-its-state"});
  require_found({"stiffens_beyond_a_tenth"}, {"calibration"},
                {"calibration.tension-does-not-jump-with-strain"});
  require_found({"soft_hypotenuses"}, {"calibration", "symmetry"},
                {"calibration.modulus-along-hypotenuses"});
}

TEST_CASE("subject: dampers along edges at rest, and wrong dampers of hinges, are found",
          "[long]") {
  const std::string damping = "momentum.angular-under-damping-drifts-less-in-shorter-steps",
                    of_hinges =
                        "momentum.angular-under-damping-of-hinges-drifts-less-in-shorter-steps",
                    linear = "momentum.linear-under-damping-of-hinges-is-conserved",
                    decay = "vibration.damped-hinge-decays-as-its-damping-says";
  require_own("damps_along_rest", {damping, "symmetry.start-turned-from-rest-with-damping"});
  require_own("hinges_are_not_damped", {decay, "damping.folded-hinges-are-damped"});
  CHECK(failing_laws("hinge_dampers_push", {"momentum"}) == Names{linear, of_hinges});
  CHECK(failing_laws("hinge_dampers_of_velocity", {"momentum"}) == Names{of_hinges});
  require_own("hinges_are_damped_unasked",
              {"symmetry.units-with-bending", "vibration.undamped-hinge-goes-on", decay});
}

TEST_CASE("subject: hinges that are wrong where sharp, on a side, or from a start, are found",
          "[long]") {
  const std::string sharp = "bending.sharp-folds-resist", sides = "bending.both-sides-resist-alike",
                    angles = "bending.rest-angles-are-those-of-the-scene";
  require_own("hinges_slacken_when_sharp", {sharp});
  CHECK(failing_laws("hinges_know_their_front", {"bending"}) ==
        Names{sides, "bending.hinges-of-all-shapes-have-their-weights"});
  require_own("hinges_rest_as_the_shape", {angles, "symmetry.rotation-with-bending"});
  require_own("hinges_crease", {"bending.bends-do-not-creep", "symmetry.units-with-bending"});
  require_law_fails("hinges_need_six_neighbours", "bending.every-pattern-resists");
  require_law_fails("hinges_are_alike", "bending.graded-rows-resist-alike");
  require_found({"hinges"}, {"together"}, {});
  require_law_fails("one_damper_at_a_time", "together.each-part-acts-as-it-does-alone");
  require_found({"last_hinge_is_missing"}, {"symmetry"}, {"symmetry.renumbering-with-bending"});
}

}  // namespace foldproof
