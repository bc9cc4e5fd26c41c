#include "verification/specimens/balance.h"

#include <Eigen/Geometry>

#include "verification/evidence.h"

namespace foldproof {

double net_force(const PerParticle3& f) {
  const Vector3 sum = f.rowwise().sum();
  return sum.norm() / (epsilon * f.colwise().norm().sum());
}

double net_torque(const PerParticle3& x, const PerParticle3& f) {
  const Vector3 centre = x.rowwise().mean();
  Vector3 sum = Vector3::Zero();
  double scale = 0;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Vector3 arm = x.col(i) - centre, force = f.col(i);
    sum += arm.cross(force);
    scale += arm.norm() * force.norm();
  }
  return sum.norm() / (epsilon * scale);
}

PerParticle3 rigid_velocity(const PerParticle3& x, const Vector3& v, const Vector3& w) {
  const Vector3 centre = x.rowwise().mean();
  PerParticle3 result(3, x.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i) result.col(i) = v + w.cross(x.col(i) - centre);
  return result;
}

}  // namespace foldproof
