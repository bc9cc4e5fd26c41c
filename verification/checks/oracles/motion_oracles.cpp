#include <complex>
#include <numbers>

#include "verification/checks/oracles/agreement.h"
#include "verification/oracles/amplification.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/forecast.h"
#include "verification/oracles/gsl.h"
#include "verification/oracles/limited_spring.h"
#include "verification/oracles/scalars.h"
#include "verification/oracles/stability.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

using oracles::Estimate;
using oracles::Oscillator;
using oracles::Scheme;
using Complex = std::complex<double>;

constexpr std::array<std::pair<Scheme, const char*>, 3> schemes{
    {{Scheme::mixed, "A"}, {Scheme::central_newmark, "B"}, {Scheme::variable_step_newmark, "C"}}};

/// Weakly, strongly and critically damped, at different time scales.
std::vector<std::pair<std::string, Oscillator>> oscillators() {
  return {{"zeta .15", {31, 1.7, .8, -.3}},
          {"zeta 2.7", {2.9, 9.1, -.4, 1.6}},
          {"zeta 1", {6.25, 5, .9, .7}},
          {"zeta .003", {840, .17, 1.3, 11}}};
}

/// One step of the scheme's lines as printed, on x'' = -k x - c x', in plain numbers. state: x, v.
template <class Scalar>
std::array<Scalar, 2> step_by_lines(Scheme scheme, const Oscillator& o, double h,
                                    const std::array<Scalar, 2>& state) {
  const Scalar half = Scalar(h) / 2, k = o.stiffness, c = o.damping, x = state[0], v = state[1];
  const auto explicit_half = [&](const Scalar& at, const Scalar& from) {
    return Scalar(from - half * (k * at + c * from));
  };
  const auto implicit_half = [&](const Scalar& at, const Scalar& from) {
    return Scalar((from - half * k * at) / (1 + half * c));
  };
  const Scalar v_move = scheme == Scheme::mixed ? explicit_half(x, v) : implicit_half(x, v);
  const Scalar x_next = x + 2 * half * v_move;
  if (scheme == Scheme::central_newmark)
    return {x_next, Scalar(v_move - half * (k * x_next + c * v_move))};
  return {x_next, implicit_half(x_next, explicit_half(x, v))};
}

/// The step's matrix, one column for each of two starts.
Eigen::Matrix2d matrix_by_lines(Scheme scheme, const Oscillator& o, double h) {
  const auto first = step_by_lines<double>(scheme, o, h, {1, 0}),
             second = step_by_lines<double>(scheme, o, h, {0, 1});
  Eigen::Matrix2d matrix;
  matrix << first[0], second[0], first[1], second[1];
  return matrix;
}

/// |1 + z + ... | of a Runge-Kutta method as the textbooks print its stages on y' =
/// z y, from y = 1.
double growth_by_stages(int order, Complex z) {
  if (order == 1) return std::abs(1.0 + z);
  if (order == 2) return std::abs(1.0 + z * (1.0 + z / 2.0));
  if (order == 3) {
    const Complex y1 = 1.0 + z, y2 = 0.75 + 0.25 * (y1 + z * y1);
    return std::abs(1.0 / 3 + 2.0 / 3 * (y2 + z * y2));
  }
  const Complex k2 = 1.0 + z / 2.0, k3 = 1.0 + z / 2.0 * k2, k4 = 1.0 + z * k3;
  return std::abs(1.0 + z / 6.0 * (1.0 + 2.0 * k2 + 2.0 * k3 + k4));
}

std::vector<oracles::ForecastInput> forecast_inputs() {
  Random random(827);
  std::vector<oracles::ForecastInput> list;
  for (const double friction : {0., .3, .3, 1.7, .05, 40.}) {
    const Vector3 normal = random.vectors(1, 1).col(0).normalized();
    const Vector3 v_object = random.vectors(1, .7).col(0);
    // the first two move away, the others hit the object
    const double towards = list.size() < 2 ? .9 : -random.uniform(.3, 3);
    list.push_back({random.uniform(-.002, .004), normal, v_object,
                    v_object + towards * normal + random.vectors(1, 1).col(0).cross(normal),
                    random.uniform(.01, .05), friction});
  }
  return list;
}

