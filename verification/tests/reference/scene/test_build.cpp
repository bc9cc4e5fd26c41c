// Scenes become systems: what is built, and in what order.
#include <catch2/catch.hpp>

#include "reference/bodies/level_set_provider.h"
#include "reference/level_set/deforming.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;

namespace {

const std::string everything =
    "[gravity]\n[stretch]\nstiffness = 30\n[bending]\nstiffness = 0.003\n[strain_limits]\n"
    "[[hold]]\nparticles = [3, 1]\nvelocity = [0.5, 0.25, 1]\n[[object]]\nshape = \"half_space\"\n"
    "[collision]\npoints = \"edges\"\nforecast_time = 0.03\n[self_collision]\nthickness = 0.01\n"
    "[[sticky]]\nstiffness = 3\nforecast_time = 0.1\nnear = 0.01\nfar = 0.02\n"
    "surface = { of = \"cloth\", triangles = [0] }\nparticles = {}\n[solver]\ntolerance = 3e-7\n";

}  // namespace

TEST_CASE("forces and filters come in their order, with the masses of the scene", "[scene]") {
  const Scene scene = scene_with(everything);
  const BuiltScene built = build(scene, computing_provider());
  const System& system = built.system;
  REQUIRE((system.forces.size() == 4 && system.filters.size() == 3));
  CHECK(std::get<Gravity>(system.forces[0]).mass == system.mass);
  CHECK(std::get<StretchSprings>(system.forces[1]).springs.size() == 5);
  CHECK(std::get<Bending>(system.forces[2]).hinges[0].rest_angle == scene.rest_angles[0]);
  CHECK(std::get<Sticking>(system.forces[3]).patches.at(0).name == "cloth 1");
  CHECK((system.prescribed.size() == 2 && system.inverse_mass[3] == 0));
  CHECK(std::get<StrainLimiter>(system.filters[0]).inverse_mass == system.inverse_mass);
  const auto& objects = std::get<ObjectCollision>(system.filters[1]);
  CHECK((objects.objects.size() == 1 && objects.forecast_time == 0.03));
  CHECK(objects.points.size() == 2 + 4);  // free particles, and edges with one
  CHECK(built.objects.at(0).name == "half_space 1");
  const auto& self = std::get<SelfCollision>(system.filters[2]);
  CHECK((self.mass == system.mass && self.at_start.empty()));
  const Scene tangled = scene_of_cloth(
      "shape = \"sheet\"\nwidth = 1\nheight = 1\ncolumns = 1\nrows = 1\n"
      "copies = { count = 2, move = [0, 0, 0] }\n[self_collision]\nthickness = 0.1\n");
  CHECK(std::get<SelfCollision>(build_system(tangled).filters.at(0)).at_start.size() == 4);
}
