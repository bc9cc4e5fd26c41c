// Labels of findings: derived from names, units and bounds, never from outcomes.
#include <catch2/catch.hpp>

#include "verification/finding_kinds.h"

using namespace foldproof;

namespace {

Record record_of(const std::string& name, const Verdict& verdict) {
  return {name, "check", "", "A sentence.", "nowhere", {verdict, {}, ""}, {}, "", 0, {}};
}

}  // namespace

TEST_CASE("what every case says is generic, what its own says is specific") {
  const Verdict none{0, 0, 0, "pairs", ""};
  for (const std::string end : {"runs-to-its-end", "is-reproducible", "never-crosses-itself"})
    CHECK(scope_of(record_of("case.robe." + end, none)) == FindingScope::generic);
  CHECK(scope_of(record_of("case.robe.stays-outside", none)) == FindingScope::specific);
  CHECK(scope_of(record_of("group.is-reproducible", none)) == FindingScope::specific);
  CHECK(scope_of(record_of("case.hinge.never-crosses-itself", none)) == FindingScope::structural);
  CHECK(certainty_of(record_of("dynamics.solves-are-counted", none)) == Certainty::structural);
}

TEST_CASE("an uncertainty of zero says why it is zero") {
  for (const auto& [verdict, certainty] : std::vector<std::pair<Verdict, Certainty>>{
           {{3, 4, 0, "pairs", ""}, Certainty::counted},
           {{0, 0, 0, "1", ""}, Certainty::counted},
           {{1, 0, 0, "1", ""}, Certainty::counted},  // it fails, and is as exact
           {{1.5, 4, 0, "particles short of 60", ""}, Certainty::computed},
           {{1.5, 16, 0, "epsilon sum |F_i|", ""}, Certainty::within_bound},
           {{0.9, 2, 0, "tolerances", ""}, Certainty::within_bound},
           {{0.9, 3, 0, "standard errors", ""}, Certainty::within_bound},
           {{0.02, 0.1, 0, "1", ""}, Certainty::computed},
           {{0, 0.1, 0, "1", ""}, Certainty::computed},
           {{0.02, 0.1, 1e-9, "1", ""}, Certainty::estimated},
           {{NAN, NAN, NAN, "1", ""}, Certainty::estimated}}) {
    INFO(verdict.measured << " of " << verdict.bound << " " << verdict.unit);
    CHECK(certainty_of(record_of("group.name", verdict)) == certainty);
  }
}

TEST_CASE("a timing without a spread is told as one") {
  const std::string name = "solver.cached-terms-save-time";
  CHECK(certainty_of(record_of(name, {0.4, 0.5, 0, "1", ""})) == Certainty::timed_once);
  CHECK(certainty_of(record_of(name, {0.4, 0.5, 1e-3, "1", ""})) == Certainty::estimated);
}

TEST_CASE("the share of measured bounds counts what is judged") {
  std::vector<Record> records;
  CHECK(empirical_share(records) == 0);
  const auto share_with = [&](const std::string& why, std::optional<Outcome> outcome) {
    records.push_back(record_of("a.b", {0, 1, 0, "1", why}));
    records.back().outcome = outcome;
    return empirical_share(records);
  };
  CHECK(share_with("derived", Outcome::holds) == 0);
  CHECK(share_with("empirical: measured 0.3", Outcome::holds) == Approx(1. / 2));
  CHECK(share_with("empirical: measured 0.4", Outcome::not_applicable) == Approx(1. / 2));
  CHECK(share_with("empirical: measured 0.5", std::nullopt) == Approx(1. / 2));
  CHECK(share_with("empirical: measured 0.6", Outcome::inconclusive) == Approx(2. / 3));
  CHECK(share_with("empirical: measured 0.7", Outcome::fails) == Approx(3. / 4));
}

TEST_CASE("a bound that was measured says so first") {
  CHECK(has_empirical_bound(record_of("a.b", {0, 1, 0, "1", "empirical: measured 0.3"})));
  CHECK_FALSE(has_empirical_bound(record_of("a.b", {0, 1, 0, "1", "derived: not empirical"})));
}
