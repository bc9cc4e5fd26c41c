// Cloth that starts crossing itself: which pairs may still pass through each other, and the push
// that separates them (after Volino and Magnenat-Thalmann 2006, "Resolving surface collisions
// through intersection contour minimization").
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "reference/filters/feature_pair.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

using CrossingTriangles = std::vector<std::pair<int, int>>;  // pairs of triangle indices

/// "2 pairs of triangles: 12 and 40, 12 and 41"; the first five are named.
std::string list_triangles(const CrossingTriangles& crossing);

/// N: whether the particle belongs to a triangle that crosses another.
std::vector<char> tangled_particles(const CrossingTriangles& crossing,
                                    const std::vector<Triangle>& triangles, Eigen::Index particles);

/// Removes the pairs whose particles are all tangled: holding these apart would keep them crossed.
void remove_tangled_pairs(const std::vector<char>& tangled, std::vector<FeaturePair>& pairs);

/// Where an edge of one triangle pierces another at p, pushes the two apart, at `speed` [m/s] or
/// more, in the direction that shortens their line of intersection. Impulses sum to zero. x, v: 3
/// x N [m], [m/s].
void push_out_of_tangle(const CrossingTriangles& crossing, const std::vector<Triangle>& triangles,
                        const PerParticle3& x, double speed, const PerParticle& inverse_mass,
                        PerParticle3& v);

}  // namespace foldproof
