// How much of a step, and of the making of level sets, several threads share, and how
// far that leads.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <array>
#include <memory>
#include <thread>

#include <fmt/format.h>

#include "reference/fast/kept_values.h"
#include "reference/dynamics/integrator.h"
#include "scripts/program/bench/bench_load.h"
#include "scripts/program/bench/bench_parts.h"

namespace foldproof {

namespace {

constexpr int rounds = 7;

/// 1, 2, 4, ... and the number of cores.
std::vector<int> thread_counts() {
  const int cores = std::max(2, int(std::thread::hardware_concurrency()));
  std::vector<int> counts;
  for (int n = 1; n < cores; n *= 2) counts.push_back(n);
  counts.push_back(cores);
  return counts;
}

/// Amdahl's law, t_n = t_1 (s + (1 - s)/n), fitted by least squares of t_n/t_1:
/// t_n/t_1 - 1/n = s (1 - 1/n).
double fitted_share(const std::vector<int>& threads, const std::vector<double>& seconds) {
  double xy = 0, xx = 0;
  for (size_t k = 1; k < threads.size(); ++k) {
    const double x = 1 - 1.0 / threads[k];
    xy += x * (seconds[k] / seconds[0] - 1.0 / threads[k]);
    xx += x * x;
  }
  return xy / xx;
}

double speed_up(double share, int threads) { return 1 / (share + (1 - share) / threads); }

/// Steps of scheme C.
void measure_steps(const System& system, const State& start, double h, ThreadScaling& scaling) {
  const Integrator& scheme = integrator_named("C");
  measure_on_threads(
      [&](int threads) -> std::function<void()> {
        const auto shared = std::make_shared<System>(system);
        set_team(*shared, threads);
        Work work;
        work.kept = std::make_shared<KeptValues>();
        State begun = start;
        begin_step(*shared, begun, work);
        return [&, shared, begun, work]() mutable { scheme.step(*shared, {&begun, 1}, h, work); };
      },
      scaling);
}

}  // namespace

void measure_on_threads(const std::function<std::function<void()>(int threads)>& run_on,
                        ThreadScaling& scaling) {
  scaling.threads = thread_counts();
  scaling.seconds.assign(scaling.threads.size(), INFINITY);
  std::vector<double> shares;
  std::vector<double> clock(scaling.threads.size(), 0), processor = clock;  // s
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> seconds;
    for (size_t k = 0; k < scaling.threads.size(); ++k) {
      const std::function<void()> run = run_on(scaling.threads[k]);
      const std::clock_t before = std::clock();
      clock[k] += seconds_of([&] { seconds.push_back(least_seconds(run)); });
      processor[k] += double(std::clock() - before) / CLOCKS_PER_SEC;
    }
    for (size_t k = 0; k < seconds.size(); ++k)
      scaling.seconds[k] = std::min(scaling.seconds[k], seconds[k]);
    shares.push_back(fitted_share(scaling.threads, seconds));
  }
  for (size_t k = 0; k < clock.size(); ++k) scaling.cores.push_back(processor[k] / clock[k]);
  std::ranges::sort(shares);
  scaling.share = shares[rounds / 2];
  scaling.uncertainty = (shares[rounds - 2] - shares[1]) / 2;
}

std::vector<ThreadScaling> thread_scalings() {
  const Load load = make_load(315);
  ThreadScaling sheet{
      .name = "serial-share-of-a-step",
      .scene = fmt::format("sheet, {} particles", load.scene.x.cols()),
      .target = 0.07,
      .why_target = "16 cores then make a step 8 times as fast",
      .on_two = "step-C-on-two-threads",
      .target_on_two = {
          0.07, "s", "lower",
          "half of a step on one thread, and a tenth for borders and for sums in order"}};
  measure_steps(load.system, load.state, load.limit / 2, sheet);

  const Scene layers = stacked_sheets(35);
  const System system = build_system(layers);
  ThreadScaling stack{
      .name = "serial-share-with-self-collision",
      .scene = fmt::format("eight layers in contact, {} particles", layers.x.cols()),
      .target = 0.15,
      .why_target =
          "impulses between layers are given one after the other; the search for pairs and the "
          "queries of all are not",
      .on_two = "self-collision-step-on-two-threads",
      .target_on_two = {0.07, "s", "lower",
                        "half of what one thread is to take, and a tenth for impulses in order"}};
  const State start = start_state(layers);
  measure_steps(system, start, 0.5 * elastic_limit(system, start), stack);
  return {sheet, stack};
}

