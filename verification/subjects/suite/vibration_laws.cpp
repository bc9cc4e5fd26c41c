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

/// One mode of a scene: its frequency by the scene's numbers, its start, and what is followed.
struct Oscillator {
  PortableScene scene;
  double omega;                                                     // 1/s
  PerParticle3 (*displaced)(const PortableScene&, double by);       // positions [m]
  double (*followed)(const PortableScene&, const PerParticle3& x);  // strain or angle
};

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

PerParticle3 enlarged(const PortableScene& scene, double by) { return (1 + by) * scene.mesh.rest; }

Oscillator breathing() {
  const PortableScene scene = triangle();
  return {scene, omega_of(scene), enlarged, strain_of};
}

//      1        Two equilateral triangles of height h and mass rho A swing about their shared edge
//     / \       by the angle theta = (z0 + z1 - z2 - z3)/h. The hinge of weight w = 1/sqrt(3), and
//    2---3      its damper of moment kd L theta', make it
//     \ /         theta'' + 9/(h^2 rho A) (kd L theta' + 2 B w theta) = 0
//      0        Springs, four times as fast or more, keep the lengths.
constexpr double height = side * 0.8660254037844386;  // m
const double hinge_weight = 1 / std::sqrt(3.0);

PortableScene two_triangles() {
  PerParticle3 corners(3, 4);
  corners << 0, 0, -side / 2, side / 2, -height, height, 0, 0, 0, 0, 0, 0;
  PortableScene scene =
      resting("swinging hinge", make_triangle_mesh(corners, {{2, 0, 3}, {3, 1, 2}}),
              {.young = 5, .bending_rigidity = 1.8e-3});
  return scene;
}

/// Each triangle turned by half of the angle [rad].
PerParticle3 folded(const PortableScene& scene, double by) {
  PerParticle3 x = scene.mesh.rest;
  x.row(1) *= std::cos(by / 2);
  x.row(2) = (scene.mesh.rest.row(1).array().abs() * std::sin(by / 2)).matrix();
  return x;
}

double angle_of(const PortableScene&, const PerParticle3& x) {
  return (x(2, 0) + x(2, 1) - x(2, 2) - x(2, 3)) / height;
}

Oscillator swinging() {
  const PortableScene scene = two_triangles();
  const double inertia = height * height * scene.mass.sum() / 2 / 9;  // kg m^2
  return {scene, std::sqrt(2 * scene.material.bending_rigidity * hinge_weight / inertia), folded,
          angle_of};
}

/// In both modes a consistent mass matrix makes g^T M^-1 g, g the gradient of what is followed,
/// four times as large.
Oscillator as_declared(Oscillator oscillator, Trial& trial) {
  if (trial.declaration().has_consistent_mass) oscillator.omega *= 2;
  return oscillator;
}

/// After these numbers of steps.
std::vector<double> displacements(Trial& trial, const Oscillator& oscillator, double dt,
                                  const std::vector<long>& steps) {
  PortableScene scene = oscillator.scene;
  scene.dt = dt;
  std::vector<double> all(steps.size(), 0);
  for (const double sign : {1.0, -1.0}) {
    scene.x = oscillator.displaced(scene, sign * amplitude);
    const std::vector<Snapshot> states = trial.motion(scene, steps);
    for (size_t k = 0; k < states.size(); ++k)
      all[k] += sign / 2 * oscillator.followed(scene, states[k].x);
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

/// At the coarsest step over `parts`, or shorter ones that the solver does not divide itself.
Oscillation oscillation(Trial& trial, const Oscillator& oscillator, long parts) {
  const double longest = coarsest / oscillator.omega;  // s
  parts *= parts_of_step(longest, trial.declaration());
  const double dt = longest / double(parts);
  return fit(displacements(trial, oscillator, dt, multiples(parts, samples)));
}

/// The limit of a number at two steps, the second half of the first, by the claimed order.
double extrapolated(double coarse, double fine, const Declaration& declared) {
  return fine + (fine - coarse) / (std::pow(2.0, std::max(1, declared.order)) - 1);
}

/// omega by the way that the released scene, without damping, has gone after 1.6 radians, a cosine,
/// over that of the scene [1]: the stiffness as it is at the start, where few steps have rounded.
double released_frequency(Trial& trial, Oscillator oscillator) {
  oscillator.scene.material.stretch_damping = oscillator.scene.material.bending_damping = 0;
  constexpr double angle = 16 * coarsest;
  const double duration = angle / oscillator.omega;  // s
  const long own = parts_of_step(duration / 16, trial.declaration());
  const auto frequency = [&](long steps) {
    const double dt = duration / double(steps);
    return std::acos(displacements(trial, oscillator, dt, {steps}).front() / amplitude) / angle;
  };
  const double coarse = frequency(16 * own), fine = frequency(32 * own);
  if (!(coarse > 0 && fine > 0))
    throw FailedWithoutNumber("strained or bent triangles do not swing back when they are let go",
                              "a frequency: lengths and angles other than at rest must pull");
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

/// With dampers of `ratio`, 2 ratio/omega times the stiffness, the rate is ratio omega of the
/// scene's omega, and as much as the solver's own stiffness differs: its calibration is another
/// law's.
Finding vibrates_with(Trial& trial, const Oscillator& oscillator, double ratio) {
  const double bound = narrow(allowed(trial.declaration()), trial.declaration());
  const double released = released_frequency(trial, oscillator),
               decay = ratio * released * released;
  const double frequency = std::sqrt(released * released - decay * decay);
  std::vector<Oscillation> at;
  for (const long parts : {1, 2, 4}) at.push_back(oscillation(trial, oscillator, parts));
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

Finding undamped_goes_on(Trial& trial) {
  return vibrates_with(trial, as_declared(breathing(), trial), 0);
}

Finding undamped_hinge_goes_on(Trial& trial) {
  return vibrates_with(trial, as_declared(swinging(), trial), 0);
}

Finding damped_decays(Trial& trial) {
  Oscillator damped = as_declared(breathing(), trial);
  damped.scene.name += ", damped";
  damped.scene.material.stretch_damping =
      2 * damping_ratio * damped.scene.material.young / damped.omega;
  return vibrates_with(trial, damped, damping_ratio);
}

Finding damped_hinge_decays(Trial& trial) {
  Oscillator damped = as_declared(swinging(), trial);
  damped.scene.name += ", damped";
  const double stiffness = 2 * damped.scene.material.bending_rigidity * hinge_weight;  // N m
  damped.scene.material.bending_damping = 2 * damping_ratio / damped.omega * stiffness / side;
  return vibrates_with(trial, damped, damping_ratio);
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
      {"vibration.undamped-hinge-goes-on",
       "Without damping, a hinge swings on: bending has none hidden.", "harmonic oscillator",
       undamped_hinge_goes_on, "bending", "of | extrapolated | expected"},
      {"vibration.damped-hinge-decays-as-its-damping-says",
       "A hinge with `bending_damping` has the period and the decay of the damped oscillator.",
       "damped harmonic oscillator", damped_hinge_decays, "damping bending",
       "of | extrapolated | expected"},
  };
}

}  // namespace foldproof
