#include "verification/oracles/exact_solutions.h"

#include <cmath>
#include <string>

#include "verification/oracles/scalars.h"

namespace foldproof::oracles {

namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw InputError("oracle exact_solutions: " + what);
}

void require_oscillator(const Oscillator& oscillator) {
  require(oscillator.stiffness >= 0, "Oscillator stiffness must be at least 0");
  require(oscillator.damping >= 0, "Oscillator damping must be at least 0");
  require(std::isfinite(oscillator.stiffness) && std::isfinite(oscillator.damping),
          "Oscillator must be finite");
  require(std::isfinite(oscillator.x0) && std::isfinite(oscillator.v0),
          "Oscillator x0 and v0 must be finite");
}

/// The solutions of y'' = -signed_square y: even(0) = 1, even'(0) = 0; odd(0) = 0, odd'(0) = 1.
struct Fundamental {
  Digits50 even, odd;
};

Fundamental fundamental(const Digits50& signed_square, const Digits50& t) {
  if (signed_square == 0) return {1, t};
  const Digits50 rate = sqrt(abs(signed_square));
  if (signed_square > 0) return {cos(rate * t), sin(rate * t) / rate};
  return {cosh(rate * t), sinh(rate * t) / rate};
}

/// The symbols of the step matrices: a = h c/2, b = h^2 k/2 [1].
struct StepLetters {
  Digits50 a, b, h;
};

StepLetters step_letters(const Oscillator& oscillator, double h) {
  const Digits50 step = h;
  return {step * oscillator.damping / 2, step * step * oscillator.stiffness / 2, step};
}

/// The entries of a step's matrix.
struct StepEntries {
  Digits50 xx, xv, vx, vv;
};

// One step by hand; every half kick is h/2 (-k x - c v) = -(b/h) x - a v.
//   A  v*   = (1 - a) v - (b/h) x              explicit half kick
//      x'   = x + h v*
//      v'   = (v* - (b/h) x')/(1 + a)          implicit half kick
//   B  v*   = (v - (b/h) x)/(1 + a)            implicit
//      x'   = x + h v*
//      v'   = (1 - a) v* - (b/h) x'            explicit
//   C  x' as in B, then v' as in A from that x': v' = ((1 - a) v - (b/h) x - (b/h) x')/(1 + a)
StepEntries step_entries(Scheme scheme, const Oscillator& oscillator, double h) {
  require_oscillator(oscillator);
  require(h > 0 && std::isfinite(h), "step_matrix: h must be positive");
  const auto [a, b, step] = step_letters(oscillator, h);
  const Digits50 p = 1 + a;
  switch (scheme) {
    case Scheme::mixed:
      return {1 - b, step * (1 - a), -b / step * (2 - b) / p, (1 - a) * (1 - b) / p};
    case Scheme::central_newmark:
      return {(p - b) / p, step / p, -b / step * (2 - b) / p, (1 - a - b) / p};
    case Scheme::variable_step_newmark:
      return {(p - b) / p, step / p, -b / step * (2 * p - b) / (p * p),
              ((1 - a) * p - b) / (p * p)};
  }
  throw InputError("oracle exact_solutions: step_matrix: no such scheme");
}

}  // namespace

// With gamma = c/2: x(t) = e^{-gamma t} (x0 even + (v0 + gamma x0) odd), y = x e^{gamma t}
// solving y'' = -(k - gamma^2) y; the velocity follows from v'' = -k v - c v' with v(0) = v0,
// v'(0) = -k x0 - c v0.
OscillatorEstimate oscillator_at(const Oscillator& oscillator, double t) {
  require_oscillator(oscillator);
  require(t >= 0 && std::isfinite(t), "time must be at least 0 and finite");
  const Digits50 k = oscillator.stiffness, c = oscillator.damping, x0 = oscillator.x0,
                 v0 = oscillator.v0, time = t;
  const Digits50 gamma = c / 2;
  const Fundamental y = fundamental(k - gamma * gamma, time);
  const Digits50 decay = exp(-gamma * time);
  return {rounded(decay * (x0 * y.even + (v0 + gamma * x0) * y.odd)),
          rounded(decay * (v0 * y.even - (k * x0 + gamma * v0) * y.odd))};
}

