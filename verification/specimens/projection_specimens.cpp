#include "verification/specimens/projection_specimens.h"

#include <Eigen/Geometry>

#include "verification/specimens/random.h"

namespace foldproof {

namespace {

/// The solid as an object that is placed, turned and in motion.
Object moving(const std::string& name, const Solid& solid) {
  const Pose place{Eigen::Quaterniond(Eigen::AngleAxisd(0.83, Vector3(0.36, -0.48, 0.8))),
                   {0.11, -0.07, 0.23}};
  Motion motion;
  motion.velocity = Vector3(0.31, 0.17, -0.23);
  motion.angular_velocity = Vector3(0.7, -1.3, 0.4);
  motion.center = Vector3(0.05, 0.13, -0.19);
  return {name, RigidObject{solid, place, motion}, 0.3};
}

Object resting(const std::string& name, const Solid& solid, const Vector3& at) {
  return {name, RigidObject{solid, {Eigen::Quaterniond::Identity(), at}, Motion{}}, 0.3};
}

/// Random points of the cube of half-side `reach` about `centre` whose distance lies
/// between the two [m].
PerParticle3 points_around(const ProjectionCase& specimen, const Vector3& centre, double reach) {
  constexpr int wanted = 300;
  constexpr double deepest = -0.13, farthest = 0.08;
  Random random(911);
  PerParticle3 points(3, wanted);
  for (int found = 0; found < wanted;) {
    const PerParticle3 point = centre + random.vectors(1, reach).col(0);
    const double phi = distances(specimen, point)[0];
    if (phi > deepest && phi < farthest) points.col(found++) = point;
  }
  return points;
}

}  // namespace

std::vector<ProjectionCase> solids_with_points() {
  std::vector<ProjectionCase> cases = {
      {"half space", {moving("half space", HalfSpace{})}, 0.37, {}},
      {"sphere", {moving("sphere", Sphere{0.41})}, 0.37, {}},
      {"box", {moving("box", Box{{0.31, 0.22, 0.43}})}, 0.37, {}},
      {"capsule", {moving("capsule", Capsule{0.19, 0.27})}, 0.37, {}},
      {"torus", {moving("torus", Torus{0.37, 0.16})}, 0.37, {}}};
  for (ProjectionCase& one : cases) {
    const RigidObject& body = std::get<RigidObject>(one.objects[0].body);
    one.x =
        points_around(one, to_world(pose_at(body.motion, one.time), body.place.translation), 0.7);
  }
  return cases;
}

ProjectionCase two_balls() {
  ProjectionCase specimen{"two balls",
                          {resting("left", Sphere{0.31}, {-0.4, 0.03, 0.02}),
                           resting("right", Sphere{0.27}, {0.35, -0.02, 0.05})},
                          0,
                          {}};
  specimen.x = points_around(specimen, {0, 0, 0}, 0.8);
  return specimen;
}

ProjectionCase overlapping_balls() {
  ProjectionCase specimen{"overlapping balls",
                          {resting("left", Sphere{0.31}, {-0.19, 0.03, 0.02}),
                           resting("right", Sphere{0.27}, {0.17, -0.02, 0.05})},
                          0,
                          {}};
  specimen.x = points_around(specimen, {0, 0, 0}, 0.5);
  return specimen;
}

FoldProjection projection_by(const std::string& map) {
  return {map, {0.004, 0.03, 0.1}, PinchedPoints::left_alone, 1e-12, 60};
}

ProjectedCloth project_specimen(const ProjectionCase& specimen, const FoldProjection& projection) {
  return project_folds(specimen.objects, specimen.x, specimen.time, projection);
}

double longest_edge(const std::vector<Triangle>& triangles, const PerParticle3& x) {
  double longest = 0;
  for (const Triangle& t : triangles)
    for (size_t k = 0; k < 3; ++k)
      longest = std::max(longest, (x.col(t[k]) - x.col(t[(k + 1) % 3])).norm());
  return longest;
}

PerParticle distances(const ProjectionCase& specimen, const PerParticle3& x) {
  PerParticle phi(x.cols());
  ObjectsOverSpan now(specimen.objects, {specimen.time, specimen.time, 0});
  for (Eigen::Index i = 0; i < x.cols(); ++i) phi[i] = nearest_of(now.at(x.col(i))).first.phi;
  return phi;
}

}  // namespace foldproof
