// Free vibration: the period and the decay of the damped oscillator.

#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

//        2        An equilateral triangle, enlarged evenly by the strain s, breathes: springs of
//      /   \      k = Y A_e/L0^2 and dampers of c = kd A_e/L0^2 at particles of mass m make it
//     0 --- 1       m s'' + 3 c s' + 3 k s = 0,      omega^2 = 3 k/m,      rate = 3 c/(2 m)
// It keeps its directions, so that springs are linear at any strain. Half the difference of two
// runs from opposite strains has no even order of other elastic laws.
constexpr double side = 0.1;           // m
constexpr double amplitude = 0.02;     // strain [1]
constexpr double coarsest = 0.1;       // omega dt [1]; then a half and a quarter of it
constexpr long samples = 126;          // one a coarsest step: two periods
constexpr long stride = 8;             // samples, 0.8 radians
constexpr double damping_ratio = 0.1;  // rate over omega [1]

PortableScene triangle() {
  PerParticle3 corners(3, 3);
  for (int i = 0; i < 3; ++i) {
    const double turn = 2 * pi * i / 3;
    corners.col(i) = side / std::sqrt(3.0) * Vector3(std::cos(turn), std::sin(turn), 0);
  }
  return resting("breathing triangle", make_triangle_mesh(corners, {{0, 1, 2}}), {.young = 5});
}

double omega_of(const PortableScene& scene) {  // 1/s
  return std::sqrt(3 * edge_stiffness(scene)[0] / scene.mass[0]);
}

double strain_of(const PortableScene& scene, const PerParticle3& x) {
  const PerParticle3 from_centre = x.colwise() - x.rowwise().mean();
  return (from_centre.array() * scene.mesh.rest.array()).sum() / scene.mesh.rest.squaredNorm() - 1;
}

/// After these numbers of steps.
std::vector<double> strains(Trial& trial, PortableScene scene, const std::vector<long>& steps) {
  std::vector<double> all(steps.size(), 0);
  for (const double sign : {1.0, -1.0}) {
    scene.x = (1 + sign * amplitude) * scene.mesh.rest;
    const std::vector<Snapshot> states = trial.motion(scene, steps);
    for (size_t k = 0; k < states.size(); ++k) all[k] += sign / 2 * strain_of(scene, states[k].x);
  }
  return all;
}

/// Of a decaying oscillation, over omega [1].
struct Oscillation {
  double decay, frequency;
};

/// Samples of it, tau apart, satisfy s(t + tau) = trace s(t) - determinant s(t - tau), with
/// determinant exp(-2 decay tau): exactly so for any one-step scheme on a linear oscillator.
Oscillation fit(const std::vector<double>& s) {
  Eigen::MatrixX2d known(Eigen::Index(s.size()) - 2 * stride, 2);
  Eigen::VectorXd next(known.rows());
  for (Eigen::Index k = 0; k < known.rows(); ++k) {
    known.row(k) << s[size_t(k + stride)], -s[size_t(k)];
    next[k] = s[size_t(k + 2 * stride)];
  }
  const Eigen::Vector2d found = (known.transpose() * known).inverse() * (known.transpose() * next);
  const double tau = stride * coarsest, root = std::sqrt(found[1]);
  return {-std::log(root) / tau, std::acos(found[0] / (2 * root)) / tau};
}

/// At the coarsest step over `parts`.
Oscillation oscillation(Trial& trial, PortableScene scene, long parts) {
  scene.dt = coarsest / omega_of(scene) / double(parts);
  return fit(strains(trial, scene, multiples(parts, samples)));
}

/// The limit of a number at two steps, the second half of the first, by the claimed order.
double extrapolated(double coarse, double fine, const Declaration& declared) {
  return fine + (fine - coarse) / (std::pow(2.0, std::max(1, declared.order)) - 1);
}

