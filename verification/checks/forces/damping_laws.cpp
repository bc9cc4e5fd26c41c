#include "verification/checks/forces/damping_laws.h"

#include "verification/evidence.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/probe.h"

namespace foldproof {

PowerOfDamping power_of_damping(const Probe& probe, const State& s) {
  const PerParticle3 f = probe.damping(s, s.v);
  const double power = f.cwiseProduct(s.v).sum();
  return {power, power / f.colwise().norm().cwiseProduct(s.v.colwise().norm()).sum()};
}

Finding dissipation(const std::vector<std::string>& names, const std::vector<PowerOfDamping>& powers) {
  std::vector<double> watts, shares;
  for (const PowerOfDamping& power : powers) {
    watts.push_back(power.power);
    shares.push_back(power.share);
  }
  return {{signed_largest(shares), 0, 0, "sum |v_i||F_i|",
           "each element takes a square out of the motion, at random velocities far more than roundings: the "
           "power is negative, and the largest is that nearest to 0"},
          {{"case", "", names}, {"power", "sum |v_i||F_i|", shares}, {"power in watts", "W", watts}},
          "measured is the largest power of the damping forces with its sign"};
}

Finding asymmetry(const Subject& subject, const std::vector<DampedScene>& cases) {
  Table measured = roundings_of("largest |D_ij|");
  for (const DampedScene& damped : cases) {
    const Eigen::MatrixXd D = damping_matrix(Probe(subject, damped.scene), damped.state);
    const double largest = (D - D.transpose()).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    measured.row(damped.name, largest / (epsilon * D.cwiseAbs().maxCoeff()));
  }
  return judged_worst(
      measured, 32, "an entry of D is a product of two rounded components and a sum over about ten elements");
}

Finding largest_eigenvalue(const Subject& subject, const std::vector<DampedScene>& cases) {
  Table measured = roundings_of("3N times the largest |eigenvalue|");
  std::vector<double> lowest, highest;
  for (const DampedScene& damped : cases) {
    const Eigen::MatrixXd D = damping_matrix(Probe(subject, damped.scene), damped.state);
    const Eigen::MatrixXd symmetric_part = 0.5 * (D + D.transpose());
    const Eigen::VectorXd values = oracles::symmetric_eigenvalues(symmetric_part);
    lowest.push_back(values.minCoeff());
    highest.push_back(values.maxCoeff());
    const double size = values.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    measured.row(damped.name, highest.back() / (epsilon * double(D.rows()) * size));
  }
  Finding finding = judged_worst(
      measured, 4, "the eigenvalue solver's backward error is about epsilon 3N times the largest eigenvalue");
  finding.evidence.add({"lowest eigenvalue", "N s/m", lowest});
  finding.evidence.add({"highest eigenvalue", "N s/m", highest});
  return finding;
}

}  // namespace foldproof
