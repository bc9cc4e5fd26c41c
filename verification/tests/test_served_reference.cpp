// The reference over the pipe: the same bits as in this process, little time lost, no false alarm.
#include <catch2/catch.hpp>

#include <filesystem>
#include <fmt/format.h>
#include <set>

#include "reference/dynamics/integrator.h"
#include "verification/checks.h"
#include "verification/subjects/reference_subject.h"
#include "verification/subjects/served/piped_subject.h"
#include "verification/subjects/served/reference_server.h"
#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

/// This program, as a server: so that seeded faults are at both ends of the pipe.
SolverCommand serve(const std::string& integrator = "C", const std::string& precision = "f8") {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  return {fmt::format("SERVED={} PRECISION={} exec '{}' 'serves the reference'", integrator,
                      precision, self),
          {},
          {}};
}

std::vector<Record> served_records(const SolverCommand& command,
                                   const std::function<bool(const std::string&)>& is_in) {
  std::vector<Law> laws = portable_laws();
  std::erase_if(laws, [&](const Law& law) { return !is_in(law.name); });
  return judge_solver(command, laws, [](const Record&) {}).records;
}

/// Every number and text of the evidence, and the verdict, in hexadecimal: all bits.
std::string bits_of(const Record& record) {
  const Verdict& verdict = record.finding.verdict;
  std::string all =
      fmt::format("{} {:a} {:a}", outcome_text(record), verdict.measured, verdict.bound);
  for (const Column& column : record.finding.evidence.columns())
    if (const auto* numbers = std::get_if<std::vector<double>>(&column.values))
      for (const double value : *numbers) all += fmt::format(" {:a}", value);
    else
      for (const std::string& text : std::get<1>(column.values)) all += " " + text;
  return all;
}

/// It expects the reference's own exceptions, which cross the pipe as words.
constexpr const char* throws_on_purpose = "bending.degenerate-triangles-are-reported";

/// Groups without any check that asks a subject: left out, for they take most of the time.
bool asks_no_subject(const Check& check) {
  for (const char* group : {"content.", "deforming.", "level-set.", "mesh.", "nearness.", "octree.",
                            "oracle.", "projection.", "scene.", "subdivision."})
    if (check.name.starts_with(group)) return true;
  return false;
}

/// A scene with everything that the protocol can say.
Scene damped_bent_sheet(const std::string& integrator) {
  const PortableScene sheet = suite::moving_sheet();
  Scene scene = scene_at_rest(sheet.mesh, 0.23);
  scene.x = sheet.x, scene.v = sheet.v;
  scene.gravity = Vector3(0.3, -0.7, -9.7);
  scene.stretch = StretchMaterial{5.3, 0.011, 0.97};
  scene.bending = BendingMaterial{3e-4, 2e-6, Weighting::rest, DampingFactor::edge, "cubic"};
  scene.rest_angles.assign(sheet.mesh.hinges.size(), 0.13);
  Motion swing;
  swing.amplitude = {0.01, 0.02, 0.03}, swing.frequency = 3.7, swing.until = 0.011;
  scene.prescribed = {{5, scene.x.col(5), swing}, {17, scene.x.col(17), Motion{}}};
  scene.integrator = integrator;
  return scene;
}

/// Positions, velocities, forces, energy and iterations after some steps of the scene.
std::vector<double> answers_of(const Subject& subject, const Scene& scene) {
  const auto prepared = subject.prepare(scene);
  std::vector<State> past{start_state(scene)};
  Work work;
  for (int n = 0; n < 7; ++n) {
    past.push_back(subject.step(*prepared, past, 0.0017, work));
    if (past.size() > 2) past.erase(past.begin());
  }
  const State& end = past.back();
  std::vector<double> all{subject.potential_energy(*prepared, end), double(work.cg_iterations)};
  for (const PerParticle3& part : {end.x, end.v, subject.elastic_forces(*prepared, end),
                                   subject.damping_forces(*prepared, end, 1.3 * end.v)})
    all.insert(all.end(), part.data(), part.data() + part.size());
  return all;
}

}  // namespace

TEST_CASE("serves the reference", "[.]") {  // started by the others
  REQUIRE(std::getenv("SERVED"));
  serve_reference({std::getenv("SERVED"), std::getenv("PRECISION") == std::string("f4")});
}

TEST_CASE("served reference: forces of contact balance the momentum in every integrator") {
  for (const Integrator& integrator : integrators()) {
    INFO(integrator.name);
    const auto is_balance = [](const std::string& law) {
      return law == "contact-forces.balance-the-momentum";
    };
    const auto records = served_records(serve(std::string(integrator.name)), is_balance);
    CHECK(records.at(0).outcome == Outcome::holds);
  }
}

