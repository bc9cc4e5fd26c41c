// The map of error and cost over step and mesh, from ladders whose laws are known.
#include <catch2/catch.hpp>

#include "convergence/any_case/error_map.h"

namespace foldproof {

using Catch::Matchers::Contains;

namespace {

constexpr double motion = 0.7;                         // m
constexpr double step_error = 3e-3, step_order = 1.9;  // over the motion, at the case's own step
constexpr double mesh_error = 4e-2, mesh_order = 1.7;
constexpr double work_by_step = 0.9, work_by_edge = 2.4, longest_by_edge = 1.3;
constexpr double first_step = 5e-3, first_edge = 0.06;  // s, m
constexpr double first_work = 3000, particles = 60, seconds_by_work = 2e-6;

/// Four levels, coarse to fine, of errors that fall by these laws.
LadderAnswer ladder(const std::string& in, double as_it_is, double order) {
  const bool in_time = in == "time";
  LadderAnswer answer{"strip", "C", in, {}, {}, {}, std::vector<std::string>(4), {}};
  std::vector<double> d;  // differences between levels [m]
  for (int k = 0; k < 3; ++k)
    d.push_back(motion * as_it_is * (std::exp2(-order * k) - std::exp2(-order * (k + 1))));
  answer.quantities = {{"positions", "m", {}, d, error_bar({{}, d, 2, 2, 0}), 1}};
  for (int k = 0; k < 4; ++k) {
    answer.sizes.push_back(std::exp2(-k) * (in_time ? first_step : first_edge));
    answer.particles.push_back(int(particles) << (in_time ? 0 : 2 * k));
    answer.work.push_back(first_work * std::exp2(k * (in_time ? work_by_step : work_by_edge)) *
                          particles / answer.particles.back());
    answer.seconds.push_back(seconds_by_work * answer.cost(size_t(k)));
  }
  return answer;
}

LadderAnswer in_time() { return ladder("time", step_error, step_order); }

LadderAnswer in_space() {
  LadderAnswer answer = ladder("space", mesh_error, mesh_order);
  answer.mean_step = first_step * std::exp2(-3 * longest_by_edge);
  const double there = step_error * std::pow(answer.mean_step / first_step, step_order);
  answer.quantities[0].step_error = 1.5 * motion * there;
  return answer;
}

ErrorMap whole_map() { return error_map(in_time(), in_space(), motion); }

}  // namespace

TEST_CASE("a map has the laws of its ladders") {
  const ErrorMap map = whole_map();
  CHECK(map.step_error.as_it_is == Approx(step_error));
  CHECK(map.step_error.exponent == Approx(step_order));
  CHECK(map.mesh_error.as_it_is == Approx(mesh_error));
  CHECK(map.mesh_error.exponent == Approx(mesh_order));
  CHECK(map.work_by_step == Approx(work_by_step));
  CHECK(map.work_by_edge == Approx(work_by_edge));
  CHECK(map.longest_by_edge == Approx(longest_by_edge));
  CHECK(map.particles_by_edge == Approx(2));
  CHECK(map.step_error_ratio == Approx(1.5));
  CHECK(map.warnings.empty());
  CHECK(map.error(first_step / 4, first_edge / 2) ==
        Approx(step_error * std::pow(0.25, step_order) + mesh_error * std::pow(0.5, mesh_order)));
  CHECK(map.seconds(first_step / 4, first_edge / 2) ==
        Approx(seconds_by_work * first_work * particles * std::pow(4, work_by_step) *
               std::pow(2, work_by_edge)));
  CHECK(map.longest_step(first_edge / 2) == Approx(first_step * std::pow(0.5, longest_by_edge)));
}

TEST_CASE("the cheapest pair shares the error as the exponents demand") {
  ErrorMap map = whole_map();
  map.longest_by_edge = -9;  // no limit on the finer meshes
  // A r^p : B s^q = a/p : b/q where the cost r^-a s^-b is least
  const double of_step = work_by_step / step_order, of_mesh = work_by_edge / mesh_order;
  const CheapestPair pair = cheapest_pair(map, 1e-3);
  CHECK(map.error(pair.step, pair.edge) == Approx(1e-3).epsilon(1e-9));
  CHECK(map.step_error.at(pair.step / first_step) ==
        Approx(1e-3 * of_step / (of_step + of_mesh)).epsilon(0.05));
  CHECK(pair.halving_costs == Approx(std::exp2(of_step + of_mesh)).epsilon(1e-3));
  CHECK_FALSE(pair.is_limited_by_rule);
}

TEST_CASE("no step of a pair is longer than the case's own rule takes") {
  const ErrorMap map = whole_map();
  const CheapestPair pair = cheapest_pair(map, 1e-3), none = cheapest_pair(map, 1e-12);
  CHECK(pair.is_limited_by_rule);
  CHECK(pair.step == Approx(map.longest_step(pair.edge)));
  CHECK(map.error(pair.step, pair.edge) <= 1e-3);
  CHECK(std::isnan(none.edge));
  CHECK_THAT(map_in_words(map, {none}).back(), Contains("1e-10 %: no mesh of edges"));
}

TEST_CASE("positions without an order have no map, and the reason is told") {
  LadderAnswer coarse = in_space();
  coarse.quantities[0].bar = error_bar({{}, {1, 2, 4}, 2, 2, 0});
  const ErrorMap map = error_map(in_time(), coarse, motion);
  CHECK_THAT(map_in_words(map, {}).at(0), Contains("no order in space: differences between"));
  CHECK(map_study(map, {}).maps.empty());
  CHECK_THAT(error_map(in_time(), in_space(), 0).reason, Contains("nothing moves"));
}

TEST_CASE(
    "a map warns of orders that have not settled, and of steps that err otherwise elsewhere") {
  LadderAnswer rough = in_time(), other = in_space();
  rough.quantities[0].bar = error_bar({{}, {8, 4, 1}, 2, 2, 0});
  other.quantities[0].step_error *= 10;
  const ErrorMap map = error_map(rough, other, motion);
  CHECK_THAT(map.warnings.at(0), Contains("the order in time, 2.00, is not asymptotic"));
  CHECK_THAT(map.warnings.at(1), Contains("times as large on the second-finest mesh"));
}

TEST_CASE("a drawn map has lines of equal cost, and no error of steps that the rule refuses") {
  const ErrorMap map = whole_map();
  const Map drawn = map_study(map, {cheapest_pair(map, 1e-2)}).maps.at(0);
  REQUIRE(drawn.values.size() == drawn.x_values.size() * drawn.y_values.size());
  for (size_t k = 0; k < drawn.values.size(); ++k) {
    const double h = drawn.x_values[k % drawn.x_values.size()],
                 dx = drawn.y_values[k / drawn.x_values.size()];
    if (h > 1.01 * map.longest_step(dx)) CHECK(std::isnan(drawn.values[k]));
    if (h < 0.99 * map.longest_step(dx)) CHECK(drawn.values[k] == Approx(map.error(h, dx)));
  }
  const Curve& line = drawn.curves.at(0);  // ten times the cost of the case as it is, 0.36 s
  CHECK(line.label == "3.6 s");
  for (size_t k = 0; k < line.x.size(); ++k)
    CHECK(map.seconds(line.x[k], line.y[k]) == Approx(10 * map.seconds(first_step, first_edge)));
  CHECK(drawn.curves.back().label == "cheapest");
}

}  // namespace foldproof
