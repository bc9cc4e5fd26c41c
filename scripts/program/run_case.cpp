#include "scripts/program/run_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "scripts/program/progress.h"
#include "verification/trajectory_file.h"

namespace foldproof {

namespace {

std::string described(const Stop& stop) {
  const std::string who = stop.particle < 0 ? "" : fmt::format(", particle {}", stop.particle);
  return fmt::format("{} (step {}, after t = {:.9g} s{})", stop.reason, stop.step, stop.time, who);
}

/// Kinetic + elastic + gravitational energy - work of damping, over the run: its largest change over what was
/// exchanged.
struct EnergyBook {
  double start = NAN, exchanged = 0;
  Worst drift;

  void enter(const Diagnostics& row) {
    const double balance = row.energy.total() - row.damping_work;
    if (std::isnan(start)) {
      start = balance;
      first_ = row.energy;
    }
    drift.see(std::abs(balance - start));
    exchanged = std::max({exchanged, std::abs(row.energy.kinetic - first_.kinetic),
                          std::abs(row.energy.stretch - first_.stretch),
                          std::abs(row.energy.bending - first_.bending),
                          std::abs(row.energy.gravity - first_.gravity)});
  }

 private:
  Energies first_;
};

bool is_driven(const Scene& scene) {
  for (const PrescribedParticle& p : scene.led)
    if (p.motion.velocity.norm() > 0 || p.motion.amplitude.norm() > 0 || p.motion.angular_velocity.norm() > 0)
      return true;
  return false;
}

Record finding(const std::string& name, const std::string& claim, Verdict verdict, const std::string& note) {
  Record record{name, "check", "", claim, "", {std::move(verdict), {}, note}, "", "", 0, {}};
  record.outcome = name_of(ruling(record.finding.verdict));
  return record;
}

std::vector<Record> judged(const Scene& scene, const CaseRecord& record, const EnergyBook& book) {
  std::vector<Record> findings;
  findings.push_back(
      finding("case." + scene.name + ".runs-to-its-end", "The run reaches its end with finite values.",
              {record.stopped.empty() ? 0.0 : 1.0, 0, 0, "stops", "a shipped case must not stop early"},
              record.stopped));
  const bool is_conservative = !scene.bending || scene.bending->weighting == Weighting::rest;
  if (!is_driven(scene) && is_conservative && record.stopped.empty())
    findings.push_back(finding("case." + scene.name + ".energy-is-accounted-for",
                               "Kinetic, elastic and gravitational energy less the work of damping stays "
                               "what it was, over the energy exchanged.",
                               {book.drift.value() / book.exchanged, 0.01, 0, "1",
                                "schemes of second order at half the elastic limit: an oscillation of (omega "
                                "h)^2/8 in energy where the stiffest modes "
                                "carry a small part of it; one percent leaves no room for a force that is "
                                "not the gradient of its energy"},
                               ""));
  return findings;
}

}  // namespace

CaseRun run_case(const Scene& scene, const std::string& folder, const Provenance& provenance) {
  const System system = build_system(scene);
  const std::string file = scene.name + ".h5";
  TrajectoryFile trajectory((std::filesystem::path(folder) / file).string(), scene, system, provenance);
  ProgressLine progress("simulate " + scene.name);
  EnergyBook book;

  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const Observer observer{[&](const State& s) { trajectory.add_frame(s); },
                          [&](const Diagnostics& row) {
                            trajectory.add_diagnostics(row);
                            book.enter(row);
                            progress.show(row.time / scene.schedule.end);
                          }};
  CaseRun run;
  run.outcome =
      simulate(system, integrator_named(scene.integrator), start_state(scene), scene.schedule, observer);
  run.record = {scene.name,  file,      scene.title,
                scene.about, elapsed(), run.outcome.stop ? described(*run.outcome.stop) : ""};
  trajectory.finish(run.record.stopped, run.record.seconds);
  run.findings = judged(scene, run.record, book);
  return run;
}

std::vector<std::string> built_in_cases() {
  return {"hinge", "hanging_sheet", "flag_drop", "rest_fold", "stiff_statue"};
}

}  // namespace foldproof
