#include "scripts/program/bench/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/dynamics/conjugate_gradient.h"
#include "reference/scene/scene.h"
#include "scripts/program/bench/bench_load.h"
#include "scripts/program/bench/bench_parts.h"
#include "scripts/program/progress.h"

namespace foldproof {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

struct Speeds {
  // seconds of each, but counts first and last
  double particles, hinges, bending, springs, product, preparation, iteration, step, simulated,
      iterations;
};

Speeds measure(const Load& load) {
  const State& s = load.state;
  PerParticle3 f = PerParticle3::Zero(3, s.x.cols());
  Work work;
  const auto& springs = std::get<StretchSprings>(load.system.forces[1]);
  const auto& bending = std::get<Bending>(load.system.forces[2]);
  Speeds speeds{};
  speeds.particles = double(s.x.cols());
  speeds.hinges = double(bending.hinges.size());
  speeds.bending = least_seconds([&] { bending.add_elastic(s, bending.shapes_at(s.x), f); });
  speeds.springs = least_seconds([&] { springs.add_elastic(s, springs.shapes_at(s.x), f); });
  speeds.preparation = least_seconds([&] { damping_at(load.system.forces, s, work); });
  const DampingOperator damping = *damping_at(load.system.forces, s, work);
  speeds.product = least_seconds([&] { damping.add_product(s.v, f); });

  // one iteration: the difference between a solve cut after 12 and one cut after 2
  System system = load.system;
  system.solver.tolerance = 1e-300;
  const auto solve = [&](int iterations) {
    system.solver.max_iterations = iterations;
    PerParticle3 v = s.v;
    solve_velocity(system, damping, load.limit / 4, v, work);
  };
  speeds.iteration = (least_seconds([&] { solve(12); }) - least_seconds([&] { solve(2); })) / 10;

  const Integrator& scheme = integrator_named("C");
  Work counted;
  scheme.step(load.system, {&s, 1}, load.limit / 2, counted);
  speeds.iterations = double(counted.cg_iterations) / double(counted.solves);
  speeds.step = least_seconds([&] { scheme.step(load.system, {&s, 1}, load.limit / 2, work); });
  speeds.simulated = seconds_per_simulated_step(load.scene, load.limit / 2);
  return speeds;
}

std::vector<double> column(const std::vector<Speeds>& all, double Speeds::*member) {
  std::vector<double> values;
  for (const Speeds& speeds : all) values.push_back(speeds.*member);
  return values;
}

Figure growth_figure(const std::vector<Speeds>& all) {
  const std::vector<double> particles = column(all, &Speeds::particles);
  Figure figure{"seconds",
                "Time against particles",
                {"particles", "1", Scale::log},
                {"time", "s", Scale::log},
                1,
                "Least time of repeats on one thread; the slope triangle is linear growth. Where "
                "the data outgrow the caches, each particle costs more.",
                {}};
  figure.curves = {
      {"bending, elastic", particles, column(all, &Speeds::bending), not_a_number, {}},
      {"springs, elastic", particles, column(all, &Speeds::springs), not_a_number, {}},
      {"damping, terms", particles, column(all, &Speeds::preparation), not_a_number, {}},
      {"damping, product", particles, column(all, &Speeds::product), not_a_number, {}},
      {"CG iteration", particles, column(all, &Speeds::iteration), not_a_number, {}},
      {"step of scheme C", particles, column(all, &Speeds::step), not_a_number, {}},
      {"simulate, a step", particles, column(all, &Speeds::simulated), not_a_number, {}}};
  return figure;
}

Table growth_table(const std::vector<Speeds>& all) {
  Table table{"speeds",
              "What each part costs",
              {{"particles", "1"},
               {"hinges", "1"},
               {"bending, elastic", "ms"},
               {"springs, elastic", "ms"},
               {"damping, terms", "ms"},
               {"damping, product", "ms"},
               {"CG iteration", "ms"},
               {"step of scheme C", "ms"},
               {"simulate, a step", "ms"},
               {"CG iterations a solve", "1"}}};
  for (const Speeds& s : all)
    table.row(s.particles, s.hinges, 1e3 * s.bending, 1e3 * s.springs, 1e3 * s.preparation,
              1e3 * s.product, 1e3 * s.iteration, 1e3 * s.step, 1e3 * s.simulated, s.iterations);
  return table;
}

std::vector<Record> rates(const std::vector<Speeds>& all, double megabytes) {
  const Speeds& large =
      *std::find_if(all.begin(), all.end(), [](const Speeds& s) { return s.particles > 9e4; });
  const std::vector<double> particles = column(all, &Speeds::particles);
  std::vector<double> evaluations;
  for (const Speeds& s : all) evaluations.push_back(s.bending + s.springs);
  return {
      rate("bending-elastic",
           fmt::format("Elastic bending forces a second, {:.0f} hinges.", large.hinges),
           large.hinges / large.bending / 1e6,
           {29, "million hinges/s", "higher",
            "35 ns a hinge: four square roots, a few divisions and some 150 other operations, with "
            "twelve numbers gathered and twelve scattered"}),
      rate("step-C",
           fmt::format("One step of scheme C, {:.0f} particles, damping ratio 0.1, half the "
                       "elastic limit, CG to 1e-6 ({:.1f} iterations a solve).",
                       large.particles, large.iterations),
           large.step,
           {0.128, "s", "lower",
            "two solves of some ten passes over springs and hinges, at memory speed; ten seconds "
            "of animation in steps of 2 ms then take eleven minutes"}),
      rate("simulate-over-step",
           fmt::format("A step that `simulate` makes, over a step by itself, {:.0f} particles: "
                       "{:.1f} and {:.1f} ms.",
                       large.particles, 1e3 * large.simulated, 1e3 * large.step),
           large.simulated / large.step,
           {1.5, "1", "lower",
            "the automatic step's bound, the row of diagnostics, frames and checkpoints read the "
            "shapes and forces that a step has computed, and a step reuses those of the one "
            "before"}),
      rate("memory",
           fmt::format("Peak memory of the process with {:.0f} particles.", large.particles),
           megabytes,
           {500, "MB", "lower",
            "5 kB a particle: its state and that of a step under way, and the kept terms of its "
            "three springs and three hinges; a million particles then fit 5 GB"}),
      rate("growth-of-iteration",
           "Growth exponent of the time per CG iteration in the number of particles.",
           growth_exponent(particles, column(all, &Speeds::iteration)),
           {1.05, "1", "lower",
            "work is proportional to particles: 1; a twentieth is left for data that outgrow the "
            "caches"}),
      rate("growth-of-forces", "Growth exponent of the time per evaluation of the elastic forces.",
           growth_exponent(particles, evaluations),
           {1.05, "1", "lower",
            "work is proportional to particles: 1; a twentieth is left for data that outgrow the "
            "caches"}),
  };
}

}  // namespace

