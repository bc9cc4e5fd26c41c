// Sticking, limited springs, forecasts, depth maps, prisms, distances and dense algebra: answers
// worked out by hand or a second way.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "verification/oracles/cloth.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/depth_maps.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/forecast.h"
#include "verification/oracles/gauss.h"
#include "verification/oracles/limited_spring.h"
#include "verification/oracles/separated_triangles.h"
#include "verification/oracles/solid_prisms.h"
#include "verification/oracles/sticking.h"
#include "verification/oracles/triangle_distance.h"
#include "verification/oracles/triple.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

StuckParticle stuck_to_two() {
  return {Vector3(.31, .22, .57),
          {{Vector3(.1, .2, .3), Vector3(.9, .1, .4), Vector3(.2, .8, .1)},
           {Vector3(.2, .1, .6), Vector3(.7, .3, .5), Vector3(.1, .9, .8)}},
          {Vector3(.3, .2, .07), Vector3(.15, .45, -.04)},
          53,
          1.7};
}

Vector3 target_of(const StuckParticle& s) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 0; k < s.corners.size(); ++k) {
    const auto& [a, b, c] = s.corners[k];
    const Vector3& w = s.places[k];
    sum += a + w[0] * (b - a) + w[1] * (c - a) + w[2] * (b - a).cross(c - a).normalized();
  }
  return sum / double(s.corners.size());
}

double energy_of(const StuckParticle& s) {
  const double d2 = (target_of(s) - s.x).squaredNorm(), far2 = s.far * s.far;
  return s.stiffness * (d2 / 2 - d2 * d2 / (2 * far2) + d2 * d2 * d2 / (6 * far2 * far2));
}

/// Coordinate j of the particle and its corners, one after the other.
double& coordinate(StuckParticle& s, int j) {
  if (j < 3) return s.x[j];
  return s.corners[std::size_t((j - 3) / 9)][std::size_t((j - 3) % 9 / 3)][j % 3];
}

LimitedSpringInput limited() {
  return {Vector3(.1, .2, .3),
          Vector3(.9, -.2, .5),
          Vector3(-3, .4, .2),
          Vector3(4, -.3, 1.1),
          1.9,
          .7,
          .05,
          .5,
          1.05};
}

}  // namespace

TEST_CASE("a particle that sticks to one or two triangles is pulled down its energy's slope") {
  StuckParticle one = stuck_to_two();
  one.corners.pop_back();
  one.places.pop_back();
  for (const StuckParticle& s : {one, stuck_to_two()}) {
    const StickingAnswer answer = sticking_answer(s);
    const int count = int(s.corners.size()), size = 3 + 9 * count;
    REQUIRE(answer.force.size() == size);
    REQUIRE(answer.derivative.cols() == 9 * count);
    CHECK((answer.target - target_of(s)).norm() < 1e-15);
    const double d2 = (answer.target - s.x).squaredNorm();
    CHECK(answer.stiffness == Approx(53 * std::pow(1 - d2 / (1.7 * 1.7), 2)).epsilon(1e-13));
    CHECK(answer.energy == Approx(energy_of(s)).epsilon(1e-13));
    for (int j = 0; j < size; ++j) {
      StuckParticle ahead = s, behind = s;
      coordinate(ahead, j) += 1e-5;
      coordinate(behind, j) -= 1e-5;
      CHECK(std::abs(answer.force[j] + (energy_of(ahead) - energy_of(behind)) / 2e-5) < 1e-8);
      if (j >= 3)
        CHECK(
            (answer.derivative.col(j - 3) - (target_of(ahead) - target_of(behind)) / 2e-5).norm() <
            1e-9);
    }
  }
}

