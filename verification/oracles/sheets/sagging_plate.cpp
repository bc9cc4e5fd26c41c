#include "verification/oracles/sheets/sagging_plate.h"

#include <Eigen/Dense>
#include <cmath>

#include "verification/oracles/gauss.h"

namespace foldproof::oracles {

namespace {

/// By polynomials of this many terms.
double sag_by_terms(const RingPlate& plate, int terms) {
  const Gauss gauss(terms + 12);
  const double a = plate.inner, width = 1 - a;
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(terms, terms);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(terms);
  for (Eigen::Index g = 0; g < gauss.s.size(); ++g) {
    const double s = gauss.s[g], r = a + width * s, area = gauss.weight[g] * width * r;
    Eigen::VectorXd w(terms), slope(terms), curvature(terms);  // s^(k + 2)
    for (int k = 0; k < terms; ++k) {
      w[k] = std::pow(s, k + 2);
      slope[k] = (k + 2) * std::pow(s, k + 1) / width;
      curvature[k] = (k + 2) * (k + 1) * std::pow(s, k) / (width * width);
    }
    const Eigen::VectorXd around = slope / r, sum = curvature + around;
    stiffness +=
        area * (sum * sum.transpose() - (1 - plate.poisson) * (curvature * around.transpose() +
                                                               around * curvature.transpose()));
    load += area * w;
  }
  return stiffness.ldlt().solve(load).sum();  // every s^(k + 2) is 1 at the edge
}

}  // namespace

Estimate sag_of_ring_by_formula(const RingPlate& plate) {
  const double a = plate.inner, nu = plate.poisson, log = std::log(a);
  // no shear at the edge: the Laplacian's slope, r/2 + 4 d/r, vanishes
  const double d = -1.0 / 8;
  Eigen::Matrix3d of;   // of 1, ln(r), r^2
  of << 1, log, a * a,  //
      0, 1 / a, 2 * a,  //
      0, nu - 1, 2 + 2 * nu;
  const Eigen::Vector3d rest(std::pow(a, 4) / 64 + d * a * a * log,
                             std::pow(a, 3) / 16 + d * a * (2 * log + 1),
                             (12 + 4 * nu) / 64 + d * (3 + nu));
  const Eigen::Vector3d abc = of.partialPivLu().solve(-rest);
  return {1.0 / 64 + abc[0] + abc[2], 1e-13 / std::pow(1 - a, 4)};
}

Estimate sag_of_ring_by_energy(const RingPlate& plate) {
  const double fine = sag_by_terms(plate, 11), coarse = sag_by_terms(plate, 8);
  return {fine, std::abs(fine - coarse) + 1e-11 * std::abs(fine)};
}

}  // namespace foldproof::oracles