/// By the principle behind Coulomb's law: of all frictional impulses within the cone, take the one
/// with the least remaining sliding speed, by bisecting the angle in doubles.
Vector3 forecast_by_least_sliding(const oracles::ForecastInput& input) {
  const Vector3& N = input.normal;
  const double gap = input.phi + input.tau * (input.v - input.v_object).dot(N);
  if (gap >= 0) return input.v;
  const double push = -gap / input.tau, most = input.friction * push;
  const Vector3 pushed = input.v + push * N;
  const Vector3 relative = pushed - input.v_object, sliding = relative - relative.dot(N) * N;
  if (sliding.norm() <= most) return pushed - sliding;
  const Vector3 one = N.unitOrthogonal(), other = N.cross(one);
  const auto impulse = [&](double angle) {
    return Vector3(most * (std::cos(angle) * one + std::sin(angle) * other));
  };
  // derivative of the remaining speed by the angle, up to a positive factor
  const auto change = [&](double angle) {
    return (sliding + impulse(angle))
        .dot(Vector3(-std::sin(angle) * one + std::cos(angle) * other));
  };
  double start = std::atan2(-sliding.dot(other), -sliding.dot(one)) - .4, end = start + .9;
  for (int i = 0; i < 80; ++i) {
    const double middle = (start + end) / 2;
    (change(middle) < 0 ? start : end) = middle;
  }
  return pushed + impulse(start);
}

/// Springs beyond their limits, long and short, with free ends and with one held end.
std::vector<oracles::LimitedSpringInput> limited_spring_inputs() {
  Random random(829);
  std::vector<oracles::LimitedSpringInput> list;
  for (const bool is_long : {true, true, false, false}) {
    const double rest = random.uniform(.02, .3), h = random.uniform(.004, .02);
    const Vector3 x = random.vectors(1, .5).col(0),
                  d = rest * random.vectors(1, 1).col(0).normalized();
    const Vector3 across = random.vectors(1, 1).col(0).cross(d);
    const Vector3 gain = (is_long ? .2 : -.2) * d / h + (is_long ? .3 : .02) * across / h;
    list.push_back({x, x + d, Vector3(.3, -.2, .1), Vector3(.3, -.2, .1) + gain,
                    random.uniform(20, 900), list.size() % 2 == 0 ? random.uniform(20, 900) : 0, h,
                    .9 * rest, 1.1 * rest});
  }
  return list;
}

/// The impulse along d, by bracketing on the resulting length.
double length_error(const oracles::LimitedSpringInput& s, double impulse) {
  const Vector3 d = s.x_b - s.x_a, along = d.normalized();
  const Vector3 v_a = s.v_a - impulse * s.inverse_mass_a * along,
                v_b = s.v_b + impulse * s.inverse_mass_b * along;
  const double before = (d + s.step * (s.v_b - s.v_a)).norm();
  return (d + s.step * (v_b - v_a)).norm() - (before > s.longest ? s.longest : s.shortest);
}

void oscillators_agree(Answers& answers) {
  const std::array<double, 2> times{.37, 2.9};
  for (const auto& [name, o] : oscillators()) {
    const oracles::RightHandSide rhs = [&o = o](double, std::span<const double> y,
                                                std::span<double> dy) {
      dy[0] = y[1];
      dy[1] = -o.stiffness * y[0] - o.damping * y[1];
    };
    const std::array<double, 2> start{o.x0, o.v0};
    const oracles::ReferenceSolution solution =
        oracles::reference_solution(rhs, start, 0, times, 1e-13);
    for (const std::size_t i : {0, 1}) {
      const oracles::OscillatorEstimate exact = oracles::oscillator_at(o, times[i]);
      answers.compare_worst(name, {{exact.x, {solution.values[i][0], solution.uncertainty[i]}},
                                   {exact.v, {solution.values[i][1], solution.uncertainty[i]}}});
    }
  }
}

