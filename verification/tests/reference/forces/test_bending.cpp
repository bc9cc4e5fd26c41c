// Bending forces, energies, dampers and bounds against the formulas of bending.h and
// the 50-digit mode.
#include <catch2/catch.hpp>
#include <limits>

#include "reference/forces/degenerate.h"
#include "reference/mesh/shapes.h"
#include "verification/tests/hinge_specimens.h"
#include "verification/tests/reference/forces/bending_specimen.h"
#include "verification/tests/reference/forces/at_state.h"

using namespace foldproof;

namespace {

using Modes = std::array<Vector3, 4>;

Modes modes_of(const BendingHinge& hinge, const PerParticle3& x) {
  return oracles::bending_mode_50(corners_of(hinge, x)).value;
}

double angle_at(const BendingHinge& hinge, const PerParticle3& x) {
  return oracles::hinge_angle_50(corners_of(hinge, x)).value;
}

double magnitude_of(const BendingMaterial& material, const BendingHinge& hinge,
                    const PerParticle3& x) {
  const double theta = angle_at(hinge, x);
  return material.law == "sine" ? sine_law(theta, hinge.rest_angle)
                                : cubic_law(theta, hinge.rest_angle);
}

double elastic_factor(const BendingMaterial& material, const BendingHinge& hinge,
                      const PerParticle3& x) {
  const double now = numbers_of(corners_of(hinge, x)).weight();
  return material.weighting == Weighting::rest ? hinge.rest_weight : now;
}

}  // namespace

TEST_CASE("bending by default: no stiffness, no damping, the paper's law with factors at rest") {
  const BendingMaterial material;
  CHECK(material.stiffness == 0);
  CHECK(material.damping == 0);
  CHECK(material.weighting == Weighting::rest);
  CHECK(material.damping_factor == DampingFactor::edge);
  CHECK(material.law == "sine");
}

TEST_CASE("the two laws of bending have these magnitudes, slopes and potentials") {
  const double theta = 1.13, rest = -0.37, change = 1.5;
  REQUIRE(bending_laws().size() == 2);
  const BendingLaw& sine = bending_law("sine");
  CHECK(sine.name == "sine");
  CHECK(sine.magnitude(theta, rest) == Approx(std::sin(0.565) + std::sin(0.185)).epsilon(1e-15));
  CHECK(sine.slope(theta, rest) == Approx(std::cos(0.565) / 2).epsilon(1e-15));
  CHECK(sine.potential(theta, rest) ==
        Approx(2 * (std::cos(0.185) - std::cos(0.565)) + std::sin(0.185) * change).epsilon(1e-14));
  const BendingLaw& cubic = bending_law("cubic");
  CHECK(cubic.name == "cubic");
  CHECK(cubic.magnitude(theta, rest) == Approx(0.75 * 3.25).epsilon(1e-15));
  CHECK(cubic.slope(theta, rest) == Approx(0.5 + 1.5 * 2.25).epsilon(1e-15));
  CHECK(cubic.potential(theta, rest) == Approx(0.5625 + 0.6328125).epsilon(1e-15));
  // near a rest angle of 0 no digit is lost
  CHECK(sine.potential(1e-9, 0) == Approx(0.25e-18).epsilon(1e-14));
}

TEST_CASE("an unknown law of bending is refused with the names of those that are known") {
  CHECK_THROWS_WITH(bending_law("quartic"), "unknown bending law 'quartic'; known: sine, cubic");
  CHECK_THROWS_WITH(bending_law(""), "unknown bending law ''; known: sine, cubic");
}

TEST_CASE("the shape of a hinge is that of its drawing, on either side of a right angle") {
  std::vector<std::array<Vector3, 4>> all;
  for (const auto& hinge : oracles::hinges()) all.push_back(hinge.x);
  for (const BendingHinge& hinge : five_hinges({}).hinges)
    all.push_back(corners_of(hinge, hinge_state().x));
  int beyond = 0;
  for (const std::array<Vector3, 4>& x : all) {
    const HingeShape shape = hinge_shape(x[0], x[1], x[2], x[3]);
    const HingeNumbers numbers = numbers_of(x);
    const auto mode = oracles::bending_mode_50(x);
    CHECK_FALSE(shape.degenerate);
    CHECK((shape.u1 - mode.value[0]).norm() < 1e-13 * mode.value[0].norm());
    CHECK((shape.u2 - mode.value[1]).norm() < 1e-13 * mode.value[1].norm());
    CHECK(shape.b1 == Approx(numbers.b[0]).epsilon(1e-13));
    CHECK(shape.b2 == Approx(numbers.b[1]).epsilon(1e-13));
    CHECK(shape.edge == Approx(numbers.edge).epsilon(1e-15));
    CHECK(shape.area_sum == Approx(numbers.area_sum).epsilon(1e-14));
    const double sin_half = oracles::sin_half_angle_50(x).value;
    beyond += std::abs(sin_half) > std::sqrt(0.5);
    CHECK(shape.sin_half == Approx(sin_half).epsilon(1e-12));
    CHECK(hinge_angle(x[0], x[1], x[2], x[3]) ==
          Approx(oracles::hinge_angle_50(x).value).epsilon(1e-13));
    const Eigen::Matrix<double, 3, 4> u = bending_mode(shape);
    for (int i = 0; i < 4; ++i) CHECK((u.col(i) - mode.value[size_t(i)]).norm() < 1e-13 * u.norm());
  }
  CHECK(beyond > 0);
  CHECK(beyond < int(all.size()));
}

