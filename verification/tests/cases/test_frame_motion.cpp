// Motion and dynamics of frames, and the frames of a case.
#include <catch2/catch.hpp>

#include "verification/cases/frame_dynamics.h"
#include "verification/cases/frames_of_case.h"
#include "verification/cases/quantities.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/cases/hand_made_frames.h"

using namespace foldproof::hand_made;
using namespace foldproof;

using Catch::Matchers::Contains;

namespace {

/// Why the budget of cloth that stays at its start is not closed; "" if it is.
std::string budget_of(Case of) {
  const Law law = [](const FrameMotion& motion) {
    require_closed_budget(motion);
    return Finding{};
  };
  return Frames(std::move(of), {0, 0.1}).missing(law);
}

}  // namespace

TEST_CASE("motion: velocities are differences of the neighbouring frames") {
  Frames cloth(sheet(""), {0.3, 0.4, 0.55, 0.6});
  const Vector3 way(0.7, -0.2, 0.3);
  for (std::size_t k = 0; k < 4; ++k) cloth.frames[k].x.colwise() += way * double(k * k);
  const std::vector<double> ways = {1, 4, 8, 5}, spans = {0.1, 0.25, 0.2, 0.05};
  for (std::size_t k = 0; k < 4; ++k)
    CHECK((cloth.motion().states.at(k).v.colwise() - way * ways[k] / spans[k]).norm() < 1e-11);
  cloth.frames.resize(1);
  CHECK(cloth.motion().states.at(0).v.isZero(0));
  cloth.frames[0].triangles.pop_back();
  CHECK(cloth.motion().states.empty());
}

TEST_CASE("motion: depths and clearances are of vertices that are free and not pinched") {
  const std::string other =
      "[[object]]\nshape = \"sphere\"\nradius = 0.07\nmove = [0.3, 0, -0.05]\n";
  Frames cloth(sheet(ball + other + "[[hold]]\nparticles = [5]\n"));
  PerParticle3 x = cloth.of.scene.x;
  x.col(5) = Vector3(0.1, 0.12, -0.19);  // held, and deep
  x.col(6) = Vector3(0.1, 0.12, -0.14);  // 4 cm deep
  x.col(2) = Vector3(0.3, 0, -0.1);      // 2 cm deep
  cloth.add(0.1, x);
  CHECK(depth_in(cloth.motion(), cloth.frames[0]) == exactly(0.04));
  CHECK(clearance_in(cloth.motion(), cloth.frames[0]) == exactly(-0.04));
  CHECK(depth_in(cloth.motion(), {"", 0, cloth.of.scene.x, cloth.of.scene.mesh.triangles}) ==
        exactly(0.02));  // of particle 3, a corner
  cloth.frames[0].x(0, 1) = foldproof::nan;
  CHECK(std::isnan(depth_in(cloth.motion(), cloth.frames[0])));
  CHECK(std::isnan(clearance_in(cloth.motion(), cloth.frames[0])));
  cloth.frames[0].x = x;
  cloth.frames[0].triangles.pop_back();  // now vertices are no particles, and none is held
  CHECK(depth_in(cloth.motion(), cloth.frames[0]) == exactly(0.09));
  CHECK(clearance_in(cloth.motion(), cloth.frames[0]) == exactly(-0.09));

  Frames pinched(sheet(ball + "[[object]]\nshape = \"sphere\"\nradius = 0.1\n"
                              "move = [0.1, 0.12, -0.06]\n"));
  x = pinched.of.scene.x.array() + 5;
  x.col(7) = Vector3(0.1, 0.12, -0.12);  // 4 cm deep in both
  pinched.add(0, x);
  CHECK(depth_in(pinched.motion(), pinched.frames[0]) == 0);
  CHECK(clearance_in(pinched.motion(), pinched.frames[0]) < 0);
  const Frames bare(sheet(""), {0});
  CHECK(depth_in(bare.motion(), bare.frames[0]) == 0);
  CHECK(clearance_in(bare.motion(), bare.frames[0]) == std::numeric_limits<double>::infinity());
}

TEST_CASE("motion: objects are where they are at the frame's time") {
  const Frames cloth(sheet(ball + "velocity = [0, 0, 1]\n"), {0.45});  // 0.25 m above, then
  CHECK(clearance_in(cloth.motion(), cloth.frames[0]) == exactly(0.15));
}

TEST_CASE("motion: a start is a frame at t = 0, to rounding") {
  for (const double time : {0.0, 1.4e-6, 1.6e-6}) {  // the largest coordinate is 0.3 m
    const Frames cloth(sheet(""), {time});
    CHECK(cloth.missing(law("start-is-that-of-the-case")).empty() == (time < 1.5e-6));
  }
}

