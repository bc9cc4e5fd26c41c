// Cloth that starts crossing itself: what is left to pass, and the push that takes it apart (after
// Volino and Magnenat-Thalmann 2006, "Resolving surface collisions through intersection contour
// minimization").
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "reference/filters/feature_pair.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

using CrossingTriangles = std::vector<std::pair<int, int>>;  // by their numbers

/// "2 pairs of triangles: 12 and 40, 12 and 41"; the first five are named.
std::string list_triangles(const CrossingTriangles& crossing);

/// N: whether the particle belongs to a triangle that crosses another.
std::vector<char> tangled_particles(const CrossingTriangles& crossing,
                                    const std::vector<Triangle>& triangles, Eigen::Index particles);

/// Leaves out the pairs of which all particles are tangled: to be held apart where they are would
/// hold them crossed.
void remove_tangled_pairs(const std::vector<char>& tangled, std::vector<FeaturePair>& pairs);

/// Where an edge of one triangle pierces another at p, moves the two against each other, at `speed`
/// [m/s] at least, in the direction in which the line where they cross grows shorter. Impulses sum
/// to zero. x, v: 3 x N [m], [m/s].
void push_out_of_tangle(const CrossingTriangles& crossing, const std::vector<Triangle>& triangles,
                        const PerParticle3& x, double speed, const PerParticle& inverse_mass,
                        PerParticle3& v);

}  // namespace foldproof
