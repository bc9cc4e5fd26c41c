#pragma once

#include <Eigen/Core>

#include "reference/types.h"
#include "verification/oracles/estimate.h"

// Motions and equilibria known in closed form. Each is evaluated in 50 digits, so the uncertainty
// is one rounding of the answer. A parameter out of its range: InputError naming it and the range.

namespace foldproof::oracles {

/// x'' = -stiffness x - damping x', from x(0), v(0). Per unit of mass.
struct Oscillator {
  double stiffness = 0;  // k = omega^2 [1/s^2], >= 0
  double damping = 0;    // c = 2 zeta omega [1/s], >= 0
  double x0 = 0;         // [m]
  double v0 = 0;         // [m/s]
};

/// Position and velocity of an oscillator.
struct OscillatorEstimate {
  Estimate x;  // [m]
  Estimate v;  // [m/s]
};

/// Exact state at time t [s] >= 0; under-, over- and critically damped.
OscillatorEstimate oscillator_at(const Oscillator& oscillator, double t);

/// The undamped oscillator after n steps of h [s] of velocity Verlet: with sin(phi) = omega h/2,
///   x_n = x0 cos(2 n phi) + v0/(omega cos(phi)) sin(2 n phi)
///   v_n = v0 cos(2 n phi) - x0 omega cos(phi) sin(2 n phi)
/// Needs damping = 0, stiffness > 0 and omega h < 2. Undamped, schemes A, B and C all are
/// velocity Verlet.
OscillatorEstimate verlet_oscillator(const Oscillator& oscillator, double h, long n);

/// The three mixed schemes of BMF03 section 3, in the paper's order.
enum class Scheme { mixed, central_newmark, variable_step_newmark };

/// The 2 x 2 matrix that takes (x_n, v_n) to (x_{n+1}, v_{n+1}) in one step h [s] > 0; the
/// oscillator's x0, v0 are not used. Derived by hand from the lines of the scheme; rounded to
/// double at the end.
Eigen::Matrix2d step_matrix(Scheme scheme, const Oscillator& oscillator, double h);

/// x and v after one step h [s] > 0 of the scheme from the oscillator's x0, v0.
OscillatorEstimate stepped_oscillator(Scheme scheme, const Oscillator& oscillator, double h);

/// The step h [s] at which the spectral radius of step_matrix leaves 1: 2/omega for A and B, (c +
/// sqrt(c^2 + 4 k))/k for C. Needs stiffness > 0.
Estimate largest_stable_step(Scheme scheme, const Oscillator& oscillator);

/// Position [m] or, per coordinate, v0 + g t [m/s] of a body in the field g [m/s^2] at time t [s].
struct FallEstimate {
  Vector3 x, v;
  double x_uncertainty = 0;  // [m], of every coordinate
  double v_uncertainty = 0;  // [m/s], of every coordinate
};

/// A body released at x0 [m] with v0 [m/s].
struct Launch {
  Vector3 x0, v0, g;  // [m], [m/s], [m/s^2]
};

/// x0 + v0 t + g t^2/2 and v0 + g t.
FallEstimate free_fall(const Launch& launch, double t);

/// Two particles and the spring between them.
struct SpringPair {
  double young = 0;        // Y [N/m], > 0
  double area = 0;         // A_e [m^2], > 0
  double rest_length = 0;  // L0 [m], > 0
  double mass_a = 0;       // [kg], > 0
  double mass_b = 0;       // [kg], > 0
};

/// Length [m] at which the pair turns steadily about its centre of mass at omega [rad/s]: spring
/// force = m omega^2 length with the reduced mass m = m_a m_b/(m_a + m_b), so length = L0/(1 - m
/// omega^2 L0^2/(Y A_e)). At or above the omega where that denominator vanishes no such motion
/// exists: InputError.
Estimate steady_rotation_length(const SpringPair& pair, double omega);

/// Two-dimensional elastic moduli of a sheet.
struct SheetModuli {
  Estimate young;    // [N/m]
  Estimate poisson;  // [1]
};

/// A sheet of equilateral triangles whose edges are springs of modulus Y [N/m] with A_e = both
/// triangles: strain energy per area (Y/2) sum over the three directions of (n.strain n)^2, whose
/// fourth-order mean 3/8 (dd + dd + dd) gives C1111 = 9 Y/8, C1122 = 3 Y/8, hence Young's modulus Y
/// and Poisson's ratio 1/3.
SheetModuli equilateral_sheet_moduli(double young);

}  // namespace foldproof::oracles
