// Laws of dynamics on frames placed by hand: every number of their evidence against its formula.
#include <Eigen/Dense>

#include "verification/cases/frame_dynamics.h"
#include "verification/tests/cases/hand_made_frames.h"

using namespace foldproof;
using namespace foldproof::hand_made;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

const Vector3 g(1.7, -8.9, 2.3), v0(0.31, -0.23, 0.57);  // m/s^2, m/s

/// Free cloth, far from the origin so that rounding counts, with a weight askew.
Case thrown(const std::string& more = "") {
  Case of = sheet("[gravity]\nacceleration = [1.7, -8.9, 2.3]\n" + more);
  of.scene.x.colwise() += Vector3(19, -7, 3);
  for (Eigen::Index i = 0; i < of.scene.x.cols(); ++i)
    of.scene.v.col(i) = v0 + Vector3(0.1, 0.07, -0.03) * double(i);
  return of;
}

/// The mean by mass [of the values' unit].
Vector3 centre_of(const PerParticle3& values, const PerParticle& mass) {
  Vector3 sum = Vector3::Zero();
  for (Eigen::Index i = 0; i < mass.size(); ++i) sum += mass[i] * values.col(i);
  return sum / mass.sum();
}

/// Frames at uneven times that fall with `fall` from the start velocity plus `push`.
void add_falling(Frames& thrown_frames, const Vector3& fall, const Vector3& push) {
  const Scene& scene = thrown_frames.of.scene;
  for (const double t : {0.0, 0.02, 0.05, 0.09, 0.14, 0.19, 0.25, 0.34, 0.41}) {
    PerParticle3 x = scene.x + t * scene.v;
    x.colwise() += t * push + t * t / 2 * fall;
    x.col(2) += Vector3(0.3, -0.1, 0.2) * t * t * t;  // no parabola, so that the frames matter
    thrown_frames.add(t, x);
  }
}

/// Checks every number of the law of free fall; says which of the three errors is the worst last.
int checked_fall(const Vector3& fall, const Vector3& push) {
  Frames cloth(thrown());
  add_falling(cloth, fall, push);
  const Table table = centre_falls_freely(cloth.motion()).evidence;
  const PerParticle& mass = cloth.built.system.mass;
  const Vector3 start = centre_of(cloth.of.scene.v, mass);
  const double size = g.norm(), e = std::sqrt(3.0) * rounding_of(cloth.frames), h = 0.02;
  REQUIRE(table.rows() == cloth.frames.size() - 2);
  int worst = -1;
  for (std::size_t k = 2; k < cloth.frames.size(); ++k) {
    const std::size_t row = k - 2;
    const double tm = cloth.frames[k / 2].time, T = cloth.frames[k].time;
    // c(t) = c0 + V t + A t^2/2 through both later frames
    const Vector3 c0 = centre_of(cloth.frames[0].x, mass);
    Eigen::Matrix2d powers;
    powers << tm, tm * tm / 2, T, T * T / 2;
    Eigen::Matrix<double, 2, 3> ways;
    ways.row(0) = (centre_of(cloth.frames[k / 2].x, mass) - c0).transpose();
    ways.row(1) = (centre_of(cloth.frames[k].x, mass) - c0).transpose();
    const Eigen::Matrix<double, 2, 3> fit = powers.inverse() * ways;
    const Vector3 V = fit.row(0).transpose() - start, A = fit.row(1).transpose();
    const double off = (A - g).norm(), along = std::abs(V.dot(g)) / size;
    const double across = std::sqrt(std::max(0.0, V.squaredNorm() - along * along));
    const double d = 3 * size * h * h / 4;  // by which a multistep method starts late [m]
    const double of_rounding = 2 * (2 * e / tm + 2 * e / (T - tm)) / T;
    const double off_allowed = size / 100 + 2 * d / (tm * T) + of_rounding;
    const double across_allowed = size * T / 100 + 2 * e / tm + of_rounding * tm / 2;
    const double along_allowed = across_allowed + std::max(size * h / 2, d / tm + d / T);
    const double of_fall = off / off_allowed, of_along = along / along_allowed;
    const double largest = std::max({of_fall, of_along, across / across_allowed});
    const auto close = [](double value) { return Approx(value).epsilon(1e-7).margin(1e-9); };
    CHECK(table.numbers("last frame")[row] == T);
    CHECK(table.numbers("acceleration's error")[row] == close(off / size));
    CHECK(table.numbers("allowed of it")[row] == close(off_allowed / size));
    CHECK(table.numbers("start velocity's error along gravity")[row] == close(along));
    CHECK(table.numbers("start velocity's error across gravity")[row] == close(across));
    CHECK(table.numbers("largest error over allowed")[row] == close(largest));
    worst = largest == of_fall ? 0 : largest == of_along ? 1 : 2;
  }
  return worst;
}

}  // namespace

