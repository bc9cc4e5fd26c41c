// Closely stacked sheets in motion: test cloth for self-collision.
#pragma once

#include "reference/filters/feature_pair.h"
#include "reference/scene/scene.h"
#include "verification/subject.h"

namespace foldproof {

/// Arrangement and motion of the sheets.
struct LayeredSheets {
  int sheets = 3;
  double gap = 0.003;     // between two [m]; the thickness is .004
  double height = 0.001;  // of random bumps of each, less than half of the gap [m]
  double speed = 0.3;     // of random velocities [m/s]
  SelfCollisionSettings settings = {0.004, 0, 0, 8, true};
  unsigned seed = 1;
};

/// Sheets of 5 x 6 jittered cells of 2 cm, 42 particles each, one above the other; the scene has
/// self-collision and no other force or filter.
Scene layered_scene(const LayeredSheets& wanted);

/// The start velocities as corrected by the subject's self-collision over a step of `step` [s] from
/// time 0. `moves`: the velocity moves the cloth; otherwise it ends a step. 3 x N [m/s].
struct StepRequest {
  double step;
  bool moves;
};
PerParticle3 corrected_by_self_collision(const Subject& subject, const Scene& scene,
                                         const StepRequest& request);

/// All pairs of a vertex and a triangle, or of two edges, with no particle in common, each once.
std::vector<FeaturePair> all_pairs(const TriangleMesh& mesh);

/// sum m v [kg m/s], sum m x x v about the mean [kg m^2/s] and sum m v^2/2 [J] of
/// velocities v at x.
Vector3 linear_momentum_of(const PerParticle& mass, const PerParticle3& v);
Vector3 angular_momentum_of(const PerParticle& mass, const PerParticle3& x, const PerParticle3& v);
double kinetic_energy_of(const PerParticle& mass, const PerParticle3& v);

}  // namespace foldproof