TEST_CASE("the half angle's sine is good to roundings however flat or folded the hinge is") {
  const Vector3 x1(-0.57, 0, 0.31), x3(0, 0, -0.13), x4(0, 0, 0.97);
  for (const double turn : {0.0, 1e-12, -1e-9, 3e-5, -1.5, 1.6, -3.1, pi - 1e-6, 1e-9 - pi}) {
    const Vector3 x2(0.83 * std::cos(turn), 0.83 * std::sin(turn), 0.29);
    CHECK(hinge_shape(x1, x2, x3, x4).sin_half == Approx(std::sin(turn / 2)).epsilon(1e-14));
    CHECK(hinge_angle(x1, x2, x3, x4) == Approx(turn).epsilon(1e-14));
  }
  CHECK(hinge_shape(x1, {0.83, 0, 0.29}, x3, x4).sin_half == 0);
  CHECK(hinge_shape(x1, {-0.83, 0, 0.29}, x3, x4).sin_half == 1);
  CHECK(hinge_angle(x1, {-0.83, 0, 0.29}, x3, x4) == pi);
}

TEST_CASE("a triangle whose height is at most 1e-10 of the edge is degenerate, on either side") {
  // the edge has length 1, and (p, q) is a height whose computed square is 1e-20 exactly
  const double limit = 1e-20;
  double p = 0.6e-10, q = 0;
  for (int tries = 0; tries < 1000 && p * p + q * q != limit; ++tries) {
    p = std::nextafter(p, 1);
    q = std::sqrt(limit - p * p);
  }
  REQUIRE(p * p + q * q == limit);
  const Vector3 x3(0, 0, 0), x4(0, 0, 1), far(-0.3, 0.7, 0.4), near(p, q, 0.5);
  const Vector3 nearer = near * 0.999, farther = near * 1.001;
  for (const Vector3& corner : {near, nearer}) {
    CHECK(hinge_shape(corner, far, x3, x4).degenerate);
    CHECK(hinge_shape(far, corner, x3, x4).degenerate);
  }
  CHECK_FALSE(hinge_shape(farther, far, x3, x4).degenerate);
  CHECK_FALSE(hinge_shape(far, farther, x3, x4).degenerate);
  // the height counts over the edge's length
  CHECK_FALSE(hinge_shape(farther / 8, far, x3, x4 / 8).degenerate);
  CHECK_FALSE(hinge_shape(8 * far, 8 * farther, x3, 8 * x4).degenerate);
  CHECK(hinge_shape(nearer / 8, far, x3, x4 / 8).degenerate);
  CHECK(hinge_shape(8 * far, 8 * nearer, x3, 8 * x4).degenerate);
  const Vector3 no_place(0.1, std::nan(""), 0.2);
  CHECK(hinge_shape(no_place, far, x3, x4).degenerate);
  CHECK(hinge_shape(far, no_place, x3, x4).degenerate);
}

TEST_CASE("a hinge that has lost a triangle is refused with its four particles in order") {
  const BendingHinge hinge = five_hinges({}).hinges[1];
  PerParticle3 x = hinge_state().x;
  CHECK_FALSE(checked_hinge_shape(hinge, x).degenerate);
  CHECK(checked_hinge_shape(hinge, x).edge == (x.col(4) - x.col(1)).norm());
  x.col(2) = x.col(4);
  CHECK_THROWS_WITH(checked_hinge_shape(hinge, x),
                    "a triangle of a hinge has lost its area (particles 6 2 1 4)");
  CHECK_THROWS_AS(five_hinges(bending_materials()[0]).shapes_at(x), DegenerateElement);
}

