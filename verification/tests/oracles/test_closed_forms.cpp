// Closed forms and limits of stability: what they refuse, how sure they are, and values
// that are known.
#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "reference/types.h"
#include "verification/oracles/amplification.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/scalars.h"
#include "verification/oracles/stability.h"
#include "verification/oracles/tip_load.h"
#include "verification/tests/complaint.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const Oscillator good{37.3, 2.9, .7, -1.3};

std::string solutions(const std::string& what) { return "oracle exact_solutions: " + what; }
std::string stability(const std::string& what) { return "oracle stability: " + what; }

/// What all functions of an oscillator say, which is one text.
std::string of_oscillator(const Oscillator& o) {
  const std::string first = complaint([&] { oscillator_at(o, 1); });
  CHECK(first == complaint([&] { step_matrix(Scheme::mixed, o, .1); }));
  CHECK(first == complaint([&] { stepped_oscillator(Scheme::mixed, o, .1); }));
  CHECK(first == complaint([&] { largest_stable_step(Scheme::mixed, o); }));
  CHECK(first == complaint([&] { verlet_oscillator(o, .1, 3); }).substr(0, first.size()));
  return first;
}

}  // namespace

TEST_CASE("closed forms of an oscillator name the quantity that they refuse") {
  CHECK(of_oscillator(good).empty());
  for (const double bad : {-1e-300, double(NAN)}) {
    CHECK(of_oscillator({bad, 2.9, .7, -1.3}) ==
          solutions("Oscillator stiffness must be at least 0"));
    CHECK(of_oscillator({37.3, bad, .7, -1.3}) ==
          solutions("Oscillator damping must be at least 0"));
  }
  CHECK(of_oscillator({infinity, 2.9, .7, -1.3}) == solutions("Oscillator must be finite"));
  CHECK(of_oscillator({37.3, infinity, .7, -1.3}) == solutions("Oscillator must be finite"));
  for (const double bad : {infinity, double(NAN)}) {
    CHECK(of_oscillator({37.3, 2.9, bad, -1.3}) ==
          solutions("Oscillator x0 and v0 must be finite"));
    CHECK(of_oscillator({37.3, 2.9, .7, bad}) == solutions("Oscillator x0 and v0 must be finite"));
  }
  for (const double t : {-1e-9, infinity, double(NAN)})
    CHECK(complaint([&] { oscillator_at(good, t); }) ==
          solutions("time must be at least 0 and finite"));
  for (const double h : {0., -.1, infinity, double(NAN)})
    CHECK(complaint([&] { step_matrix(Scheme::central_newmark, good, h); }) ==
          solutions("step_matrix: h must be positive"));
  CHECK(complaint([] {
          largest_stable_step(Scheme::mixed, {0, 2.9, 0, 0});
        }) ==
        solutions("largest_stable_step: stiffness must be positive, else every step is stable"));
  CHECK_THROWS_WITH(step_matrix(Scheme(3), good, .1), solutions("step_matrix: no such scheme"));
}

TEST_CASE("velocity Verlet's closed form needs an undamped oscillator and a short step") {
  const auto of = [](const Oscillator& o, double h, long n) {
    return complaint([&] { verlet_oscillator(o, h, n); });
  };
  CHECK(of({4, 1e-9, 1, 2}, .5, 3) == solutions("verlet_oscillator: damping must be 0"));
  CHECK(of({0, 0, 1, 2}, .5, 3) == solutions("verlet_oscillator: stiffness must be positive"));
  const std::string step = solutions("verlet_oscillator: h must be positive and n at least 0");
  CHECK(of({4, 0, 1, 2}, 0, 3) == step);
  CHECK(of({4, 0, 1, 2}, .5, -1) == step);
  const std::string fast = solutions("verlet_oscillator: omega h must be below 2");
  CHECK(of({4, 0, 1, 2}, 1, 3) == fast);
  CHECK(of({4, 0, 1, 2}, std::nextafter(1, 0), 3).empty());
  const OscillatorEstimate start = verlet_oscillator({4, 0, 1.7, -2.3}, .5, 0);
  CHECK(start.x.value == 1.7);
  CHECK(start.v.value == -2.3);
  CHECK(start.x.uncertainty == one_rounding(1.7));
  CHECK(start.v.uncertainty == one_rounding(2.3));
}

