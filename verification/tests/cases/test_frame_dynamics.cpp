// Laws of dynamics on frames placed by hand: every number of their evidence against its formula.
#include "verification/cases/frame_dynamics.h"
#include "verification/tests/cases/hand_made_frames.h"

using namespace foldproof;
using namespace foldproof::hand_made;
using Catch::Matchers::Contains;

namespace {

const Vector3 g(1.7, -8.9, 2.3);  // m/s^2
const std::string askew = "[gravity]\nacceleration = [1.7, -8.9, 2.3]\n";

/// Cloth whose particles have different velocities; far from the origin rounding counts.
Case thrown(const std::string& more, const Vector3& place) {
  Case of = sheet(more);
  of.scene.x.colwise() += place;
  for (Eigen::Index i = 0; i < of.scene.x.cols(); ++i)
    of.scene.v.col(i) = Vector3(0.31, -0.23, 0.57) + Vector3(0.1, 0.07, -0.03) * double(i);
  return of;
}

/// The mean by mass [of the values' unit].
Vector3 centre_of(const PerParticle3& values, const PerParticle& mass) {
  return values * mass / mass.sum();
}

}  // namespace

TEST_CASE("free fall: the errors of the centre's parabola, and what is allowed of each") {
  // through 0, h and 2 h: 1 % of g, and a multistep method that starts 3/4 g h^2 late
  const double size = g.norm(), h = 0.2, d = 0.75 * size * h * h;
  const double fall = size / 100 + d / (h * h), across = size * 2 * h / 100;
  const double along = across + std::max(size * h / 2, d / h + d / (2 * h));
  const Vector3 down = g.normalized(), aside = Vector3(8.9, 1.7, 0).normalized();
  for (const double part : {0.9, -1.1})
    for (const int kind : {0, 1, 2}) {  // of fall, along gravity, across it
      const Vector3 more = kind == 0 ? Vector3(part * fall * aside) : Vector3(0, 0, 0);
      const Vector3 push = kind == 0   ? Vector3(0, 0, 0)
                           : kind == 1 ? Vector3(part * along * down)
                                       : Vector3(part * across * aside);
      Frames cloth(thrown(askew, Vector3::Zero()));
      for (const double t : {0.0, h, 2 * h, 3 * h})
        cloth.add(t, (cloth.of.scene.x + t * cloth.of.scene.v).colwise() +
                         (t * push + t * t / 2 * (g + more)));
      const Table table = centre_falls_freely(cloth.motion()).evidence;
      const auto check = [&](const char* column, double value) {
        CHECK(table.numbers(column).at(0) == Approx(value).epsilon(0.03).margin(1e-9));
      };
      CHECK(table.rows() == 2);
      check("acceleration's error", more.norm() / size);
      check("allowed of it", fall / size);
      check("start velocity's error along gravity", std::abs(push.dot(down)));
      check("start velocity's error across gravity", std::abs(push.dot(aside)));
      check("largest error over allowed", std::abs(part));
    }
}

TEST_CASE("free fall: frames are compared until the cloth is near an object") {
  for (const std::size_t free : {0u, 2u, 3u, 5u}) {
    Frames cloth(sheet("[gravity]\n[[object]]\nshape = \"half_space\"\nmove = [0, 0, -1]\n"));
    for (std::size_t k = 0; k < 7; ++k) {
      PerParticle3 x = cloth.of.scene.x;
      x.row(2).setConstant(-1 + radius_of_half_cells * (k < free ? 1 + 1e-9 : 1 - 1e-9));
      if (k == 6) x.row(2).setConstant(3);  // away again
      cloth.add(0.02 * double(k), x);
    }
    if (free < 3)
      CHECK_THAT(cloth.missing(centre_falls_freely), Contains("there are " + std::to_string(free)));
    else
      CHECK(centre_falls_freely(cloth.motion()).evidence.rows() == free - 2);
  }
  const Frames far(sheet("[gravity]\n[[object]]\nshape = \"half_space\"\nmove = [0, 0, -100]\n"),
                   {0, 0.02, 0.04});
  CHECK(centre_falls_freely(far.motion()).evidence.rows() == 1);
}

