// Solvers whose contact is right raise no alarm; each wrong one is found by the law that it breaks.
#include <catch2/catch.hpp>

#include <set>
#include <string>

#include "verification/tests/wrong_solvers.h"

namespace foldproof {

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

TEST_CASE("subject: wrong contact with balls is found") {
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

TEST_CASE("subject: wrong contact with capsules is found") {
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

TEST_CASE("subject: correct contact with round bodies raises no alarm") {
  for (const char* kind : {"on_round_bodies", "on_round_bodies_single"}) {
    INFO(kind);
    CHECK(failing_laws(kind, laws_of({"ball", "capstan"})) == std::set<std::string>{});
  }
  // a slow one
  const std::vector<Law> laws = laws_of({"ball.falling", "capstan.strip"});
  CHECK(failing_laws("on_round_bodies_backward_euler", laws) == std::set<std::string>{});
}

}  // namespace foldproof
