// sticking-lag: how far what sticks lags behind, what forecasts buy against a plain spring, and
// what they cost.
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <complex>

#include "convergence/stability/stable_step.h"
#include "convergence/stability/step_matrix.h"
#include "convergence/study.h"
#include "reference/dynamics/integrator.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/stepper.h"
#include "verification/specimens/sticking_scenes.h"

namespace foldproof {

namespace {

constexpr double particle_mass = 0.002;  // kg

enum class StuckTo { nothing, surface, cloth };

/// Bonds after the first step, everything else at rest.
State begun(Stepper& stepper) {
  State s = stepper.start();
  s.bonds = stepper.step(s, 1e-12).bonds;
  return s;
}

/// A particle that sticks at `place` [m] to a large level square about the origin that
/// moves as given. stiffness [N/m], forecast_time [s]. (Two more particles of its triangle
/// stick to nothing.)
Scene particle_on_palm(const Vector3& place, const Motion& motion, double stiffness,
                       double forecast_time) {
  PerParticle3 x(3, 3);
  x << place, place + Vector3(0.1, 0, 0), place + Vector3(0, 0.1, 0);
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}});
  Scene scene =
      scene_at_rest(mesh, 3 * particle_mass / triangle_areas(mesh.triangles, mesh.rest)[0]);
  StickyPatch patch = palm(scene, 2, motion);
  patch.particles = {0};
  patch.stiffness = stiffness;
  patch.forecast_time = forecast_time;
  patch.near = 0.01;
  patch.far = 0.04;
  scene.sticky = {patch};
  scene.solver.tolerance = 1e-13;
  return scene;
}

/// A particle at rest at its place, disturbed along one direction.
class StuckParticle {
 public:
  StuckParticle(const Subject& subject, const char* method, double stiffness, double forecast_time)
      : omega_(std::sqrt(stiffness / particle_mass)),
        stepper_(subject, particle_on_palm({0.11, 0.23, 0}, Motion{}, stiffness, forecast_time),
                 method),
        rest_(begun(stepper_)) {}

  /// Of (omega x, v) over a step of h [s], 2 x 2.
  Eigen::MatrixXd step_matrix(double h) {
    constexpr double small = 1e-9;  // m; k fades by 1e-15 over it
    Eigen::MatrixXd matrix(2, 2);
    for (int j = 0; j < 2; ++j) {
      State s = rest_;
      if (j == 0) s.x(2, 0) += small;
      if (j == 1) s.v(2, 0) += small * omega_;
      const State next = stepper_.step(s, h);
      matrix.col(j) << (next.x(2, 0) - rest_.x(2, 0)) / small, next.v(2, 0) / (small * omega_);
    }
    return matrix;
  }

 private:
  double omega_;
  Stepper stepper_;
  State rest_;
};

/// Two layers of soft cloth, the lower one held but for the particle nearest to its middle.
Scene held_layers() {
  constexpr double side = 0.2;
  Scene scene = scene_at_rest(two_sheets(2, side, 0.004), 0.2);
  scene.stretch = StretchMaterial{0.3, 0, 1};
  add_flat_hinges(scene, 1e-4, 0);
  const Eigen::Index lower = scene.x.cols() / 2;
  Eigen::Index middle = 0;
  (scene.x.leftCols(lower).colwise() - Vector3(side / 2, side / 2, 0))
      .colwise()
      .norm()
      .minCoeff(&middle);
  for (int i = 0; i < int(lower); ++i)
    if (i != middle) scene.prescribed.push_back({i, scene.x.col(i), Motion{}});
  return scene;
}

