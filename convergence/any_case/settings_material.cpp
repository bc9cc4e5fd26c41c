#include "convergence/any_case/settings_material.h"

#include "verification/subjects/suite/relaxation.h"

namespace foldproof {

namespace {

constexpr double enough = 1e-5;         // of the length, that the last two rounds may move it
constexpr double usual_gravity = 9.81;  // m/s^2

/// In its rest shape, with the particles of one end held.
PortableScene hung(PortableScene cloth, int along) {
  cloth.name += ", hung";
  const double gravity = cloth.gravity.norm() > 0 ? cloth.gravity.norm() : usual_gravity;
  cloth.gravity = Vector3::Zero(), cloth.gravity[along] = -gravity;
  cloth.x = cloth.mesh.rest, cloth.v.setZero();
  cloth.planes.clear(), cloth.boxes.clear(), cloth.spheres.clear(), cloth.capsules.clear();
  cloth.bodies.clear(), cloth.moving_held = {}, cloth.held.clear(), cloth.air.reset();
  const double top = cloth.x.row(along).maxCoeff(),
               near = 0.1 * rest_lengths(cloth.mesh).minCoeff();
  for (int i = 0; i < cloth.x.cols(); ++i)
    if (cloth.x(along, i) > top - near) cloth.held.push_back(i);
  return cloth;
}

}  // namespace

double apparent_young(Trial& trial, PortableScene cloth, double dt) {
  trial.require("held");
  Eigen::Index along = 0;
  const Vector3 sides = cloth.mesh.rest.rowwise().maxCoeff() - cloth.mesh.rest.rowwise().minCoeff();
  const double length = sides.maxCoeff(&along);
  PortableScene scene = hung(std::move(cloth), int(along));
  scene.dt = dt;
  const suite::Relaxed end = suite::relaxed(trial, scene, {scene.x, length, enough, dt});
  if (end.dt < dt) throw NotOffered{"rest in such steps: the hanging cloth gains energy"};
  const double stretch = scene.x.row(along).minCoeff() - end.x.row(along).minCoeff();
  return scene.material.density * scene.gravity.norm() * length * length / (2 * stretch);
}

}  // namespace foldproof
