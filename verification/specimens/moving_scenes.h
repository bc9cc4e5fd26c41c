// Small sheets in motion, and what the checks of dynamics do with them.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "reference/scene/scene.h"
#include "verification/verdict.h"
#include "verification/seeds.h"
#include "verification/subject.h"

namespace foldproof {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Uniform numbers, the same on every machine for the same seed and shift of seeds.
class Random {
 public:
  explicit Random(unsigned seed) : bits_(shifted(seed)) {}

  double in(double low, double high) { return low + (high - low) * (double(bits_() >> 11) * 0x1p-53); }
  double in_decades(double low, double high);             // uniform in the logarithm; low > 0
  PerParticle3 vectors(Eigen::Index count, double size);  // 3 x count, components in [-size, size]

 private:
  std::mt19937_64 bits_;
};

/// A free crumpled sheet of irregular triangles that moves at random: stretched and folded, with rest angles
/// of its own. Springs and bending, both damped; no gravity. Elastic limit about 6 ms.
Scene free_sheet();

/// The same without any damping.
Scene undamped_sheet();

/// A jittered sheet under gravity, damped, moving: one corner is held, two particles are led (an oscillation
/// with drift, a rotation with drift), the others are free. Elastic limit about 2 ms, by the bound.
Scene led_sheet();

/// A scene made ready by a subject, stepped by it.
class Stepper {
 public:
  Stepper(const Subject& subject, Scene scene, const std::string& integrator);

  const Scene& scene() const { return scene_; }
  State start() const { return start_state(scene_); }
  State step(const State& s, double h);                        // h [s]
  State step_after(const std::vector<State>& past, double h);  // the latest state last
  State run(State s, double h, int steps);
  PerParticle3 elastic_forces(const State& s) const;                         // 3 x N [N]
  PerParticle3 damping_forces(const State& s, const PerParticle3& v) const;  // 3 x N [N]
  const Work& work() const { return work_; }                                 // of all steps so far

 private:
  const Subject& subject_;
  Scene scene_;
  std::unique_ptr<Prepared> prepared_;
  Work work_;
};

/// How many times a small disturbance of the start has grown at most, in all of `steps` steps of h [1], at
/// least 1. It is random, its velocities scaled with 1/(steps h); rounding errors on the way grow no faster.
double growth(Stepper& stepper, const State& start, double h, int steps);

/// Largest distance between the columns of two 3 x N arrays; NaN if any is.
double largest_difference(const PerParticle3& a, const PerParticle3& b);

/// How many numbers of two 3 x N arrays differ; NaN differs from everything.
double numbers_that_differ(const PerParticle3& a, const PerParticle3& b);

/// Half the diagonal of the box around all positions, plus the distance of its centre from the origin [m].
double extent(const PerParticle3& x);

/// Says in a note what a bound in roundings lets through: "The smallest defect that this notices is 3.1e-13
/// of the extent." bound: in epsilon of the scale.
std::string smallest_defect(double bound, const std::string& scale);

double largest_speed(const PerParticle3& v);  // m/s

/// One check for each of the paper's schemes A, B and C, its name ended by a dot and the scheme's.
void add_for_each_scheme(std::vector<Check>& list, const Check& pattern,
                         const std::function<Finding(const Subject&, const std::string& integrator)>& run);

}  // namespace foldproof