namespace {

/// Checks every number of the law; returns the number of rows.
std::size_t checked_budget(const std::string& weight, const Vector3& gravity) {
  Case of =
      thrown("[stretch]\nstiffness = 31\n[bending]\nstiffness = 2e-3\n" + weight, {19, -7, 3});
  of.scene.x *= 1.03;
  of.scene.x.row(2) = 0.2 * (of.scene.x.row(0).array() - 20).square();
  Frames cloth(of);
  // the third and fourth intervals differ by a little less than 2 %, the fifth and sixth by more
  for (const double t :
       {0.0, 0.05, 0.1, 0.1501, 0.1501 + 0.0501 * 0.9803, 0.26, 0.32, 0.38, 0.44}) {
    PerParticle3 x = of.scene.x;
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      x.col(i) += Vector3(0.3, 0.8, -0.2) * std::sin(4 * t) * (1 + 0.1 * double(i)) +
                  Vector3(0.11, -0.2, 0.4) * t * t * double(i % 3);
    cloth.add(t, x);
  }
  const PerParticle& mass = cloth.built.system.mass;
  const Energies start = energies(cloth.built.system, start_state(of.scene));
  const double M = mass.sum(), e = std::sqrt(3.0) * rounding_of(cloth.frames), G = gravity.norm();
  const auto weight_of = [&](const PerParticle3& x) {
    return -M * gravity.dot(centre_of(x, mass));
  };
  const double kinetic0 = of.scene.v.colwise().squaredNorm().dot(mass.transpose()) / 2;
  const double total0 = kinetic0 + weight_of(of.scene.x) + start.stretch + start.bending;
  CHECK(start.stretch > 1e-3);
  CHECK(start.bending > 1e-6);
  const Table table = motion_stays_in_budget(cloth.motion()).evidence;
  double largest = 0;
  std::size_t row = 0;
  for (std::size_t k = 1; k + 1 < cloth.frames.size(); ++k) {
    const TimedMesh &a = cloth.frames[k - 1], &b = cloth.frames[k], &c = cloth.frames[k + 1];
    const double before = b.time - a.time, span = c.time - a.time;
    if (std::abs(span - 2 * before) >= 0.01 * span) continue;
    const PerParticle speeds = (c.x - a.x).colwise().norm().transpose() / span;
    const double kinetic = mass.dot(speeds.cwiseAbs2()) / 2;
    const double potential = (weight_of(a.x) + 4 * weight_of(b.x) + weight_of(c.x)) / 6;
    largest = std::max(
        {largest, std::abs(kinetic - kinetic0), std::abs(potential - weight_of(of.scene.x))});
    const double off = 2 * e / span;  // of a speed [m/s]
    const double late = G * before / 2;
    const double along = G > 0 ? std::abs(centre_of(of.scene.v, mass).dot(gravity)) / G : 0;
    const double allowed = largest / 100 + off * mass.dot(speeds) + M * off * off / 2 + M * G * e +
                           M * (along * late + late * late / 2);
    const double excess = kinetic + potential - total0;
    REQUIRE(row < table.rows());
    CHECK(table.numbers("time")[row] == b.time);
    CHECK(table.numbers("kinetic and weight less the start's total")[row] == exactly(excess));
    CHECK(table.numbers("allowed excess")[row] == exactly(allowed));
    CHECK(table.numbers("measured over allowed")[row] ==
          exactly(excess > 0 ? excess / allowed : 0));
    ++row;
  }
  CHECK(table.rows() == row);
  return row;
}

}  // namespace

TEST_CASE("budget of motion: the energy of the mean velocity and weight, and what is allowed") {
  CHECK(checked_budget(askew, g) == 6);
  CHECK(checked_budget("", Vector3::Zero()) == 6);
}

namespace {

/// No forces but a weight, so that the reference's free particles move on parabolas; the third and
/// the last are held.
Case held(const Vector3& gravity, const Vector3& velocity) {
  Case of = sheet("[gravity]\nacceleration = [1, 2, 3]\n[[hold]]\nparticles = [3, 11]\n");
  of.scene.gravity = gravity;
  for (const int i : {0, 1, 2, 4, 5, 6, 7, 8, 9, 10}) of.scene.v.col(i) = velocity;
  return of;
}

/// A velocity by which it moves one percent of the sheet's size, times `factor`, in so many frames.
Vector3 percent_in(int frames, double factor) {
  return factor * 0.01 * std::hypot(0.3, 0.24) / (frames * 0.02) * Vector3(2, 3, 6) / 7;
}

}  // namespace

TEST_CASE("start: the free centre is compared until the reference has moved by one percent") {
  // the number of frames compared, of a cloth that moves a fifth too fast; 0: it is not asked
  const auto compared = [](const Vector3& gravity, const Vector3& velocity, int count) {
    const auto way = [&](double t) { return Vector3(t * velocity + t * t / 2 * gravity); };
    Frames cloth(held(gravity, velocity));
    const double h = 0.02;
    for (int k = 0; k < count; ++k) {
      PerParticle3 x = cloth.of.scene.x.colwise() + 1.2 * way(h * k);
      x.col(3).setConstant(k), x.col(11).setConstant(-k);  // held particles do not count
      cloth.add(h * k, x);
    }
    if (!cloth.missing(starts_as_the_reference).empty()) return std::size_t(0);
    const Table table = starts_as_the_reference(cloth.motion()).evidence;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const double t = double(row + 1) * h, length = way(t).norm();
      const double late =
          std::max((way(t + h / 2) - way(t)).norm(), (way(t - h / 2) - way(t)).norm());
      const double allowed = late + length / 10 + std::sqrt(12.0) * rounding_of(cloth.frames);
      CHECK(table.numbers("reference's displacement")[row] == exactly(length));
      CHECK(table.numbers("the frames'")[row] == exactly(1.2 * length));
      CHECK(table.numbers("measured over allowed")[row] == exactly(0.2 * length / allowed));
    }
    return table.rows();
  };
  const Vector3 none = Vector3::Zero(), weight(1, -8, 2), slow(0.2, -0.5, 0.3);
  CHECK(compared(weight, slow, 13) == 5);
  CHECK(compared(weight, {-0.2, 4.5, -0.3}, 13) == 5);  // slows down
  CHECK(compared(weight, slow, 4) == 3);
  CHECK(compared(weight, slow, 6) == 5);
  CHECK(compared(none, percent_in(5, 1.001), 14) == 5);
  CHECK(compared(none, percent_in(5, 0.999), 14) == 6);
  CHECK(compared(none, percent_in(10, 1.001), 14) == 10);
  CHECK(compared(none, percent_in(10, 0.999), 14) == 0);
  CHECK(compared(none, percent_in(2, 1.001), 3) == 2);
  CHECK(compared(none, percent_in(2, 0.999), 3) == 0);
}

TEST_CASE("start: as many frames as are compared must be equally spaced") {
  for (const int late : {1, 2, 3, 9, 10, 11, 12, 14}) {  // the frame that comes late
    Frames cloth(held(Vector3(1, -8, 2), Vector3::Zero()));
    for (int k = 0; k < 14; ++k) cloth.add(0.02 * k + (k >= late ? 0.001 : 0), cloth.of.scene.x);
    CHECK(cloth.missing(starts_as_the_reference) == (late > 10 ? "" : "equally spaced frames"));
  }
}
