// Quantities of a whole run: the summary of its diagnostics, and the table of all quantities.
#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"
#include "verification/cases/quantities.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

Approx exactly(double value) { return Approx(value).epsilon(1e-10).margin(1e-13); }

/// Rows at uneven times until t = 2 s, with random numbers.
std::vector<Diagnostics> random_rows(unsigned seed) {
  std::mt19937 bits(seed);
  std::uniform_real_distribution<double> within(-3, 5);
  std::vector<Diagnostics> rows;
  for (const double t : {0.0, 0.11, 0.2, 0.29, 0.7, 1.3, 1.7, 1.8, 1.93, 2.0}) {
    Diagnostics row;
    row.time = t, row.step = 0.01 + 0.003 * double(rows.size() + 1);
    for (const auto term : energy_terms) row.energy.*term = within(bits);
    row.energy.kinetic = std::abs(row.energy.kinetic);
    row.damping_work = within(bits);
    row.linear_momentum = Vector3(within(bits), within(bits), within(bits));
    row.angular_momentum = Vector3(within(bits), within(bits), within(bits));
    row.work.object_contacts = long(10 + 3 * within(bits));
    rows.push_back(row);
  }
  return rows;
}

double balance_of(const Diagnostics& row) {
  const Energies& e = row.energy;
  return e.kinetic + e.stretch + e.bending + e.gravity + e.custom + e.sticking - row.damping_work;
}

}  // namespace

TEST_CASE("quantities of a run: energies, momenta, contacts and steps from its diagnostics") {
  for (unsigned seed = 1; seed < 9; ++seed) {
    const std::vector<Diagnostics> rows = random_rows(seed);
    DiagnosticsSummary summary;
    for (const Diagnostics& row : rows) summary.record(row, 2);
    double balance = 0, exchange = 0, kinetic = 0, linear = 0, angular = 0;
    long contacts = 0;
    for (const Diagnostics& row : rows) {
      balance = std::max(balance, std::abs(balance_of(row) - balance_of(rows[0])));
      for (const auto term :
           {&Energies::kinetic, &Energies::stretch, &Energies::bending, &Energies::gravity})
        exchange = std::max(exchange, std::abs(row.energy.*term - rows[0].energy.*term));
      kinetic = std::max(kinetic, row.energy.kinetic);
      linear = std::max(linear, (row.linear_momentum - rows[0].linear_momentum).norm());
      angular = std::max(angular, (row.angular_momentum - rows[0].angular_momentum).norm());
      contacts = std::max(contacts, row.work.object_contacts);
    }
    double early = 0, early_time = 0, late = 0, late_time = 0;
    for (const std::size_t k : {0u, 1u, 2u})  // until 0.2 s
      early += rows[k].step * balance_of(rows[k]), early_time += rows[k].step;
    for (const std::size_t k : {7u, 8u, 9u})  // from 1.8 s on
      late += rows[k].step * balance_of(rows[k]), late_time += rows[k].step;

    Scene scene = scene_at_rest(make_sheet({SheetPattern::union_jack, 0.5, 0.3, 4, 3}), 0.23);
    scene.x.colwise() += Vector3(0.3, -0.9, 0.4);
    RunResult result;
    result.last = start_state(scene);
    result.last.x *= seed % 2 ? 1.3 : 0.6;  // farther from the origin at the end, or at the start
    result.steps = 37, result.work.unfinished_solves = 5;
    if (seed == 3) result.stop = Stop{"it stops", 1.9, 4, 2};
    double reach = 0;
    for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
      reach = std::max({reach, scene.x.col(i).norm(), result.last.x.col(i).norm()});
    const double momentum = std::sqrt(2 * 0.23 * 0.5 * 0.3 * kinetic);
    const Repetition repetition(scene, computing_provider());
    const RunView run{scene, summary, result, repetition};
    const auto value = [&](const char* key) { return find_quantity(key)->of_run(run); };
    CHECK(value("energy_is_accounted_for") == exactly(balance / exchange));
    CHECK(value("energy_does_not_drift") ==
          exactly(std::abs(late / late_time - early / early_time) / exchange));
    CHECK(value("linear_momentum_is_conserved") == exactly(linear / momentum));
    CHECK(value("angular_momentum_is_conserved") == exactly(angular / (reach * momentum)));
    CHECK(value("comes_to_rest") == exactly(rows.back().energy.kinetic / kinetic));
    CHECK(value("makes_contact") == double(contacts));
    CHECK(value("takes_steps") == 37);
    CHECK(value("solves_converge") == 5);
    CHECK(value("runs_to_its_end") == (seed == 3 ? 1 : 0));
  }
}

TEST_CASE("quantities of a run: an exchange of each form of energy counts") {
  for (const auto term :
       {&Energies::kinetic, &Energies::stretch, &Energies::bending, &Energies::gravity}) {
    DiagnosticsSummary summary;
    Diagnostics row;
    row.linear_momentum = row.angular_momentum = Vector3::Zero();
    row.energy.*term = 3;
    summary.record(row, 1);
    row.energy.*term = 5.5;
    summary.record(row, 1);
    row.energy.*term = 1;
    summary.record(row, 1);
    CHECK(summary.largest_exchange == 2.5);
    CHECK(summary.balance.value() == 2.5);
  }
}

