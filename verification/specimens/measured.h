// How the checks of forces ask a subject and how they put their numbers together.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "verification/verdict.h"
#include "verification/oracles/estimate.h"
#include "verification/subject.h"

namespace foldproof {

/// A scene made ready by a subject. Each call throws NotOffered if the subject has no such operation.
class Probe {
 public:
  Probe(const Subject& subject, const Scene& scene);

  PerParticle3 elastic(const State& s) const;                         // 3 x N [N]
  PerParticle3 damping(const State& s, const PerParticle3& v) const;  // 3 x N [N]
  double energy(const State& s) const;                                // J

 private:
  const Subject& subject_;
  std::unique_ptr<Prepared> prepared_;
};

/// Numbers measured case by case: all are shown, the worst is judged.
class Measured {
 public:
  /// What is measured and in what unit.
  Measured(std::string quantity, std::string unit) : quantity_(std::move(quantity)), unit_(std::move(unit)) {}

  void see(const std::string& name, double value);
  void see(const std::string& name, const oracles::Estimate& value);

  /// The worst value, with the largest of the uncertainties, against the bound; NaN, which fails, if nothing
  /// was seen.
  Finding judged(double bound, const std::string& why_bound) const;

 private:
  std::string quantity_, unit_;
  std::vector<std::string> names_;
  std::vector<double> values_;
  Worst worst_, uncertainty_;
};

/// A Measured in multiples of epsilon times a scale.
Measured roundings_of(const std::string& scale);

/// The largest value with its sign; NaN if any is, or if there is none.
double signed_largest(const std::vector<double>& values);

/// The message with which `act` refuses; empty if it does not, or by anything but InputError.
std::string refusal(const std::function<void()>& act);

/// The positions x (3 x N [m]) without motion.
State still_at(PerParticle3 x);

/// |sum of F| over epsilon times sum |F_i|; NaN without any force. f: 3 x N [N].
double net_force(const PerParticle3& f);

/// |sum of x_i x F_i| about the mean of x, over epsilon times sum |x_i||F_i|; NaN without any force. x: 3 x N
/// [m].
double net_torque(const PerParticle3& x, const PerParticle3& f);

/// The damping matrix D at s, column by column: 3N x 3N [N s/m], coordinates particle by particle.
Eigen::MatrixXd damping_matrix(const Probe& probe, const State& s);

/// Velocity [m/s] of particles at x moved rigidly: v + w x (x - mean).
PerParticle3 rigid_velocity(const PerParticle3& x, const Vector3& v, const Vector3& w);

}  // namespace foldproof
