// Scenes become systems: what is built, in what order, and how it is described.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "reference/bodies/level_set_provider.h"
#include "reference/level_set/deforming.h"
#include "reference/mesh/shapes.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::StartsWith;

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

TEST_CASE("a scene at rest is its mesh, and nothing else", "[scene]") {
  const TriangleMesh mesh = make_hinge(0.7, 0.3);
  const Scene scene = scene_at_rest(mesh, 0.4);
  CHECK(scene.mesh.rest == mesh.rest);
  CHECK(scene.mesh.triangles == mesh.triangles);
  CHECK(scene.x == mesh.rest);
  CHECK(scene.v == PerParticle3::Zero(3, 4));
  CHECK(scene.density == 0.4);
  const BuiltScene built = build(scene, computing_provider());
  CHECK(built.system.forces.empty());
  CHECK(built.system.filters.empty());
  CHECK(built.system.prescribed.empty());
  CHECK(built.objects.empty());
  CHECK(built.system.mass == lumped_masses(mesh, 0.4));
  CHECK(built.start.time == 0);
  CHECK(built.start.x == mesh.rest);
  CHECK(built.start.v == PerParticle3::Zero(3, 4));
}

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

TEST_CASE("objects answer with the response of the case", "[scene]") {
  for (const Response& response : responses()) {
    const System system =
        build_system(scene_with("[[object]]\nshape = \"half_space\"\n[collision]\nresponse = \"" +
                                std::string(response.name) + "\"\n"));
    CHECK(std::get<ObjectCollision>(system.filters.at(0)).response.name == response.name);
  }
}

TEST_CASE("strain limits of a scene without springs are refused", "[scene]") {
  Scene scene = scene_with("");
  scene.strain_limits = StrainLimits{};
  CHECK_THROWS_WITH(build_system(scene), "strain limits limit springs; the scene has none");
}

TEST_CASE("held particles start where and as their motion says", "[scene]") {
  const Scene scene = scene_with(
      "[start]\nvelocity = [3, 5, 7]\n[[hold]]\nparticles = [2]\nvelocity = [0.5, 0.25, 1]\n"
      "[[hold]]\nparticles = [1]\nvelocity = [0.5, 0.25, 1]\nfrom = 0.1\n");
  Scene moved = scene;
  moved.prescribed[0].start = {9, 8, 6};
  const State start = start_state(moved);
  CHECK(start.time == 0);
  CHECK(start.x.col(2) == Vector3(9, 8, 6));
  CHECK(start.v.col(2) == Vector3(0.5, 0.25, 1));
  CHECK(start.v.col(1) == Vector3::Zero());
  CHECK(start.v.col(0) == Vector3(3, 5, 7));
  CHECK(start.x.col(0) == scene.x.col(0));
}

TEST_CASE("a surface is where its object's motion takes it, with that velocity", "[scene]") {
  const Scene scene = scene_with(
      "[[object]]\nshape = \"half_space\"\nmove = [1, 2, 3]\nangular_velocity = [0, 0, 90]\n"
      "velocity = [0.5, 0.25, 1]\n");
  const SceneObject& part = scene.objects[0];
  const double t = 2;  // half a turn about the origin
  const PerParticle3 x = surface_at(part, t), v = surface_velocity_at(part, t);
  for (int i = 0; i < 4; ++i) {
    const Vector3 X = part.vertices.col(i), turned(-X.x(), -X.y(), X.z());
    CHECK((x.col(i) - turned - Vector3(1, 0.5, 2)).norm() < 1e-14);
    CHECK((v.col(i) - Vector3(0, 0, pi / 2).cross(turned) - Vector3(0.5, 0.25, 1)).norm() < 1e-14);
  }
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
  const auto height = [&](double t) { return surface_at(part, t)(2, 0); };
  const auto speed = [&](double t) {
    const PerParticle3 v = surface_velocity_at(part, t);
    CHECK(v.cols() == 3);
    CHECK(v.cwiseAbs().sum() == std::abs(v(2, 0)));
    return v(2, 0);
  };
  CHECK(height(0.5) == 2);
  CHECK(height(1.25) == 2.5);
  CHECK(height(9) == 2);
  CHECK(speed(0) == 0);
  CHECK(speed(0.25) == 4);
  CHECK(speed(0.5) == 4);
  CHECK(speed(0.75) == -1);  // where it jumps, the later one
  CHECK(speed(1.7) == -1);
  CHECK(speed(1.75) == 0);
  CHECK(speed(2) == 0);
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

TEST_CASE("objects and what they do are described", "[scene]") {
  CHECK(parts_with("[[object]]\nshape = \"half_space\"\nfriction = 0.35\n[[object]]\n"
                   "shape = \"sphere\"\nradius = 2\nmove = [90, 0, 0]\nname = \"ball\"\n"
                   "[collision]\npoints = \"faces\"\n") ==
        Parts{"object 'half_space 1' (half_space, friction 0.35)",
              "object 'ball' (sphere, friction 0)",
              "11 points held out of objects, response 'forecast'"});
  Scene scene = scene_with("[[object]]\nshape = \"half_space\"\n");
  scene.objects[0].animation =
      std::make_shared<const MeshSequence>(MeshSequence{{{0, 1, 2}}, {0.25, 0.75, 1.75}, {}});
  CHECK(parts_of(scene).at(1) == "object 'half_space 1' (half_space, 3 level sets, friction 0)");
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

TEST_CASE("parts are described in the order of their kinds", "[scene]") {
  const Parts parts = parts_with(everything);
  const Parts begins = {"gravity",         "5 springs",   "1 hinge",  "2 particles",   "object ",
                        "sticky 'cloth 1", "5 springs l", "6 points", "self-collision"};
  REQUIRE(parts.size() == begins.size());
  for (size_t k = 0; k < parts.size(); ++k) CHECK_THAT(parts[k], StartsWith(begins[k]));
}

TEST_CASE("split vertices are counted, and the particles that they became", "[scene]") {
  Scene scene = scene_with("");
  const auto described = [&](const std::vector<int>& copy_of) {
    scene.copy_of = copy_of;
    return parts_of(scene).at(1);
  };
  CHECK(described({0, 1, 2, 1, 1, 2}) == "2 vertices split into 5 particles");
  CHECK(described({0, 1, 1}) == "1 vertex split into 2 particles");
  CHECK(described({0, 1, 0, 0}) == "1 vertex split into 3 particles");
}
