// Small scenes of cloth against objects, and what the studies of contact measure on them.
#pragma once

#include <vector>

#include "verification/subject.h"

namespace foldproof {

/// An object at rest with friction, ready to be put in a scene.
SceneObject solid_object(const std::string& name, const Solid& solid, double friction);

/// A square sheet of n x n cells, `side` [m] wide, level, its middle at `middle` [m]; damped
/// springs and hinges, under gravity.
Scene level_sheet(int n, double side, const Vector3& middle);

/// Steps the scene with scheme C in steps of h [s] until `end` [s]; `watch` sees every state.
/// Returns the last.
State run_to_end(
    const Subject& subject, const Scene& scene, double h, double end,
    const std::function<void(const State&)>& watch = [](const State&) {});

/// Half the elastic limit of the start [s].
double usual_step(const Scene& scene);

/// Signed distance of p [m] to the nearest of the scene's objects at the time [s].
double distance_at(const Scene& scene, const Vector3& p, double time);

/// The deepest that particles, midpoints of edges and centres of triangles are inside
/// [m]; 0 if none is.
struct Depths {
  double particles = 0, edges = 0, faces = 0;
};
Depths depths_of(const Scene& scene, const State& s);

}  // namespace foldproof
