// Closed forms, differential equations and statics, each compared with a second way.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <tuple>

#include "verification/tests/hinge_specimens.h"
#include "verification/oracles/cloth.h"
#include "verification/oracles/definitions.h"
#include "verification/oracles/driven_hinge.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/gsl.h"
#include "verification/oracles/elastica.h"
#include "verification/oracles/heavy_cantilever.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

/// One step of the scheme's lines as printed, on x'' = -k x - c x', with numbers for a
/// and no algebra.
Eigen::Vector2d step_by_lines(Scheme scheme, const Oscillator& o, double h,
                              const Eigen::Vector2d& state) {
  const auto explicit_half = [&](double x, double v) {
    return v + h / 2 * (-o.stiffness * x - o.damping * v);
  };
  const auto implicit_half = [&](double x, double v) {
    return (v - h / 2 * o.stiffness * x) / (1 + h / 2 * o.damping);
  };
  const double x = state[0], v = state[1];
  const double v_move = scheme == Scheme::mixed ? explicit_half(x, v) : implicit_half(x, v);
  const double x_next = x + h * v_move;
  if (scheme == Scheme::central_newmark) {
    return {x_next, v_move + h / 2 * (-o.stiffness * x_next - o.damping * v_move)};
  }
  return {x_next, implicit_half(x_next, explicit_half(x, v))};
}

constexpr std::array<Scheme, 3> schemes{Scheme::mixed, Scheme::central_newmark,
                                        Scheme::variable_step_newmark};