RunRecord bench(int most_particles) {
  std::vector<Speeds> all;
  double megabytes = 0;
  std::vector<Record> contact;
  std::vector<int> cells = {31, 99, 315, 999};  // 1k, 10k, 100k, 1M particles
  std::erase_if(cells, [&](int n) { return (n + 1) * (n + 1) > most_particles; });
  auto begin = [stage = 0, of = cells.size() + 4](const std::string& what) mutable {
    show_line(fmt::format("bench {} of {}: {}", ++stage, of, what));
  };
  forget_peak();
  const double seconds = seconds_of([&] {
    for (const int n : cells) {
      begin(fmt::format("{} particles", (n + 1) * (n + 1)));
      const Load load = make_load(n);
      all.push_back(measure(load));
      if (n == 315) {
        megabytes = resident_megabytes("VmHWM");
        contact.push_back(contact_rate(load.scene, load.limit / 2, all.back().step));
        contact.push_back(strain_rate(load.scene, load.limit / 2, all.back().step));
      }
    }
  });
  begin("threads");
  const std::vector<ThreadScaling> scalings = thread_scalings();
  begin("threads on level sets");
  std::vector<ThreadScaling> timed = scalings;
  for (ThreadScaling& scaling : level_set_scalings()) timed.push_back(std::move(scaling));
  RunRecord run;
  run.tier = "";
  run.subject = "foldproof reference";
  run.records = rates(all, megabytes);
  run.records.insert(run.records.end(), contact.begin(), contact.end());
  run.records.push_back(self_collision_rate());
  for (const ThreadScaling& scaling : scalings) run.records.push_back(serial_share(scaling));
  for (const ThreadScaling& scaling : timed)
    if (!scaling.on_two.empty()) run.records.push_back(on_two_threads(scaling));
  begin("growth");
  for (Record& record : growth_rates(most_particles)) run.records.push_back(std::move(record));
  begin("level sets");
  for (Record& record : level_set_rates()) run.records.push_back(std::move(record));
  for (Record& record : octree_rates()) run.records.push_back(std::move(record));
  run.records.push_back(crossing_rate());
  end_line();
  run.studies.push_back(
      {"bench",
       "How time and memory grow with the number of particles.",
       "measured",
       "A square sheet of alternating diagonals, gently waved, springs and hinges damped at a "
       "ratio of 0.1. Times are of a shared machine: compare them as ratios.",
       seconds,
       {growth_figure(all)},
       {},
       {growth_table(all), threads_table(timed), forecast_table(scalings)}});
  return run;
}

}  // namespace foldproof
