// Error bars of ladders whose limit is known.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "convergence/any_case/error_bar.h"
#include "reference/types.h"
#include "verification/evidence.h"

namespace foldproof {

using Catch::Matchers::Contains;

namespace {

/// f at sizes 0.4, 0.4/ratio, ...
std::vector<double> ladder_of(const std::function<double(double)>& f, int levels,
                              double ratio = 2) {
  std::vector<double> values;
  for (int k = 0; k < levels; ++k) values.push_back(f(0.4 / std::pow(ratio, k)));
  return values;
}

ErrorBar bar_of(std::vector<double> values, double formal_order, double floor = 0) {
  return error_bar({std::move(values), {}, 2, formal_order, floor});
}

/// The largest error over bar, of values limit + h^p + c h^q that are read as asked; 0 if none.
double worst_share(double p, double q, double formal_order, int levels, Reading reading) {
  double worst = 0;
  for (const double sign : {-1.0, 1.0})
    for (int i = -40; i <= 40; ++i) {
      const double c = sign * std::pow(10, i / 10.0);
      const ErrorBar bar =
          bar_of(ladder_of([&](double h) { return std::pow(h, p) + c * std::pow(h, q); }, levels),
                 formal_order);
      const double h = 0.4 / std::pow(2, levels - 1);
      const double error = std::abs(std::pow(h, p) + c * std::pow(h, q));
      if (bar.reading == reading) worst = std::max(worst, error / bar.half_width);
    }
  return worst;
}

}  // namespace

TEST_CASE("errors of one power are read as what they are") {
  for (const double order : {1.0, 2.0, 4.0})
    for (const double ratio : {2.0, 1.5}) {
      const auto f = [&](double h) { return 7.3 - 0.31 * std::pow(h, order); };
      const ErrorBar bar = error_bar({ladder_of(f, 5, ratio), {}, ratio, order, 0});
      CHECK(bar.reading == Reading::asymptotic);
      CHECK(bar.reason.empty());
      REQUIRE(bar.orders.size() == 3);
      for (const double observed : bar.orders) CHECK(observed == Approx(order).epsilon(1e-8));
      CHECK(bar.limit == Approx(7.3).epsilon(1e-12));
      CHECK(bar.safety == 1.25);
      const double error = 0.31 * std::pow(0.4 / std::pow(ratio, 4), order);
      CHECK(bar.half_width == Approx(1.25 * error).epsilon(1e-8));
    }
}

TEST_CASE("the index and the limit of the NPARC example are reproduced") {
  // J. W. Slater, "Examining spatial (grid) convergence", NPARC alliance: pressure recovery on
  // three grids, r = 2; p = 1.78617, limit 0.97130, GCI 0.103083 %
  const ErrorBar bar = bar_of({0.96178, 0.96854, 0.97050}, 1.9);
  CHECK(bar.reading == Reading::asymptotic);
  CHECK(bar.order == Approx(1.786170).epsilon(1e-6));
  CHECK(bar.limit == Approx(0.971300).margin(5e-7));
  CHECK(bar.half_width / 0.97050 == Approx(0.00103083).epsilon(1e-5));
}

TEST_CASE("the index of the example of Celik et al. is reproduced") {
  // their table 1, reattachment length: 6.063 and 5.972 at r = 1.5, p = 1.53; limit 6.1685, GCI 2.2
  // %. Their third grid has another ratio; this one is put where p is theirs
  const double difference = 6.063 - 5.972;
  const ErrorBar bar =
      error_bar({{5.972 - difference * std::pow(1.5, 1.53), 5.972, 6.063}, {}, 1.5, 1.53, 0});
  CHECK(bar.order == Approx(1.53).epsilon(1e-10));
  CHECK(bar.limit == Approx(6.1685).margin(6e-4));  // p is printed with three digits
  CHECK(bar.half_width / 6.063 == Approx(0.022).margin(5e-4));
}

TEST_CASE("an order above the method's is not used") {
  const ErrorBar bar = bar_of(ladder_of([](double h) { return 2 + std::pow(h, 4); }, 4), 1);
  CHECK(bar.order == Approx(4));
  const double before = std::pow(0.2, 4) - std::pow(0.1, 4);
  CHECK(bar.half_width == Approx(1.25 * before / 2).epsilon(1e-10));
}

TEST_CASE("an order that falls is taken to fall once more") {
  // differences 1, 2^-1.9, 2^-3.7: orders 1.9 and 1.8
  const ErrorBar bar = error_bar({{}, {1, std::pow(2, -1.9), std::pow(2, -3.7)}, 2, 2, 0});
  CHECK(bar.reading == Reading::asymptotic);
  CHECK(bar.half_width == Approx(1.25 * std::pow(2, -3.7) / (std::pow(2, 1.7) - 1)).epsilon(1e-12));
  const ErrorBar rising = error_bar({{}, {1, std::pow(2, -1.8), std::pow(2, -3.7)}, 2, 2, 0});
  CHECK(rising.half_width ==
        Approx(1.25 * std::pow(2, -3.7) / (std::pow(2, 1.9) - 1)).epsilon(1e-12));
}

TEST_CASE("bars hold errors of two terms, whose orders may look alike by accident") {
  for (const int levels : {4, 5, 6})
    for (const double p : {1.0, 1.5, 2.0})
      for (const double more : {0.5, 1.0, 2.0, 3.0})
        for (const double formal : {p, 2.0})
          for (const Reading reading : {Reading::asymptotic, Reading::not_asymptotic}) {
            INFO(levels << " levels, h^" << p << " + c h^" << p + more << ", formal " << formal);
            CHECK(worst_share(p, p + more, formal, levels, reading) <= 1 + 1e-9);
          }
}

TEST_CASE("two terms that pass for one of high order are the known limit of the reading") {
  // h^0.5 hidden under c h^3.5, read by a method of order 4: no ladder of four levels shows it
  const double worst = worst_share(0.5, 3.5, 4, 4, Reading::asymptotic);
  CHECK(worst > 1);
  CHECK(worst < 3.5);
}

TEST_CASE("without agreement of orders the bar is wide and of first order at most") {
  const ErrorBar bar = error_bar({{}, {1, 0.5, 0.5 / 4}, 2, 2, 0});  // a kink: orders 1, 2
  CHECK(bar.reading == Reading::not_asymptotic);
  CHECK_THAT(bar.reason, Contains("changes from level to level"));
  CHECK(bar.safety == 3);
  CHECK(bar.half_width == Approx(3 * 0.25));
}

TEST_CASE("an order that settles far below the method's is not asymptotic") {
  // of a membrane held at points: 0.75, 0.72 where 2 is the formal order
  const ErrorBar held = error_bar({{}, {1, std::pow(2, -0.75), std::pow(2, -1.47)}, 2, 2, 0});
  CHECK(held.reading == Reading::not_asymptotic);
  CHECK(held.reason == "settled at order 0.72, not at the formal 2");
  CHECK(held.order == Approx(0.72));
  CHECK(held.safety == 3);
  // the order fell by 0.03 and is taken to fall once more
  CHECK(held.half_width == Approx(3 * std::pow(2, -1.47) / (std::pow(2, 0.69) - 1)));
  for (const double formal : {1.0, 1.2})
    CHECK(error_bar({{}, {1, std::pow(2, -0.75), std::pow(2, -1.47)}, 2, formal, 0}).reading ==
          Reading::asymptotic);
  // half an order below is near enough, as is any order above
  CHECK(bar_of(ladder_of([](double h) { return std::pow(h, 1.51); }, 4), 2).reading ==
        Reading::asymptotic);
  CHECK(bar_of(ladder_of([](double h) { return std::pow(h, 1.49); }, 4), 2).reading ==
        Reading::not_asymptotic);
}

TEST_CASE("three levels are asymptotic only with the method's own order") {
  CHECK(error_bar({{}, {1, 0.25}, 2, 2, 0}).reading == Reading::asymptotic);
  const ErrorBar first = error_bar({{}, {1, 0.5}, 2, 2, 0});
  CHECK(first.reading == Reading::not_asymptotic);
  CHECK_THAT(first.reason, Contains("not the method's own"));
}

TEST_CASE("differences that sink to the floor give no order, and a bar that is no less") {
  const auto f = [](double h) { return 3 + 1e-6 * h * h + 1e-9 * std::sin(1e4 * h); };
  const ErrorBar bar = bar_of(ladder_of(f, 9), 2, 1e-9);
  CHECK(bar.reading == Reading::inconclusive);
  CHECK_THAT(bar.reason, Contains("sunk to rounding"));
  CHECK(bar.half_width >= std::abs(f(0.4 / 256) - 3));
  CHECK(std::isnan(bar.order));
  CHECK(std::isnan(bar.orders.back()));
  CHECK(bar.orders.front() == Approx(2).margin(0.1));
  // the last difference is five floors: its sign says nothing yet
  CHECK(error_bar({{}, {4, 1}, 2, 2, 0.2}).reading == Reading::inconclusive);
  CHECK(error_bar({{}, {4, 1}, 2, 2, 0.09}).reading == Reading::asymptotic);
}

TEST_CASE("a value that never changes has a bar of the floor") {
  const ErrorBar bar = bar_of({5, 5, 5, 5}, 2, 1e-12);
  CHECK(bar.half_width == 1e-12);
  CHECK(bar.reading == Reading::inconclusive);
}

TEST_CASE("a bar is never less than the floor") {
  CHECK(error_bar({{}, {4, 1}, 2, 2, 0.0999}).half_width == Approx(1.25 / 3));
  CHECK(error_bar({{}, {1e4, 20}, 2, 10, 1.9}).half_width >= 1.9);
}

TEST_CASE("an oscillation has no order and a bar of its spread") {
  for (const std::vector<double>& values :
       {std::vector<double>{1, 2, 1, 2}, {1, 3, 2.5, 2.75}, {1, 0, 0.9}}) {
    const ErrorBar bar = bar_of(values, 2);
    CHECK(bar.reading == Reading::inconclusive);
    CHECK_THAT(bar.reason, Contains("change sign"));
    const size_t n = values.size();
    CHECK(bar.half_width == Approx(3 * std::max(std::abs(values[n - 1] - values[n - 2]),
                                                std::abs(values[n - 2] - values[n - 3]))));
    CHECK(std::isnan(bar.limit));
  }
}

TEST_CASE("differences that grow or hardly fall have no order") {
  const ErrorBar growing = bar_of({0, 1, 3, 7}, 2);
  CHECK_THAT(growing.reason, Contains("grow"));
  CHECK(growing.half_width == Approx(12));
  const ErrorBar slow = error_bar({{}, {1, 0.9, 0.8}, 2, 2, 0});
  CHECK_THAT(slow.reason, Contains("hardly fall"));
  CHECK(slow.half_width == Approx(2.7));
}

TEST_CASE("a level that stopped leaves no bar; an early one only its order") {
  const ErrorBar last = bar_of({1, 2, 2.5, nan}, 2);
  CHECK(last.reading == Reading::inconclusive);
  CHECK_THAT(last.reason, Contains("came to no end"));
  CHECK(std::isnan(last.half_width));
  CHECK(std::isnan(bar_of({1, nan, 2.5, 2.6}, 2).half_width));
  const ErrorBar early = bar_of({nan, 0, 1, 1.5, 1.75}, 1);
  CHECK(early.reading == Reading::asymptotic);
  CHECK(std::isnan(early.orders.front()));
}

TEST_CASE("a field has no limit, and else the bar of its differences") {
  const ErrorBar field = error_bar({{}, {0.4, 0.1, 0.025}, 2, 2, 0});
  CHECK(std::isnan(field.limit));
  CHECK(field.half_width == Approx(1.25 * 0.025 / 3));
}

TEST_CASE("what is no ladder is refused") {
  CHECK_THROWS_AS(bar_of({1, 2}, 2), InputError);
  CHECK_THROWS_AS(error_bar({{1, 2, 3}, {1}, 2, 2, 0}), InputError);
  CHECK_THROWS_AS(error_bar({{1, 2, 3, 4}, {1, 1}, 2, 2, 0}), InputError);
  for (const double ratio : {1.0, 0.5, nan})
    CHECK_THROWS_AS(error_bar({{}, {1, 0.5}, ratio, 2, 0}), InputError);
  for (const double formal : {0.0, -1.0, nan})
    CHECK_THROWS_AS(error_bar({{}, {1, 0.5}, 2, formal, 0}), InputError);
}

}  // namespace foldproof
