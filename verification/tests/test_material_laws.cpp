// What materials mean to a solver, and shapes that show it: each wrong one fails by the law's name.
#include <catch2/catch.hpp>

#include <set>
#include <string>
#include <vector>

#include "verification/tests/wrong_solvers.h"

namespace foldproof {

TEST_CASE("subject: parameters that mean something else are found") {
  const std::string young = "calibration.young-s-modulus-is-the-scene-s",
                    refined = "calibration.modulus-survives-refinement";
  const std::vector<Law> laws = laws_of({"calibration"});
  CHECK(failing_laws("springs_of_one_stiffness", laws).contains(young));
  CHECK(failing_laws("springs_per_length", laws) == std::set<std::string>{young, refined});
  CHECK(failing_laws("bends_upright_only", laws_of({"calibration", "cantilever"})) ==
        std::set<std::string>{"cantilever.heavy-strip-hangs-as-the-elastica"});
  CHECK(failing_laws("bends_fourfold", laws) ==
        std::set<std::string>{"calibration.bending-rigidity-is-the-scene-s"});
}

TEST_CASE("subject: bending that nobody asked for, and springs that only pull, are found") {
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

TEST_CASE("subject: bent strips raise no alarm for bending of another kind or rigidity") {
  for (const char* kind : {"bends", "bends_fourfold"}) {
    INFO(kind);
    CHECK(failing_laws(kind, laws_of({"strip"})) == std::set<std::string>{});
  }
}

TEST_CASE(
    "subject: bending that is wrong where a sheet is turned over, or sharply bent, is found") {
  const std::string loops = "strip.loops-hang-as-the-elastica",
                    rings = "strip.rings-take-the-elastica-s-shape",
                    wrinkles = "strip.wrinkles-take-the-elastica-s-shape",
                    fold = "strip.free-fold-takes-the-elastica-s-shape";
  const std::vector<Law> laws = laws_of({"calibration", "cantilever", "strip"});
  CHECK(failing_laws("bends_face_up_alone", laws) == std::set<std::string>{loops, rings, fold});
  CHECK(failing_laws("stiffens_when_sharp", laws) ==
        std::set<std::string>{"cantilever.heavy-strip-hangs-as-the-elastica", loops, rings,
                              wrinkles, fold});
}

TEST_CASE("subject: a strip on edge that tips too late or too early is found, no other one") {
  const std::string tips = "buckling.strip-on-edge-tips-at-its-load";
  for (const char* kind : {"bends", "bends_fourfold"})
    CHECK(outcome_of_law(kind, tips) == Outcome::holds);
  require_law_fails("springs_pull_alone", tips);
  CHECK(failing_laws("held_strips_weigh_twice", laws_of({"buckling"})) ==
        std::set<std::string>{tips, "buckling.upright-strip-falls-at-greenhill-s-load"});
}

}  // namespace foldproof
