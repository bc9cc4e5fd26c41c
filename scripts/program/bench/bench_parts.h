// Parts shared by all benches: times, targets, records.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "reference/scene/scene.h"
#include "verification/verdict.h"

namespace foldproof {

double seconds_of(const std::function<void()>& run);

/// The least time of enough repeats to fill a fifth of a second, at least three [s].
double least_seconds(const std::function<void()>& run);

/// "VmHWM" (largest resident memory since forgotten) or "VmRSS" (now) of this process [MB]; NaN
/// where the system does not say.
double resident_megabytes(const std::string& what);

/// Gives free memory back and forgets the peak, so that what follows is not hidden in what
/// was used before.
void forget_peak();

struct Target {
  double value = 0;
  std::string unit, better;  // "higher" or "lower"
  std::string why;
};

/// A measured number beside its target.
Record rate(const std::string& name, const std::string& claim, double measured,
            const Target& target);

/// bench_contact.cpp: a scene's particles on an object, against a step of its own [s] that
/// takes step_seconds.
Record contact_rate(const Scene& scene, double step, double step_seconds);

/// bench_strain.cpp: a sweep of strain limits over the scene's springs, likewise.
Record strain_rate(const Scene& scene, double step, double step_seconds);

/// bench_simulate.cpp: a step of a run of the scene as `simulate` makes it, automatic, with files
/// [s].
///   step   about as long as the automatic one [s]
double seconds_per_simulated_step(const Scene& scene, double step);

/// Eight sheets of columns + 1 by columns + 1 particles in contact (bench_self.cpp).
Scene stacked_sheets(int columns);

/// Least-squares slope of log seconds over log sizes.
double growth_exponent(const std::vector<double>& sizes, const std::vector<double>& seconds);

/// How a step of scheme C, or the making of a level set, speeds up with threads.
struct ThreadScaling {
  std::string name = {}, scene = {};  // name: of the record of its share; "": it has none
  double target = 0;                  // of the share [1]
  std::string why_target = {};
  std::vector<int> threads = {};     // 1, 2, 4, ... to the cores of the machine
  std::vector<double> seconds = {};  // the least of it
  // processor time over clock time: fewer than `threads` where other programs need the cores
  std::vector<double> cores = {};
  double share = 0, uncertainty = 0;  // serial share by Amdahl's law [1]
  std::string on_two = {};  // name of the record of its time on two threads; "": it has none
  Target target_on_two = {};
};

/// Times run_on(threads)() for its numbers of threads, in rounds over all, so that what slows the
/// machine down slows all. The share is the median of the rounds' shares; its uncertainty half the
/// range of the middle five of seven.
void measure_on_threads(const std::function<std::function<void()>(int threads)>& run_on,
                        ThreadScaling& scaling);

/// bench_level_set.cpp: of a grid's band, of signs by winding number, of a body's frames.
std::vector<ThreadScaling> level_set_scalings();
/// bench_threads.cpp: of a sheet of 100,000 particles without contact, and of layers in contact.
std::vector<ThreadScaling> thread_scalings();
Record serial_share(const ThreadScaling& scaling);
Record on_two_threads(const ThreadScaling& scaling);
Table threads_table(const std::vector<ThreadScaling>& scalings);
Table forecast_table(const std::vector<ThreadScaling>& scalings);

Record self_collision_rate();  // bench_self.cpp: a step of cloth that lies on itself
Record crossing_rate();        // bench_crossings.cpp: the test for crossings of moving features
/// bench_growth.cpp: exponents of contact, objects and stored frames.
std::vector<Record> growth_rates(double most_particles);
std::vector<Record> octree_rates();     // bench_octree.cpp: an octree of a mesh, queries
std::vector<Record> level_set_rates();  // bench_level_set.cpp: grids about a mesh, queries

}  // namespace foldproof
