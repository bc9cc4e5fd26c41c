// How deep triangles can be whose corners are outside: the bound on faces_outside.
#pragma once

#include <optional>
#include <vector>

#include "reference/scene/scene.h"
#include "verification/cases/expectations.h"

namespace foldproof {

/// The radius of the smallest circle that holds the triangle [m]: about its longest side unless all
/// angles are acute.
double enclosing_radius(const Vector3& a, const Vector3& b, const Vector3& c);

/// That of the largest triangle, stretched by a quarter or, if it has one, by its strain limit [m].
double largest_enclosing_radius(const Scene& scene);

/// How deep particles may be where nothing is stated: a tenth of largest_enclosing_radius [m].
double usual_particle_depth(const Scene& scene);

/// The bound on `faces_outside` that follows from the particles' depth and the triangles' size,
/// with its reason. None without objects, and none where particles are meant to lie inside: the
/// case expects lies_inside and not stays_outside.
///   d   the particles' depth: the stated bound on stays_outside, else r/10 [m]
///   r   largest_enclosing_radius [m]
std::optional<Expectation> expected_faces_outside(const Scene& scene,
                                                  const std::vector<Expectation>& stated);

}  // namespace foldproof