TEST_CASE("an oscillator at the start is where it began, and free without a spring") {
  const OscillatorEstimate start = oscillator_at(good, 0);
  CHECK(start.x.value == .7);
  CHECK(start.v.value == -1.3);
  CHECK(start.x.uncertainty == one_rounding(.7));
  const OscillatorEstimate drift = oscillator_at({0, 0, .7, -1.3}, 2.5);
  CHECK(drift.x.value == Approx(.7 - 1.3 * 2.5).epsilon(1e-15));
  CHECK(drift.v.value == -1.3);
  // slowed down by damping alone
  const OscillatorEstimate slowed = oscillator_at({0, .8, .7, -1.3}, 2.5);
  CHECK(slowed.x.value == Approx(.7 - 1.3 / .8 * (1 - std::exp(-2.))).epsilon(1e-14));
  CHECK(slowed.v.value == Approx(-1.3 * std::exp(-2.)).epsilon(1e-14));
  // critically damped: (x0 + (v0 + g x0) t) e^{-g t}
  const OscillatorEstimate critical = oscillator_at({9, 6, .7, -1.3}, .4);
  CHECK(critical.x.value == Approx((.7 + (-1.3 + 3 * .7) * .4) * std::exp(-1.2)).epsilon(1e-14));
  CHECK(critical.v.value ==
        Approx((-1.3 - (9 * .7 - 3 * 1.3) * .4) * std::exp(-1.2)).epsilon(1e-14));
}

TEST_CASE("a fall needs finite numbers, and is as sure as its largest coordinate") {
  const Launch launch{Vector3(.3, -2, 5), Vector3(1.1, .4, -.7), Vector3(.2, .5, -9.8)};
  const FallEstimate fall = free_fall(launch, 1.3);
  CHECK(fall.x_uncertainty == one_rounding(fall.x.cwiseAbs().maxCoeff()));
  CHECK(fall.v_uncertainty == one_rounding(fall.v.cwiseAbs().maxCoeff()));
  CHECK(complaint([&] { free_fall(launch, infinity); }) ==
        solutions("free_fall: time must be finite"));
  for (Vector3 Launch::*part : {&Launch::x0, &Launch::v0, &Launch::g}) {
    Launch bad = launch;
    (bad.*part).z() = NAN;
    CHECK(complaint([&] { free_fall(bad, 1); }) == solutions("free_fall: Launch must be finite"));
  }
}

TEST_CASE("a turning pair needs positive numbers, and a spin that its spring bears") {
  const SpringPair pair{41, .13, .7, .05, .09};
  // m omega^2 L0^2 = Y A
  const double limit = std::sqrt(41 * .13 / (.05 * .09 / .14 * .49));
  CHECK(steady_rotation_length(pair, limit * .6).value == Approx(.7 / .64).epsilon(1e-13));
  CHECK(steady_rotation_length(pair, -limit * .6).value == Approx(.7 / .64).epsilon(1e-13));
  CHECK(steady_rotation_length(pair, 0).value == .7);
  CHECK(steady_rotation_length(pair, 0).uncertainty == one_rounding(.7));
  const std::string fast = solutions(
      "steady_rotation_length: omega is too fast for the spring, lower it or stiffen the spring");
  CHECK(complaint([&] { steady_rotation_length(pair, limit * (1 + 1e-12)); }) == fast);
  CHECK(complaint([&] { steady_rotation_length(pair, limit * (1 - 1e-12)); }).empty());
  CHECK(complaint([] { steady_rotation_length({1, 1, 1, 2, 2}, 1); }) == fast);  // just there
  CHECK(complaint([&] { steady_rotation_length(pair, infinity); }) ==
        solutions("steady_rotation_length: omega must be finite"));
  for (double SpringPair::*part :
       {&SpringPair::young, &SpringPair::area, &SpringPair::rest_length}) {
    SpringPair bad = pair;
    bad.*part = 0;
    CHECK(complaint([&] { steady_rotation_length(bad, 1); }) ==
          solutions("SpringPair young, area, rest_length must be positive"));
  }
  for (double SpringPair::*part : {&SpringPair::mass_a, &SpringPair::mass_b}) {
    SpringPair bad = pair;
    bad.*part = 0;
    CHECK(complaint([&] { steady_rotation_length(bad, 1); }) ==
          solutions("SpringPair masses must be positive"));
  }
  for (const double young : {0., -2., infinity, double(NAN)})
    CHECK(complaint([&] { equilateral_sheet_moduli(young); }) ==
          solutions("equilateral_sheet_moduli: young must be positive"));
  CHECK(equilateral_sheet_moduli(7.9).young.value == 7.9);
  CHECK(equilateral_sheet_moduli(7.9).poisson.value == 1. / 3);
}

