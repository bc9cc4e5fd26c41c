// What a run keeps from step to step: the same bits as computed anew, and computed once.
#include <cmath>

#include "reference/fast/kept_values.h"
#include "verification/checks/dynamics/dynamics_checks.h"
#include "verification/evidence.h"
#include "verification/specimens/followed_runs.h"
#include "verification/specimens/sticking_scenes.h"

namespace foldproof {

namespace {

/// All numbers of the forces at a state.
Numbers numbers_at(const System& system, const State& s, Work work) {
  const Forces forces = forces_at(system.forces, s, work);
  PerParticle3 damping = PerParticle3::Zero(3, s.x.cols());
  forces.damping->add_product(s.v, damping);
  Numbers numbers = {elastic_limit(system, s, work)};
  for (const auto term : energy_terms) numbers.push_back(energies(system, s, work).*term);
  for (const PerParticle3& f : {*forces.elastic, damping})
    numbers.insert(numbers.end(), f.data(), f.data() + f.size());
  return numbers;
}

/// A state and others that differ from it in one thing on which forces depend.
std::vector<std::pair<std::string, State>> neighbours_of(const State& s) {
  State moved = s, later = s, freed = s, faster = s;
  moved.x(1, s.x.cols() - 1) = std::nextafter(moved.x(1, s.x.cols() - 1), 1e9);
  later.time += 0.003;
  freed.bonds.pop_back();
  faster.v *= 1.7;
  return {{"the same", s},
          {"a coordinate by a rounding", moved},
          {"the time", later},
          {"a bond less", freed},
          {"the velocity", faster}};
}

/// A force that depends on the velocity, as an experiment may.
CustomForce experiment() {
  CustomForce force;
  force.elastic = [](const State& s, PerParticle3& f) { f -= 0.3 * s.v; };
  force.potential = [](const State& s) { return 0.3 * s.v.squaredNorm(); };
  return force;
}

/// Forces at neighbouring states, one after the other, by a run that keeps values.
void see_neighbours(bool has_custom, Table& measured) {
  StuckSpecimen specimen = stuck_to_turning_surface();
  specimen.scene.stretch = StretchMaterial{3.7, 0.6, 1};
  System system = build_system(specimen.scene);
  if (has_custom) system.forces.push_back(experiment());
  const State& start = specimen.state;
  for (const auto& [what, next] : neighbours_of(start)) {
    Work work;
    work.kept = std::make_shared<KeptValues>();
    numbers_at(system, start, work);
    measured.row(what + (has_custom ? ", with a custom force" : ""), start.bonds.size(),
                 start.bonds.empty() ? NAN
                                     : bits_that_differ(numbers_at(system, next, work),
                                                        numbers_at(system, next, {})));
  }
}

thread_local const Integrator* forgetful_of = nullptr;

/// The step of `forgetful_of` in a run that keeps nothing.
State forgetful_step(const System& system, std::span<const State> past, double h, Work& work) {
  Work forgetting = work;
  forgetting.kept = nullptr;
  State next = forgetful_of->step(system, past, h, forgetting);
  forgetting.kept = work.kept;
  work = forgetting;
  return next;
}

Numbers numbers_of(const NamedRun& of, bool forgets) {
  Integrator integrator = integrator_named(of.integrator);
  forgetful_of = &integrator_named(of.integrator);
  if (forgets) integrator.step = forgetful_step;
  Followed run;
  run.result = simulate(build_system(of.scene), integrator, start_state(of.scene),
                        of.scene.schedule, follower(run));
  if (run.result.stop.has_value() != of.stops || run.frames.empty()) return {};
  return numbers_after(run, 0, 0, 0);
}

Finding reuse_finding(const Subject&) {
  Table measured{{"case", ""}, {"numbers or bonds", "1"}, {"numbers that differ", "1"}};
  see_neighbours(false, measured);
  see_neighbours(true, measured);
  for (const NamedRun& run : runs_of_all_parts()) {
    const Numbers kept = numbers_of(run, false);
    measured.row("run: " + run.name + ", " + run.integrator, kept.size(),
                 kept.empty() ? NAN : bits_that_differ(kept, numbers_of(run, true)));
  }
  return judge_worst(
      measured, 0, "a value is used again only for the same position, time and bonds, to the bit");
}

/// Steps by hand: how often forces are computed, over one each step and the start.
Finding once_finding(const Subject&) {
  Table measured{{"scheme", ""}, {"of", ""}, {"asked", "1"}, {"computed", "1"}, {"too many", "1"}};
  constexpr int steps = 7;
  for (const NamedRun& run : runs_of_all_parts()) {
    const Integrator& integrator = integrator_named(run.integrator);
    if (run.name != "led" || integrator.family != Family::mixed) continue;
    const System system = build_system(run.scene);
    State s = start_state(run.scene);
    Work work;
    work.kept = std::make_shared<KeptValues>();
    for (int n = 0; n < steps; ++n) {
      const double h = 0.5 * elastic_limit(system, s, work);
      s = integrator.step(system, {&s, 1}, h, work);
      energies(system, s, work);
    }
    const ForceCounts computed = computed_in_run(system.forces, work);
    const auto see = [&](const std::string& of, long asked, long count) {
      measured.row(run.integrator, of, asked, count,
                   asked == 2 * steps ? double(count - steps - 1) : NAN);
    };
    see("shapes", work.elastic_evaluations, computed.shapes);
    see("elastic forces", work.elastic_evaluations, computed.elastic);
    see("damping", work.damping_preparations, computed.damping);
  }
  return judge_worst(
      measured, 0,
      "a step begins where the one before ended, and limit and energies need the same shapes");
}

}  // namespace

std::vector<Check> reuse_checks() {
  return {{"dynamics.reuse-changes-no-bit",
           "A run that keeps forces and shapes for its next step has the bits of one that computes "
           "them anew.",
           "good practice", reuse_finding},
          {"dynamics.each-position-is-evaluated-once",
           "Schemes A, B and C compute shapes, elastic forces and damping once for each position.",
           "good practice", once_finding}};
}

}  // namespace foldproof
