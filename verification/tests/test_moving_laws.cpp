// Solvers that are wrong in what protocol 2 adds: each is found by the law that it breaks.
#include <catch2/catch.hpp>

#include "verification/tests/wrong_solvers.h"

namespace foldproof {

namespace {

const std::string follow = "moving.held-particles-follow-their-path",
                  led = "moving.led-sheet-goes-along", belt = "moving.friction-carries-the-sheet",
                  table = "moving.turntable-turns-the-sheet", grip = "moving.grip-lifts-and-holds";

/// The groups of these laws.
const std::vector<std::string> groups{"moving", "materials", "strain-limits", "air", "layers"};

}  // namespace

TEST_CASE("subject: what moves, and moves wrongly, is found") {
  require_found({"follows"}, groups, {});
  require_found({"follows_boxes"}, groups, {});
  require_found({"held_stay"}, groups, {follow, led});
  require_found({"held_are_a_step_late"}, groups, {follow, led});
  require_found({"held_go_on"}, groups, {follow});
  require_found({"planes_stay"}, groups, {belt, table});
  require_found({"planes_do_not_turn"}, groups, {table});
  require_found({"friction_of_standing_planes"}, groups, {belt, table});
  require_found({"grip_of_one_side"}, groups, {grip});
}

TEST_CASE("subject: wrong materials, limits, layers and air are found") {
  require_found({"first_material_alone"}, groups, {"materials.each-triangle-has-its-own"});
  require_found({"limits_are_their_own"}, groups, {"strain-limits.are-kept"});
  require_found({"no_limits"}, groups, {"strain-limits.are-kept"});
  require_found({"still_air"}, groups, {"air.drags-a-falling-sheet"});
  require_found({"no_air"}, groups, {"air.drags-a-falling-sheet"});
  require_found({"layers_rub"}, groups, {});
  require_found({"layers_do_not_rub"}, groups, {"layers.rub-as-coulomb-says"});
  require_found({"layers_stick"}, groups, {"layers.rub-as-coulomb-says"});
}

TEST_CASE("subject: forces of contact that are read wrongly are found") {
  const std::string balance = "contact-forces.balance-the-momentum",
                    each = "contact-forces.carry-each-particle",
                    coulomb = "contact-forces.keep-to-coulomb-s-law",
                    apart = "contact-forces.vanish-apart";
  const std::vector<std::string> read{"contact-forces"};
  require_found({"reads_contact"}, read, {});
  require_found({"reads_nothing"}, read, {balance, each, coulomb, apart});
  require_found({"reads_impulses"}, read, {balance, each, coulomb, apart});
  require_found({"reads_the_last_step"}, read, {balance});
  require_found({"reads_forces_on_obstacles"}, read, {balance, each, coulomb});
  require_found({"reads_normal_forces"}, read, {balance, coulomb});
  require_found({"reads_the_mean"}, read, {each});
  require_found({"reads_a_penalty"}, read, {balance, each, coulomb, apart});
  require_found({"reads_the_scene_before"}, read, {apart});
  require_found({"reads_for_ever"}, read, {balance, each, coulomb, apart});
}

TEST_CASE("subject: materials that rub wrongly are found") {
  const std::string own = "materials.rub-by-their-own-coefficient";
  require_found({"rubs_by_material"}, {own}, {});
  for (const char* wrong :
       {"rubs_by_obstacles_alone", "rubs_by_the_mean", "rubs_by_the_first",
        "rubs_by_material_alone", "rubs_by_material_on_planes_alone", "rubs_unless_zero"})
    require_found({wrong}, {own}, {own});
}

TEST_CASE("subject: cloth that is woven wrongly is found") {
  const std::string pulls = "membrane.pulls-as-warp-and-weft-say";
  require_found({"woven"}, {"membrane"}, {});
  for (const char* wrong :
       {"woven_across", "woven_along_x", "woven_without_narrowing", "woven_alike",
        "woven_of_half_the_shear", "woven_undamped", "woven_in_its_first_plane",
        "woven_as_the_first_triangle", "woven_of_one_poisson_ratio"})
    require_found({wrong}, {pulls}, {pulls});
  require_found({"woven_without_springs"}, {"membrane"}, {"membrane.acts-beside-springs"});
  require_found({"woven_of_the_first_material"}, {"membrane"},
                {"membrane.each-material-has-its-own"});
}

TEST_CASE("subject: a solver of protocol 1 is served, and gets no capability of protocol 2") {
  const auto read = [](int protocol, const char* capability) {
    return read_declaration({{"protocol", protocol},
                             {"name", "n"},
                             {"version", "1"},
                             {"level", "L1"},
                             {"precision", "f8"},
                             {"scheme", {{"name", "s"}}},
                             {"capabilities", {capability}}});
  };
  CHECK(read(1, "planes").offers("planes"));
  CHECK(read(2, "air").offers("air"));
  CHECK_THROWS_AS(read(1, "air"), SolverFailure);
  CHECK_THROWS_AS(read(3, "planes"), SolverFailure);
}

}  // namespace foldproof
