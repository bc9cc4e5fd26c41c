#include "verification/specimens/differences.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "verification/evidence.h"

namespace foldproof {

double largest_difference(const PerParticle3& a, const PerParticle3& b) {
  Worst worst;
  for (Eigen::Index i = 0; i < a.cols(); ++i) worst.observe((a.col(i) - b.col(i)).norm());
  return worst.value();
}

double count_differing_entries(const PerParticle3& a, const PerParticle3& b) {
  return double((a.array() != b.array()).count());
}

double extent(const PerParticle3& x) {
  const Vector3 low = x.rowwise().minCoeff(), high = x.rowwise().maxCoeff();
  return (high - low).norm() / 2 + (high + low).norm() / 2;
}

std::string smallest_defect(double bound, const std::string& scale) {
  return fmt::format("The smallest defect that this notices is {:.1e} of the {}.", bound * epsilon,
                     scale);
}

double largest_speed(const PerParticle3& v) {
  return largest_difference(v, PerParticle3::Zero(3, v.cols()));
}

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
