// Scenes become systems: what is built, in what order, and how it is described.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "reference/bodies/level_set_provider.h"
#include "reference/level_set/deforming.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;

namespace {

std::vector<std::string> parts_of(const Scene& scene) {
  return describe_parts(scene, build_system(scene));
}

/// The parts after the cloth itself.
std::vector<std::string> parts_with(const std::string& tables) {
  std::vector<std::string> parts = parts_of(scene_with(tables));
  parts.erase(parts.begin());
  return parts;
}

using Parts = std::vector<std::string>;

const std::string everything =
    "[gravity]\n[stretch]\nstiffness = 30\n[bending]\nstiffness = 0.003\n[strain_limits]\n"
    "[[hold]]\nparticles = [3, 1]\nvelocity = [0.5, 0.25, 1]\n[[object]]\nshape = \"half_space\"\n"
    "[collision]\npoints = \"edges\"\nforecast_time = 0.03\n[self_collision]\nthickness = 0.01\n"
    "[[sticky]]\nstiffness = 3\nforecast_time = 0.1\nnear = 0.01\nfar = 0.02\n"
    "surface = { of = \"cloth\", triangles = [0] }\nparticles = {}\n[solver]\ntolerance = 3e-7\n";

}  // namespace

TEST_CASE("forces and filters come in their order, with the masses and settings of the scene",
          "[scene]") {
  const Scene scene = scene_with(everything);
  const BuiltScene built = build(scene, computing_provider());
  const System& system = built.system;
  REQUIRE(system.forces.size() == 4);
  CHECK(std::get<Gravity>(system.forces[0]).acceleration == Vector3(0, -9.80665, 0));
  CHECK(std::get<Gravity>(system.forces[0]).mass == system.mass);
  CHECK(std::get<StretchSprings>(system.forces[1]).springs.size() == 5);
  CHECK(std::get<Bending>(system.forces[2]).hinges[0].rest_angle == scene.rest_angles[0]);
  CHECK(std::get<Bending>(system.forces[2]).material.stiffness == 0.003);
  CHECK(std::get<Sticking>(system.forces[3]).patches.at(0).name == "cloth 1");
  REQUIRE(system.filters.size() == 3);
  CHECK(system.solver.tolerance == 3e-7);
  REQUIRE(system.prescribed.size() == 2);
  CHECK(system.prescribed[0].particle == 3);
  CHECK(system.inverse_mass[3] == 0);
  CHECK(system.inverse_mass[1] == 0);
  CHECK(system.inverse_mass[0] == 1 / system.mass[0]);

  const auto& limiter = std::get<StrainLimiter>(system.filters[0]);
  CHECK(limiter.springs.size() == 5);
  CHECK(limiter.inverse_mass == system.inverse_mass);
  const auto& objects = std::get<ObjectCollision>(system.filters[1]);
  CHECK(objects.objects.size() == 1);
  CHECK(objects.forecast_time == 0.03);
  CHECK(objects.response.name == "forecast");
  CHECK(objects.points.size() == 2 + 4);  // free particles, and edges with one
  CHECK(built.objects.at(0).name == "half_space 1");
  const auto& self = std::get<SelfCollision>(system.filters[2]);
  CHECK(self.settings.thickness == 0.01);
  CHECK(self.mass == system.mass);
  CHECK(self.inverse_mass == system.inverse_mass);
  CHECK(self.at_start.empty());
}

TEST_CASE("a deforming surface moves evenly from frame to frame, and rests outside", "[scene]") {
  MeshSequence sequence{{{0, 1, 2}}, {0.25, 0.75, 1.75}, {}};
  for (const double height : {1.0, 3.0, 2.0}) {
    PerParticle3 x(3, 3);
    x << 0, 1, 0, 0, 0, 1, height, 5, 5;
    sequence.positions.push_back(x);
  }
  SceneObject part;
  part.vertices = sequence.positions[0];
  part.animation = std::make_shared<const MeshSequence>(sequence);
  const std::vector<std::array<double, 3>> rows = {// time, height, speed
                                                   {0, 1, 0},     {0.25, 1, 4},    {0.5, 2, 4},
                                                   {0.75, 3, -1}, {1.25, 2.5, -1}, {1.75, 2, 0},
                                                   {9, 2, 0}};
  for (const auto& [t, height, speed] : rows) {
    CHECK(surface_at(part, t)(2, 0) == height);
    const PerParticle3 v = surface_velocity_at(part, t);
    REQUIRE(v.cols() == 3);
    CHECK(v(2, 0) == speed);  // where it jumps, the later one
    CHECK(v.cwiseAbs().sum() == std::abs(speed));
  }
}