TEST_CASE("free fall: the errors of the centre's parabola, and what is allowed of each") {
  CHECK(checked_fall(g + Vector3(2, 1, -1), Vector3::Zero()) == 0);
  CHECK(checked_fall(g, 1.3 * g.normalized()) == 1);
  CHECK(checked_fall(g, -1.3 * g.normalized()) == 1);
  CHECK(checked_fall(g, 0.7 * g.cross(Vector3(0.2, 0.5, 0.9)).normalized()) == 2);
}

TEST_CASE("free fall: frames are compared until the cloth is near an object") {
  // the inside is z < -1; near is the radius about a cell's half, a quarter larger
  const double near = 1.25 * std::hypot(0.1, 0.12) / 2;
  for (const std::size_t free : {0u, 2u, 3u, 5u}) {
    Frames cloth(sheet("[gravity]\n[[object]]\nshape = \"half_space\"\nmove = [0, 0, -1]\n"));
    for (std::size_t k = 0; k < 7; ++k) {
      PerParticle3 x = cloth.of.scene.x;
      x.row(2).setConstant(-1 + near * (k < free ? 1 + 1e-9 : 1 - 1e-9));
      if (k == 6) x.row(2).setConstant(3);  // away again
      cloth.add(0.02 * double(k), x);
    }
    INFO(free);
    if (free < 3)
      CHECK(cloth.missing(centre_falls_freely) ==
            "three frames before the cloth is near an object: there are " + std::to_string(free));
    else
      CHECK(centre_falls_freely(cloth.motion()).evidence.rows() == free - 2);
  }
  Frames far(sheet("[gravity]\n[[object]]\nshape = \"half_space\"\nmove = [0, 0, -100]\n"));
  for (const double t : {0.0, 0.02, 0.04}) far.add(t, far.of.scene.x);
  CHECK(centre_falls_freely(far.motion()).evidence.rows() == 1);
}

TEST_CASE("free fall: it is asked of free cloth with a weight, from the start on") {
  const auto missing = [](Case of, double start = 0) {
    Frames cloth(std::move(of));
    for (const double t : {0.0, 0.02, 0.04, 0.06}) cloth.add(start + t, cloth.of.scene.x);
    return cloth.missing(centre_falls_freely);
  };
  const std::string weight = "[gravity]\n";
  CHECK(missing(sheet(weight)) == "");
  CHECK(missing(sheet("")) == "gravity: the case has none");
  Case weightless = sheet(weight);
  weightless.scene.gravity = Vector3::Zero();
  CHECK(missing(weightless) == "gravity: the case has none");
  CHECK_THAT(missing(sheet(weight + "[[hold]]\nparticles = [2]\n")), StartsWith("free cloth: the"));
  Case sticky = sheet(weight);
  sticky.scene.sticky.emplace_back();
  CHECK_THAT(missing(sticky), StartsWith("free cloth: bonds"));
  CHECK(missing(sheet(weight), 0.001) == "a frame at t = 0");
  Frames other(sheet(weight));
  other.add(0, other.of.scene.x);
  other.frames[0].triangles.pop_back();
  CHECK_THAT(other.missing(centre_falls_freely), StartsWith("the case's mesh"));
  other.frames[0].triangles = other.of.scene.mesh.triangles;
  CHECK_THAT(other.missing(centre_falls_freely), StartsWith("three frames before"));
}