/// The spectral radius of a step of scheme C of two layers of soft cloth, the lower one held but
/// for its middle, the upper one's particles stuck to the lower one's triangles with k = m
/// (omega_h/h)^2 and the forecast time `share` of h.
double layers_radius(const Subject& subject, double omega_h, double share) {
  constexpr double h = 0.01, small = 1e-6;  // s, m
  Scene scene = held_layers();
  StickyPatch patch = layer_patch(scene.mesh);
  const double mass = lumped_masses(scene.mesh, scene.density).mean();
  patch.stiffness = mass * omega_h * omega_h / (h * h);
  patch.forecast_time = share * h;
  patch.near = 0.02;
  patch.far = 0.05;
  scene.sticky = {patch};
  scene.solver.tolerance = 1e-14;
  Stepper stepper(subject, scene, scene.integrator);
  const State rest = begun(stepper);

  std::vector<Eigen::Index> free;  // coordinates
  for (const int i : free_particles(scene))
    for (int k = 0; k < 3; ++k) free.push_back(3 * i + k);
  const Eigen::Index n = Eigen::Index(free.size());
  Eigen::MatrixXd matrix(2 * n, 2 * n);
  for (Eigen::Index j = 0; j < 2 * n; ++j) {
    const auto stepped = [&](double by) -> State {
      State s = rest;
      if (j < n) s.x.reshaped()[free[size_t(j)]] += by;
      if (j >= n) s.v.reshaped()[free[size_t(j - n)]] += by / h;
      return stepper.step(s, h);
    };
    const State ahead = stepped(small), behind = stepped(-small);
    const Eigen::VectorXd x = (ahead.x - behind.x).reshaped() / (2 * small),
                          v = (ahead.v - behind.v).reshaped() * (h / (2 * small));
    matrix.col(j) << x(free), v(free);
  }
  return spectral_radius(matrix);
}

/// Iterations of a solve of a damped sheet of n x n cells stuck so that k tau_s h/(2 m) is `number`
/// inside it, over the first steps of scheme C from random velocities.
double iterations_where(const Subject& subject, int n, StuckTo to, double number) {
  constexpr double h = 0.004, tau = 0.02, density = 0.2;
  const TriangleMesh mesh = two_sheets(n, 0.5, 0.002);
  Scene scene = scene_at_rest(mesh, density);
  scene.stretch = StretchMaterial{20, 0.3, 1};
  const double mass = density * (0.5 / n) * (0.5 / n);  // of a particle inside
  StickyPatch patch = to == StuckTo::cloth ? layer_patch(mesh) : palm(scene, 2, Motion{});
  if (to == StuckTo::nothing) patch.particles.clear();
  patch.forecast_time = tau;
  patch.stiffness = 2 * mass * number / (tau * h);
  patch.near = 0.003;
  patch.far = 0.05;
  scene.sticky = {patch};
  Stepper stepper(subject, scene, scene.integrator);
  State s = stepper.start();
  s.v = disturbance_shape(s.x.cols());
  stepper.run(s, h, 3);
  return double(stepper.work().cg_iterations) / double(stepper.work().solves);
}

// ---- lag on a turntable

constexpr double turning = 3.1;  // rad/s
constexpr double arm = 0.31;     // m

// Lag of a particle on a turntable: x = (R + u) e^{i w t} with m w^2 (R + u) = -(k
// (1 + i w tau)) u.
//
// Scheme C lags further. Let e = x_t - x and d = v_t - v at the start of a step, omega^2 =
// k/m, q = h tau omega^2/2, and let the target have the constant acceleration a. The moving
// velocity v~ solves
//   (1 + q) (v~ - v_t) = -d + h omega^2 e/2
// with the target's velocity of the step's start; the trapezoidal line gives a = omega^2 e + 2 q
// d/h where d is the same from step to step. So is e, if v~ = v_t + h a/2:
//   omega^2 e = a (1 + q + q^2)/(1 + q)
double derived_lag(const std::string& method, double k, double tau, double h) {
  const double inertia = particle_mass * turning * turning;
  const double lag = inertia * arm / std::abs(std::complex<double>(k - inertia, k * turning * tau));
  const double q = h * tau * k / (2 * particle_mass);
  return method == "C" ? lag * (1 + q + q * q) / (1 + q) : lag;
}

/// How far a particle is from its place in the mean over the last part of a run [m], and the width
/// of its swing about that mean, over m a/k; both as seen from the turntable.
struct Lag {
  double mean, swing;
};

