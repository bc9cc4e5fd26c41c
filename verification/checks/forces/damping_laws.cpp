#include "verification/checks/forces/damping_laws.h"

#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/probe.h"

namespace foldproof {

DampingPower damping_power_of(const Probe& probe, const State& s) {
  const PerParticle3 f = probe.damping(s, s.v);
  const double power = f.cwiseProduct(s.v).sum();
  return {power, power / f.colwise().norm().cwiseProduct(s.v.colwise().norm()).sum()};
}

Table no_powers() { return {{"case", ""}, {"power", "sum |v_i||F_i|"}, {"power in watts", "W"}}; }

Finding dissipation(const Table& powers) {
  return {{signed_largest(powers.numbers("power")), 0, 0, "sum |v_i||F_i|",
           "each element removes a square from the energy, at random velocities far more than "
           "rounding: the power is negative, and the largest is nearest to 0"},
          powers,
          "measured is the largest power of the damping forces with its sign"};
}

Finding asymmetry(const Subject& subject, const std::vector<DampedScene>& cases) {
  Table measured = roundings_of("largest |D_ij|");
  for (const DampedScene& damped : cases) {
    const Eigen::MatrixXd D = damping_matrix(Probe(subject, damped.scene), damped.state);
    const double largest = (D - D.transpose()).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    measured.row(damped.name, largest / (epsilon * D.cwiseAbs().maxCoeff()));
  }
  return judge_worst(
      measured, 32,
      "an entry of D is a product of two rounded components and a sum over about ten elements");
}

Finding largest_eigenvalue(const Subject& subject, const std::vector<DampedScene>& cases) {
  Table measured = roundings_of("3N times the largest |eigenvalue|");
  measured.add({"lowest eigenvalue", "N s/m"});
  measured.add({"highest eigenvalue", "N s/m"});
  for (const DampedScene& damped : cases) {
    const Eigen::MatrixXd D = damping_matrix(Probe(subject, damped.scene), damped.state);
    const Eigen::MatrixXd symmetric_part = 0.5 * (D + D.transpose());
    const Eigen::VectorXd values = oracles::symmetric_eigenvalues(symmetric_part);
    const double size = values.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    measured.row(damped.name, values.maxCoeff() / (epsilon * double(D.rows()) * size),
                 values.minCoeff(), values.maxCoeff());
  }
  return judge_worst(
      measured, "measured", 4,
      "the eigenvalue solver's backward error is about epsilon 3N times the largest eigenvalue");
}

}  // namespace foldproof
