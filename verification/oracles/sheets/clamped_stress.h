// A flat rectangular sheet between two clamps pulled apart: where it is compressed across.
#pragma once

#include <span>
#include <vector>

#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

/// An isotropic, linearly elastic continuum in plane stress. The clamped ends keep their width, the
/// two long edges are free.
struct ClampedRectangle {
  double length_over_width = 0;  // from 0.5 to 5
  double poisson = 0;            // nu, from 0 to below 0.5
};

/// The stress across over the tension T, the mean stress along, on the middle line between the free
/// edges [1]; positive is tension. places: distance from a clamp over the length, 0.05 to 0.5.
///
/// Stresses in equilibrium with T, of least complementary energy: second derivatives of
///   T y^2/2 + (1 - (2 y/W)^2)^2 sum c_mn P_2m(2 x/L) P_2n(2 y/W),
/// Legendre's polynomials P. The clamps do no work on the terms added to T: they have no force.
std::vector<Estimate> clamped_stress_by_stresses(const ClampedRectangle& sheet,
                                                 std::span<const double> places);

/// The same from displacements that the clamps allow, of least strain energy:
///   u = strain x + (1 - (2 x/L)^2) sum a_mn P_2m+1(2 x/L) P_2n(2 y/W) along,
///   v = (1 - (2 x/L)^2) sum b_mn P_2m(2 x/L) P_2n+1(2 y/W) across.
std::vector<Estimate> clamped_stress_by_displacements(const ClampedRectangle& sheet,
                                                      std::span<const double> places);

}  // namespace foldproof::oracles
