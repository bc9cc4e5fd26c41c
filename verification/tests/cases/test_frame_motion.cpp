// Motion and dynamics of frames, and the frames of a case.
#include <catch2/catch.hpp>

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