void verlet_oscillators_agree(Answers& answers) {
  for (const auto& [o, h] : {std::pair{Oscillator{29, 0, .7, -1.3}, .041},
                             std::pair{Oscillator{3.1, 0, -2.3, .6}, .93}}) {
    const oracles::OscillatorEstimate closed = oracles::verlet_oscillator(o, h, 1000);
    for (const auto& [scheme, name] : schemes) {
      std::array<oracles::Digits50, 2> state{o.x0, o.v0};
      for (int i = 0; i < 1000; ++i) state = step_by_lines(scheme, o, h, state);
      answers.compare_worst(
          std::string(name) + ", thousand steps of " + std::to_string(h) + " s",
          {{closed.x, oracles::rounded(state[0])}, {closed.v, oracles::rounded(state[1])}});
    }
  }
}

void step_matrices_agree(Answers& answers) {
  for (const auto& [o, h] : {std::pair{Oscillator{37.3, 2.9, .7, -1.9}, .11},
                             std::pair{Oscillator{.83, 7.1, 2.3, .4}, 1.7}})
    for (const auto& [scheme, name] : schemes) {
      const oracles::OscillatorEstimate stepped = oracles::stepped_oscillator(scheme, o, h);
      const auto lines = step_by_lines<oracles::Digits50>(scheme, o, h, {o.x0, o.v0});
      answers.compare_worst(
          std::string(name) + ", h " + std::to_string(h),
          {{stepped.x, oracles::rounded(lines[0])}, {stepped.v, oracles::rounded(lines[1])}});
    }
}

void stable_steps_agree(Answers& answers) {
  for (const Oscillator& o : {Oscillator{37.3, 2.9, 0, 0}, Oscillator{2.1, 1.7, 0, 0}}) {
    const Eigen::MatrixXd K = Eigen::MatrixXd::Constant(1, 1, o.stiffness),
                          C = Eigen::MatrixXd::Constant(1, 1, o.damping);
    for (const auto& [scheme, name] : schemes) {
      const Estimate closed = oracles::largest_stable_step(scheme, o);
      // there the step's matrix has the eigenvalue -1
      const auto determinant = [&o, scheme = scheme](double h) {
        return (matrix_by_lines(scheme, o, h) + Eigen::Matrix2d::Identity()).determinant();
      };
      Estimate root =
          oracles::bracketed_root(determinant, .7 * closed.value, 1.4 * closed.value, 0);
      root.uncertainty += 32 * epsilon * root.value;
      const std::string point = std::string(name) + ", k " + std::to_string(o.stiffness);
      answers.compare(point + ", closed form and lines of the scheme", closed, root);
      answers.compare(point + ", closed form and eigenvalues", closed,
                      scheme == Scheme::variable_step_newmark
                          ? oracles::largest_variable_newmark_step(K, C)
                          : oracles::largest_leapfrog_step(K));
    }
  }
}

void falls_agree(Answers& answers) {
  for (const double t : {.41, 1.3}) {
    const oracles::Launch launch{{.3, -2, 5}, {1.1, .4, -.7}, {.2, .5, -9.80665}};
    const oracles::FallEstimate fall = oracles::free_fall(launch, t);
    const oracles::RightHandSide rhs = [&](double, std::span<const double> y,
                                           std::span<double> dy) {
      for (int k = 0; k < 3; ++k) {
        dy[std::size_t(k)] = y[std::size_t(k + 3)];
        dy[std::size_t(k + 3)] = launch.g[k];
      }
    };
    const std::array<double, 6> start{.3, -2, 5, 1.1, .4, -.7};
    const auto solution =
        oracles::reference_solution(rhs, start, 0, std::array<double, 1>{t}, 1e-13);
    Pairs pairs;
    for (int k = 0; k < 3; ++k) {
      pairs.push_back({{fall.x[k], fall.x_uncertainty},
                       {solution.values[0][std::size_t(k)], solution.uncertainty[0] + 1e-14}});
      pairs.push_back({{fall.v[k], fall.v_uncertainty},
                       {solution.values[0][std::size_t(k + 3)], solution.uncertainty[0] + 1e-14}});
    }
    answers.compare_worst("t " + std::to_string(t), pairs);
  }
}