Lag measured_lag(const Subject& subject, const std::string& method, double k, double tau,
                 double h) {
  Motion motion;
  motion.angular_velocity = {0, 0, turning};
  Stepper stepper(subject, particle_on_palm({arm, 0, 0}, motion, k, tau), method);
  const double omega = std::sqrt(k / particle_mass);
  const double settled = 12 * std::max(tau, 2 / omega), watched = 3 * 2 * pi / omega;
  State s = stepper.start();
  s.v.col(0) = Vector3(0, turning * arm, 0);
  std::vector<std::complex<double>> seen;
  std::complex<double> sum = 0;
  while (s.time < settled + watched) {
    s = stepper.step(s, h);
    if (s.bonds.empty()) return {nan, nan};
    if (s.time < settled) continue;
    seen.push_back(std::complex<double>(s.x(0, 0), s.x(1, 0)) * std::polar(1.0, -turning * s.time) -
                   arm);
    sum += seen.back();
  }
  const std::complex<double> mean = sum / double(seen.size());
  Worst farthest;
  for (const std::complex<double>& u : seen) farthest.observe(std::abs(u - mean));
  return {std::abs(mean), 2 * farthest.value() * k / (particle_mass * turning * turning * arm)};
}

/// Contribution of a long step to the lag, by scheme.
void add_lags_of_long_steps(const Subject& subject, StudyResult& result) {
  constexpr double k = 1000;
  const double omega = std::sqrt(k / particle_mass), tau = 8 / omega;
  Table lags("scheme; omega h [1]; lag [m]; derived [m]");
  for (const char* method : {"A", "B", "C"})
    for (const double omega_h : {0.05, 0.4, 1.6}) {
      const double h = omega_h / omega;
      lags.row(method, omega_h, measured_lag(subject, method, k, tau, h).mean,
               derived_lag(method, k, tau, h));
    }
  result.findings.push_back(
      {"sticking-lag.lag-grows-with-the-step-in-C",
       "On a moving surface scheme C lags by 1 + q^2/(1 + q) times m a/k, with q = h tau_s k/(2 "
       "m): up to h tau_s a/2 more; A and B lag by m a/k.",
       {{largest_deviation(lags, "lag", "derived"), 1e-2, 0, "1",
         "the surface turns by less than 0.01 in a step and by 0.04 in tau_s, in which the lag "
         "settles; errors are of the order of its square; C lags up to six times as far as A"},
        lags,
        "tau_s = 8/omega"}});
}

Table lags_over_stiffness(const Subject& subject, Tier tier) {
  Table lags(
      "scheme [1]; stiffness [N/m]; plain spring, mean lag [m]; plain spring, swing over m a/k "
      "[1]; with forecasts, lag [m]; derived [m]; with forecasts, swing over m a/k [1]");
  for (const std::string scheme : {"A", "B", "C"})
    for (const double k : geometric_range(10, 1e4, tier == Tier::quick ? 4 : 10)) {
      // critical damping
      const double omega = std::sqrt(k / particle_mass), tau = 2 / omega, h = 0.02 / omega;
      const Lag without = measured_lag(subject, scheme, k, 0, h),
                with = measured_lag(subject, scheme, k, tau, h);
      lags.row(scheme, k, without.mean, without.swing, with.mean, derived_lag(scheme, k, tau, h),
               with.swing);
    }
  return lags;
}

Figure lag_figure(const Table& by_scheme) {
  const Table lags = group_of(by_scheme, "scheme", "C");
  return {"lag",
          "How far what sticks to a turntable lags behind, scheme C",
          {"stiffness", "N/m", Scale::log},
          {"lag", "m", Scale::log},
          -1,
          "A particle of 2 g, 0.31 m from the axis, 3.1 rad/s. The plain spring's lag is the mean "
          "of an oscillation that never decays; with forecasts the lag is steady.",
          {curve_of("plain spring, mean", lags, "stiffness", "plain spring, mean lag"),
           curve_of("with forecasts", lags, "stiffness", "with forecasts, lag"),
           curve_of("m a/k as derived", lags, "stiffness", "derived")}};
}

NamedFinding lag_finding(const Table& lags) {
  return {"sticking-lag.lag-is-m-a-over-k",
          "With forecasts a particle on a turntable lags under A, B and C by m a/|k (1 + i omega "
          "tau_s) - m omega^2|, in short steps: m a/k where it is stiff.",
          {{largest_deviation(lags, "with forecasts, lag", "derived"), 2e-3, 0, "1",
            "k falls by 2 (lag/far)^2, at most 6e-4 here, and steps of 0.02/omega err by their "
            "square; another law of k or of a is off by a factor"},
           lags}};
}

NamedFinding swing_finding(const Table& lags) {
  return {"sticking-lag.forecasts-damp-the-swing",
          "With critical forecasts, tau_s = 2/omega, a stuck particle comes to rest relative to "
          "its bond under A, B and C.",
          judge_worst(lags, 1e-3, "twelve times 2/omega leave (1 + 12) e^-12 = 8e-5 of m a/k")};
}

