// Closed forms, amplification factors and limits of stability: refused input, uncertainties, and
// known values.
#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
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
using Refused = std::vector<std::pair<std::function<void()>, std::string>>;

/// Each call is refused with a message that contains the text; "" stands for no refusal.
void check_refused(const Refused& rows) {
  for (const auto& [call, why] : rows) {
    INFO(why);
    const std::string said = complaint(call);
    CHECK_THAT(said, Catch::Contains(why));
    CHECK(said.empty() == why.empty());
  }
}

}  // namespace

TEST_CASE("closed forms of an oscillator name the quantity that they refuse") {
  Refused rows{{[] { step_matrix(Scheme(3), good, .1); }, "no such scheme"}};
  for (const double bad : {-1e-300, infinity, double(NAN)}) {
    rows.push_back({[=] { oscillator_at({bad, 0, .7, -1.3}, 1); }, "Oscillator"});
    rows.push_back({[=] { oscillator_at({37.3, bad, .7, -1.3}, 1); }, "Oscillator"});
    rows.push_back({[=] { oscillator_at(good, bad); }, "time must be"});
    rows.push_back({[=] { equilateral_sheet_moduli(bad); }, "young must be positive"});
  }
  rows.push_back({[] { step_matrix(Scheme::mixed, good, 0); }, "h must be positive"});
  const auto row = [&](const Oscillator& o, double h, long n, const char* why) {
    rows.push_back({[=] { verlet_oscillator(o, h, n); }, why});
  };
  row({4, 0, 1, infinity}, .5, 3, "x0 and v0 must be finite");
  row({4, 1e-9, 1, 2}, .5, 3, "damping must be 0");
  row({0, 0, 1, 2}, .5, 3, "stiffness must be positive");
  row({4, 0, 1, 2}, 0, 3, "h must be positive and n");
  row({4, 0, 1, 2}, .5, -1, "h must be positive and n");
  row({4, 0, 1, 2}, 1, 3, "omega h must be below 2");
  row({4, 0, 1, 2}, std::nextafter(1, 0), 3, "");
  check_refused(rows);
}

TEST_CASE("a fall is as sure as its largest coordinate, a pair turns as fast as its spring bears") {
  const Launch launch{Vector3(.3, -2, 5), Vector3(1.1, .4, -.7), Vector3(.2, .5, -9.8)};
  const FallEstimate fall = free_fall(launch, 1.3);
  CHECK(fall.x_uncertainty == one_rounding(fall.x.cwiseAbs().maxCoeff()));
  CHECK(fall.v_uncertainty == one_rounding(fall.v.cwiseAbs().maxCoeff()));
  Refused rows{{[=] { free_fall(launch, infinity); }, "time must be finite"}};
  const auto row = [&](const SpringPair& pair, double omega, const char* why) {
    rows.push_back({[=] { steady_rotation_length(pair, omega); }, why});
  };
  for (double SpringPair::*part : {&SpringPair::young, &SpringPair::area, &SpringPair::rest_length,
                                   &SpringPair::mass_a, &SpringPair::mass_b}) {
    SpringPair bad{41, .13, .7, .05, .09};
    bad.*part = 0;
    row(bad, 1, "must be positive");
  }
  row({1, 1, 1, 2, 2}, 1, "omega is too fast");  // m omega^2 L0^2 = Y A
  row({1, 1, 1, 2, 2}, 1 - 1e-12, "");
  row({1, 1, 1, 2, 2}, infinity, "omega must be finite");
  check_refused(rows);
  for (const double omega : {.6, -.6})
    CHECK(steady_rotation_length({1, 1, .7, 2, 2}, omega / .7).value ==
          Approx(.7 / .64).epsilon(1e-13));
}

