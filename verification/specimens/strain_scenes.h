// Cloth with strain limits, in states and motions for tests.
#pragma once

#include <string>
#include <vector>

#include "reference/scene/scene.h"
#include "verification/subject.h"

namespace foldproof {

/// A scene with springs and strain limits; its state is within the limits, its motion is not.
struct LimitedCloth {
  std::string name;
  Scene scene;
  State state;
  double step;  // in which springs would leave their limits [s]
};

/// Crumpled sheets of every pattern, a disc and a sphere, each twice: as they are, with limits just
/// outside their strains; and nearly flat, stretched by 5 %, with limits of +10 % and 0 %. Random
/// velocities move the ends of a spring relative to each other by up to .3 of its length in a step:
/// at .5, sweeps may diverge from the limits.
std::vector<LimitedCloth> limited_cloths(SweepOrder order);

/// Largest relative motion of a spring's ends in a step h [s], over its length [1].
double relative_motion(const LimitedCloth& cloth, double h);

/// The four orders with their names in case files.
struct NamedOrder {
  std::string name;
  SweepOrder order;
};
const std::vector<NamedOrder>& sweep_orders();

/// limited_cloths for each order; names begin with the order's.
std::vector<LimitedCloth> cloths_in_all_orders();

/// The largest violation of the scene's strain limits at the positions x (3 x N [m]), over rest
/// lengths [1]; negative if all springs are within.
double strain_violation(const Scene& scene, const PerParticle3& x);

/// The velocities v (3 x N [m/s]) as corrected by the subject's strain limits for the cloth's step.
PerParticle3 corrected_by_strain_limits(const Subject& subject, const LimitedCloth& cloth,
                                        const PerParticle3& v);

}  // namespace foldproof