/// omega by the way that the released triangle has gone after 1.6 radians, a cosine, over that of
/// the scene [1]: the stiffness as it is at the start, where few steps have rounded yet.
double released_frequency(Trial& trial) {
  constexpr double angle = 16 * coarsest;
  const auto frequency = [&](long steps) {
    PortableScene scene = triangle();
    scene.dt = angle / omega_of(scene) / double(steps);
    return std::acos(strains(trial, scene, {steps}).front() / amplitude) / angle;
  };
  const double coarse = frequency(16), fine = frequency(32);
  if (!(coarse > 0 && fine > 0))
    throw FailedWithoutNumber("a strained triangle does not swing back when it is let go",
                              "a frequency: lengths beyond those of the rest shape must pull");
  return extrapolated(coarse, fine, trial.declaration());
}

/// What is left of the series in the step when its first term is extrapolated from two steps, and
/// rounding, over omega [1].
///
/// The next term is d (omega dt)^(p + 1), |d| <= 1/2 (1/3 in both of Euler's schemes). Of it 1/(2
/// (2^p - 1)) is left of dt and dt/2, in the release, and 2^-(p + 1) times as much of dt/2 and
/// dt/4. Positions round to epsilon of the size; solvers that take velocities from them move the
/// strain by that over omega dt, at random: over the 500 steps of dt/4, which are 12.6 radians,
/// twice as much as in one; four times that with substeps; extrapolating makes it three times more.
/// Elastic laws of fourth order, such as St. Venant and Kirchhoff's, shift a frequency by the
/// squared strain.
double allowed(const Declaration& declared) {
  const int p = std::max(1, declared.order);
  const double left = (1 + std::pow(0.5, p + 1)) / (2 * (std::pow(2.0, p) - 1));
  const double noise = 2 * 4 * declared.rounding() + declared.solve_tolerance;
  return left * std::pow(coarsest, p + 1) / 2 + 3 * noise / (amplitude * coarsest / 4) +
         2 * amplitude * amplitude;
}

/// With dampers of `ratio`, c = 2 ratio k/omega, the rate is ratio omega of the scene's omega, and
/// as much as the solver's own stiffness differs: its calibration is another law's.
Finding vibrates_with(Trial& trial, const PortableScene& scene, double ratio) {
  const double bound = narrow(allowed(trial.declaration()), trial.declaration());
  const double released = released_frequency(trial), decay = ratio * released * released;
  const double frequency = std::sqrt(released * released - decay * decay);
  std::vector<Oscillation> at;
  for (const long parts : {1, 2, 4}) at.push_back(oscillation(trial, scene, parts));
  const auto row = [&](Table& table, const char* of, auto member, double expected) {
    const double limit = extrapolated(at[1].*member, at[2].*member, trial.declaration());
    table.row(of, at[0].*member, at[1].*member, at[2].*member, limit, expected,
              std::abs(limit - expected));
  };
  Table measured = table_of(
      "of | 63 steps a period [omega] | 126 steps [omega] | 251 steps [omega] | "
      "extrapolated [omega] | expected [omega] | difference [omega]");
  row(measured, "decay", &Oscillation::decay, decay);
  row(measured, "frequency", &Oscillation::frequency, frequency);
  return judge_worst(measured, bound,
                     "the scheme's own error falls with the step, as its order says: the next term "
                     "of the series is left, rounding, and the squared strain twice");
}

Finding undamped_goes_on(Trial& trial) { return vibrates_with(trial, triangle(), 0); }

Finding damped_decays(Trial& trial) {
  PortableScene scene = triangle();
  scene.name += ", damped";
  scene.material.stretch_damping = 2 * damping_ratio * scene.material.young / omega_of(scene);
  return vibrates_with(trial, scene, damping_ratio);
}

}  // namespace

std::vector<Law> vibration_laws() {
  return {
      {"vibration.undamped-goes-on",
       "Without damping, a free vibration keeps its period and its amplitude as the step goes to "
       "0.",
       "harmonic oscillator", undamped_goes_on, "", "of | extrapolated | expected"},
      {"vibration.damped-decays-as-its-damping-says",
       "A damped free vibration has the period and the decay of the damped oscillator.",
       "damped harmonic oscillator", damped_decays, "damping", "of | extrapolated | expected"},
  };
}

}  // namespace foldproof
