// Laws of dynamics on frames placed by hand: what is compared, and what is allowed.
#include "verification/cases/frame_dynamics.h"
#include "verification/tests/cases/hand_made_frames.h"

using namespace foldproof;
using namespace foldproof::hand_made;
using Catch::Matchers::Contains;

namespace {

const Vector3 g(1.7, -8.9, 2.3);  // m/s^2
const std::string askew = "[gravity]\nacceleration = [1.7, -8.9, 2.3]\n";

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
      Case of = sheet(askew);
      of.scene.v.colwise() = Vector3(0.31, -0.23, 0.57);
      Frames cloth(of);
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
    return starts_as_the_reference(cloth.motion()).evidence.rows();
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
