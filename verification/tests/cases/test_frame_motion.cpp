// Frames as a motion: velocities, rounding, depths, clearances, and closed budgets.
#include "verification/cases/quantities.h"
#include "verification/tests/cases/hand_made_frames.h"

using namespace foldproof;
using namespace foldproof::hand_made;
using Catch::Matchers::StartsWith;

namespace {

const std::string ball = "[[object]]\nshape = \"sphere\"\nradius = 0.1\nmove = [0.1, 0.12, -0.2]\n";

std::string budget_of(Case of) {
  Frames cloth(std::move(of));
  for (const double t : {0.0, 0.1}) cloth.add(t, cloth.of.scene.x);
  try {
    require_closed_budget(cloth.motion());
  } catch (const NotOffered& needed) {
    return needed.operation;
  }
  return "";
}

}  // namespace

TEST_CASE("motion: velocities are differences of the neighbouring frames") {
  Frames cloth(sheet(""));
  const std::vector<double> times = {0.3, 0.4, 0.55, 0.6};
  for (std::size_t k = 0; k < 4; ++k) {
    PerParticle3 x = cloth.of.scene.x;
    x.colwise() += Vector3(0.7, -0.2, 0.3) * double(k * k);
    cloth.add(times[k], x);
  }
  const FrameMotion motion = cloth.motion();
  REQUIRE(motion.states.size() == 4);
  const std::vector<double> ways = {1, 4, 8, 5}, spans = {0.1, 0.25, 0.2, 0.05};
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(motion.states[k].time == times[k]);
    CHECK(motion.states[k].x == cloth.frames[k].x);
    const Vector3 v = Vector3(0.7, -0.2, 0.3) * ways[k] / spans[k];
    for (const Eigen::Index i : {0, 5, 11}) CHECK((motion.states[k].v.col(i) - v).norm() < 1e-12);
  }
  Frames alone(sheet(""));
  alone.add(0.3, alone.of.scene.x);
  CHECK(alone.motion().states.at(0).v.isZero(0));
  alone.frames[0].triangles.pop_back();
  CHECK(alone.motion().matching == Matching::surface);
  CHECK(alone.motion().states.empty());
}

TEST_CASE("motion: half a unit of the sixth digit of the largest coordinate is rounding") {
  Frames cloth(sheet(""));
  for (const double far : {0.5, -4.0, 3.0}) {
    PerParticle3 x = cloth.of.scene.x;
    x(1, 4) = far;
    cloth.add(double(cloth.frames.size()), x);
  }
  CHECK(cloth.motion().rounding() == exactly(2e-5));
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
  Frames bare(sheet(""));
  bare.add(0, bare.of.scene.x);
  CHECK(depth_in(bare.motion(), bare.frames[0]) == 0);
  CHECK(clearance_in(bare.motion(), bare.frames[0]) == std::numeric_limits<double>::infinity());
}

TEST_CASE("motion: objects are where they are at the frame's time") {
  Frames cloth(
      sheet("[[object]]\nshape = \"sphere\"\nradius = 0.1\nmove = [0.1, 0.12, -0.5]\n"
            "velocity = [0, 0, 1]\n"));
  cloth.add(0.45, cloth.of.scene.x);
  CHECK(depth_in(cloth.motion(), cloth.frames[0]) == exactly(0.05));
}

TEST_CASE("motion: the largest change of one form of energy is what was exchanged") {
  const Energies start{1, 2, 3, 4, 5, 6};
  for (const auto term : energy_terms)
    for (const double change : {2.5, -3.5}) {
      Energies now = start;
      now.*term += change;
      CHECK(exchanged(now, start) == std::abs(change));
    }
}

TEST_CASE("motion: expectations are found by their key") {
  Case of = sheet("");
  of.expectations = {{"stays_flat", 0.1, ""}, {"takes_steps", 3, ""}};
  Frames cloth(of);
  cloth.add(0, cloth.of.scene.x);
  const FrameMotion motion = cloth.motion();
  CHECK(stated(motion, "takes_steps") == &cloth.of.expectations[1]);
  CHECK(stated(motion, "stays_flat") == &cloth.of.expectations[0]);
  CHECK(stated(motion, "sticks") == nullptr);
}

TEST_CASE("motion: a start is a frame at t = 0, to rounding") {
  const auto is_offered = [](double time) {
    Frames cloth(sheet(""));  // its largest coordinate is 0.3 m
    cloth.add(time, cloth.of.scene.x);
    try {
      require_start(cloth.motion());
    } catch (const NotOffered& needed) {
      CHECK(needed.operation == "a frame at t = 0");
      return false;
    }
    return true;
  };
  CHECK(is_offered(0));
  CHECK(is_offered(1.4e-6));
  CHECK(!is_offered(1.6e-6));
}

TEST_CASE("motion: a budget is closed where nothing does work on the cloth") {
  CHECK(budget_of(sheet("[gravity]\n[bending]\nstiffness = 1e-3\n" + ball)) == "");
  CHECK(budget_of(sheet("[[hold]]\nparticles = [0]\n")) == "");
  CHECK_THAT(budget_of(sheet("[[hold]]\nparticles = [0]\nvelocity = [0, 0, 1]\n")),
             StartsWith("a closed budget: prescribed particles do work"));
  CHECK_THAT(budget_of(sheet(ball + ball + "velocity = [0, 0, -1]\n")),
             StartsWith("a closed budget: an object moves"));
  // one that moves after the frames, into the cloth
  CHECK(budget_of(sheet(ball + "velocity = [0, 0, 0.4]\nfrom = 0.5\n")) == "");
  Case one = sheet("");
  one.scene.sticky.emplace_back();
  CHECK_THAT(budget_of(one), StartsWith("the energy of bonds"));
  CHECK_THAT(budget_of(sheet("[bending]\nstiffness = 1e-3\nweighting = \"current\"\n")),
             StartsWith("an energy: the case's bending has none"));
  Frames other(sheet(""));
  other.add(0, other.of.scene.x);
  other.frames[0].triangles.pop_back();
  CHECK_THROWS_AS(require_closed_budget(other.motion()), NotOffered);
}

TEST_CASE("motion: a start that breaks a constraint opens the budget") {
  const double usual = 0.125 * std::hypot(0.1, 0.12) / 2;  // a tenth of the triangles' radius
  const auto sunk = [](double depth) {
    Case of = sheet("[[object]]\nshape = \"half_space\"\n");
    of.scene.x(2, 4) = -depth;
    return budget_of(of);
  };
  CHECK(sunk(0.99 * usual) == "");
  CHECK(sunk(1.01 * usual) == "a closed budget: the cloth starts inside an object");
  Case crossed = sheet("");
  crossed.scene.x.col(0) = Vector3(0.17, 0.13, -0.05);
  crossed.scene.x.col(1) = Vector3(0.17, 0.11, 0.05);
  CHECK(budget_of(crossed) == "a closed budget: the cloth starts crossed");
  const auto stretched = [](double by) {
    Case of =
        sheet("[stretch]\nstiffness = 31\n[strain_limits]\nextension = 0.1\ntolerance = 0.01\n");
    of.scene.x *= 1 + by;
    return budget_of(of);
  };
  CHECK(stretched(0.109) == "");
  CHECK(stretched(0.111) == "a closed budget: springs start beyond a strain limit");
}
