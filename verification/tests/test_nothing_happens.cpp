// Solvers in whose scenes nothing happens hold no law that is about motion; right but unusual
// solvers fail none.
#include <catch2/catch.hpp>

#include "verification/tests/wrong_solvers.h"

namespace foldproof {

namespace {

Names holding_laws(const std::string& kind, const std::vector<std::string>& laws) {
  Names names;
  for (const Record& record : records_of(kind, laws))
    if (record.outcome == Outcome::holds) names.insert(record.name);
  return names;
}

Names failing_odd(const std::string& kind, const std::vector<std::string>& laws) {
  Names names;
  const SolverCommand command = python("odd/odd.py " + kind);
  for (const Record& record : judge_solver(command, laws_of(laws), ignore).records) {
    INFO(record.name << ": " << record.finding.note);
    CHECK(!did_not_run(record));
    if (record.outcome == Outcome::fails) names.insert(record.name);
  }
  return names;
}

// those of a numpy solver's second
const std::vector<std::string> short_laws = {
    "smoke",     "rest",  "inertia",       "gravity",   "momentum",  "symmetry",
    "repeat",    "order", "forces",        "precision", "damping",   "calibration",
    "vibration", "held",  "contact.sheet", "ball.f",    "tunnelling"};

}  // namespace

TEST_CASE("subject: a solver that never moves holds no law", "[long]") {
  CHECK(holding_laws("never_moves", {""}).empty());
}

TEST_CASE("subject: a solver that moves sheets rigidly holds laws of rigid motion only", "[long]") {
  CHECK(holding_laws("moves_rigidly", {"smoke", "rest", "inertia.free", "gravity.speed",
                                       "gravity.fall", "momentum", "repeat", "forces", "stability",
                                       "contact", "box", "ball", "capsule", "capstan"}) ==
        Names{"contact.lets-go", "box.lets-go", "ball.lets-go", "capsule.lets-go",
              "smoke.free-fall-within-5-percent", "inertia.free-sheet-keeps-its-velocity",
              "gravity.speed-grows-by-g-t", "gravity.fall-is-as-exact-as-the-order-claims",
              "forces.weight-is-mass-times-g"});
}

TEST_CASE("subject: a solver that ignores all contact holds no law of contact", "[long]") {
  CHECK(holding_laws("ignores_all_contact",
                     {"contact.s", "contact.f", "box.f", "ball.f", "ball.slides", "capsule.f"})
            .empty());
}

TEST_CASE("subject: a law that holds though nothing happened says what did not happen") {
  const Record still = records_of("never_moves", {"rest.no-force-no-motion"}).at(0);
  CHECK(still.outcome == Outcome::inconclusive);
  CHECK_THAT(still.finding.note, Catch::StartsWith("nothing happened: its scene does not deform"));
  const Record falls = records_of("ignores_all_contact", {"contact.fall"}).at(0);
  CHECK(falls.outcome == Outcome::inconclusive);
  CHECK_THAT(falls.finding.note, Catch::Contains("no obstacle changed"));
}

TEST_CASE("subject: right but unusual solvers fail no law", "[long]") {
  for (const char* kind : {"double", "single", "shell_1mm", "shell_2mm", "shell_5mm", "random_sums",
                           "substeps", "consistent_mass", "linearised", "loose_solves"}) {
    INFO(kind);
    CHECK(failing_odd(kind, short_laws) == Names{});
  }
}

TEST_CASE("subject: laws that a time limit ends did not run, and the next one goes on") {
  TrialWatch watch;
  watch.law_seconds = 1e-9;
  const Judgement judgement = judge_solver(python("bad/wrong.py none"), laws_of({"smoke"}), watch);
  CHECK(judgement.records.size() == 2);
  for (const Record& record : judgement.records) {
    CHECK(did_not_run(record));
    CHECK_THAT(record.finding.note, Catch::Contains("--law-seconds"));
  }
}

}  // namespace foldproof
