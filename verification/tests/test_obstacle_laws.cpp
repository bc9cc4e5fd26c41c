// Solvers that are wrong in contact with obstacles, or between layers, in one place each.
#include <catch2/catch.hpp>

#include "verification/tests/wrong_solvers.h"

namespace foldproof {

TEST_CASE("subject: slips in obstacles are found by the law of their kind, and no other one",
          "[long]") {
  const std::string side = "each-side-has-its-friction",
                    several = "each-of-several-has-its-friction",
                    kinds = "obstacles.of-several-kinds-each-has-its-friction",
                    both = "obstacles.both-act-on-what-touches-both";
  const std::vector<std::string> box{"box.s", "box.e",        "box.l",
                                     "box.i", "box.friction", "obstacles"},
      capsule{"capsule.s", "capsule.e", "capsule.lets"};
  require_found({"on_obstacles"}, {"contact", "box", "ball", "capsule", "obstacles"}, {});
  require_found({"boxes_off_centre"}, {"box.surface"}, {"box.surface-is-where-the-scene-says"});
  require_found({"rough_on_top_alone"}, {"box.surface", "box.each-side", "box.stops", "box.lets"},
                {"box." + side});
  CHECK(failing_laws("capsules_endless", capsule)
            .contains("capsule.surface-is-where-the-scene-says"));
  require_found({"walls_are_nothing"}, {"contact.planes"},
                {"contact.planes-of-all-ways-have-their-friction"});
  const std::string size = "of-any-size-is-where-the-scene-says";
  require_found({"no_obstacle_is_small"}, {"box.o", "ball.o", "capsule.o", "box.surface"},
                {"box." + size, "ball." + size, "capsule." + size});
  require_law_fails("planes_snap_to_axes", "contact.planes-of-all-ways-have-their-friction");
  require_found({"points_are_nothing"}, {"capsule.of"}, {"capsule.of-one-point-is-a-ball"});
  const std::string many = "obstacles.many-keep-cloth-out";
  require_found({"forgets_others"}, {"box.each", "obstacles"}, {"box." + several, both, many});
  require_found({"first_kind_alone"}, box, {kinds, both, many});
  require_law_fails("meets_one_obstacle", both);
  require_found({"means_friction"}, {"box"}, {"box.sheet-across-two-has-the-friction-of-both"});
  require_found({"keeps_old_obstacles"}, {"obstacles"},
                {"obstacles.go-with-their-scene", "obstacles.far-ones-change-nothing"});
  require_found({"far_obstacles_pull"}, box, {"obstacles.far-ones-change-nothing"});
  require_found({"obstacles_cling"}, box, {"box.lets-go"});
  require_found({"slow_cloth_creeps"}, box, {"box.stuck-sheet-does-not-creep"});
  require_found({"fast_cloth_slides"}, box, {"box.impact-has-coulomb-s-friction"});
  require_found({"obstacles_rebound"}, {"ball.stops"}, {"ball.stops-without-rebound"});
  require_found({"slides_beside_held"}, box, {"box.friction-holds-beside-held-particles"});
  require_found({"sixty_four_contacts"}, box, {"box.large-sheet-slides-as-coulomb-says"});
}

TEST_CASE("subject: slips in contact of layers are found, each by its law", "[long]") {
  const std::vector<std::string> layers{"self-collision.l", "self-collision.t",
                                        "self-collision.fine"};
  const std::string keep = "self-collision.layers-that-meet-keep-momentum",
                    lies = "self-collision.layer-lies-on-a-layer-on-a-plane";
  require_found({"layers"}, layers, {});
  require_found({"layers_push_one_side", "layers_push_corners"}, layers, {keep});
  require_law_fails("layers_push_one_side", "self-collision.pairs-that-meet-keep-momentum");
  require_found({"layers_twice_as_thick"}, layers,
                {"self-collision.layers-beyond-the-thickness-are-left-alone", lies});
  require_found({"layers_glue"}, layers,
                {"self-collision.layers-part-freely", lies,
                 "self-collision.layers-slide-where-no-friction-is-stated"});
  require_found({"layers_forget_planes"}, layers, {lies});
  require_found({"thick_on_planes"}, {"contact", "self-collision.t"},
                {"self-collision.thickness-is-not-kept-from-planes"});
  require_law_fails("particles_repel_alone", "self-collision.vertices-and-edges-stop");
  require_law_fails("particles_repel_alone", "self-collision.stack-keeps-its-order");
  require_found({"neighbours_repel"}, {"self-collision.fine"},
                {"self-collision.fine-mesh-stays-at-rest"});
}

TEST_CASE("subject: one of several obstacles, pieces or questions is not taken for all") {
  require_found({"sums_what_pushes"}, {"obstacles.l", "contact.stops"},
                {"obstacles.listed-twice-is-one"});
  require_found({"large_reach_out"}, {"obstacles.cloth", "obstacles.f"},
                {"obstacles.cloth-is-free-until-it-meets-one"});
  require_found({"rims_snag"}, {"box.rim", "box.surface", "box.seams"},
                {"box.rim-holds-nothing-back", "box.seams-of-a-floor-hold-nothing-back"});
  require_found({"boxes_shrink_for_thick_cloth"}, {"box.surface"},
                {"box.surface-is-there-for-thick-cloth"});
  require_found({"loose_pieces_freeze"}, {"mixed", "held"}, {"mixed.pieces-move-as-they-do-alone"});
  require_found({"calls_begin_without_friction"}, {"mixed"}, {"mixed.calls-may-be-divided"});
  require_law_fails("held_stay_held", "mixed.scenes-leave-nothing");
  require_found({"held_are_pushed"}, {"held"}, {"held.particles-stay-inside-boxes"});
  require_found({"tables_of_eight_edges"}, {"size.h"},
                {"size.hub-of-many-edges-moves-alike-to-each"});
  require_found({"rough_on_top_alone"}, {"mixed"}, {"mixed.turned-scene-moves-alike"});
  require_found({"holds_in_order_alone"}, {"mixed"}, {"mixed.lists-have-no-order"});
  require_found({"sixty_four_contacts"}, {"size.sheet-slides"},
                {"size.sheet-slides-alike-among-many"});
  require_found({"hit_triangles_are_held"}, {"self-collision.pairs", "self-collision.what"},
                {"self-collision.what-is-hit-turns-about-what-is-held"});
  require_law_fails("layers_rub", "self-collision.layers-slide-where-no-friction-is-stated");
  require_outcome({"layers"}, "self-collision.layers-slide-where-no-friction-is-stated",
                  Outcome::holds);
  require_law_fails("bounds_parts_once", "repeat.stiff-scene-after-a-soft-one");
  require_outcome({"damped_backward_euler"}, "repeat.stiff-scene-after-a-soft-one", Outcome::holds);
  require_found({"forces_kick"}, {"repeat", "forces"}, {"repeat.questions-change-nothing"});
}

}  // namespace foldproof