TEST_CASE("quantities: each has its unit, its side, its scope and the way it is measured") {
  // unit; < at most, > at least; * any cloth, - this shape; r of the run, f frame, o objects
  const std::map<std::string, std::string> table = {{"runs_to_its_end", "stops <*r"},
                                                    {"is_reproducible", "steps <*r"},
                                                    {"takes_steps", "steps >-r"},
                                                    {"solves_converge", "solves <*r"},
                                                    {"energy_is_accounted_for", "1 <*r"},
                                                    {"energy_does_not_drift", "1 <*r"},
                                                    {"linear_momentum_is_conserved", "1 <*r"},
                                                    {"angular_momentum_is_conserved", "1 <*r"},
                                                    {"stays_flat", "m <-f"},
                                                    {"leaves_its_plane", "m >-f"},
                                                    {"keeps_its_angles", "degrees <-f"},
                                                    {"folds_to", "degrees >-f"},
                                                    {"folds_back_to", "degrees >-f"},
                                                    {"keeps_its_lengths", "1 <-f"},
                                                    {"stays_outside", "m <*o"},
                                                    {"lies_inside", "m >-r"},
                                                    {"makes_contact", "points >-r"},
                                                    {"is_pinched", "particles >-o"},
                                                    {"stays_between", "m <*o"},
                                                    {"never_crosses_itself", "pairs <*f"},
                                                    {"tangle_does_not_grow", "pairs <-f"},
                                                    {"ends_untangled", "pairs <*r"},
                                                    {"keeps_its_place", "m <-f"},
                                                    {"is_carried", "m >-f"},
                                                    {"is_carried_aside", "m >-f"},
                                                    {"speed_is_limited", "m/s <-f"},
                                                    {"reaches_turning_rate", "degrees/s >-f"},
                                                    {"comes_to_rest", "1 <-r"},
                                                    {"faces_outside", "m <-o"},
                                                    {"sticks", "particles >-f"},
                                                    {"lets_go", "particles <-r"},
                                                    {"keeps_hold", "m <*f"},
                                                    {"is_lifted", "m >-f"},
                                                    {"stays_within_strain_limits", "1 <*f"},
                                                    {"stretches_to", "1 >-f"},
                                                    {"lengthens_by", "1 >-f"},
                                                    {"keeps_its_area", "1 <-f"},
                                                    {"keeps_its_height", "1 >-r"},
                                                    {"collapses_to", "1 <-r"},
                                                    {"keeps_most_angles", "degrees <-r"},
                                                    {"crumples_by", "degrees >-r"},
                                                    {"forms_creases", "1 >-r"},
                                                    {"wrinkles_stay_short", "m <-r"}};
  CHECK(quantities().size() == table.size());
  for (const Quantity& row : quantities()) {
    INFO(row.key);
    REQUIRE(table.contains(row.key));
    const std::string as_read =
        std::string(row.unit) + (row.sense == Sense::at_most ? " <" : " >") +
        (row.scope == Scope::any_cloth ? "*" : "-") + (row.of_run ? "r" : "") +
        (row.of_frame ? "f" : "") + (row.of_objects ? "o" : "");
    CHECK(as_read == table.at(row.key));
    CHECK(find_quantity(row.key) == &row);
    CHECK(std::string(row.claim).back() == '.');
  }
  CHECK(find_quantity("sticksy") == nullptr);
}

TEST_CASE("quantities: a scene without what they need says so") {
  const TriangleMesh mesh = make_sheet({SheetPattern::union_jack, 0.5, 0.3, 4, 3});
  Scene bare = scene_at_rest(mesh, 0.23), whole = bare;
  whole.gravity = Vector3(0, -3, 0);
  whole.bending = BendingMaterial{};
  whole.stretch = StretchMaterial{};
  whole.strain_limits = StrainLimits{};
  whole.objects.emplace_back();
  whole.sticky.emplace_back();
  int refused = 0;
  for (const Quantity& row : quantities()) {
    INFO(row.key);
    if (!row.rejection) continue;
    CHECK(row.rejection(whole) == "");
    if (row.key == std::string("stays_flat") || row.key == std::string("leaves_its_plane"))
      continue;
    CHECK_THAT(row.rejection(bare), Contains("the case has no ["));
    ++refused;
  }
  CHECK(refused == 23);
  Scene weightless = whole;
  weightless.gravity = Vector3::Zero();
  CHECK(find_quantity("is_lifted")->rejection(weightless) == "the case has no [gravity]");
  CHECK(find_quantity("sticks")->rejection(bare) == "the case has no [[sticky]]");
  CHECK(find_quantity("faces_outside")->rejection(bare) == "the case has no [[object]]");
  CHECK(find_quantity("stays_outside")->rejection(bare) == "the case has no [[object]]");
  CHECK(find_quantity("folds_to")->rejection(bare) == "the case has no [bending]");
  CHECK(find_quantity("stretches_to")->rejection(bare) == "the case has no [stretch]");
  CHECK(find_quantity("stays_within_strain_limits")->rejection(bare) ==
        "the case has no [strain_limits]");
}

TEST_CASE("quantities: a plane is one to a hundredth of the cloth's longest extent") {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::union_jack, 0.5, 0.3, 4, 3}), 0.23);
  const Quantity& flat = *find_quantity("stays_flat");
  scene.x(2, 7) = 0.00499;
  CHECK(flat.rejection(scene) == "");
  scene.x(2, 7) = -0.00501;
  CHECK(flat.rejection(scene) == "the cloth does not start in a plane of constant z");
}
