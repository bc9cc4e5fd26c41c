// Frames matched to a cloth: what differs first, in words; and the cubic between two frames.
#include "verification/cases/frame_comparison.h"
#include "verification/tests/cases/hand_made_frames.h"

using namespace foldproof;
using namespace foldproof::hand_made;

namespace {

/// What the last frame differs by, after one that matches.
std::string difference(const std::vector<Triangle>& triangles, int vertices = 5) {
  const std::vector<Triangle> faces = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}};
  PerParticle3 x(3, 5);
  x << 0, 1, 0, 1, 0, 0, 0, 1, 1, 2, 0, 0, 0, 0, 0;
  const TriangleMesh cloth = make_triangle_mesh(x, faces);
  PerParticle3 other = PerParticle3::Zero(3, vertices);
  const std::vector<TimedMesh> frames = {{"first.obj", 0, x, {{3, 4, 2}, {2, 0, 1}, {1, 3, 2}}},
                                         {"second.obj", 1, other, triangles}};
  const std::string said = mesh_difference(cloth, frames);
  CHECK((matching_of(cloth, frames) == Matching::particles) == said.empty());
  return said;
}

}  // namespace

TEST_CASE("frames match: faces in any order, from any corner on") {
  CHECK(difference({{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}) == "");
  CHECK(difference({{4, 2, 3}, {2, 0, 1}, {3, 2, 1}}) == "");
  CHECK(name_of(Matching::particles) == "vertex by vertex");
  CHECK(name_of(Matching::surface) == "by nearest points");
}

TEST_CASE("frames match: the first difference is named with the frame and the triangle") {
  CHECK(difference({{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}, 7) ==
        "second.obj has 7 vertices, the case 5");
  CHECK(difference({{0, 1, 2}, {3, 1, 2}, {4, 3, 2}}) ==
        "second.obj: vertex order cannot match, triangle 1, (3, 1, 2), is one of the case's turned "
        "over (all counted from 0)");
  CHECK(difference({{0, 1, 2}, {1, 3, 2}, {2, 1, 4}}) ==
        "second.obj: vertex order cannot match, triangle 2, (2, 1, 4), is none of the case's (all "
        "counted from 0)");
  CHECK(difference({{3, 1, 0}, {1, 2, 3}, {2, 3, 4}}) ==
        "second.obj: vertex order cannot match, triangle 0, (3, 1, 0), is none of the case's (all "
        "counted from 0)");
  CHECK(difference({{0, 1, 2}, {1, 3, 2}}) == "second.obj has 2 triangles, the case 3");
  CHECK(difference({{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {1, 3, 2}}) ==
        "second.obj has 4 triangles, the case 3");
}

TEST_CASE("between frames: velocities go evenly, and beyond the frames each stays") {
  State a{0.4, PerParticle3::Constant(3, 2, 0.7), PerParticle3::Constant(3, 2, -3)};
  State b{0.9, PerParticle3::Constant(3, 2, 1.9), PerParticle3::Constant(3, 2, 5)};
  a.x(1, 1) = -0.3, b.v(2, 0) = 11;
  a.bonds.resize(3), b.bonds.resize(2);
  for (const double t : {0.41, 0.55, 0.7, 0.88}) {
    const State now = state_between(a, b, t);
    const double share = (t - 0.4) / 0.5;
    CHECK(now.time == t);
    CHECK((now.v - a.v - share * (b.v - a.v)).norm() < 1e-13);
    // the cubic by its derivatives at the start, solved from both ends
    const PerParticle3 way = b.x - a.x - 0.5 * a.v, turn = 0.5 * (b.v - a.v);
    const PerParticle3 c = 3 * way - turn, d = turn - 2 * way;
    const PerParticle3 x = a.x + 0.5 * share * a.v + share * share * c + share * share * share * d;
    CHECK((now.x - x).norm() < 1e-13);
  }
  CHECK(state_between(a, b, 0.3).x == a.x);
  CHECK(state_between(a, b, 0.3).time == 0.4);
  CHECK(state_between(a, b, 0.4).v == a.v);
  CHECK(state_between(a, b, 0.4).bonds.size() == 3);
  CHECK(state_between(a, b, 0.9).x == b.x);
  CHECK(state_between(a, b, 0.9).bonds.size() == 2);
  CHECK(state_between(a, b, 1.5).time == 0.9);
}

TEST_CASE("comparison: what is no oriented surface has no folds, and depths are at the time") {
  Frames cloth(
      sheet("[[object]]\nshape = \"sphere\"\nradius = 0.1\nmove = [0.1, 0.12, -0.5]\n"
            "velocity = [0, 0, 1]\n[[object]]\nshape = \"sphere\"\nradius = 0.02\n"
            "move = [0.2, 0.12, 0.01]\n"));
  TimedMesh frame{"f", 0.45, cloth.of.scene.x, cloth.of.scene.mesh.triangles};
  std::swap(frame.triangles[3][0], frame.triangles[3][1]);
  const State at{0.43, cloth.of.scene.x, cloth.of.scene.v};
  const FrameComparison c =
      compare_frame({cloth.of.scene, cloth.built, Matching::surface}, at, frame);
  for (const double share : c.frame.folds) CHECK(std::isnan(share));
  CHECK(std::isnan(c.frame.bending));
  CHECK(c.run.folds[0] == exactly(1));
  CHECK(c.time == 0.45);
  CHECK(c.run.depth == exactly(0.03));  // both at the run's time
  CHECK(c.frame.depth == exactly(0.03));
  const State early{0.1, cloth.of.scene.x, cloth.of.scene.v};
  CHECK(compare_frame({cloth.of.scene, cloth.built, Matching::surface}, early, frame).run.depth ==
        exactly(0.01));
  frame.x.col(5) += Vector3(0, 0, -0.2);
  frame.x.col(6) += Vector3(0, 0, 0.01);
  CHECK(compare_frame({cloth.of.scene, cloth.built, Matching::surface}, early, frame).frame.depth ==
        exactly(0.02));
}
