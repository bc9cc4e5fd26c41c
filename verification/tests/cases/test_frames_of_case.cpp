// Frames in the numbering of a mesh before sewing, and points without faces.
#include <catch2/catch.hpp>

#include "verification/cases/frames_of_case.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;
using Catch::Matchers::Contains;

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