namespace {

/// Elastic cloth that starts stretched and bent, with or without a weight.
Case elastic(const std::string& weight) {
  Case of = sheet("[stretch]\nstiffness = 31\n[bending]\nstiffness = 2e-3\n" + weight);
  of.scene.x *= 1.03;
  of.scene.x.row(2) = 0.2 * of.scene.x.row(0).array().square();
  of.scene.x.colwise() += Vector3(2, 0.7, -0.3);
  for (Eigen::Index i = 0; i < of.scene.v.cols(); ++i)
    of.scene.v.col(i) = v0 + Vector3(0.1, 0.07, -0.03) * double(i);
  return of;
}

/// Rises and falls, and wobbles.
void add_wobbling(Frames& cloth, const std::vector<double>& times) {
  for (const double t : times) {
    PerParticle3 x = cloth.of.scene.x;
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      x.col(i) += Vector3(0.3, 0.8, -0.2) * std::sin(4 * t) * (1 + 0.1 * double(i)) +
                  Vector3(0.11, -0.2, 0.4) * t * t * double(i % 3);
    cloth.add(t, x);
  }
}

/// Checks every number of the law; returns the number of rows.
std::size_t checked_budget(const std::string& weight, const Vector3& gravity) {
  Frames cloth(elastic(weight));
  // the third and fourth intervals differ by a little less than 2 %, the fifth and sixth by more
  add_wobbling(cloth, {0, 0.05, 0.1, 0.1501, 0.1501 + 0.0501 * 0.9803, 0.26, 0.32, 0.38, 0.44});
  const Scene& scene = cloth.of.scene;
  const PerParticle& mass = cloth.built.system.mass;
  const Energies start = energies(cloth.built.system, start_state(scene));
  const double M = mass.sum(), e = std::sqrt(3.0) * rounding_of(cloth.frames), G = gravity.norm();
  const auto weight_of = [&](const PerParticle3& x) {
    return -M * gravity.dot(centre_of(x, mass));
  };
  double kinetic0 = 0, largest = 0;
  for (Eigen::Index i = 0; i < mass.size(); ++i)
    kinetic0 += mass[i] * scene.v.col(i).squaredNorm() / 2;
  const double total0 = kinetic0 + weight_of(scene.x) + start.stretch + start.bending;
  CHECK(start.stretch > 1e-3);
  CHECK(start.bending > 1e-6);
  const Table table = motion_stays_in_budget(cloth.motion()).evidence;
  std::size_t row = 0;
  for (std::size_t k = 1; k + 1 < cloth.frames.size(); ++k) {
    const TimedMesh &a = cloth.frames[k - 1], &b = cloth.frames[k], &c = cloth.frames[k + 1];
    const double before = b.time - a.time, after = c.time - b.time, span = c.time - a.time;
    if (std::abs(before - after) >= 0.01 * span) continue;
    double kinetic = 0, speeds = 0;
    for (Eigen::Index i = 0; i < mass.size(); ++i) {
      const double speed = (c.x.col(i) - a.x.col(i)).norm() / span;
      kinetic += mass[i] * speed * speed / 2, speeds += mass[i] * speed;
    }
    const double potential = (weight_of(a.x) + 4 * weight_of(b.x) + weight_of(c.x)) / 6;
    largest =
        std::max({largest, std::abs(kinetic - kinetic0), std::abs(potential - weight_of(scene.x))});
    const double off = 2 * e / span;  // of a speed [m/s]
    const double late = G * before / 2,
                 along = G > 0 ? std::abs(centre_of(scene.v, mass).dot(gravity)) / G : 0;
    const double allowed = largest / 100 + off * speeds + M * off * off / 2 + M * G * e +
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
  CHECK(checked_budget("[gravity]\nacceleration = [1.7, -8.9, 2.3]\n", g) == 6);
  CHECK(checked_budget("", Vector3::Zero()) == 6);
}

TEST_CASE("budget of motion: it is asked of three frames that are equally spaced") {
  const auto missing = [](const std::vector<double>& times) {
    Frames cloth(elastic(""));
    for (const double t : times) cloth.add(t, cloth.of.scene.x);
    return cloth.missing(motion_stays_in_budget);
  };
  CHECK(missing({0, 0.1, 0.2}) == "");
  CHECK(missing({0, 0.1}) == "three equally spaced frames");
  CHECK(missing({0, 0.1, 0.205}) == "three equally spaced frames");
  CHECK(missing({0, 0.105, 0.205}) == "three equally spaced frames");
  CHECK(missing({0, 0.1, 0.205, 0.31}) == "");
  Frames longer(elastic(""));  // frames that follow the judged ones are not read
  for (const double t : {0.0, 0.1, 0.2, 0.3}) longer.add(t, longer.of.scene.x);
  const auto judged = std::span<const TimedMesh>(longer.frames).first(3);
  CHECK(motion_stays_in_budget(motion_of(longer.of, longer.built, judged)).evidence.rows() == 1);
  Frames driven(sheet("[[hold]]\nparticles = [0]\nvelocity = [0, 0, 1]\n"));
  for (const double t : {0.0, 0.1, 0.2}) driven.add(t, driven.of.scene.x);
  CHECK_THAT(driven.missing(motion_stays_in_budget), Contains("prescribed particles do work"));
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

/// Checks every number of the comparison with the reference; returns the number of rows.
std::size_t checked_start(const Vector3& gravity, const Vector3& velocity, std::size_t count) {
  Frames cloth(held(gravity, velocity));
  const double h = 0.02;
  for (std::size_t k = 0; k < count; ++k) {
    PerParticle3 x = cloth.of.scene.x;
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      x.col(i) += Vector3(0.02, 0.05 * double(i), -0.03) * double(k * k) * h;
    cloth.add(h * double(k), x);
  }
  PerParticle mass = cloth.built.system.mass;
  mass[3] = mass[11] = 0;
  const auto way = [&](double t) { return Vector3(t * velocity + t * t / 2 * gravity); };
  const Table table = starts_as_the_reference(cloth.motion()).evidence;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double t = double(row + 1) * h;
    const Vector3 moved =
        centre_of(cloth.frames.at(row + 1).x, mass) - centre_of(cloth.frames[0].x, mass);
    const double late =
        std::max((way(t + h / 2) - way(t)).norm(), (way(t - h / 2) - way(t)).norm());
    const double allowed = late + way(t).norm() / 10 + std::sqrt(12.0) * rounding_of(cloth.frames);
    const double off = (moved - way(t)).norm();
    CHECK(table.numbers("time")[row] == exactly(t));
    CHECK(table.numbers("reference's displacement")[row] == exactly(way(t).norm()));
    CHECK(table.numbers("the frames'")[row] == exactly(moved.norm()));
    CHECK(table.numbers("distance of both")[row] == exactly(off));
    CHECK(table.numbers("allowed difference")[row] == exactly(allowed));
    CHECK(table.numbers("measured over allowed")[row] == exactly(off / allowed));
  }
  return table.rows();
}

const double size = std::hypot(0.3, 0.24);  // of the sheet [m]

/// A velocity by which it moves one percent of the sheet's size, times `factor`, in so many frames.
Vector3 percent_in(int frames, double factor) {
  return factor * 0.01 * size / (frames * 0.02) * Vector3(2, 3, 6) / 7;
}

}  // namespace

TEST_CASE("start: the centre of the free particles is compared with that of the reference") {
  CHECK(checked_start(Vector3(1, -8, 2), Vector3(0.2, -0.5, 0.3), 13) == 5);
  CHECK(checked_start(Vector3(1, -8, 2), Vector3(-0.2, 4.5, -0.3), 13) == 5);  // slows down
  CHECK(checked_start(Vector3(1, -8, 2), Vector3(0.2, -0.5, 0.3), 4) == 3);
  CHECK(checked_start(Vector3(1, -8, 2), Vector3(0.2, -0.5, 0.3), 6) == 5);
}

TEST_CASE("start: more frames are compared until the reference has moved by one percent") {
  const Vector3 none = Vector3::Zero();
  CHECK(checked_start(none, percent_in(5, 1.001), 14) == 5);
  CHECK(checked_start(none, percent_in(5, 0.999), 14) == 6);
  CHECK(checked_start(none, percent_in(7, 1.001), 14) == 7);
  CHECK(checked_start(none, percent_in(10, 1.001), 14) == 10);
  CHECK(checked_start(none, percent_in(2, 1.001), 3) == 2);
  const auto missing = [&](const Vector3& velocity, std::size_t count) {
    Frames cloth(held(none, velocity));
    for (std::size_t k = 0; k < count; ++k) cloth.add(0.02 * double(k), cloth.of.scene.x);
    return cloth.missing(starts_as_the_reference);
  };
  CHECK_THAT(missing(percent_in(10, 0.999), 14),
             StartsWith("a motion to compare: in 10 frames the reference's centre moves by less"));
  CHECK_THAT(missing(percent_in(2, 0.999), 3), Contains("in 2 frames"));
  CHECK(missing(percent_in(1, 3), 1) == "a second frame");
}

TEST_CASE("start: it is asked of as many equally spaced frames as are compared") {
  const auto missing = [&](std::size_t late) {  // the frame that comes late
    Frames cloth(held(Vector3(1, -8, 2), Vector3::Zero()));
    for (std::size_t k = 0; k < 14; ++k)
      cloth.add(0.02 * double(k) + (k >= late ? 0.001 : 0), cloth.of.scene.x);
    return cloth.missing(starts_as_the_reference);
  };
  for (const std::size_t k : {1u, 2u, 3u, 9u, 10u}) CHECK(missing(k) == "equally spaced frames");
  for (const std::size_t k : {11u, 12u, 14u}) CHECK(missing(k) == "");
}

TEST_CASE("start: it is asked where a reference moves what does not fall freely") {
  const auto missing = [](Case of, double start = 0) {
    Frames cloth(std::move(of));
    for (std::size_t k = 0; k < 7; ++k) cloth.add(start + 0.02 * double(k), cloth.of.scene.x);
    return cloth.missing(starts_as_the_reference);
  };
  CHECK(missing(held(g, v0)) == "");
  CHECK(missing(held(g, v0), 0.01) == "a frame at t = 0");
  CHECK_THAT(missing(thrown()), Contains("it falls freely"));
  CHECK(missing(sheet("[gravity]\n[[hold]]\ntop = 1\n")) == "free particles");
  Case stopping = held(g, v0);
  stopping.scene.schedule.step.fixed = 0.002;
  stopping.scene.schedule.max_steps = 2;
  CHECK_THAT(missing(stopping), StartsWith("a reference that runs: it stops, as "));
  Frames other(held(g, v0));
  other.add(0, other.of.scene.x);
  other.frames[0].triangles.pop_back();
  CHECK_THAT(other.missing(starts_as_the_reference), StartsWith("the case's mesh"));
}