TEST_CASE("a spring beyond a limit is brought back to it, across itself untouched") {
  LimitedSpringInput input = limited();
  const Vector3 d = input.x_b - input.x_a, along = d.normalized();
  const auto predicted = [&](const Vector3& v_a, const Vector3& v_b) {
    return Vector3(d + input.step * (v_b - v_a));
  };
  const double length = predicted(input.v_a, input.v_b).norm();
  const auto kinetic = [&](const Vector3& v_a, const Vector3& v_b) {
    return v_a.squaredNorm() / (2 * input.inverse_mass_a) +
           v_b.squaredNorm() / (2 * input.inverse_mass_b);
  };
  for (const auto& [shortest, longest] :
       {std::pair{.5, .9 * length}, std::pair{1.1 * length, 3.}}) {
    input.shortest = shortest;
    input.longest = longest;
    const double limit = longest < length ? longest : shortest;
    const LimitedSpringAnswer answer = limited_spring(input);
    CHECK(answer.is_violated);
    CHECK(answer.is_reachable);
    CHECK(answer.length == Approx(limit).epsilon(1e-15));
    CHECK(predicted(answer.v_a, answer.v_b).norm() == Approx(limit).epsilon(1e-14));
    const Vector3 p_a = (answer.v_a - input.v_a) / 1.9, p_b = (answer.v_b - input.v_b) / .7;
    CHECK((p_a + p_b).norm() < 1e-14);
    CHECK(p_a.cross(along).norm() < 1e-14);
    CHECK(predicted(answer.v_a, answer.v_b).dot(d) > 0);
    CHECK(answer.energy_taken ==
          Approx(kinetic(input.v_a, input.v_b) - kinetic(answer.v_a, answer.v_b)).epsilon(1e-12));
    const double after = predicted(answer.v_a, answer.v_b).dot(along);
    CHECK(answer.sensitivity == Approx(std::max(1., limit / after)).epsilon(1e-12));
    CHECK(answer.sensitivity > 1);
  }
}

TEST_CASE("a spring within its limits, or at them, is left alone") {
  LimitedSpringInput input = limited();
  input.v_a = input.v_b = Vector3(.3, -.7, 1.1);
  input.x_a = Vector3(1, 2, 3);
  input.x_b = Vector3(4, 2, 7);
  for (const auto& [shortest, longest] : {std::pair{4., 6.}, {5., 6.}, {4., 5.}}) {
    input.shortest = shortest;
    input.longest = longest;
    const LimitedSpringAnswer answer = limited_spring(input);
    CHECK_FALSE(answer.is_violated);
    CHECK(answer.is_reachable);
    CHECK(answer.v_a == input.v_a);
    CHECK(answer.v_b == input.v_b);
    CHECK(answer.length == 5);
    CHECK(answer.energy_taken == 0);
    CHECK(answer.sensitivity == 1);
  }
  input.shortest = std::nextafter(5, 6);
  input.longest = 7;
  CHECK(limited_spring(input).is_violated);
  input.shortest = 3;
  input.longest = std::nextafter(5, 4);
  CHECK(limited_spring(input).is_violated);
}

TEST_CASE("a spring that turns beyond its longest comes as near as it can") {
  LimitedSpringInput input{
      Vector3(0, 0, 0), Vector3(3, 0, 0), Vector3(.2, 0, 0), Vector3(0, 8, 0), 0, .7, .5, 1, 3.5};
  const LimitedSpringAnswer answer = limited_spring(input);  // 4 m across by the end of the step
  CHECK(answer.is_violated);
  CHECK_FALSE(answer.is_reachable);
  CHECK(answer.length == 4);
  CHECK(answer.sensitivity == 1);
  CHECK(answer.v_a == input.v_a);  // prescribed
  // nothing of it is left along: 3 + .5 (v_b - .2) = 0
  CHECK((answer.v_b - Vector3(-5.8, 8, 0)).norm() < 1e-14);
  input.longest = 4;  // just reached, by nothing left along
  const LimitedSpringAnswer just = limited_spring(input);
  CHECK(just.is_reachable);
  CHECK(just.length == 4);
  CHECK(just.sensitivity == 1);
  CHECK((just.v_b - Vector3(-5.8, 8, 0)).norm() < 1e-14);
}

