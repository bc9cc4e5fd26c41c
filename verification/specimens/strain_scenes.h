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
/// outside of their strains, and nearly flat, stretched by 5 %, with limits of +10 % and 0 %.
/// Random velocities move the ends of a spring against each other by up to .3 of its length in a
/// step: at half, sweeps may diverge from the limits.
std::vector<LimitedCloth> limited_cloths(SweepOrder order);

/// Largest relative motion of the ends of a spring in a step h [s], over its length [1].
double relative_motion(const LimitedCloth& cloth, double h);

/// The four orders with the names that case files give them.
struct NamedOrder {
  std::string name;
  SweepOrder order;
};
const std::vector<NamedOrder>& sweep_orders();

/// limited_cloths of each order, whose name begins theirs.
std::vector<LimitedCloth> cloths_in_all_orders();

/// The largest violation of the scene's strain limits at the positions x (3 x N [m]), over rest
/// lengths [1]; negative: all are within.
double strain_violation(const Scene& scene, const PerParticle3& x);

/// The velocities v (3 x N [m/s]) as corrected by the subject's strain limits for the cloth's step.
PerParticle3 corrected_by_strain_limits(const Subject& subject, const LimitedCloth& cloth,
                                        const PerParticle3& v);

}  // namespace foldproof
