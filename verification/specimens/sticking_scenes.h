// Cloth that sticks to cloth and to surfaces that move, with the oracle's answers.
#pragma once

#include <string>
#include <vector>

#include "reference/scene/scene.h"
#include "verification/oracles/sticking.h"

namespace foldproof {

/// A state with bonds made by hand.
struct StuckSpecimen {
  std::string name;
  Scene scene;  // no force but sticking
  State state;
  std::vector<oracles::StuckParticle> stuck;
  // of each: the particle, and the corners if these are cloth
  std::vector<std::vector<int>> particles;

  const StickyPatch& patch() const { return scene.sticky.front(); }
};

/// Two small irregular sheets, one above the other. The upper one's particles stick to one or two
/// triangles of the lower one, at distances of .07, .44, .83 and .99 `far` from their targets.
std::vector<StuckSpecimen> stuck_layers();

/// The upper sheet alone, stuck to a surface that turns and drifts by formula: rates are known.
StuckSpecimen stuck_to_turning_surface();

/// The oracle's elastic forces (3 x N [N]) and energy [J] of the specimen.
PerParticle3 expected_elastic(const StuckSpecimen& specimen);
double expected_energy(const StuckSpecimen& specimen);

/// -k tau_s G^T G over all particles, G = (-1 at the particle, the target's derivative at the
/// corners): 3N x 3N [N s/m].
Eigen::MatrixXd expected_damping(const StuckSpecimen& specimen);

/// Two sheets of n x n cells as one mesh, `gap` apart in z; particles of the lower one come first.
/// [m]
TriangleMesh two_sheets(int n, double side, double gap);

/// The second half of the particles may stick to the triangles of the first half; nothing else is
/// set.
StickyPatch layer_patch(const TriangleMesh& mesh);

/// A swinging palm of .8 m for all particles of the scene, with all sticking parameters set.
StickyPatch swinging_palm(const Scene& scene);

/// A horizontal square of two triangles that face upwards, about the origin at rest: a patch for
/// all particles of the scene to stick to. The square moves with `motion`.
StickyPatch palm(const Scene& scene, double side, const RigidMotion& motion);

}  // namespace foldproof