TEST_CASE("amplification factors need a step and an oscillator that does not grow") {
  for (const double h : {0., -.1, double(NAN)})
    CHECK_THROWS_WITH(exact_factors(good, h), "oracle amplification: the step h must be > 0 s");
  const std::string why =
      "oracle amplification: Oscillator stiffness and damping must be at least 0";
  CHECK_THROWS_WITH(exact_factors({-1, 2, 0, 0}, .1), why);
  CHECK_THROWS_WITH(exact_factors({1, -2, 0, 0}, .1), why);
  CHECK_THROWS_WITH(step_factors("leapfrog", good, .1),
                    "oracle amplification: no factors are known of the method 'leapfrog'");
  // without forces nothing changes; without a spring one mode decays
  const Factors still = exact_factors({0, 0, 0, 0}, .3), slowed = exact_factors({0, 2, 0, 0}, .3);
  CHECK(std::abs(still[0] - 1.0) + std::abs(still[1] - 1.0) < 1e-15);
  CHECK(std::abs(slowed[0] - 1.0) < 1e-15);
  CHECK(std::abs(slowed[1] - std::exp(-.6)) < 1e-15);
  for (const auto& [name, scheme] : {std::pair{"A", Scheme::mixed},
                                     {"B", Scheme::central_newmark},
                                     {"C", Scheme::variable_step_newmark}}) {
    const Factors factors = step_factors(name, {37.3, 2.9, 0, 0}, .21);
    const Eigen::Matrix2d matrix = step_matrix(scheme, good, .21);
    CHECK(std::abs(factors[0] + factors[1] - matrix.trace()) < 1e-14);
    CHECK(std::abs(factors[0] * factors[1] - matrix.determinant()) < 1e-14);
    CHECK(factors[0].imag() > 0);
  }
}

TEST_CASE("rates of an oscillator solve its quadratic equation, and those of a system too") {
  for (const auto& [omega, zeta] :
       {std::pair{3.7, .3}, {3.7, 1.}, {.9, 4.1}, {2.1, 0.}, {5., 1e9}}) {
    const auto rates = oscillator_rates(omega, zeta);
    REQUIRE(rates.size() == 2);
    for (const auto& rate : rates)
      CHECK(std::abs(rate * rate + 2 * zeta * omega * rate + omega * omega) <
            1e-14 * (std::norm(rate) + omega * omega));
    CHECK(std::abs(rates[0] * rates[1] - omega * omega) < 1e-14 * omega * omega);
    CHECK(std::abs(rates[0] + rates[1] + 2 * zeta * omega) < 1e-14 * omega * (1 + zeta));
    if (zeta < 1) CHECK(rates[0].imag() > 0);
    if (zeta > 1) CHECK(rates[0].real() < rates[1].real());
  }
  const std::string omega = stability("omega must be positive and finite"),
                    zeta = stability("zeta must be at least 0 and finite");
  for (const double bad : {0., -1., infinity, double(NAN)})
    CHECK(complaint([&] { oscillator_rates(bad, .3); }) == omega);
  for (const double bad : {-1e-9, infinity, double(NAN)})
    CHECK(complaint([&] { oscillator_rates(3, bad); }) == zeta);

  Eigen::Matrix2d K, C;
  K << 31, -7, -7, 13;
  C << 1.9, .3, .3, 5.7;
  const auto rates = system_rates(K, C);
  REQUIRE(rates.size() == 4);
  for (const auto& rate : rates) {
    const Eigen::Matrix2cd matrix = rate * rate * Eigen::Matrix2cd::Identity() + rate * C + K;
    CHECK(std::abs(matrix.determinant()) < 1e-10);
  }
  CHECK(std::abs(rates[0] + rates[1] + rates[2] + rates[3] + 7.6) < 1e-12);
  const std::string finite = stability("K and C must be finite"),
                    square = stability("K and C must be square and of one size");
  Eigen::MatrixXd bad = K;
  bad(0, 1) = NAN;
  CHECK(complaint([&] { system_rates(bad, C); }) == finite);
  CHECK(complaint([&] { system_rates(K, bad); }) == finite);
  CHECK(complaint([&] { system_rates(Eigen::MatrixXd::Ones(2, 3), C); }) == square);
  CHECK(complaint([&] { system_rates(K, Eigen::MatrixXd::Ones(2, 3)); }) == square);
  CHECK(complaint([&] { system_rates(K, Eigen::MatrixXd::Ones(3, 2)); }) == square);
}