NamedFinding plain_swing_finding(const Table& lags) {
  double least_swing = INFINITY;
  for (const double swing : lags.numbers("plain spring, swing over m a/k"))
    least_swing = std::min(least_swing, std::isnan(swing) ? -INFINITY : swing);
  return {"sticking-lag.plain-spring-swings-forever",
          "A plain spring oscillates for ever about its lag, with an amplitude as large as the "
          "lag: it never holds still.",
          {{1.9 - least_swing, 0, 0, "1",
            "it oscillates between 0 and twice m a/k; a tenth allows for where the steps fall and "
            "for the fading of k"},
           lags,
           "measured is 1.9 minus the smallest range of the oscillation over m a/k"}};
}

void add_lags(const Subject& subject, Tier tier, StudyResult& result) {
  const Table lags = lags_over_stiffness(subject, tier);
  result.figures.push_back(lag_figure(lags));
  result.findings = {lag_finding(lags), swing_finding(lags), plain_swing_finding(lags)};
}

// ---- the step's limit against the forecast time

/// The largest stable step times omega, by the radius of the step's matrix, and as derived.
double measured_limit(const Subject& subject, const char* method, double omega_tau) {
  constexpr double k = 300;
  const double omega = std::sqrt(k / particle_mass);
  StuckParticle particle(subject, method, k, omega_tau / omega);
  double stable = 0.5, grows = 100;
  for (int n = 0; n < 40; ++n) {
    const double middle = std::sqrt(stable * grows);
    (spectral_radius(particle.step_matrix(middle / omega)) <= 1 + 1e-7 ? stable : grows) = middle;
  }
  return stable;
}

double derived_limit(const std::string& method, double omega_tau) {
  return method == "C" ? omega_tau + std::sqrt(omega_tau * omega_tau + 4) : 2;
}

NamedFinding limit_finding(const std::string& name, const Table& limits) {
  return {
      "sticking-lag.limit-is-as-derived." + name,
      "Scheme " + name + ": what sticks is stable in steps up to " +
          (name == "C" ? "tau_s + sqrt(tau_s^2 + 4/omega^2)." : "2/omega, for any forecast time."),
      {{largest_deviation(limits, "omega h, measured", "derived"), 1e-3, 0, "1",
        "a radius of 1 + 1e-7 counts as growth, which errs by a ten-thousandth where the radius "
        "leaves 1 slowest; the formulas for A, B and for C differ by more from tau_s = 2e-3/omega "
        "on"},
       limits,
       "measured is the largest relative deviation"}};
}

void add_limits(const Subject& subject, Tier tier, StudyResult& result) {
  Figure figure{"limit",
                "Largest stable step of a stuck particle",
                {"forecast time times frequency", "1", Scale::log},
                {"largest stable step times frequency", "1", Scale::log},
                "Forecasts do not widen the limit of A and B; C is stable for steps up to twice "
                "the forecast time, however stiff the bond. Points are measured, lines derived."};
  for (const Integrator& integrator : paper_schemes()) {
    const std::string name(integrator.name);
    Table limits("omega tau_s [1]; omega h, measured [1]; derived [1]");
    for (const double omega_tau : geometric_range(0.03, 30, tier == Tier::quick ? 7 : 19))
      limits.row(omega_tau, measured_limit(subject, name.c_str(), omega_tau),
                 derived_limit(name, omega_tau));
    result.findings.push_back(limit_finding(name, limits));
    figure.curves.push_back(curve_of(name, limits, "omega tau_s", "omega h, measured"));
    if (name != "B")
      figure.curves.push_back(curve_of(name + ", derived", limits, "omega tau_s", "derived"));
  }
  result.figures.push_back(figure);
}

// ---- two layers, stuck stiffly