TEST_CASE("a forecast pushes out what would come in, and friction holds it at most") {
  ForecastInput at{.03, Vector3(0, 0, 1), Vector3(.5, 0, .2), Vector3(1.3, -.6, -4.8), .01, .3};
  const ForecastAnswer slides = forecast_answer(at);
  CHECK(slides.phi_new == Approx(.03 - .05).epsilon(1e-14));
  // pushed by 2 m/s, so .6 of the 1 m/s of sliding is lost
  CHECK((slides.v - Vector3(.5 + .4 * .8, -.4 * .6, -2.8)).norm() < 1e-14);
  at.friction = .5;
  CHECK((forecast_answer(at).v - Vector3(.5, 0, -2.8)).norm() < 1e-14);
  at.friction = .7;
  CHECK((forecast_answer(at).v - Vector3(.5, 0, -2.8)).norm() < 1e-14);
  at.v = Vector3(.5, 0, -4.8);  // straight in
  CHECK((forecast_answer(at).v - Vector3(.5, 0, -2.8)).norm() < 1e-14);
  at = {.5, Vector3(0, 0, 1), Vector3(0, 0, 0), Vector3(1, 2, -2), .25, .3};
  CHECK(forecast_answer(at).phi_new == 0);  // just reaches it
  CHECK(forecast_answer(at).v == at.v);
  at.phi = -.5;
  at.v.z() = 4;
  CHECK(forecast_answer(at).phi_new == .5);
  CHECK(forecast_answer(at).v == at.v);
}

TEST_CASE("depth maps climb from eps at the deepest to tau, where their slope is 1") {
  const Band band{.002, .013, .041};
  for (const auto& map : {power_map, blend_map}) {
    CHECK(map(band, -.041).value == Approx(.002).epsilon(1e-14));
    CHECK(map(band, .013).value == Approx(.013).epsilon(1e-14));
    CHECK((map(band, .013).value - map(band, .013 - 1e-7).value) / 1e-7 == Approx(1).epsilon(1e-5));
    CHECK(map(band, .004).uncertainty > 0);
    CHECK(map(band, .004).uncertainty < 1e-17);
    double before = 0;
    for (int i = 0; i <= 50; ++i) {
      const double now = map(band, -.041 + i * .054 / 50).value;
      CHECK(now > before);
      before = now;
    }
  }
  // (tau - eps) u^p with p = (tau + t^)/(tau - eps)
  CHECK(power_map(band, .001).value ==
        Approx(.002 + .011 * std::pow(.042 / .054, .054 / .011)).epsilon(1e-13));
  // slope m on .0485, then to 1 over w = .0055: m .0485 + .0055 (1 + m)/2 = .011
  const double m = (.011 - .00275) / (.0485 + .00275);
  CHECK(blend_map(band, -.01).value == Approx(.002 + m * .031).epsilon(1e-13));
  CHECK(blend_map(band, .0075).value == Approx(.002 + m * .0485).epsilon(1e-13));
  CHECK(blend_map(band, .010).value ==
        Approx(.002 + m * .051 + (1 - m) * .0025 * .0025 / .011).epsilon(1e-13));
}

TEST_CASE("a prism over a polygon with slanting sides is inside where all lattice points say") {
  // a triangle with a notch from below, not convex; sides at several slopes
  const std::vector<Whole2> polygon{{0, 0}, {5, 6}, {12, 1}, {9, 13}, {-3, 9}};
  const WholePrism prism{polygon, -2, 5};
  const auto by_angles = [&](long x, long y) {  // turns around the point
    double turn = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const double ax = double(polygon[i][0] - x), ay = double(polygon[i][1] - y),
                   bx = double(polygon[(i + 1) % 5][0] - x),
                   by = double(polygon[(i + 1) % 5][1] - y);
      const double cross = ax * by - ay * bx, dot = ax * bx + ay * by;
      if (cross == 0 && dot <= 0) return 0;  // on the side
      turn += std::atan2(cross, dot);
    }
    return turn > 3 ? 1 : -1;
  };
  for (long x = -5; x <= 14; ++x)
    for (long y = -2; y <= 15; ++y) {
      const int across = by_angles(x, y);
      for (const auto& [z, height] : {std::pair{-3l, -1}, {-2l, 0}, {1l, 1}, {5l, 0}, {6l, -1}}) {
        const int expected = std::min(across, height);
        REQUIRE(inside_prism(prism, {x, y, z}) == expected);
      }
    }
  CHECK(inside_nested({}, {1, 2, 3}) == -1);
  const WholePrism inner{{{4, 8}, {6, 8}, {6, 10}, {4, 10}}, 0, 3};
  CHECK(inside_nested({prism, inner}, {5, 9, 1}) == -1);
  CHECK(inside_nested({prism, inner}, {5, 9, 4}) == 1);
  CHECK(inside_nested({prism, inner}, {5, 9, 3}) == 0);
  CHECK(inside_nested({prism, inner}, {5, 9, 5}) == 0);
}