TEST_CASE("Runge-Kutta methods reach as far along both axes as the textbook says") {
  const std::array<double, 4> real{2, 2, 2.5127453266183286, 2.7852935634052818},
      imaginary{0, 0, std::sqrt(3.), std::sqrt(8.)};
  using Complex = std::complex<double>;
  for (const double scale : {1., 37e3, .004}) {
    for (int order = 1; order <= 4; ++order) {
      const double along = real[std::size_t(order - 1)], up = imaginary[std::size_t(order - 1)];
      const Estimate h = largest_runge_kutta_step(order, {-scale, -.3 * scale});
      CHECK(h.value * scale == Approx(along).epsilon(2e-10));
      CHECK(h.uncertainty * scale == Approx(1e-10 * along).epsilon(1e-3));
      const Estimate swing =
          largest_runge_kutta_step(order, {Complex(0, scale), Complex(0, -scale)});
      CHECK(swing.value * scale == Approx(up).margin(1e-6));
      if (up == 0) CHECK(swing.uncertainty == 0);
    }
  }
  for (const int order : {0, 5})
    CHECK(complaint([&] { largest_runge_kutta_step(order, {-1}); }) ==
          stability("order must be 1, 2, 3 or 4"));
  CHECK(complaint([] {
          largest_runge_kutta_step(2, {0, 0});
        }) == stability("one rate at least must not vanish"));
  CHECK(complaint([] {
          largest_runge_kutta_step(2, {-1, -infinity});
        }) == stability("rates must be finite"));
}

TEST_CASE("leapfrogs are stable as long as their formulas say, in any coordinates") {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(.7).toRotationMatrix();
  const auto turned = [&](double a, double b) {
    return Eigen::MatrixXd(turn * Eigen::Vector2d(a, b).asDiagonal() * turn.transpose());
  };
  const Estimate plain = largest_leapfrog_step(turned(9, 49));
  CHECK(plain.value == Approx(2 / 7.).epsilon(1e-13));
  CHECK(plain.uncertainty == Approx(2 * 2.220446049250313e-16 * plain.value).epsilon(1e-9));
  for (const auto& [k, c] : {std::pair{49., 3.}, {49., 90.}, {49., 1e5}, {.3, .2}, {7., 0.}}) {
    const double limit = (c + std::sqrt(c * c + 4 * k)) / k;
    // the other mode, softer and as damped, is stable for longer
    const Estimate h = largest_variable_newmark_step(turned(k, k / 5), turned(c, c));
    CHECK(h.value == Approx(limit).epsilon(1e-9));
    CHECK(h.uncertainty < 2e-10 * limit);
    CHECK(h.uncertainty >= 1e-10 * h.value);
  }
  CHECK(complaint([] { largest_leapfrog_step(Eigen::MatrixXd::Zero(2, 2)); }) ==
        stability("K must have a positive eigenvalue"));
  CHECK(complaint([] { largest_leapfrog_step(Eigen::MatrixXd(0, 0)); }) ==
        stability("K must be finite"));
  Eigen::MatrixXd bad = turned(9, 49);
  bad(1, 0) = NAN;
  CHECK(complaint([&] { largest_leapfrog_step(bad); }) == stability("K must be finite"));

  const double ratio = bdf2_largest_ratio().value;
  CHECK(ratio * ratio / (1 + 2 * ratio) == Approx(1).epsilon(1e-15));
  CHECK(bdf2_largest_ratio().uncertainty == std::numeric_limits<double>::epsilon());
  CHECK(undamped_growth(0) == 1);
  CHECK(undamped_growth(1.2) == Approx(1 / .8).epsilon(1e-15));
  for (const double bad_step : {-1e-9, 2., double(NAN)})
    CHECK(complaint([&] { undamped_growth(bad_step); }) ==
          stability("omega h must be at least 0 and below 2"));
}

TEST_CASE("a loaded tip needs a load within its bounds, and knows how sure it is") {
  for (const double alpha : {0., -1., std::nextafter(100, 101), double(NAN)}) {
    const std::string why = "oracle tip_load: alpha must be in (0, 100]";
    CHECK_THROWS_WITH(tip_load(alpha), why);
    CHECK_THROWS_WITH(tip_load_by_shooting(alpha), why);
  }
  for (const double alpha : {.01, .7, 6., 37., 100.}) {
    const LoadedTip one = tip_load(alpha), other = tip_load_by_shooting(alpha);
    for (const auto& [p, q] :
         {std::pair{one.drop, other.drop}, std::pair{one.reach, other.reach}}) {
      CHECK(std::abs(p.value - q.value) <= p.uncertainty + q.uncertainty);
      CHECK(p.uncertainty >= 1e-13);
      CHECK(p.uncertainty < 1e-9);
      CHECK(q.uncertainty > 1e-14);
      CHECK(q.uncertainty < 2e-7);
    }
  }
}
