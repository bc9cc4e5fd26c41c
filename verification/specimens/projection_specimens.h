// Cloth and objects for tests of the projection.
#pragma once

#include <string>
#include <vector>

#include "reference/mesh/triangle_mesh.h"
#include "reference/post/fold_projection.h"

namespace foldproof {

struct ProjectionCase {
  std::string name;
  std::vector<Object> objects;
  double time;     // s
  PerParticle3 x;  // 3 x N points in and around the objects [m]
};

/// Every solid in closed form, placed, turned and in motion, each with points around its surface,
/// from 0.13 m inside to 0.08 m outside.
std::vector<ProjectionCase> solids_with_points();

/// Two separate balls, with points around both.
ProjectionCase two_balls();

/// Two balls that overlap, with points around the lens that is inside both.
ProjectionCase overlapping_balls();

/// eps .004, tau .03, t^ .1 [m]; converged within 1e-12 m.
FoldProjection projection_by(const std::string& map);

ProjectedCloth project_specimen(const ProjectionCase& specimen, const FoldProjection& projection);

/// [m]
double longest_edge(const std::vector<Triangle>& triangles, const PerParticle3& x);

/// Signed distance of each point to the union of the objects [m].
PerParticle distances(const ProjectionCase& specimen, const PerParticle3& x);

}  // namespace foldproof
