// Error bars of ladders whose limit is known.
#include <catch2/catch.hpp>

#include "convergence/any_case/error_bar.h"
#include "verification/evidence.h"

namespace foldproof {

using Catch::Matchers::Contains;

namespace {

ErrorBar bar_of(std::vector<double> values, double formal_order, double floor = 0) {
  return error_bar({std::move(values), {}, 2, formal_order, floor});
}

ErrorBar bar_of_differences(std::vector<double> differences, double formal_order = 2,
                            double floor = 0) {
  return error_bar({{}, std::move(differences), 2, formal_order, floor});
}

/// f at sizes 0.4, 0.2, ...
template <class F>
std::vector<double> ladder_of(const F& f, int levels) {
  std::vector<double> values;
  for (int k = 0; k < levels; ++k) values.push_back(f(0.4 / std::pow(2, k)));
  return values;
}

/// The largest error over bar, of values limit + h^p + c h^q that are read so; 0 if none.
double worst_share(double p, double q, double formal_order, int levels, Reading reading) {
  double worst = 0;
  for (int i = -80; i <= 81; ++i) {
    const double c = (i % 2 ? -1 : 1) * std::pow(10, i / 20.0);
    const auto values =
        ladder_of([&](double h) { return std::pow(h, p) + c * std::pow(h, q); }, levels);
    const ErrorBar bar = bar_of(values, formal_order);
    if (bar.reading == reading) worst = std::max(worst, std::abs(values.back()) / bar.half_width);
  }
  return worst;
}

}  // namespace

TEST_CASE("errors of one power are read as what they are") {
  for (const double order : {1.0, 2.0, 4.0})
    for (const double ratio : {2.0, 1.5}) {
      std::vector<double> values;
      for (int k = 0; k < 5; ++k) values.push_back(7.3 - 0.31 * std::pow(ratio, -k * order));
      const ErrorBar bar = error_bar({values, {}, ratio, order, 0});
      CHECK(bar.reading == Reading::asymptotic);
      REQUIRE(bar.orders.size() == 3);
      for (const double observed : bar.orders) CHECK(observed == Approx(order).epsilon(1e-8));
      CHECK(bar.limit == Approx(7.3).epsilon(1e-12));
      CHECK(bar.half_width == Approx(1.25 * (7.3 - values.back())).epsilon(1e-8));
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

TEST_CASE("an order above the method's is not used") {
  const ErrorBar bar = bar_of(ladder_of([](double h) { return 2 + std::pow(h, 4); }, 4), 1);
  CHECK(bar.order == Approx(4));
  CHECK(bar.half_width == Approx(1.25 * (std::pow(0.2, 4) - std::pow(0.1, 4)) / 2).epsilon(1e-10));
}

TEST_CASE("an order that falls is taken to fall once more") {
  // differences 1, 2^-1.9, 2^-3.7: orders 1.9 and 1.8, then 1.8 and 1.9
  for (const double order : {1.9, 1.8}) {
    const ErrorBar bar = bar_of_differences({1, std::pow(2, -order), std::pow(2, -3.7)});
    const double next = order > 1.85 ? 1.7 : 1.9;
    CHECK(bar.reading == Reading::asymptotic);
    CHECK(bar.half_width ==
          Approx(1.25 * std::pow(2, -3.7) / (std::pow(2, next) - 1)).epsilon(1e-12));
  }
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

TEST_CASE("without agreement of orders the bar is wide and of first order at most") {
  const ErrorBar bar = bar_of_differences({1, 0.5, 0.5 / 4});  // a kink: orders 1, 2
  CHECK(bar.reading == Reading::not_asymptotic);
  CHECK_THAT(bar.reason, Contains("changes from level to level"));
  CHECK(bar.half_width == Approx(3 * 0.25));
}

TEST_CASE("an order that settles far below the method's is not asymptotic") {
  // of a membrane held at points: 0.75, 0.72 where 2 is the formal order
  const std::vector<double> held = {1, std::pow(2, -0.75), std::pow(2, -1.47)};
  const ErrorBar bar = bar_of_differences(held);
  CHECK(bar.reading == Reading::not_asymptotic);
  CHECK(bar.reason == "settled at order 0.72, not at the formal 2");
  // the order fell by 0.03 and is taken to fall once more
  CHECK(bar.half_width == Approx(3 * std::pow(2, -1.47) / (std::pow(2, 0.69) - 1)));
  CHECK(bar_of_differences(held, 1.2).reading == Reading::asymptotic);
  // half an order below is near enough, as is any order above
  for (const double order : {1.51, 1.49})
    CHECK(bar_of(ladder_of([&](double h) { return std::pow(h, order); }, 4), 2).reading ==
          (order > 1.5 ? Reading::asymptotic : Reading::not_asymptotic));
}

TEST_CASE("three levels are asymptotic only with the method's own order") {
  CHECK(bar_of_differences({1, 0.25}).reading == Reading::asymptotic);
  CHECK(bar_of_differences({1, 0.5}).reading == Reading::not_asymptotic);
  CHECK_THAT(bar_of_differences({1, 0.5}).reason, Contains("not the method's own"));
}

TEST_CASE("differences that sink to the floor give no order, and a bar that is no less") {
  const auto f = [](double h) { return 3 + 1e-6 * h * h + 1e-9 * std::sin(1e4 * h); };
  const ErrorBar bar = bar_of(ladder_of(f, 9), 2, 1e-9);
  CHECK(bar.reading == Reading::inconclusive);
  CHECK_THAT(bar.reason, Contains("sunk to rounding"));
  CHECK(bar.half_width >= std::abs(f(0.4 / 256) - 3));
  CHECK(std::isnan(bar.order));
  CHECK(bar.orders.front() == Approx(2).margin(0.1));
  // the last difference is five floors: its sign says nothing yet
  CHECK(bar_of_differences({4, 1}, 2, 0.2).reading == Reading::inconclusive);
  CHECK(bar_of_differences({4, 1}, 2, 0.09).reading == Reading::asymptotic);
  CHECK(bar_of({5, 5, 5, 5}, 2, 1e-12).half_width == 1e-12);
  CHECK(bar_of_differences({1e4, 20}, 10, 1.9).half_width >= 1.9);
}

TEST_CASE("an oscillation has no order and a bar of its spread") {
  struct Ladder {
    std::vector<double> values;
    double half_width;
    const char* reason;
  };
  for (const Ladder& one : {Ladder{{1, 2, 1, 2}, 3, "change sign"},
                            {{1, 3, 2.5, 2.75}, 1.5, "change sign"},
                            {{1, 0, 0.9}, 3, "change sign"},
                            {{0, 1, 3, 7}, 12, "grow"},
                            {{0, 1, 1.9, 2.7}, 2.7, "hardly fall"},
                            {{1, 2, 2.5, nan}, nan, "came to no end"}}) {
    const ErrorBar bar = bar_of(one.values, 2);
    CHECK(bar.reading == Reading::inconclusive);
    CHECK_THAT(bar.reason, Contains(one.reason));
    CHECK((std::isnan(one.half_width) ? std::isnan(bar.half_width)
                                      : bar.half_width == Approx(one.half_width)));
    CHECK(std::isnan(bar.limit));
  }
  CHECK(bar_of({nan, 0, 1, 1.5, 1.75}, 1).reading == Reading::asymptotic);
}

}  // namespace foldproof