TEST_CASE("bending forces are ke c times the law's magnitude along the mode, for every setting") {
  const State s = hinge_state();
  const PerParticle3 start = scattered(hinge_particles, 5.1);
  for (const BendingMaterial& material : bending_materials()) {
    const Bending bending = five_hinges(material);
    PerParticle3 f = start, expected = start;
    for (const BendingHinge& hinge : bending.hinges) {
      const Modes u = modes_of(hinge, s.x);
      const double size = material.stiffness * elastic_factor(material, hinge, s.x) *
                          magnitude_of(material, hinge, s.x);
      for (size_t i = 0; i < 4; ++i) expected.col(hinge.particles[i]) += size * u[i];
    }
    add_elastic(bending, s, f);
    CHECK(agree(f, expected, 1e-12));
  }
}

TEST_CASE("the energy of bending is ke c times the law's potential, for every setting") {
  const State s = hinge_state();
  for (const BendingMaterial& material : bending_materials()) {
    double expected = 0;
    for (const BendingHinge& hinge : five_hinges(material).hinges) {
      const double theta = angle_at(hinge, s.x), rest = hinge.rest_angle;
      const double potential =
          material.law == "sine"
              ? 2 * (std::cos(rest / 2) - std::cos(theta / 2)) - std::sin(rest / 2) * (theta - rest)
              : std::pow(theta - rest, 2) / 4 + std::pow(theta - rest, 4) / 8;
      expected += 0.37 * elastic_factor(material, hinge, s.x) * potential;
    }
    CHECK(energy_of(five_hinges(material), s) == Approx(expected).epsilon(1e-13));
  }
}

TEST_CASE("dampers of hinges resist the mode with kd times either factor") {
  const State s = hinge_state();
  for (BendingMaterial material : bending_materials())
    for (const double kd : {0.19, 1.0}) {
      material.damping = kd;
      const Bending bending = five_hinges(material);
      DampingOperator damping;
      prepare_damping(bending, s, damping);
      REQUIRE(damping.hinges.size() == 5);
      PerParticle3 expected = PerParticle3::Zero(3, hinge_particles);
      for (size_t h = 0; h < 5; ++h) {
        const BendingHinge& hinge = bending.hinges[h];
        const HingeNumbers numbers = numbers_of(corners_of(hinge, s.x));
        const double factor =
            material.damping_factor == DampingFactor::edge ? numbers.edge : numbers.weight();
        const Modes u = modes_of(hinge, s.x);
        double rate = 0;
        for (size_t i = 0; i < 4; ++i) rate += u[i].dot(s.v.col(hinge.particles[i]));
        for (size_t i = 0; i < 4; ++i)
          expected.col(hinge.particles[i]) -= kd * factor * rate * u[i];
        const HingeDamper& damper = damping.hinges[h];
        CHECK(damper.particles == hinge.particles);
        CHECK(damper.weight1 == Approx(numbers.b[0]).epsilon(1e-13));
        CHECK(damper.weight2 == Approx(numbers.b[1]).epsilon(1e-13));
        CHECK((damper.w1 - std::sqrt(kd * factor) * u[0]).norm() < 1e-12 * u[0].norm());
        CHECK((damper.w2 - std::sqrt(kd * factor) * u[1]).norm() < 1e-12 * u[1].norm());
      }
      const PerParticle3 start = scattered(hinge_particles, 5.1);
      PerParticle3 f = start;
      damping.add_product(s.v, f);
      CHECK(agree(f - start, expected, 1e-12));
    }
}

TEST_CASE("hinges without damping have no dampers, and further ones join those that are there") {
  const State s = hinge_state();
  BendingMaterial material = bending_materials()[0];
  DampingOperator damping;
  prepare_damping(five_hinges(material), s, damping);
  prepare_damping(five_hinges(material), s, damping);
  CHECK(damping.hinges.size() == 10);
  CHECK(damping.hinges[7].particles == damping.hinges[2].particles);
  CHECK(damping.hinges[7].w1 == damping.hinges[2].w1);
  DampingOperator none;
  material.damping = 0;
  prepare_damping(five_hinges(material), s, none);
  CHECK(none.hinges.empty());
}