OscillatorEstimate verlet_oscillator(const Oscillator& oscillator, double h, long n) {
  require_oscillator(oscillator);
  require(oscillator.damping == 0, "verlet_oscillator: damping must be 0");
  require(oscillator.stiffness > 0, "verlet_oscillator: stiffness must be positive");
  require(h > 0 && n >= 0, "verlet_oscillator: h must be positive and n at least 0");
  const Digits50 omega = sqrt(Digits50(oscillator.stiffness)), half = omega * h / 2;
  require(half < 1, "verlet_oscillator: omega h must be below 2");
  const Digits50 phi = asin(half), angle = 2 * n * phi, speed = omega * cos(phi);
  const Digits50 x0 = oscillator.x0, v0 = oscillator.v0;
  return {rounded(x0 * cos(angle) + v0 / speed * sin(angle)),
          rounded(v0 * cos(angle) - x0 * speed * sin(angle))};
}

Eigen::Matrix2d step_matrix(Scheme scheme, const Oscillator& oscillator, double h) {
  const StepEntries m = step_entries(scheme, oscillator, h);
  Eigen::Matrix2d matrix;
  matrix << m.xx.convert_to<double>(), m.xv.convert_to<double>(), m.vx.convert_to<double>(),
      m.vv.convert_to<double>();
  return matrix;
}

OscillatorEstimate stepped_oscillator(Scheme scheme, const Oscillator& oscillator, double h) {
  const StepEntries m = step_entries(scheme, oscillator, h);
  return {rounded(m.xx * oscillator.x0 + m.xv * oscillator.v0),
          rounded(m.vx * oscillator.x0 + m.vv * oscillator.v0)};
}

// A and B: b = 2. C: b = 2 (1 + a), that is k h^2 - 2 c h - 4 = 0.
Estimate largest_stable_step(Scheme scheme, const Oscillator& oscillator) {
  require_oscillator(oscillator);
  require(oscillator.stiffness > 0,
          "largest_stable_step: stiffness must be positive, else every step is stable");
  const Digits50 k = oscillator.stiffness, c = oscillator.damping;
  if (scheme == Scheme::variable_step_newmark) return rounded((c + sqrt(c * c + 4 * k)) / k);
  return rounded(2 / sqrt(k));
}

FallEstimate free_fall(const Launch& launch, double t) {
  require(std::isfinite(t), "free_fall: time must be finite");
  require(launch.x0.allFinite() && launch.v0.allFinite() && launch.g.allFinite(),
          "free_fall: Launch must be finite");
  FallEstimate fall;
  const Digits50 time = t;
  for (int i = 0; i < 3; ++i) {
    const Digits50 x0 = launch.x0[i], v0 = launch.v0[i], g = launch.g[i];
    const Estimate x = rounded(x0 + time * (v0 + g * time / 2)), v = rounded(v0 + g * time);
    fall.x[i] = x.value;
    fall.v[i] = v.value;
    if (x.uncertainty > fall.x_uncertainty) fall.x_uncertainty = x.uncertainty;
    if (v.uncertainty > fall.v_uncertainty) fall.v_uncertainty = v.uncertainty;
  }
  return fall;
}

Estimate steady_rotation_length(const SpringPair& pair, double omega) {
  require(pair.young > 0 && pair.area > 0 && pair.rest_length > 0,
          "SpringPair young, area, rest_length must be positive");
  require(pair.mass_a > 0 && pair.mass_b > 0, "SpringPair masses must be positive");
  require(std::isfinite(omega), "steady_rotation_length: omega must be finite");
  const Digits50 mass = Digits50(pair.mass_a) * pair.mass_b / (Digits50(pair.mass_a) + pair.mass_b);
  const Digits50 rest_length = pair.rest_length, spin = omega;
  const Digits50 stiffness = Digits50(pair.young) * pair.area / (rest_length * rest_length);
  const Digits50 remaining = 1 - mass * spin * spin / stiffness;
  require(
      remaining > 0,
      "steady_rotation_length: omega is too fast for the spring, lower it or stiffen the spring");
  return rounded(rest_length / remaining);
}

SheetModuli equilateral_sheet_moduli(double young) {
  require(young > 0 && std::isfinite(young), "equilateral_sheet_moduli: young must be positive");
  return {rounded(Digits50(young)), rounded(Digits50(1) / 3)};
}

}  // namespace foldproof::oracles