TEST_CASE("parts are described with their numbers", "[scene]") {
  CHECK(parts_of(scene_with("")) == Parts{"4 particles, 2 triangles"});
  CHECK(parts_with("[gravity]\n[stretch]\nstiffness = 3\n") == Parts{"gravity", "5 springs"});
  CHECK(parts_with("[stretch]\nstiffness = 3\ndamping = 1e-300\n") == Parts{"5 springs, damped"});
  CHECK(parts_with("[bending]\nstiffness = 3\n") == Parts{"1 hinge, rest weighting, law 'sine'"});
  CHECK(parts_with("[bending]\nstiffness = 3\nweighting = \"current\"\nlaw = \"cubic\"\n"
                   "damping = 1e-300\n") ==
        Parts{"1 hinge, current weighting, law 'cubic', damped"});
  CHECK(parts_with("[[hold]]\nparticles = [2]\n") == Parts{"1 particle with prescribed motion"});
  CHECK(parts_with("[[hold]]\nparticles = [2, 3, 0]\n") ==
        Parts{"3 particles with prescribed motion"});
  const Parts sheet = parts_of(sheet_with("[bending]\nstiffness = 3\n"));
  CHECK(sheet == Parts{"20 particles, 24 triangles", "29 hinges, rest weighting, law 'sine'"});
}

TEST_CASE("strain limits, stickiness and self-collision are described", "[scene]") {
  const std::string springs = "[stretch]\nstiffness = 3\n[strain_limits]\n";
  CHECK(parts_with(springs) ==
        Parts{"5 springs",
              "5 springs limited to 1 to 1.1 of their rest lengths, in at most 20 sweeps"});
  // three springs meet in a particle, and no two of a colour may
  CHECK(parts_with(springs +
                   "order = \"coloured\"\ncompression = 0.25\nextension = 0.5\nsweeps = 7\n")
            .at(1) ==
        "5 springs in 3 colours limited to 0.75 to 1.5 of their rest lengths, in at most 7 sweeps");
  const std::string glue =
      "[[sticky]]\nstiffness = 3\nforecast_time = 0.1\nnear = 0.01\nfar = 0.02\n";
  CHECK(parts_with(glue + "surface = { of = \"cloth\", triangles = [0] }\nparticles = {}\n") ==
        Parts{"sticky 'cloth 1' (1 triangles of the cloth, 4 particles that may stick)"});
  CHECK(parts_with("[[object]]\nshape = \"box\"\nsize = [1, 2, 3]\nmove = [90, 0, 0]\n" + glue +
                   "surface = { of = \"box 1\" }\nparticles = { particles = [3] }\n")
            .at(1) == "sticky 'box 1 1' (12 triangles of an object, 1 particles that may stick)");
  CHECK(parts_with("[self_collision]\nthickness = 0.01\nfriction = 0.4\n") ==
        Parts{"self-collision (thickness 0.01 m, friction 0.4)"});
  const Scene tangled = scene_of_cloth(
      "shape = \"sheet\"\nwidth = 1\nheight = 1\ncolumns = 1\nrows = 1\n"
      "copies = { count = 2, move = [0, 0, 0] }\n[self_collision]\nthickness = 0.1\n");
  CHECK(parts_of(tangled).at(1) ==
        "self-collision (thickness 0.1 m, friction 0), which starts crossing itself: 4 pairs of "
        "triangles: 0 and 2, 0 and 3, 1 and 2, 1 and 3");
  CHECK(std::get<SelfCollision>(build_system(tangled).filters.at(0)).at_start.size() == 4);
}
