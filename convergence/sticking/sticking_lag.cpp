// sticking-lag: how far what sticks lags behind, what forecasts buy against a plain spring, and
// what they cost.
#include <Eigen/Geometry>
#include <cmath>
#include <complex>

#include "convergence/sticking/sticking_scenes.h"
#include "convergence/stability/step_matrix.h"
#include "convergence/study.h"
#include "reference/dynamics/integrator.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

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
  Table lags{{"scheme", ""}, {"omega h", "1"}, {"lag", "m"}, {"derived", "m"}};
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
  Table lags{{"scheme", "1"},
             {"stiffness", "N/m"},
             {"plain spring, mean lag", "m"},
             {"plain spring, swing over m a/k", "1"},
             {"with forecasts, lag", "m"},
             {"derived", "m"},
             {"with forecasts, swing over m a/k", "1"}};
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
           lags,
           ""}};
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
    Table limits{{"omega tau_s", "1"}, {"omega h, measured", "1"}, {"derived", "1"}};
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
  Table layers{{"omega h of a bond", "1"},
               {"radius less 1 with tau_s = h/2", "1"},
               {"radius less 1 with a plain spring", "1"}};
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
  Table iterations{
      {"k tau_s h/(2 m)", "1"}, {"nothing sticks", "1"}, {"to a surface", "1"}, {"to cloth", "1"}};
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