TEST_CASE("motion: a budget is closed where nothing does work on the cloth") {
  CHECK(budget_of(sheet("[gravity]\n[bending]\nstiffness = 1e-3\n" + ball)) == "");
  CHECK(budget_of(sheet("[[hold]]\nparticles = [0]\n")) == "");
  CHECK_THAT(budget_of(sheet(driven)), Contains("prescribed particles"));
  CHECK_THAT(budget_of(sheet(ball + ball + "velocity = [0, 0, -1]\n")), Contains("object moves"));
  // one that moves after the frames, into the cloth
  CHECK(budget_of(sheet(ball + "velocity = [0, 0, 0.4]\nfrom = 0.5\n")) == "");
  Case one = sheet("");
  one.scene.sticky.emplace_back();
  CHECK_THAT(budget_of(one), Contains("bonds"));
  CHECK_THAT(budget_of(sheet("[bending]\nstiffness = 1e-3\nweighting = \"current\"\n")),
             Contains("bending"));
}

TEST_CASE("motion: a start that breaks a constraint opens the budget") {
  const auto sunk = [](double depth) {
    Case of = sheet("[[object]]\nshape = \"half_space\"\n");
    of.scene.x(2, 4) = -depth;
    return budget_of(of);
  };
  CHECK(sunk(0.099 * radius_of_half_cells) == "");
  CHECK_THAT(sunk(0.101 * radius_of_half_cells), Contains("inside an object"));
  Case tangled = sheet("");
  tangled.scene.x = crossed(tangled.scene.x);
  CHECK_THAT(budget_of(tangled), Contains("starts crossed"));
  const auto stretched = [](double by) {
    Case of =
        sheet("[stretch]\nstiffness = 31\n[strain_limits]\nextension = 0.1\ntolerance = 0.01\n");
    of.scene.x *= 1 + by;
    return budget_of(of);
  };
  CHECK(stretched(0.109) == "");
  CHECK_THAT(stretched(0.111), Contains("beyond a strain limit"));
}

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

namespace {

/// Two squares that share a seam, each vertex of which is doubled: vertices 4 and 7 are 1 and 2.
const std::string panels =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\n"
    "f 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\n";
const std::vector<Triangle> unsewn = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};

struct Sewn {
  explicit Sewn(const std::string& more = "") {
    folder.write("panels.obj", panels);
    scene = read_scene_text("[cloth]\nmesh = \"panels.obj\"\nseams = 0.001\ndensity = 0.2\n" +
                                more + "[time]\nend = 0.1\n",
                            folder.file("sewn.toml"));
    x.resize(3, 8);
    x << 0, 1, 1, 0, 1, 2, 2, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0;
  }
  CaseFrames with(const std::vector<Triangle>& triangles) const {
    return frames_of_case(scene, {{"f.obj", 0.1, x, triangles}});
  }
  ScratchFolder folder;
  Scene scene;
  PerParticle3 x;
};

}  // namespace

TEST_CASE("frames before sewing are judged through the case's seams") {
  Sewn cloth;
  cloth.x.col(4) += Vector3(0, 0, 0.0005);
  cloth.x.col(6) += Vector3(0, 0, 0.25);
  for (const auto& triangles : {unsewn, std::vector<Triangle>{}}) {
    const CaseFrames read = cloth.with(triangles);
    CHECK(matching_of(cloth.scene.mesh, read.frames) == Matching::particles);
    CHECK(read.frames[0].x.col(1) == Vector3(1, 0, 0));
    CHECK(read.frames[0].x.col(5) == Vector3(2, 1, 0.25));
    CHECK_THAT(read.seams, Contains("at most 0.0005 m open"));
  }
}

TEST_CASE("frames before sewing with open seams stay another mesh, and say where") {
  Sewn cloth;
  cloth.x.col(7) += Vector3(0, 0, 0.03);
  const CaseFrames read = cloth.with(unsewn);
  CHECK(matching_of(cloth.scene.mesh, read.frames) == Matching::surface);
  CHECK_THAT(read.seams, Contains("vertices 2 and 7") && Contains("0.03 m apart"));
}

TEST_CASE("points are the case's particles only if they are as many") {
  const Sewn cloth;
  CaseFrames read = frames_of_case(cloth.scene, {{"p.ply", 0, cloth.x.leftCols(6), {}}});
  CHECK(matching_of(cloth.scene.mesh, read.frames) == Matching::particles);
  read = frames_of_case(cloth.scene, {{"p.ply", 0, cloth.x.leftCols(5), {}}});
  CHECK(matching_of(cloth.scene.mesh, read.frames) == Matching::points);
  CHECK_THAT(mesh_difference(cloth.scene.mesh, read.frames), Contains("5 points without faces"));
  const Sewn copied("copies = { count = 2, move = [0, 0, 1] }\n");
  CHECK(copied.with(unsewn).seams == "");
}