void add_layers(const Subject& subject, StudyResult& result) {
  Table layers(
      "omega h of a bond [1]; radius less 1 with tau_s = h/2 [1]; radius less 1 with a plain "
      "spring [1]");
  double least = INFINITY;
  for (const double omega_h : {1.0, 10.0, 100.0, 1000.0}) {
    const double without = layers_radius(subject, omega_h, 0) - 1;
    layers.row(omega_h, layers_radius(subject, omega_h, 0.5) - 1, without);
    if (omega_h > 2) least = std::min(least, std::isnan(without) ? -INFINITY : without);
  }
  result.findings.push_back(
      {"sticking-lag.stiff-layers-are-stable",
       "Two layers that stick to each other are stable in scheme C with tau_s = h/2, however stiff "
       "their bonds.",
       judge_worst(
           layers, "radius less 1 with tau_s = h/2", 1e-3,
           "disturbances of 1e-6 m turn a triangle of 0.1 m by 1e-5, whose square times (omega "
           "h)^2 is 1e-4 of a step; what is unstable grows many times over in one step",
           "measured is the largest spectral radius less 1")});
  result.findings.push_back(
      {"sticking-lag.stiff-layers-need-forecasts",
       "Without forecasts the same bonds are unstable once omega h exceeds a few.",
       {{1 - least, 0, 0, "1",
         "beyond its limit a plain spring's spectral radius grows as (omega h)^2: far above 2 at "
         "omega h = 10"},
        layers,
        "measured is 2 minus the smallest spectral radius for omega h of at least 10"}});
}

// ---- cost

Table iterations_over_stiffness(const Subject& subject, Tier tier) {
  const int cells = tier == Tier::quick ? 8 : 24;
  const double loose = iterations_where(subject, cells, StuckTo::nothing, 1);
  Table iterations("k tau_s h/(2 m) [1]; nothing sticks [1]; to a surface [1]; to cloth [1]");
  for (const double number : geometric_range(0.01, 1e4, 7))
    iterations.row(number, loose, iterations_where(subject, cells, StuckTo::surface, number),
                   iterations_where(subject, cells, StuckTo::cloth, number));
  return iterations;
}

NamedFinding cost_finding(const Table& iterations) {
  return {"sticking-lag.surface-bonds-add-few-iterations",
          "Bonds to a surface add only the iterations that a worse first guess needs.",
          {{largest_ratio(iterations, "to a surface", "nothing sticks"), 1.4, 0, "1",
            "they add k tau_s to the diagonal, which does not spread the spectrum; but the error "
            "of the first guess, the explicit velocity, grows up to 1e4 times: fourteen digits to "
            "gain instead of ten"},
           iterations,
           "measured is the largest number of iterations over the number where nothing sticks; "
           "bonds between layers spread the spectrum, and cost more"}};
}

void add_cost(const Subject& subject, Tier tier, StudyResult& result) {
  const Table iterations = iterations_over_stiffness(subject, tier);
  const std::string number = "k tau_s h/(2 m)";
  Figure figure{"iterations",
                "Iterations of a solve where a sheet sticks",
                {number, "1", Scale::log},
                {"iterations of a solve", "1"},
                "A damped sheet all of whose particles stick, to a surface or to a second sheet. "
                "Scheme C, tolerance 1e-10."};
  for (const char* to : {"nothing sticks", "to a surface", "to cloth"})
    figure.curves.push_back(curve_of(to, iterations, number, to));
  result.figures.push_back(figure);
  result.findings.push_back(cost_finding(iterations));
}

StudyResult run_sticking_lag(const Subject& subject, Tier tier, const Progress& progress) {
  StudyResult result;
  add_lags(subject, tier, result);
  add_lags_of_long_steps(subject, result);
  progress(0.4);
  add_limits(subject, tier, result);
  progress(0.6);
  add_layers(subject, result);
  progress(0.8);
  add_cost(subject, tier, result);
  return result;
}

}  // namespace

Study sticking_lag_study() {
  return {"sticking-lag",
          "What sticks lags by m a/k, and in scheme C by more the longer the step; forecasts stop "
          "its swinging and, in scheme C, keep steps of up to twice the forecast time stable "
          "however stiff the bond.",
          {"lag-is-m-a-over-k", "lag-grows-with-the-step-in-C", "forecasts-damp-the-swing",
           "plain-spring-swings-forever", "limit-is-as-derived.C", "stiff-layers-are-stable"},
          "BMF03 section 6",
          "A bond is a spring of zero rest length between the forecast positions of a particle and "
          "its target. Forecasting both adds damping of their relative velocity, which the schemes "
          "treat implicitly: the bond lags as a plain spring does, but it comes to rest, and in "
          "scheme C it is stable however stiff.",
          run_sticking_lag};
}

}  // namespace foldproof