void rotation_lengths_agree(Answers& answers) {
  for (const auto& [pair, omega] : {std::pair{oracles::SpringPair{41, .13, .7, .05, .09}, 7.3},
                                    std::pair{oracles::SpringPair{9, 2.1, 1.6, .4, .23}, 1.9}}) {
    const double mass = pair.mass_a * pair.mass_b / (pair.mass_a + pair.mass_b);
    // of the spring over the force that the turn needs [N]
    const auto surplus = [&, pair = pair, omega = omega](double length) {
      return pair.young * pair.area / pair.rest_length * (length / pair.rest_length - 1) -
             mass * omega * omega * length;
    };
    Estimate root = oracles::bracketed_root(surplus, pair.rest_length, 50 * pair.rest_length, 0);
    root.uncertainty += 32 * epsilon * root.value;
    answers.compare("omega " + std::to_string(omega), oracles::steady_rotation_length(pair, omega),
                    root);
  }
}

// The product of the two factors is exp(-c h), and their sum is the trace of the step
// from two starts.
void amplification_factors_agree(Answers& answers) {
  for (const auto& [name, o] : oscillators()) {
    const double h = .3 / std::sqrt(o.stiffness);
    const oracles::Factors exact = oracles::exact_factors(o, h);
    const Complex sum = exact[0] + exact[1], product = exact[0] * exact[1];
    const double trace = oracles::oscillator_at({o.stiffness, o.damping, 1, 0}, h).x.value +
                         oracles::oscillator_at({o.stiffness, o.damping, 0, 1}, h).v.value;
    const double off = 20 * epsilon;
    answers.compare_worst(name + ", exact",
                          {{{sum.real(), off}, {trace, off}},
                           {{product.real(), off}, {std::exp(-o.damping * h), off}},
                           {{sum.imag(), off}, {0, off}}});
    for (const auto& [method, order] :
         {std::pair{"forward-euler", 1}, {"RK2", 2}, {"SSP-RK3", 3}, {"RK4", 4}}) {
      const oracles::Factors factors = oracles::step_factors(method, o, h);
      Pairs pairs;
      for (const std::size_t i : {0, 1})
        pairs.push_back(
            {{std::abs(factors[i]), off}, {growth_by_stages(order, std::log(exact[i])), off}});
      answers.compare_worst(name + ", " + method, pairs);
    }
  }
}

void runge_kutta_limits_agree(Answers& answers) {
  for (const double zeta : {.31, .74, 2.3})
    for (const int order : {1, 2, 3, 4}) {
      const double omega = 5.3;
      const std::vector<Complex> rates = oracles::oscillator_rates(omega, zeta);
      const Estimate limit = oracles::largest_runge_kutta_step(order, rates);
      // the rates of the same oscillator as the eigenvalues of its first-order system, the
      // growth by stages
      const std::vector<Complex> others =
          oracles::system_rates(Eigen::MatrixXd::Constant(1, 1, omega * omega),
                                Eigen::MatrixXd::Constant(1, 1, 2 * zeta * omega));
      const auto excess = [&](double h) {
        return std::max(growth_by_stages(order, h * others[0]),
                        growth_by_stages(order, h * others[1])) -
               1;
      };
      Estimate root = oracles::bracketed_root(excess, .6 * limit.value, 1.3 * limit.value, 0);
      root.uncertainty += 1e3 * epsilon * root.value;
      answers.compare("order " + std::to_string(order) + ", zeta " + std::to_string(zeta), limit,
                      root);
    }
}

void forecasts_agree(Answers& answers) {
  const std::vector<oracles::ForecastInput> inputs = forecast_inputs();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const oracles::ForecastAnswer answer = oracles::forecast_answer(inputs[i]);
    const Vector3 other = forecast_by_least_sliding(inputs[i]);
    const double speeds =
        inputs[i].v.norm() + inputs[i].v_object.norm() + std::abs(inputs[i].phi) / inputs[i].tau;
    Pairs pairs;  // the angle is found to a rounding of the turn, the normal is 1 to a rounding
    for (int k = 0; k < 3; ++k)
      pairs.push_back(
          {{answer.v[k], oracles::one_rounding(answer.v[k])}, {other[k], 32 * epsilon * speeds}});
    answers.compare_worst(
        "particle " + std::to_string(i + 1) + ", mu " + std::to_string(inputs[i].friction), pairs);
  }
}