TEST_CASE("hinges do the same on any number of threads, to the bit") {
  // so many that forces on a particle come from the same and from another thread in turn
  constexpr int particles = 12;
  const State s{0, scattered(particles, 0.4), scattered(particles, 2.9)};
  Elements<BendingHinge> many;
  for (int k = 0; k < 60; ++k) {
    const auto at = [&](int shift) { return (5 * k + 1 + shift) % particles; };
    const double angle = 3 * std::sin(k + 0.3);
    many.push_back({{at(0), at(3 + k % 2), at(7 + k % 2), at(10 + k % 2)},
                    0.4 + 0.01 * k,
                    angle,
                    std::sin(angle / 2)});
  }
  const PerParticle3 start = scattered(particles, 5.1);
  const auto results = [&](const BendingMaterial& material, int threads) {
    Bending bending{material, many};
    bending.set_team(threads, particles);
    PerParticle3 f = start, damped = start;
    PerParticle rows = start.row(0).transpose();
    add_elastic(bending, s, f);
    add_stiffness_bound(bending, s, rows);
    DampingOperator damping;
    prepare_damping(bending, s, damping);
    damping.add_product(s.v, damped);
    return std::tuple(f, damped, rows, energy_of(bending, s));
  };
  for (const BendingMaterial& material : bending_materials())
    for (const int threads : {2, 3, 7}) CHECK(results(material, threads) == results(material, 1));
}

TEST_CASE("the rows of a hinge's stiffness are bounded by the page's sums") {
  State s = hinge_state();
  s.v = {};
  for (const BendingMaterial& material : bending_materials()) {
    const Bending bending = five_hinges(material);
    const PerParticle start = scattered(hinge_particles, 5.1).row(0).transpose();
    PerParticle rows = start, expected = start;
    add_stiffness_bound(bending, s, rows);
    for (const BendingHinge& hinge : bending.hinges) {
      const std::array<Vector3, 4> x = corners_of(hinge, s.x);
      const HingeNumbers numbers = numbers_of(x);
      const Modes u = modes_of(hinge, s.x);
      const double e = numbers.edge;
      Eigen::Matrix4d table = Eigen::Matrix4d::Zero();  // of |du_i/dx_j|
      for (int k = 0; k < 2; ++k) {
        const double size = u[size_t(k)].norm(), b = numbers.b[size_t(k)];
        const double l3 = (x[size_t(k)] - x[2]).norm(), l4 = (x[size_t(k)] - x[3]).norm();
        const double g3 = size * size * l3 / e + size / e, g4 = size * size * l4 / e + size / e;
        table(k, k) = size * size;
        table(k, 2) = table(2, k) = g4;
        table(k, 3) = table(3, k) = g3;
        table(2, 2) += std::abs(b) * g4 + size * l4 / (e * e);
        table(2, 3) += std::abs(b) * g3 + size * l3 / (e * e);
        table(3, 2) += std::abs(1 - b) * g4 + size * l4 / (e * e);
        table(3, 3) += std::abs(1 - b) * g3 + size * l3 / (e * e);
      }
      const double theta = angle_at(hinge, s.x), change = theta - hinge.rest_angle;
      const double slope =
          material.law == "sine" ? std::cos(theta / 2) / 2 : 0.5 + 1.5 * change * change;
      const double weight = 0.37 * elastic_factor(material, hinge, s.x);
      const double sum = u[0].norm() + u[1].norm() + u[2].norm() + u[3].norm();
      for (int i = 0; i < 4; ++i)
        expected[hinge.particles[size_t(i)]] +=
            weight * (slope * u[size_t(i)].norm() * sum +
                      std::abs(magnitude_of(material, hinge, s.x)) * table.row(i).sum());
    }
    CHECK(agree(rows, expected, 1e-12));
  }
}

TEST_CASE("no row of a hinge's stiffness exceeds its bound, whichever way it is folded") {
  BendingMaterial material = bending_materials()[0];
  for (const double rest_angle : {-2.9, -0.8, 0.3, 1.7}) {
    for (const BendingHinge& one : five_hinges(material).hinges) {
      Bending bending{material, {one}};
      bending.hinges[0].rest_angle = rest_angle;
      bending.hinges[0].sin_half_rest = std::sin(rest_angle / 2);
      PerParticle rows = PerParticle::Zero(hinge_particles);
      add_stiffness_bound(bending, hinge_state(), rows);
      ForceDifferential K;
      bending.add_elastic_differential(hinge_state(), Definiteness::exact, K);
      for (int i = 0; i < 4; ++i) {
        double sum = 0;
        for (int j = 0; j < 4; ++j)
          sum += K.hinges[0].block.block<3, 3>(3 * i, 3 * j).jacobiSvd().singularValues()[0];
        CHECK(sum <= rows[one.particles[size_t(i)]] * (1 + 1e-12));
      }
    }
  }
}

