// Frames as a motion: velocities, rounding, depths, clearances, and closed budgets.
#include "verification/cases/quantities.h"
#include "verification/tests/cases/hand_made_frames.h"

using namespace foldproof;
using namespace foldproof::hand_made;
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