TEST_CASE("distances to several triangles are the least, with their own rounding") {
  PerParticle3 x(3, 5);
  x << 0, 4, 0, 9, 9, 0, 0, 4, 0, 5, 0, 0, 0, 0, 0;
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}, {1, 3, 4}};
  const auto to = [&](const Vector3& p) { return distance_to_triangles(x, triangles, p).value; };
  CHECK(to({1, 1, 7}) == Approx(7));
  CHECK(to({1, 1, -7}) == Approx(7));
  CHECK(to({-3, -4, 12}) == Approx(13));
  CHECK(to({2, -3, 4}) == Approx(5));
  CHECK(to({-3, 2, 4}) == Approx(5));
  CHECK(to({8, 1, 2}) == Approx(2));
  CHECK(to({12, 3, 4}) == Approx(5));
  CHECK(to({2, 2, 3}) == Approx(3));
  const Estimate far = distance_to_triangles(x, triangles, {3, 4, 0});
  CHECK(far.uncertainty ==
        Approx(64 * double(std::numeric_limits<long double>::epsilon()) * (5 + std::sqrt(106.))));
}

TEST_CASE("triangles are separated across either's plane, side or two sides") {
  const auto flat = [](double x, double y, double z) {
    return Corners3{Vector3(x, y, z), Vector3(x + 2, y, z), Vector3(x, y + 2, z)};
  };
  CHECK(normal_of(flat(3, 4, 5)) == Vector3(0, 0, 4));
  CHECK(are_separated(flat(0, 0, 0), flat(0, 0, 1)));
  CHECK(are_separated(flat(0, 0, 0), flat(3, 0, 0)));
  CHECK(are_separated(flat(0, 0, 0), flat(1.5, 1.5, 0)));
  CHECK_FALSE(are_separated(flat(0, 0, 0), flat(1, 1, 0)));  // touch
  CHECK_FALSE(are_separated(flat(0, 0, 0), flat(.5, .5, 0)));
  const Corners3 upright{Vector3(.5, .5, -1), Vector3(.5, .5, 1), Vector3(3, 3, 0)};
  CHECK_FALSE(are_separated(flat(0, 0, 0), upright));
  CHECK_FALSE(are_separated(upright, flat(0, 0, 0)));
  // edges that pass each other, as two sticks across
  const Corners3 stick{Vector3(-5, 0, 0), Vector3(5, 0, 0), Vector3(0, 0, -5)},
      other{Vector3(0, -5, .5), Vector3(0, 5, .5), Vector3(0, 0, 5)};
  CHECK(are_separated(stick, other));
}

TEST_CASE("inputs and answers of oracles begin with the paper's defaults, and zero") {
  CHECK(Estimate{}.value == 0);
  CHECK(Estimate{}.uncertainty == 0);
  const LimitedSpringAnswer spring{};
  CHECK((spring.is_violated && spring.is_reachable && spring.sensitivity == 1));
  const HingeInput hinge{};
  CHECK((hinge.ke == 0 && hinge.kd == 0 && hinge.theta0 == 0));
  CHECK(hinge.elastic_geometry == Geometry::rest);
  CHECK(hinge.damping_geometry == Geometry::current);
  CHECK(hinge.damping_factor == DampingFactor::edge_length);
  const ClothMaterial material{};
  CHECK((material.young == 0 && material.spring_damping == 0 && material.bending_stiffness == 0 &&
         material.bending_damping == 0));
  CHECK(material.elastic_geometry == Geometry::rest);
  CHECK(material.damping_geometry == Geometry::current);
  CHECK(material.damping_factor == DampingFactor::edge_length);
  const SpringDefinition edge{};
  CHECK((edge.a == 0 && edge.b == 0 && edge.rest_length == 0 && edge.area == 0));
  const HingeDefinition flat{};
  CHECK((flat.rest_angle == 0 && flat.rest_anisotropy == 0 && flat.rest_edge_length == 0));
  CHECK(Harmonic{}.frequency == 0);
  CHECK(Harmonic{}.phase == 0);
  const Oscillator oscillator{};
  CHECK((oscillator.stiffness == 0 && oscillator.damping == 0));
  CHECK((oscillator.x0 == 0 && oscillator.v0 == 0));
}