TEST_CASE("served reference: every integrator gives the same bits over the pipe") {
  const Subject here = reference_subject(), there = piped_reference(serve());
  for (const Integrator& integrator : integrators()) {
    INFO(integrator.name);
    const Scene scene = damped_bent_sheet(std::string(integrator.name));
    CHECK(answers_of(here, scene) == answers_of(there, scene));
  }
}

TEST_CASE(
    "served reference: every check that asks for steps, forces or energy gives the same bits") {
  long scenes = 0;
  const Subject here = reference_subject();
  Subject there = piped_reference(serve());
  there.prepare = [prepare = there.prepare, &scenes](const Scene& scene) {
    ++scenes;
    return prepare(scene);
  };
  int compared = 0;
  for (const Check& check : all_checks()) {
    if (asks_no_subject(check) || check.name == throws_on_purpose) continue;
    const long before = scenes;
    const Record over_pipe = run_check(check, there);
    if (scenes == before || over_pipe.outcome == Outcome::not_applicable) continue;
    ++compared;
    INFO(check.name << ": " << over_pipe.finding.note);
    CHECK(bits_of(over_pipe) == bits_of(run_check(check, here)));
  }
  CHECK(compared >= 60);
}

/// Every law holds for the reference behind the pipe, but those that need digits or short steps.
void require_no_alarm(const std::string& integrator, const std::string& precision) {
  for (const Record& record :
       served_records(serve(integrator, precision), [](const std::string&) { return true; })) {
    INFO(integrator << " " << precision << " " << record.name << " " << record.finding.note);
    const bool needs_digits =
        precision == "f4" && (record.name == "precision.results-need-the-declared-digits" ||
                              record.name == "together.each-part-acts-as-it-does-alone" ||
                              (record.name.starts_with("order.") && integrator == "RK4"));
    const bool needs_short_steps =
        ((record.name.starts_with("game-step.") ||
          record.name == "repeat.stiff-scene-after-a-soft-one") &&
         integrator != "backward-euler" && integrator != "implicit-midpoint") ||
        (record.name == "damping.long-steps-damp-as-short-ones" && integrator == "RK4");
    CHECK(record.outcome ==
          (needs_digits || needs_short_steps ? Outcome::not_applicable : Outcome::holds));
  }
}

TEST_CASE("served reference: scheme A raises no alarm in f4", "[long][alarm]") {
  require_no_alarm("A", "f4");
}

TEST_CASE("served reference: no law raises an alarm, in f8 and f4", "[long]") {
  for (const std::string integrator : {"A", "C", "RK4", "backward-euler", "implicit-midpoint"})
    for (const std::string precision : {"f8", "f4"}) require_no_alarm(integrator, precision);
}

TEST_CASE("served reference: laws that it meets exactly leave it roundings, not their bounds") {
  const std::set<std::string> exact{"smoke.free-fall-within-5-percent",
                                    "gravity.speed-grows-by-g-t",
                                    "gravity.fall-is-as-exact-as-the-order-claims",
                                    "momentum.linear-is-conserved",
                                    "momentum.linear-under-damping-is-conserved",
                                    "vibration.undamped-goes-on",
                                    "vibration.damped-decays-as-its-damping-says",
                                    "forces.are-minus-the-energy-gradient",
                                    "contact.sheet-rests-on-a-plane",
                                    "contact.resting-sheet-is-still",
                                    "contact.slides-as-coulomb-says",
                                    "contact.fall-gains-no-energy",
                                    "box.fall-gains-no-energy",
                                    "ball.fall-gains-no-energy",
                                    "capsule.fall-gains-no-energy",
                                    "capstan.strip-lies-on-the-capsule"};
  const auto records =
      served_records(serve(), [&](const auto& name) { return exact.contains(name); });
  CHECK(records.size() == exact.size());
  for (const Record& record : records) {
    INFO(record.name);
    CHECK(record.finding.verdict.measured <= 1e-3 * record.finding.verdict.bound);
  }
}

TEST_CASE("served reference: schemes that need shorter steps get them for the heavy strip") {
  for (const char* integrator : {"forward-euler", "RK2"})
    for (const Record& record : served_records(serve(integrator), [](const std::string& name) {
           return name.starts_with("cantilever.");
         })) {
      INFO(integrator << " " << record.name << " " << record.finding.note);
      CHECK(record.outcome == Outcome::holds);
    }
}

TEST_CASE("served reference: masses of the scene replace those of the density") {
  const PortableScene plain = suite::moving_sheet(), own = suite::moving_sheet_of_unequal_masses();
  PipedSolver solver(serve());
  solver.prepare(plain);
  const Snapshot first = solver.advance(plain.dt, 5);
  solver.prepare(own);
  CHECK((solver.advance(own.dt, 5).x - first.x).cwiseAbs().maxCoeff() > 1e-6);
}

}  // namespace foldproof