double spectral_radius(const Eigen::Matrix2d& matrix) {
  return Eigen::EigenSolver<Eigen::Matrix2d>(matrix, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("step matrices are the scheme's lines, with the table's determinants and traces") {
  for (const auto& [o, h] :
       {std::pair{Oscillator{37.3, 2.9, 0, 0}, .11}, std::pair{Oscillator{.83, 7.1, 0, 0}, 1.7}}) {
    const double a = h * o.damping / 2, b = h * h * o.stiffness / 2, p = 1 + a;
    for (const Scheme scheme : schemes) {
      const Eigen::Matrix2d matrix = step_matrix(scheme, o, h);
      for (const Eigen::Vector2d& state : {Eigen::Vector2d(.7, -1.9), Eigen::Vector2d(2.3, .4)}) {
        CHECK((matrix * state - step_by_lines(scheme, o, h, state)).norm() <
              roundings * matrix.norm() * state.norm());
      }
      const bool is_c = scheme == Scheme::variable_step_newmark;
      const double determinant = (1 - a) / p + (is_c ? a * b / (p * p) : 0);
      const double trace = is_c ? (2 * p - b * (2 + a)) / (p * p) : 2 * (1 - b) / p;
      CHECK(std::abs(matrix.determinant() - determinant) < roundings * matrix.squaredNorm());
      CHECK(std::abs(matrix.trace() - trace) < roundings * matrix.norm());
      const double limit = largest_stable_step(scheme, o).value;
      CHECK(spectral_radius(step_matrix(scheme, o, limit * (1 - 1e-6))) < 1);
      CHECK(spectral_radius(step_matrix(scheme, o, limit * (1 + 1e-6))) > 1);
    }
  }
  const std::array<std::pair<double, double>, 6> table{
      {{0, 2.}, {.1, 2.21}, {.5, 3.2361}, {1, 4.8284}, {2, 8.4721}, {10, 40.10}}};
  for (const auto& [zeta, omega_h] : table) {
    const Oscillator o{49, 2 * zeta * 7, 0, 0};
    CHECK(std::abs(7 * largest_stable_step(Scheme::variable_step_newmark, o).value - omega_h) <
          5.1e-3);
  }
}

TEST_CASE("velocity Verlet's closed form is what a thousand undamped steps of every scheme give") {
  for (const auto& [o, h] : {std::pair{Oscillator{29, 0, .7, -1.3}, .041},
                             std::pair{Oscillator{3.1, 0, -2.3, .6}, .93}}) {
    const OscillatorEstimate expected = verlet_oscillator(o, h, 1000);
    for (const Scheme scheme : schemes) {
      Eigen::Vector2d state(o.x0, o.v0);
      for (int i = 0; i < 1000; ++i) state = step_by_lines(scheme, o, h, state);
      CHECK(std::abs(state[0] - expected.x.value) < 1000 * roundings);
      CHECK(std::abs(state[1] - expected.v.value) < 1000 * roundings * std::sqrt(o.stiffness));
    }
  }
}

TEST_CASE("GSL and the closed forms of the damped oscillator and of free fall agree") {
  const std::array<double, 2> times{.37, 2.9};
  for (const Oscillator& o : {Oscillator{31, 1.7, .8, -.3}, Oscillator{2.9, 9.1, -.4, 1.6},
                              Oscillator{6.25, 5, .9, .7}}) {
    const RightHandSide rhs = [&o](double, std::span<const double> y, std::span<double> dy) {
      dy[0] = y[1];
      dy[1] = -o.stiffness * y[0] - o.damping * y[1];
    };
    const std::array<double, 2> start{o.x0, o.v0};
    const ReferenceSolution solution = reference_solution(rhs, start, 0, times, 1e-13);
    for (std::size_t i : {0, 1}) {
      const OscillatorEstimate exact = oscillator_at(o, times[i]);
      CHECK(solution.uncertainty[i] < 2e-11);
      CHECK(std::abs(solution.values[i][0] - exact.x.value) <=
            solution.uncertainty[i] + exact.x.uncertainty);
      CHECK(std::abs(solution.values[i][1] - exact.v.value) <=
            solution.uncertainty[i] + exact.v.uncertainty);
    }
  }
  const FallEstimate fall =
      free_fall({Vector3(.3, -2, 5), Vector3(1.1, .4, -.7), Vector3(.2, .5, -9.80665)}, 1.3);
  CHECK((fall.x - Vector3(1.899, -1.0575, -4.19661925)).norm() < 1e-14);
  CHECK((fall.v - Vector3(1.36, 1.05, -13.448645)).norm() < 1e-14);
}

TEST_CASE("GSL's doors refuse what has no answer and pass exceptions on") {
  const std::array<double, 1> start{1}, times{2};
  const RightHandSide infinite = [](double, std::span<const double> y, std::span<double> dy) {
    dy[0] = y[0] * y[0];
  };
  const RightHandSide throwing = [](double, std::span<const double>, std::span<double>) {
    throw std::domain_error("own");
  };
  CHECK_THROWS_AS(reference_solution(infinite, start, 0, times, 1e-10), std::runtime_error);
  CHECK_THROWS_AS(reference_solution(throwing, start, 0, times, 1e-10), std::domain_error);
  CHECK_THROWS_AS(reference_solution(throwing, start, 3, times, 1e-10), InputError);
  const Estimate root = bracketed_root([](double x) { return x * x - 2; }, .3, 5, 0);
  CHECK(std::abs(root.value - std::numbers::sqrt2) <= root.uncertainty + roundings);
  CHECK_THROWS_AS(bracketed_root([](double x) { return x * x + 2; }, .3, 5, 0), InputError);
}

namespace {

/// H/L and W/L by shooting from the clamp with the curvature there as the unknown: the
/// equation as printed.
std::array<double, 2> cantilever_from_clamp(double gamma) {
  const auto integrate = [gamma](double curvature) {
    const RightHandSide rhs = [gamma](double s, std::span<const double> y, std::span<double> dy) {
      dy[0] = y[1];
      dy[1] = -gamma * (1 - s) * std::cos(y[0]);
      dy[2] = std::sin(y[0]);
      dy[3] = std::cos(y[0]);
    };
    const std::array<double, 4> clamp{0, curvature, 0, 0};
    return reference_solution(rhs, clamp, 0, std::array<double, 1>{1}, 1e-13).values[0];
  };
  const Estimate curvature =
      bracketed_root([&](double k) { return integrate(k)[1]; }, 0, gamma / 2 + .01, 1e-14);
  const std::vector<double> tip = integrate(curvature.value);
  return {tip[2], tip[3]};
}

}  // namespace

TEST_CASE("the heavy cantilever's tip is the table's, and that of shooting from the clamp") {
  const std::array<std::array<double, 3>, 5> table{{{1, .1234714020, .9912463953},
                                                    {5, .4959050446, .8466571800},
                                                    {10, .7001997155, .6563537612},
                                                    {100, .9375239354, .1592233826},
                                                    {1e4, .9941099339, .0142608898}}};
  for (const auto& [gamma, drop, reach] : table) {
    const CantileverTip tip = heavy_cantilever(gamma);
    CHECK(std::abs(tip.drop.value - drop) <= 5e-11 + tip.drop.uncertainty);
    CHECK(std::abs(tip.reach.value - reach) <= 5e-11 + tip.reach.uncertainty);
    CHECK(std::max(tip.drop.uncertainty, tip.reach.uncertainty) < 5e-11);  // the table's last digit
    if (gamma > 10) continue;
    const auto [other_drop, other_reach] = cantilever_from_clamp(gamma);
    CHECK(std::abs(tip.drop.value - other_drop) <= tip.drop.uncertainty + 1e-12);
    CHECK(std::abs(tip.reach.value - other_reach) <= tip.reach.uncertainty + 1e-12);
  }
  const auto slope = [](double gamma) {
    return heavy_cantilever(gamma).drop.value / heavy_cantilever(gamma).reach.value;
  };
  CHECK(std::abs(slope(1e-3) * 8 / 1e-3 - 1) < 1e-6);
  const double test_angle = std::tan(41.5 * pi / 180);
  const Estimate gamma =
      bracketed_root([&](double g) { return slope(g) - test_angle; }, 7, 9, 1e-9);
  CHECK(std::abs(gamma.value - 8.004197) < 5.1e-7);
}

TEST_CASE("loops without weight are as high as Peirce printed") {
  const std::array<double, 1> middle{.5};
  const auto height = [&](double first_slope, double turn) {
    const StripShape shape =
        strip_by_collocation({0, first_slope, {{first_slope + turn, 0, 0}}, 0}, middle);
    return -shape.points[0].up;
  };
  CHECK(std::abs(height(0, -2 * pi) - 1 / pi) < 1e-11);       // ring: a circle
  CHECK(std::abs(height(-pi / 2, -pi) - .4243) < 5e-5);       // pear loop
  CHECK(std::abs(height(pi / 2, -3 * pi) - .1337) < 2.5e-4);  // heart loop; ours is .13386
}

TEST_CASE("the strip of the elastica refuses weights and ends that it does not know") {
  const std::array<double, 1> middle{.5};
  CHECK_THROWS_AS(strip_by_collocation({-1, 0, {}, 0}, middle), InputError);
  CHECK_THROWS_AS(strip_by_collocation({2e5, 0, {}, 0}, middle), InputError);
  CHECK_THROWS_AS(strip_by_collocation({std::nan(""), 0, {}, 0}, middle), InputError);
  CHECK_THROWS_AS(strip_by_shooting({1, 0, {}, 0}, middle), InputError);
  // ends farther apart than the strip is long
  CHECK_THROWS_AS(strip_by_collocation({0, 0, {{0, 1.2, 0}}, 0}, middle), std::runtime_error);
}

namespace {

/// A corner shaken, a corner pushed by a force of time, an edge of which one end is
/// held: not autonomous.
DrivenHinge drive(const HingeInput& hinge) {
  DrivenHinge problem{hinge, .23, 31, .017, Vector3(.4, -.9, -9.80665), {}, {}};
  problem.prescribed[2] = fixed_motion(hinge.x[2]);
  problem.prescribed[1] = harmonic_motion({hinge.x[1], .1 * (hinge.x[1] - hinge.x[2]), 1.9, .6});
  problem.external_force = [](int particle, double t) {
    return Vector3(1e-2 * std::sin(5 * t), 3e-3 * particle, 1e-2 * t);
  };
  return problem;
}

/// The hinge at the state of the moment; the shaken corner is where its motion, written out, says.
HingeInput hinge_at(const HingeInput& start, double t) {
  HingeInput now = start;
  const Vector3 amplitude = .1 * (start.x[1] - start.x[2]);
  const double angle = 3.8 * pi * t + .6;
  now.x[1] += std::sin(angle) * amplitude;
  now.v[1] = 3.8 * pi * std::cos(angle) * amplitude;
  now.v[2].setZero();
  return now;
}

/// Accelerations of the four corners from the 50-digit forces, masses and areas by cross products.
Corners accelerations_50(const DrivenHinge& problem, const HingeInput& now, double t) {
  const Corners& rest = now.rest;
  const double first = .5 * (rest[0] - rest[2]).cross(rest[0] - rest[3]).norm();
  const double second = .5 * (rest[1] - rest[2]).cross(rest[1] - rest[3]).norm();
  Corners force = bending_elastic_50(now).value;
  for (int i = 0; i < 4; ++i)
    force[i] += bending_damping_50(now).value[i] + problem.external_force(i, t);
  for (const auto& [a, b, area] :
       {std::tuple{0, 2, first}, std::tuple{0, 3, first}, std::tuple{1, 2, second},
        std::tuple{1, 3, second}, std::tuple{2, 3, first + second}}) {
    const double length = (rest[a] - rest[b]).norm();
    const SpringInput spring{{now.x[a], now.x[b]},
                             {now.v[a], now.v[b]},
                             {problem.young, problem.spring_damping, area, length}};
    force[a] += spring_elastic_50(spring).value[0] + spring_damping_50(spring).value[0];
    force[b] += spring_elastic_50(spring).value[1] + spring_damping_50(spring).value[1];
  }
  const double third = problem.density / 3, both = first + second;
  return {force[0] / (third * first) + problem.gravity,
          force[1] / (third * second) + problem.gravity,
          force[2] / (third * both) + problem.gravity, force[3] / (third * both) + problem.gravity};
}

}  // namespace

TEST_CASE("a driven hinge accelerates as the 50-digit forces say, wherever the factors are taken") {
  constexpr double t = .31;
  for (HingeInput hinge : hinges()) {
    for (const int variant : {0, 1, 2, 3, 4, 5, 6, 7}) {
      hinge.elastic_geometry = variant & 1 ? Geometry::current : Geometry::rest;
      hinge.damping_geometry = variant & 2 ? Geometry::current : Geometry::rest;
      hinge.damping_factor = variant & 4 ? DampingFactor::anisotropy : DampingFactor::edge_length;
      const DrivenHinge problem = drive(hinge);
      const std::vector<double> y = driven_hinge_start(problem);
      std::vector<double> dy(y.size());
      cloth_rhs(driven_hinge(problem))(t, y, dy);
      const ClothState state = cloth_state(driven_hinge(problem), t, y);
      const HingeInput now = hinge_at(hinge, t);
      for (int i = 0; i < 4; ++i) {
        CHECK((state.x.col(i) - now.x[i]).norm() <= roundings * size(now.x));
        CHECK((state.v.col(i) - now.v[i]).norm() <= roundings * size(now.v));
      }
      const Corners expected = accelerations_50(problem, now, t);
      for (const auto& [corner, row] : {std::pair{0, 6}, std::pair{3, 9}}) {
        const Vector3 acceleration(dy[row], dy[row + 1], dy[row + 2]);
        CHECK((acceleration - expected[corner]).norm() < 10 * roundings * expected[corner].norm());
      }
    }
  }
}

TEST_CASE("a hinge with all corners free accelerates as the 50-digit forces say") {
  constexpr double t = .17;
  for (const HingeInput& hinge : hinges()) {
    DrivenHinge problem = drive(hinge);
    problem.prescribed.clear();
    std::vector<double> dy(24);
    cloth_rhs(driven_hinge(problem))(t, driven_hinge_start(problem), dy);
    const Corners expected = accelerations_50(problem, hinge, t);
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector3 velocity(dy[3 * i], dy[3 * i + 1], dy[3 * i + 2]);
      const Vector3 acceleration(dy[12 + 3 * i], dy[13 + 3 * i], dy[14 + 3 * i]);
      CHECK((velocity - hinge.v[i]).norm() == 0);
      CHECK((acceleration - expected[i]).norm() < 10 * roundings * expected[i].norm());
    }
  }
}

TEST_CASE(
    "a free hinge falls with its centre of mass, keeps its spin, and loses what damping takes") {
  for (const HingeInput& hinge : hinges()) {
    DrivenHinge problem = drive(hinge);
    problem.prescribed.clear();
    problem.external_force = nullptr;
    // the second hinge folds through pi at .077 s, where its energy jumps
    const double end_time = .07;
    const auto run = [end_time](const DrivenHinge& p) {
      const ClothDefinition cloth = driven_hinge(p);
      const std::array<double, 1> times{end_time};
      const auto solution =
          reference_solution(cloth_rhs(cloth), driven_hinge_start(p), 0, times, 1e-13);
      CHECK(solution.uncertainty[0] < 1e-9);
      return std::pair{cloth, cloth_state(cloth, times[0], solution.values[0])};
    };
    const auto [cloth, end] = run(problem);
    const ClothState start = cloth_state(cloth, 0, driven_hinge_start(problem));
    const Eigen::Map<const Eigen::VectorXd> m(cloth.masses.data(), 4);
    const Vector3 centre = start.x * m / m.sum(), drift = start.v * m / m.sum();
    CHECK((end.x * m / m.sum() - free_fall({centre, drift, problem.gravity}, end_time).x).norm() <
          1e-11);
    const auto spin = [&m](const ClothState& state) {
      const Vector3 x = state.x * m / m.sum(), v = state.v * m / m.sum();
      Vector3 total = Vector3::Zero();
      for (int i = 0; i < 4; ++i)
        total += m[i] * Vector3(state.x.col(i) - x).cross(Vector3(state.v.col(i) - v));
      return total;
    };
    CHECK((spin(end) - spin(start)).norm() < 1e-10 * spin(start).norm());
    CHECK(mechanical_energy(cloth, end) < mechanical_energy(cloth, start));
    problem.hinge.kd = problem.spring_damping = 0;
    const auto [undamped, undamped_end] = run(problem);
    const double energy = mechanical_energy(undamped, start);
    CHECK(std::abs(mechanical_energy(undamped, undamped_end) - energy) < 1e-10 * std::abs(energy));
  }
}

TEST_CASE("a pre-stretched pair turns steadily at the length of the closed form") {
  for (const auto& [pair, omega] : {std::pair{SpringPair{41, .13, .7, .05, .09}, 7.3},
                                    std::pair{SpringPair{9, 2.1, 1.6, .4, .23}, 1.9}}) {
    const double length = steady_rotation_length(pair, omega).value,
                 total = pair.mass_a + pair.mass_b;
    const double reach_a = length * pair.mass_b / total, reach_b = length * pair.mass_a / total;
    ClothDefinition cloth;
    cloth.masses = {pair.mass_a, pair.mass_b};
    cloth.springs = {{0, 1, pair.rest_length, pair.area}};
    cloth.material.young = pair.young;
    cloth.material.spring_damping = .3;
    const std::array<double, 12> start{reach_a,         0, 0, -reach_b,         0, 0, 0,
                                       omega * reach_a, 0, 0, -omega * reach_b, 0};
    const std::array<double, 1> times{2.3};
    const auto solution = reference_solution(cloth_rhs(cloth), start, 0, times, 1e-13);
    const Vector3 expected(reach_a * std::cos(2.3 * omega), reach_a * std::sin(2.3 * omega), 0);
    CHECK((cloth_state(cloth, 2.3, solution.values[0]).x.col(0) - expected).norm() <
          solution.uncertainty[0] + 1e-12);
    CHECK_THROWS_AS(steady_rotation_length(pair, 100 * omega), InputError);
  }
}

TEST_CASE(
    "an equilateral sheet's springs store the energy of Young's modulus Y and Poisson's ratio "
    "1/3") {
  for (const auto& [young, side] : {std::pair{7.9, .31}, std::pair{430., 1.7}}) {
    const SheetModuli moduli = equilateral_sheet_moduli(young);
    const double cell = std::sqrt(3.) / 2 * side * side, strain = 1e-5;
    const auto energy = [&, young = young, side = side](const Eigen::Matrix2d& stretch) {
      double sum = 0;
      for (const double turn : {.2, .2 + pi / 3, .2 + 2 * pi / 3}) {
        const Eigen::Vector2d d = stretch * side * Eigen::Vector2d(std::cos(turn), std::sin(turn));
        sum += spring_energy<double>({}, {d.x(), d.y(), 0}, {young, 0, cell, side});
      }
      return sum / cell;
    };
    const Eigen::Matrix2d unit = Eigen::Matrix2d::Identity();
    const double nu = moduli.poisson.value;
    const Eigen::Matrix2d uniaxial =
        unit + strain * Eigen::Vector2d(1, -nu).asDiagonal().toDenseMatrix();
    CHECK(std::abs(energy(uniaxial) / (strain * strain / 2) / moduli.young.value - 1) <
          10 * strain);
    const Eigen::Matrix2d equal = unit + strain * unit;
    CHECK(std::abs(energy(equal) / (strain * strain) * (1 - nu) / moduli.young.value - 1) <
          10 * strain);
  }
}
