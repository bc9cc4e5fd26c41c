#include "convergence/bending/bending_rigidity.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

#include <cmath>

namespace foldproof {

namespace {

constexpr double ke = 0.0037;  // J

Scene bending_scene(TriangleMesh mesh) {
  Scene scene = scene_at_rest(std::move(mesh), 0.17);
  scene.bending = BendingMaterial{ke, 0, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  return scene;
}

/// Distance of a point from the border of the sheet [m].
double depth(const Vector3& p, const Vector3& far_corner) {
  const double x = p.x() < far_corner.x() / 2 ? p.x() : far_corner.x() - p.x();
  const double y = p.y() < far_corner.y() / 2 ? p.y() : far_corner.y() - p.y();
  return x < y ? x : y;
}

/// theta by the definition's formula in doubles [rad].
double angle_of(const Hinge& hinge, const PerParticle3& x) {
  oracles::Quad<double> corners;
  for (size_t k = 0; k < 4; ++k) {
    const Vector3 corner = x.col(hinge.particles[k]);
    corners[k] = {corner.x(), corner.y(), corner.z()};
  }
  return oracles::hinge_angle(corners);
}

}  // namespace

GentleSheet::GentleSheet(const Subject& subject, TriangleMesh mesh, double width)
    : subject_(subject),
      scene_(bending_scene(std::move(mesh))),
      probe_(subject, scene_),
      width_(width) {
  const PerParticle3& rest = scene_.mesh.rest;
  const Vector3 far_corner = rest.rowwise().maxCoeff();
  flat_.points = rest.topRows<2>();
  for (Eigen::Index i = 0; i < rest.cols(); ++i)
    flat_.held.push_back(depth(rest.col(i), far_corner) < 1.2 * width);
  for (const Hinge& hinge : scene_.mesh.hinges) {
    flat_.hinges.push_back(hinge.particles);
    bool inside = true;
    for (const int i : hinge.particles)
      inside = inside && !(depth(rest.col(i), far_corner) < 2.2 * width);
    flat_.counted.push_back(inside);
    const Edge& edge = scene_.mesh.edges[size_t(hinge.edge)];
    if (!inside) continue;
    for (const int t : edge.triangles) {
      const Triangle& corners = scene_.mesh.triangles[size_t(t)];
      const Vector3 side = rest.col(corners[1]) - rest.col(corners[0]),
                    other = rest.col(corners[2]) - rest.col(corners[0]);
      area_ += (side.x() * other.y() - side.y() * other.x()) / 6;
    }
  }
}

Eigen::VectorXd GentleSheet::cylinder(double angle) const {
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  return 0.5 * gentle_curvature *
         (along.transpose() * flat_.points).array().square().matrix().transpose();
}

PerParticle3 GentleSheet::positions_at(const Eigen::VectorXd& heights) const {
  PerParticle3 x = scene_.mesh.rest;
  x.row(2) = heights.transpose();
  return x;
}

double GentleSheet::rigidity(const Eigen::VectorXd& heights) const {
  // hinges that do not count are at rest in this shape, and store nothing
  const PerParticle3 x = positions_at(heights);
  Scene scene = scene_;
  for (size_t h = 0; h < flat_.hinges.size(); ++h)
    scene.rest_angles[h] = flat_.counted[h] ? 0 : angle_of(scene.mesh.hinges[h], x);
  return 2 * Probe(subject_, scene).energy(resting_state(x)) /
         (ke * area_ * gentle_curvature * gentle_curvature);
}

Eigen::VectorXd GentleSheet::pull(const Eigen::VectorXd& heights) const {
  Eigen::VectorXd force = probe_.elastic(resting_state(positions_at(heights))).row(2).transpose();
  for (Eigen::Index i = 0; i < force.size(); ++i)
    if (flat_.held[size_t(i)]) force[i] = 0;
  return force;
}

double GentleSheet::forced(double angle) const { return rigidity(cylinder(angle)); }

double GentleSheet::relaxed(double angle) const {
  // conjugate gradients: over the plane, forces are linear in heights as far as the slopes' square
  constexpr double tolerance = 1e-9;  // of the forces, to those at the start
  // sum of the heights tried [m]
  const double probing = 1e-4 * width_ * double(scene_.mesh.particles());
  Eigen::VectorXd heights = cylinder(angle), residual = pull(heights), direction = residual;
  double squared = residual.squaredNorm();
  const double goal = tolerance * tolerance * squared;
  for (Eigen::Index i = 0; i < 20 * heights.size() && squared > goal; ++i) {
    const double reach = probing / direction.cwiseAbs().sum();
    const Eigen::VectorXd product = -pull(reach * direction) / reach;
    const double step = squared / direction.dot(product);
    heights += step * direction;
    residual -= step * product;
    const double before = squared;
    squared = residual.squaredNorm();
    direction = residual + squared / before * direction;
  }
  return rigidity(heights);
}

}  // namespace foldproof
