#include "verification/specimens/measured.h"

#include <Eigen/Geometry>
#include <cmath>
#include <exception>
#include <limits>

#include "verification/specimens/moving_scenes.h"

namespace foldproof {

Probe::Probe(const Subject& subject, const Scene& scene)
    : subject_(subject), prepared_(offered(subject.prepare, "prepare")(scene)) {}

PerParticle3 Probe::elastic(const State& s) const {
  return offered(subject_.elastic_forces, "elastic_forces")(*prepared_, s);
}

PerParticle3 Probe::damping(const State& s, const PerParticle3& v) const {
  return offered(subject_.damping_forces, "damping_forces")(*prepared_, s, v);
}

double Probe::energy(const State& s) const {
  return offered(subject_.potential_energy, "potential_energy")(*prepared_, s);
}

void Measured::see(const std::string& name, double value) { see(name, oracles::Estimate{value, 0}); }

void Measured::see(const std::string& name, const oracles::Estimate& value) {
  names_.push_back(name);
  values_.push_back(value.value);
  worst_.see(value.value);
  uncertainty_.see(value.uncertainty);
}

Finding Measured::judged(double bound, const std::string& why_bound) const {
  const double worst = values_.empty() ? std::numeric_limits<double>::quiet_NaN() : worst_.value();
  return {{worst, bound, uncertainty_.value(), unit_, why_bound},
          {{"case", "", names_}, {quantity_, unit_, values_}},
          ""};
}

Measured roundings_of(const std::string& scale) { return {"measured", "epsilon " + scale}; }

double signed_largest(const std::vector<double>& values) {
  if (values.empty()) return NAN;
  double largest = values.front();
  for (const double value : values)
    if (!std::isnan(largest) && !(value <= largest)) largest = value;
  return largest;
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

State still_at(PerParticle3 x) {
  PerParticle3 v = PerParticle3::Zero(3, x.cols());
  return {0, std::move(x), std::move(v)};
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

Eigen::MatrixXd damping_matrix(const Probe& probe, const State& s) {
  const Eigen::Index size = s.x.size();
  Eigen::MatrixXd D(size, size);
  PerParticle3 v = PerParticle3::Zero(3, s.x.cols());
  for (Eigen::Index k = 0; k < size; ++k) {
    v.reshaped()[k] = 1;
    const PerParticle3 column = probe.damping(s, v);
    D.col(k) = column.reshaped();
    v.reshaped()[k] = 0;
  }
  return D;
}

PerParticle3 rigid_velocity(const PerParticle3& x, const Vector3& v, const Vector3& w) {
  const Vector3 centre = x.rowwise().mean();
  PerParticle3 result(3, x.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i) result.col(i) = v + w.cross(x.col(i) - centre);
  return result;
}

}  // namespace foldproof