TEST_CASE("a hinge folded flat onto itself has a bound, though its sine may round above 1") {
  const Bending bending{bending_materials()[0], {{{0, 1, 2, 3}, 0.83, 0.4, std::sin(0.2)}}};
  for (int k = 0; k < 50; ++k) {
    State s;
    s.x = scattered(4, 0.17 * k);
    const Vector3 x3 = s.x.col(2), x4 = s.x.col(3), E = x4 - x3;
    s.x.col(1) = Vector3(x3 + 0.3 * E + 0.7 * (Vector3(s.x.col(0)) - x3));
    PerParticle rows = PerParticle::Zero(4);
    add_stiffness_bound(bending, s, rows);
    CHECK(rows.minCoeff() > 0);
  }
}

TEST_CASE("the angles of a mesh's hinges are those of its drawing, one a hinge") {
  const TriangleMesh mesh = make_sheet({SheetPattern::alternating, 1.3, 0.7, 3, 2});
  const PerParticle3 x = mesh.rest + 0.2 * scattered(mesh.particles(), 1.7);
  const std::vector<double> angles = hinge_angles(mesh, x);
  REQUIRE(angles.size() == mesh.hinges.size());
  for (size_t h = 0; h < angles.size(); ++h) {
    const BendingHinge hinge{mesh.hinges[h].particles, 0, 0, 0};
    CHECK(angles[h] == Approx(angle_at(hinge, x)).epsilon(1e-12));
    CHECK(checked_hinge_shape(hinge, x).angle() == angles[h]);
  }
}

TEST_CASE("bending of a mesh has a hinge's factor at rest and its rest angle") {
  const TriangleMesh mesh = make_sheet({SheetPattern::alternating, 1.3, 0.7, 3, 2});
  std::vector<double> angles;
  for (size_t h = 0; h < mesh.hinges.size(); ++h) angles.push_back(3 * std::sin(1.0 + double(h)));
  angles.front() = pi;
  angles.back() = -pi;
  const BendingMaterial material = bending_materials()[3];
  const Bending bending = make_bending(mesh, material, angles);
  CHECK(bending.material.stiffness == material.stiffness);
  CHECK(bending.material.damping == material.damping);
  CHECK(bending.material.weighting == material.weighting);
  CHECK(bending.material.law == "cubic");
  REQUIRE(bending.hinges.size() == mesh.hinges.size());
  for (size_t h = 0; h < angles.size(); ++h) {
    const BendingHinge& hinge = bending.hinges[h];
    CHECK(hinge.particles == mesh.hinges[h].particles);
    CHECK(hinge.rest_angle == angles[h]);
    CHECK(hinge.sin_half_rest == std::sin(0.5 * angles[h]));
    CHECK(hinge.rest_weight ==
          Approx(numbers_of(corners_of(hinge, mesh.rest)).weight()).epsilon(1e-14));
  }
}

TEST_CASE("bending refuses constants, angles and laws that mean nothing") {
  const TriangleMesh mesh = make_sheet({SheetPattern::one_diagonal, 1.3, 0.7, 2, 1});
  const std::vector<double> angles{0.3, -0.2, 0.1};
  REQUIRE(mesh.hinges.size() == 3);
  BendingMaterial material = bending_materials()[0];
  for (const double good : {0.0, 1e-300, 0.4}) {
    material.stiffness = material.damping = good;
    CHECK(make_bending(mesh, material, angles).hinges.size() == 3);
  }
  for (const double bad : {-1e-300, -2.0, std::nan("")}) {
    material.stiffness = bad, material.damping = 0.3;
    CHECK_THROWS_WITH(make_bending(mesh, material, angles),
                      "bending: stiffness must be a number >= 0 [J]");
    material.stiffness = 0.3, material.damping = bad;
    CHECK_THROWS_WITH(make_bending(mesh, material, angles),
                      "bending: damping must be a number >= 0 [N s]");
  }
  material.damping = 0.3;
  for (const double bad : {std::nextafter(pi, 4), std::nextafter(-pi, -4), 9.0, std::nan("")})
    CHECK_THROWS_WITH(make_bending(mesh, material, {0.3, 0.1, bad}),
                      "bending: rest angles must lie in [-pi, pi] rad");
  CHECK_THROWS_WITH(make_bending(mesh, material, {0.3, 0.1}),
                    "bending: 2 rest angles given for 3 hinges");
  CHECK_THROWS_WITH(make_bending(mesh, material, {0.3, 0.1, 0.2, 0.4}),
                    "bending: 4 rest angles given for 3 hinges");
  material.law = "linear";
  CHECK_THROWS_WITH(make_bending(mesh, material, angles),
                    "unknown bending law 'linear'; known: sine, cubic");
}
