// Limited springs, prisms, distances and dense algebra: answers worked out by hand.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/limited_spring.h"
#include "verification/oracles/solid_prisms.h"
#include "verification/oracles/triangle_distance.h"

using namespace foldproof;
using namespace foldproof::oracles;

TEST_CASE("a spring beyond a limit is brought back to it, and otherwise left alone") {
  LimitedSpringInput input{Vector3(1, 2, 3),
                           Vector3(4, 2, 7),
                           Vector3(.3, -.7, 1.1),
                           Vector3(.3, -.7, 1.1),
                           1.9,
                           .7,
                           .05,
                           4,
                           6};  // 5 m long
  for (const auto& [shortest, longest, is_violated] : {std::tuple{4., 6., false},
                                                       {5., 6., false},
                                                       {4., 5., false},
                                                       {std::nextafter(5, 6), 7., true},
                                                       {3., std::nextafter(5, 4), true}}) {
    input.shortest = shortest;
    input.longest = longest;
    const LimitedSpringAnswer answer = limited_spring(input);
    CHECK(answer.is_violated == is_violated);
    if (is_violated) continue;
    CHECK(answer.v_a == input.v_a);
    CHECK(answer.v_b == input.v_b);
    CHECK(answer.length == 5);
  }
  input.v_b += Vector3(4, -.3, 7);
  const auto kinetic = [](const Vector3& v_a, const Vector3& v_b) {
    return v_a.squaredNorm() / (2 * 1.9) + v_b.squaredNorm() / (2 * .7);
  };
  const Vector3 d = input.x_b - input.x_a;
  for (const auto& [shortest, longest] : {std::pair{3., 5.1}, std::pair{6., 7.}}) {
    input.shortest = shortest;
    input.longest = longest;
    const LimitedSpringAnswer answer = limited_spring(input);
    const double limit = longest < 6 ? longest : shortest;
    const Vector3 after = d + .05 * (answer.v_b - answer.v_a);
    CHECK(answer.is_reachable);
    CHECK(answer.length == Approx(limit).epsilon(1e-15));
    CHECK(after.norm() == Approx(limit).epsilon(1e-14));
    CHECK(answer.energy_taken ==
          Approx(kinetic(input.v_a, input.v_b) - kinetic(answer.v_a, answer.v_b)).epsilon(1e-12));
    CHECK(answer.sensitivity == Approx(limit / after.dot(d.normalized())).epsilon(1e-12));
  }
}

TEST_CASE("a spring that turns beyond its longest comes as near as it can") {
  LimitedSpringInput input{
      Vector3(0, 0, 0), Vector3(3, 0, 0), Vector3(.2, 0, 0), Vector3(0, 8, 0), 0, .7, .5, 1, 3.5};
  for (const double longest : {3.5, 4.}) {  // 4 m across by the end of the step
    input.longest = longest;
    const LimitedSpringAnswer answer = limited_spring(input);
    CHECK(answer.is_violated);
    CHECK(answer.is_reachable == (longest == 4));
    CHECK(answer.length == 4);
    CHECK(answer.sensitivity == 1);
    CHECK(answer.v_a == input.v_a);  // prescribed
    // nothing of it is left along: 3 + .5 (v_b - .2) = 0
    CHECK((answer.v_b - Vector3(-5.8, 8, 0)).norm() < 1e-14);
  }
}

TEST_CASE("nested prisms are inside by turns, and have both their floors") {
  // the outer one with a notch, the inner one above it
  const WholePrism outer{{{0, 0}, {5, 6}, {12, 1}, {9, 13}, {-3, 9}}, -2, 5},
      inner{{{4, 8}, {6, 8}, {6, 10}, {4, 10}}, 0, 3};
  CHECK(inside_nested({}, {1, 2, 3}) == -1);
  for (const auto& [z, side] : {std::pair{-3l, -1},
                                {-2l, 0},
                                {-1l, 1},
                                {0l, 0},
                                {1l, -1},
                                {3l, 0},
                                {4l, 1},
                                {5l, 0},
                                {6l, -1}})
    CHECK(inside_nested({outer, inner}, {5, 9, z}) == side);
  CHECK(inside_nested({outer, inner}, {5, 5, 1}) == -1);
}

TEST_CASE("distances to several triangles are the least, with their own rounding") {
  PerParticle3 x(3, 5);
  x << 0, 4, 0, 9, 9, 0, 0, 4, 0, 5, 0, 0, 0, 0, 0;
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}, {1, 3, 4}};
  for (const auto& [p, distance] : std::vector<std::pair<Vector3, double>>{
           {{1, 1, 7}, 7}, {{-3, -4, 12}, 13}, {{2, -3, 4}, 5}, {{8, 1, 2}, 2}, {{12, 3, 4}, 5}})
    CHECK(distance_to_triangles(x, triangles, p).value == Approx(distance));
  CHECK(distance_to_triangles(x, triangles, {3, 4, 0}).uncertainty ==
        Approx(64 * double(std::numeric_limits<long double>::epsilon()) * (5 + std::sqrt(106.))));
}

TEST_CASE("modes are orthogonal by masses, and turns between directions the smallest") {
  Eigen::Matrix3d K;
  K << 4, .7, -.3, .7, 3, .5, -.3, .5, 2;
  const Eigen::Vector3d masses(.3, 1.7, 2.9);
  CHECK((symmetric_eigenvalues(K) - symmetric_modes(K).values).norm() < 1e-14);
  const SymmetricModes modes = symmetric_modes(K, masses);
  const Eigen::Matrix3d M = masses.asDiagonal();
  CHECK((K * modes.vectors - M * modes.vectors * modes.values.asDiagonal()).norm() < 1e-13);
  CHECK((modes.vectors.transpose() * M * modes.vectors).isIdentity(1e-13));
  const Eigen::Vector3d from(1, -2, .5);
  for (const Eigen::Vector3d& to :
       {Eigen::Vector3d(-.4, .1, .7), Eigen::Vector3d(-2, 4, -1), Eigen::Vector3d(2, -4, 1)}) {
    const Eigen::Quaterniond turn = rotation_between(from, to);
    CHECK((turn * from.normalized() - to.normalized()).norm() < 1e-12);
    const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
    CHECK(2 * std::atan2(turn.vec().norm(), turn.w()) == Approx(angle).margin(1e-7));
  }
}