void limited_springs_agree(Answers& answers) {
  const std::vector<oracles::LimitedSpringInput> inputs = limited_spring_inputs();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const oracles::LimitedSpringInput& s = inputs[i];
    const oracles::LimitedSpringAnswer answer = oracles::limited_spring(s);
    const Vector3 along = (s.x_b - s.x_a).normalized();
    const double sum = s.inverse_mass_a + s.inverse_mass_b, speed = (s.v_b - s.v_a).dot(along);
    // brings both ends together along d
    const double stop = (s.x_b - s.x_a).norm() / s.step / sum + speed / sum;
    const double low = speed > 0 ? -stop : 0,
                 high = speed > 0 ? 0 : 2 * (s.longest / s.step) / sum + std::abs(stop);
    const Estimate impulse =
        oracles::bracketed_root([&](double p) { return length_error(s, p); }, low, high, 0);
    const double off =
        answer.sensitivity * 64 * epsilon * (s.v_b.norm() + s.v_a.norm() + s.longest / s.step) +
        impulse.uncertainty * sum;
    const Vector3 v_a = s.v_a - impulse.value * s.inverse_mass_a * along;
    const Vector3 v_b = s.v_b + impulse.value * s.inverse_mass_b * along;
    Pairs pairs;
    for (int k = 0; k < 3; ++k) {
      pairs.push_back({{answer.v_a[k], oracles::one_rounding(answer.v_a[k])}, {v_a[k], off}});
      pairs.push_back({{answer.v_b[k], oracles::one_rounding(answer.v_b[k])}, {v_b[k], off}});
    }
    answers.compare_worst("spring " + std::to_string(i + 1), pairs);
  }
}

}  // namespace

std::vector<Comparison> motion_comparisons() {
  return {
      {"oracle.oscillators-agree",
       "The oracle's closed form of the damped oscillator is what GSL's Runge-Kutta methods find, "
       "weakly, critically and strongly damped.",
       oscillators_agree},
      {"oracle.verlet-oscillators-agree",
       "The oracle's closed form of velocity Verlet gives what a thousand undamped steps of "
       "schemes "
       "A, B and C give in 50 digits.",
       verlet_oscillators_agree},
      {"oracle.step-matrices-agree",
       "The oracle's step matrices are the printed lines of schemes A, B and C in 50 digits.",
       step_matrices_agree},
      {"oracle.stable-steps-agree",
       "At the oracle's closed-form stability limits the printed step has an eigenvalue -1, and "
       "the "
       "stiffness's eigenvalues give the same limits.",
       stable_steps_agree},
      {"oracle.free-falls-agree",
       "The oracle's free fall in closed form is what GSL's Runge-Kutta methods find.",
       falls_agree},
      {"oracle.turning-pair-lengths-agree",
       "At the oracle's closed-form length of a turning pair the spring's force is the centripetal "
       "force.",
       rotation_lengths_agree},
      {"oracle.amplification-factors-agree",
       "The oracle's factors of one step multiply and add up as the oscillator's, and agree with "
       "the "
       "methods' stages.",
       amplification_factors_agree},
      {"oracle.runge-kutta-limits-agree",
       "The oracle's stability limits of Runge-Kutta methods by polynomials and closed-form rates "
       "are those by stages and eigenvalues.",
       runge_kutta_limits_agree},
      {"oracle.forecasts-agree",
       "The oracle's forecast with Coulomb friction uses the impulse within the cone that leaves "
       "the "
       "least sliding speed.",
       forecasts_agree},
      {"oracle.strain-limiting-impulses-agree",
       "The oracle's strain-limiting impulse by Pythagoras is the root of the equation for the "
       "length after it.",
       limited_springs_agree}};
}

}  // namespace foldproof