Record serial_share(const ThreadScaling& scaling) {
  Record record = rate(scaling.name,
                       fmt::format("Share of a step of scheme C that threads do not speed up, by "
                                   "Amdahl's law: {}; {:.1f} ms on one thread, {:.1f} ms on {}.",
                                   scaling.scene, 1e3 * scaling.seconds.front(),
                                   1e3 * scaling.seconds.back(), scaling.threads.back()),
                       scaling.share, {scaling.target, "1", "lower", scaling.why_target});
  record.finding.verdict.uncertainty = scaling.uncertainty;
  record.finding.note = fmt::format(
      "1 to {} threads, {} rounds, median and middle range; means something where all cores were "
      "in use: {:.1f}",
      scaling.threads.back(), rounds, scaling.cores.back());
  return record;
}

Record on_two_threads(const ThreadScaling& scaling) {
  Record record = rate(scaling.on_two, scaling.scene + ", on two threads.", scaling.seconds[1],
                       scaling.target_on_two);
  record.finding.note = fmt::format("two threads, the least of {} rounds; {:.2f} cores in use",
                                    rounds, scaling.cores[1]);
  return record;
}

Table threads_table(const std::vector<ThreadScaling>& scalings) {
  Table table{
      "threads",
      "A step of scheme C, or a level set, on several threads",
      {{"of", ""}, {"threads", "1"}, {"cores in use", "1"}, {"time", "ms"}, {"speed-up", "1"}}};
  for (const ThreadScaling& of : scalings)
    for (size_t k = 0; k < of.threads.size(); ++k)
      table.row(of.scene, of.threads[k], of.cores[k], 1e3 * of.seconds[k],
                of.seconds[0] / of.seconds[k]);
  return table;
}

/// Share of the sheet's hinges that this number of threads computes once more, at borders.
double computed_twice(int threads) {
  const TriangleMesh mesh = make_load(315).scene.mesh;
  std::vector<std::array<int, 4>> corners;
  for (const Hinge& hinge : mesh.hinges) corners.push_back(hinge.particles);
  const Division division = divide(threads, mesh.particles(), corners);
  double visits = 0;
  for (const OwnedParticles& owned : division->owners)
    for (const ElementRun& run : owned.runs) visits += double(run.end - run.first);
  return visits / double(corners.size()) - 1;
}

/// Amdahl's law leaves out what cores share, above all the memory's bandwidth.
Table forecast_table(const std::vector<ThreadScaling>& scalings) {
  Table table{"forecast",
              "Serial share, and the speed-up that Amdahl's law forecasts; elements computed twice "
              "and memory shared by all cores allow less",
              {{"scene", ""},
               {"serial share", "1"},
               {"uncertainty", "1"},
               {"cores", "1"},
               {"hinges of the sheet computed twice", "1"},
               {"speed-up", "1"},
               {"at least", "1"},
               {"at most", "1"}}};
  for (const ThreadScaling& of : scalings)
    for (const int cores : {16, 64})
      table.row(of.scene, of.share, of.uncertainty, cores, computed_twice(cores),
                speed_up(of.share, cores),
                speed_up(std::min(1.0, of.share + of.uncertainty), cores),
                speed_up(std::max(0.0, of.share - of.uncertainty), cores));
  return table;
}

}  // namespace foldproof