TEST_CASE("amplification factors err by the method's order and one") {
  const Oscillator swing{7.1, .6, 0, 0};
  const std::array<std::vector<std::string>, 4> methods{
      {{"forward-euler", "backward-euler", "linear-backward-euler"},
       {"A", "B", "C", "RK2", "BDF2", "implicit-midpoint"},
       {"SSP-RK3"},
       {"RK4"}}};
  for (std::size_t order = 1; order <= 4; ++order)
    for (const std::string& method : methods[order - 1]) {
      INFO(method);
      for (const std::size_t i : {0, 1}) {
        const auto error = [&](double h) {
          return std::abs(step_factors(method, swing, h)[i] - exact_factors(swing, h)[i]);
        };
        CHECK(std::log2(error(.01) / error(.005)) == Approx(double(order + 1)).margin(.05));
      }
    }
  for (const auto& [name, scheme] : {std::pair{"A", Scheme::mixed},
                                     {"B", Scheme::central_newmark},
                                     {"C", Scheme::variable_step_newmark}}) {
    const Factors factors = step_factors(name, good, .21);
    const Eigen::Matrix2d matrix = step_matrix(scheme, good, .21);
    CHECK(std::abs(factors[0] + factors[1] - matrix.trace()) < 1e-14);
    CHECK(std::abs(factors[0] * factors[1] - matrix.determinant()) < 1e-14);
    CHECK(factors[0].imag() > 0);
  }
  check_refused({{[] { exact_factors(good, 0); }, "h must be > 0 s"},
                 {[] { step_factors("leapfrog", good, .1); }, "'leapfrog'"}});
}

TEST_CASE("rates of an oscillator are good when strongly damped, and those of a system too") {
  const auto fast = oscillator_rates(5, 1e9);
  CHECK(std::abs(fast[0] * fast[1] - 25.) < 1e-12);
  CHECK(fast[0].real() == Approx(-1e10).epsilon(1e-14));
  Eigen::MatrixXd K(2, 2), C(2, 2);
  K << 31, -7, -7, 13;
  C << 1.9, .3, .3, 5.7;
  const auto rates = system_rates(K, C);
  REQUIRE(rates.size() == 4);
  for (const auto& rate : rates) {
    const Eigen::Matrix2cd matrix = rate * rate * Eigen::Matrix2cd::Identity() + rate * C + K;
    CHECK(std::abs(matrix.determinant()) < 1e-10);
  }
  CHECK(std::abs(rates[0] + rates[1] + rates[2] + rates[3] + 7.6) < 1e-12);
  const Eigen::MatrixXd wide = Eigen::MatrixXd::Ones(2, 3), bad = K * NAN;
  check_refused({{[&] { system_rates(K, bad); }, "K and C must be finite"},
                 {[&] { system_rates(K, wide); }, "square and of one size"},
                 {[] { oscillator_rates(0, .3); }, "omega must be positive"},
                 {[] { oscillator_rates(3, -1e-9); }, "zeta must be at least 0"},
                 {[] { oscillator_rates(3, infinity); }, "zeta must be at least 0"}});
}

TEST_CASE("Runge-Kutta methods reach as far along both axes as the textbook says") {
  using Complex = std::complex<double>;
  const std::array<double, 4> real{2, 2, 2.5127453266183286, 2.7852935634052818},
      imaginary{0, 0, std::sqrt(3.), std::sqrt(8.)};
  for (const double scale : {37e3, .004})
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
  check_refused({{[] { largest_runge_kutta_step(0, {-1}); }, "order must be"},
                 {[] { largest_runge_kutta_step(5, {-1}); }, "order must be"},
                 {[] { largest_runge_kutta_step(2, {}); }, "one rate at least"}});
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
  const double ratio = bdf2_largest_ratio().value;
  CHECK(ratio * ratio / (1 + 2 * ratio) == Approx(1).epsilon(1e-15));
  CHECK(undamped_growth(0) == 1);
  CHECK(undamped_growth(1.2) == Approx(1 / .8).epsilon(1e-15));
  Refused rows{
      {[] { largest_leapfrog_step(Eigen::MatrixXd::Zero(2, 2)); }, "a positive eigenvalue"},
      {[] { largest_leapfrog_step(Eigen::MatrixXd(0, 0)); }, "K must be finite"},
      {[&] { largest_leapfrog_step(turned(9, NAN)); }, "K must be finite"}};
  for (const double bad : {-1e-9, 2., double(NAN)})
    rows.push_back({[=] { undamped_growth(bad); }, "at least 0 and below 2"});
  check_refused(rows);
}

TEST_CASE("a loaded tip needs a load within its bounds, and knows how sure it is") {
  for (const double alpha : {0., -1., std::nextafter(100, 101), double(NAN)})
    check_refused({{[=] { tip_load(alpha); }, "alpha must be in (0, 100]"},
                   {[=] { tip_load_by_shooting(alpha); }, "alpha must be in (0, 100]"}});
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