TEST_CASE("vectors over any scalar are added, scaled and multiplied") {
  const Triple<double> p{2, -3, 5}, q{7, 11, -13};
  CHECK(dot(p, q) == 14 - 33 - 65);
  const Triple<double> n = cross(p, q), half = p / 2., minus = -q, sum = p + q, off = p - q,
                       twice = 2. * q, one = unit(Triple<double>{3, 4, 12});
  CHECK((n.x == 39 - 55 && n.y == 35 + 26 && n.z == 22 + 21));
  CHECK((half.x == 1 && half.y == -1.5 && half.z == 2.5));
  CHECK((minus.x == -7 && minus.y == -11 && minus.z == 13));
  CHECK((sum.x == 9 && sum.y == 8 && sum.z == -8));
  CHECK((off.x == -5 && off.y == -14 && off.z == 18));
  CHECK((twice.x == 14 && twice.y == 22 && twice.z == -26));
  CHECK(length(Triple<double>{3, 4, 12}) == 13);
  CHECK((one.x == 3. / 13 && one.y == 4. / 13 && one.z == 12. / 13));
}

TEST_CASE("Gauss's sums integrate polynomials of degree 2 n - 1, and not of 2 n") {
  for (const int n : {1, 2, 5}) {
    const Gauss gauss(n);
    for (int degree = 0; degree <= 2 * n; ++degree) {
      const double off =
          gauss.weight.dot(gauss.s.unaryExpr([&](double s) { return std::pow(s, degree); })) -
          1. / (degree + 1);
      if (degree < 2 * n)
        CHECK(std::abs(off) < 1e-14);
      else
        CHECK(std::abs(off) > 1e-7);
    }
  }
}

TEST_CASE("dense algebra solves, decomposes and turns") {
  Eigen::Matrix3d A, K;
  A << 2, -1, .3, .7, 3, -2, 1.1, .4, 5;
  K << 4, .7, -.3, .7, 3, .5, -.3, .5, 2;
  const Eigen::Vector3d b(1.3, -.7, 2.9), masses(.3, 1.7, 2.9);
  CHECK((A * solve_linear(A, b) - b).norm() < 1e-14);
  CHECK((K * solve_symmetric(K, A) - A).norm() < 1e-14);
  CHECK(std::abs(eigenvalues(A).sum() - A.trace()) < 1e-13);
  CHECK(std::abs(eigenvalues(A).prod() - A.determinant()) < 1e-12);
  const Eigen::VectorXd values = symmetric_eigenvalues(K);
  CHECK(std::is_sorted(values.begin(), values.end()));
  CHECK((values - symmetric_modes(K).values).norm() < 1e-14);
  const SymmetricModes modes = symmetric_modes(K, masses);
  const Eigen::Matrix3d M = masses.asDiagonal();
  CHECK((K * modes.vectors - M * modes.vectors * modes.values.asDiagonal()).norm() < 1e-13);
  CHECK((modes.vectors.transpose() * M * modes.vectors - Eigen::Matrix3d::Identity()).norm() <
        1e-13);
  const SingularParts parts = singular_parts(A);
  CHECK((parts.U * parts.values.asDiagonal() * parts.V.transpose() - A).norm() < 1e-13);
  for (const auto& [from, to] : {std::pair{Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(-.4, .1, .7)},
                                 {Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(1e-5, 0, -3)},
                                 {Eigen::Vector3d(1, -2, .5), Eigen::Vector3d(-2, 4, -1)},
                                 {Eigen::Vector3d(1, -2, .5), Eigen::Vector3d(2, -4, 1)}}) {
    const Eigen::Quaterniond turn = rotation_between(from, to);
    CHECK(turn.norm() == Approx(1).epsilon(1e-15));
    CHECK((turn * from.normalized() - to.normalized()).norm() < 1e-12);
    // the smallest: its angle is that between them
    const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
    CHECK(2 * std::atan2(turn.vec().norm(), turn.w()) == Approx(angle).margin(1e-7));
  }
}
