// Tables of a case: each key goes to its field, and each default is the documented one.
#include <catch2/catch.hpp>
#include <cmath>

#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

Scene at(const std::string& time_keys) {
  return read_scene_text(hinge_cloth + "[time]\n" + time_keys, "some.toml");
}

std::string refusal(const std::string& tables) {
  try {
    scene_with(tables);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("a case of a cloth and a time has nothing else", "[scene]") {
  const Scene scene = scene_with("");
  CHECK(scene.name == "some");
  CHECK(scene.title.empty());
  CHECK(scene.about.empty());
  CHECK(scene.folder.empty());
  CHECK(scene.density == 0.2);
  CHECK(scene.x == scene.mesh.rest);
  CHECK(scene.v == PerParticle3::Zero(3, 4));
  CHECK(scene.copy_of.empty());
  CHECK_FALSE(scene.gravity);
  CHECK_FALSE(scene.stretch);
  CHECK_FALSE(scene.bending);
  CHECK(scene.rest_angles.empty());
  CHECK(scene.prescribed.empty());
  CHECK(scene.warnings.empty());
  CHECK(scene.objects.empty());
  CHECK_FALSE(scene.strain_limits);
  CHECK_FALSE(scene.self_collision);
  CHECK(scene.sticky.empty());
  CHECK(scene.collision.forecast_time == 0);
  CHECK(scene.collision.points == PointKind::particles);
  CHECK(scene.collision.response == "forecast");
}

TEST_CASE("a case without a cloth or a time is refused", "[scene]") {
  CHECK_THROWS_WITH(read_scene_text("[time]\nend = 1\n", "some.toml"),
                    EndsWith(": a case needs the tables [cloth] and [time]"));
  CHECK_THROWS_WITH(
      read_scene_text(hinge_cloth, "some.toml"),
      StartsWith("some.toml") && EndsWith(": a case needs the tables [cloth] and [time]"));
}

TEST_CASE("the time's defaults are 30 frames a second, automatic steps, scheme C", "[scene]") {
  const Scene scene = at("end = 0.7\n");
  CHECK(scene.schedule.end == 0.7);
  CHECK(scene.schedule.frame_interval == 1.0 / 30);
  CHECK(scene.schedule.step.fixed == 0);
  CHECK(scene.schedule.step.safety == 0.5);
  CHECK(scene.schedule.step.strain_per_step == 0.1);
  CHECK(scene.schedule.step.ends.empty());
  CHECK(scene.schedule.max_steps == 100'000'000);
  CHECK(scene.integrator == "C");
}

TEST_CASE("each key of the time goes to its place", "[scene]") {
  const Scene scene =
      at("end = 0.9\nframes_per_second = 24\nstep = 0.003\nsafety = 0.4\nstrain_per_step = 0.07\n"
         "max_steps = 53\nintegrator = \"A\"\n");
  CHECK(scene.schedule.end == 0.9);
  CHECK(scene.schedule.frame_interval == 1.0 / 24);
  CHECK(scene.schedule.step.fixed == 0.003);
  CHECK(scene.schedule.step.safety == 0.4);
  CHECK(scene.schedule.step.strain_per_step == 0.07);
  CHECK(scene.schedule.max_steps == 53);
  CHECK(scene.integrator == "A");
  CHECK(at("end = 0.9\nstep = \"automatic\"\n").schedule.step.fixed == 0);
}

TEST_CASE("values of the time out of range are refused with their place", "[scene]") {
  CHECK_THROWS_WITH(at("end = 0\n"), "some.toml:7: 'end' must be > 0");
  CHECK_THROWS_WITH(at("end = 1\nframes_per_second = 0\n"),
                    "some.toml:8: 'frames_per_second' must be > 0");
  CHECK_THROWS_WITH(at("end = 1\nstep = 0\n"), "some.toml:8: 'step' must be > 0");
  CHECK_THROWS_WITH(at("end = 1\nstep = \"manual\"\n"),
                    "some.toml:8: 'step' must be a number [s] or \"automatic\"");
  CHECK_THROWS_WITH(at("end = 1\nsafety = 0\n"), "some.toml:8: 'safety' must be > 0");
  CHECK_THROWS_WITH(at("end = 1\nstrain_per_step = 0\n"),
                    "some.toml:8: 'strain_per_step' must be > 0");
  CHECK_THROWS_WITH(at("end = 1\nmax_steps = 0\n"), StartsWith("some.toml:8: 'max_steps'"));
  CHECK_THROWS_WITH(at("end = 1\nintegrator = \"nothing\"\n"),
                    StartsWith("some.toml:8: ") && Contains("nothing"));
}

TEST_CASE("stretch has its stiffness, and defaults for the rest", "[scene]") {
  const Scene plain = scene_with("[stretch]\nstiffness = 0\n");
  CHECK(plain.stretch->stiffness == 0);
  CHECK(plain.stretch->damping == 0);
  CHECK(plain.stretch->rest_length_scale == 1);
  const Scene full =
      scene_with("[stretch]\nstiffness = 37.5\ndamping = 0.011\nrest_length_scale = 0.97\n");
  CHECK(full.stretch->stiffness == 37.5);
  CHECK(full.stretch->damping == 0.011);
  CHECK(full.stretch->rest_length_scale == 0.97);
  CHECK(refusal("[stretch]\n") == "some.toml:6: [stretch] needs the key 'stiffness'");
  CHECK(refusal("[stretch]\nstiffness = -1e-9\n") ==
        "some.toml:7: 'stiffness' must not be negative");
  CHECK(refusal("[stretch]\nstiffness = 3\ndamping = -1e-9\n") ==
        "some.toml:8: 'damping' must not be negative");
  CHECK(refusal("[stretch]\nstiffness = 3\nrest_length_scale = 0\n") ==
        "some.toml:8: 'rest_length_scale' must be > 0");
}

TEST_CASE("bending has its stiffness, and defaults for the rest", "[scene]") {
  const Scene plain = scene_with("[bending]\nstiffness = 0\n");
  CHECK(plain.bending->stiffness == 0);
  CHECK(plain.bending->damping == 0);
  CHECK(plain.bending->weighting == Weighting::rest);
  CHECK(plain.bending->damping_factor == DampingFactor::edge);
  CHECK(plain.bending->law == "sine");
  const Scene full = scene_with(
      "[bending]\nstiffness = 3.1e-4\ndamping = 2.3e-5\nweighting = \"current\"\n"
      "damping_factor = \"edge_squared_over_area\"\nlaw = \"cubic\"\n");
  CHECK(full.bending->stiffness == 3.1e-4);
  CHECK(full.bending->damping == 2.3e-5);
  CHECK(full.bending->weighting == Weighting::current);
  CHECK(full.bending->damping_factor == DampingFactor::edge_squared_over_area);
  CHECK(full.bending->law == "cubic");
  CHECK(scene_with("[bending]\nstiffness = 3\nweighting = \"rest\"\ndamping_factor = \"edge\"\n"
                   "law = \"sine\"\n")
            .bending->law == "sine");
  CHECK(refusal("[bending]\n") == "some.toml:6: [bending] needs the key 'stiffness'");
  CHECK(refusal("[bending]\nstiffness = -1e-9\n") ==
        "some.toml:7: 'stiffness' must not be negative");
  CHECK(refusal("[bending]\nstiffness = 3\ndamping = -1e-9\n") ==
        "some.toml:8: 'damping' must not be negative");
  CHECK(refusal("[bending]\nstiffness = 3\nlaw = \"none\"\n") ==
        "some.toml:8: unknown law 'none'; known: sine, cubic");
}

TEST_CASE("rest angles are those of the rest shape, or zero, or a number of degrees", "[scene]") {
  const auto angles = [](const std::string& key) {
    return scene_with("[bending]\nstiffness = 3\n" + key).rest_angles;
  };
  for (const char* key : {"", "rest_angle = \"rest_shape\"\n"}) {
    REQUIRE(angles(key).size() == 1);
    CHECK(angles(key)[0] == Approx(pi / 20).epsilon(1e-12));
  }
  CHECK(angles("rest_angle = \"flat\"\n") == std::vector<double>{0});
  CHECK(angles("rest_angle = 18\n")[0] == Approx(pi / 10).epsilon(1e-15));
  CHECK(angles("rest_angle = 180\n")[0] == Approx(pi).epsilon(1e-15));
  CHECK(angles("rest_angle = -180\n")[0] == Approx(-pi).epsilon(1e-15));
  const std::string table = "[bending]\nstiffness = 3\nrest_angle = ",
                    must = "some.toml:8: 'rest_angle' must lie in [-180, 180] degrees";
  CHECK(refusal(table + "180.0001\n") == must);
  CHECK(refusal(table + "-180.0001\n") == must);
  CHECK(refusal(table + "\"bent\"\n") ==
        "some.toml:8: unknown rest_angle 'bent'; known: rest_shape, flat");
  // of a rest shape, not of the start
  const Scene pleated = scene_of_cloth(
      "shape = \"sheet\"\nwidth = 0.5\nheight = 0.25\ncolumns = 2\nrows = 1\n"
      "pleats = { columns = 1, angle = 27 }\n[bending]\nstiffness = 3\n");
  double sum = 0;  // along the one fold
  for (const double angle : pleated.rest_angles) sum += std::abs(angle);
  CHECK(sum == Approx(3 * pi / 20).epsilon(1e-12));
}

TEST_CASE("gravity is that of the earth, downwards, unless it is given", "[scene]") {
  CHECK(*scene_with("[gravity]\n").gravity == Vector3(0, -9.80665, 0));
  CHECK(*scene_with("[gravity]\nacceleration = [0.3, -0.7, 1.1]\n").gravity ==
        Vector3(0.3, -0.7, 1.1));
}

TEST_CASE("the solver has its documented defaults and takes each key", "[scene]") {
  const Scene plain = scene_with("[solver]\n");
  CHECK(plain.solver.tolerance == 1e-10);
  CHECK(plain.solver.max_iterations == 1000);
  CHECK(plain.solver.scale == ResidualScale::momentum);
  const Scene full = scene_with(
      "[solver]\ntolerance = 3e-7\nmax_iterations = 17\nrelative_to = \"initial_residual\"\n");
  CHECK(full.solver.tolerance == 3e-7);
  CHECK(full.solver.max_iterations == 17);
  CHECK(full.solver.scale == ResidualScale::initial_residual);
  CHECK(refusal("[solver]\ntolerance = 0\n") == "some.toml:7: 'tolerance' must be > 0");
  CHECK_THAT(refusal("[solver]\nmax_iterations = 0\n"),
             StartsWith("some.toml:7: 'max_iterations' must lie"));
  CHECK(refusal("[solver]\nrelative_to = \"x\"\n") ==
        "some.toml:7: unknown relative_to 'x'; known: momentum, initial_residual");
}

TEST_CASE("strain limits have their documented defaults and take each key", "[scene]") {
  const std::string springs = "[stretch]\nstiffness = 3\n[strain_limits]\n";
  const StrainLimits plain = *scene_with(springs).strain_limits;
  CHECK(plain.extension == 0.1);
  CHECK(plain.compression == 0);
  CHECK(plain.order == SweepOrder::gauss_seidel);
  CHECK(plain.sweeps == 20);
  CHECK(plain.tolerance == 1e-3);
  const StrainLimits full = *scene_with(springs +
                                        "extension = 1.5\ncompression = 0.03\norder = \"jacobi\"\n"
                                        "sweeps = 7\ntolerance = 2e-5\n")
                                 .strain_limits;
  CHECK(full.extension == 1.5);
  CHECK(full.compression == 0.03);
  CHECK(full.order == SweepOrder::jacobi);
  CHECK(full.sweeps == 7);
  CHECK(full.tolerance == 2e-5);
  const auto order = [&](const std::string& name) {
    return scene_with(springs + "order = \"" + name + "\"\n").strain_limits->order;
  };
  CHECK(order("gauss_seidel") == SweepOrder::gauss_seidel);
  CHECK(order("alternating") == SweepOrder::alternating);
  CHECK(order("coloured") == SweepOrder::coloured);
  CHECK(refusal(springs + "extension = -1e-9\n") ==
        "some.toml:9: 'extension' must not be negative");
  CHECK(refusal(springs + "compression = -1e-9\n") ==
        "some.toml:9: 'compression' must not be negative");
  CHECK(refusal(springs + "compression = 0.999999\n") == "none");
  CHECK(refusal(springs + "compression = 1\n") == "some.toml:9: 'compression' must lie in [0, 1)");
  CHECK(refusal(springs + "tolerance = 0\n") == "some.toml:9: 'tolerance' must be > 0");
  CHECK_THAT(refusal(springs + "sweeps = 0\n"), StartsWith("some.toml:9: 'sweeps' must lie"));
  CHECK(refusal("[strain_limits]\n") ==
        "some.toml:6: [strain_limits] limits springs; the case needs a [stretch] table");
}

TEST_CASE("self-collision has its documented defaults and takes each key", "[scene]") {
  const SelfCollisionSettings plain =
      *scene_with("[self_collision]\nthickness = 0.01\n").self_collision;
  CHECK(plain.thickness == 0.01);
  CHECK(plain.stiffness == 0);
  CHECK(plain.friction == 0);
  CHECK(plain.rounds == 8);
  CHECK(plain.untangle);
  const SelfCollisionSettings full =
      *scene_with(
           "[self_collision]\nthickness = 0.02\nstiffness = 3.5\nfriction = 0.4\nrounds = 5\n"
           "untangle = false\n")
           .self_collision;
  CHECK(full.thickness == 0.02);
  CHECK(full.stiffness == 3.5);
  CHECK(full.friction == 0.4);
  CHECK(full.rounds == 5);
  CHECK_FALSE(full.untangle);
  const std::string table = "[self_collision]\nthickness = 0.02\n";
  CHECK(refusal("[self_collision]\nthickness = 0\n") == "some.toml:7: 'thickness' must be > 0");
  CHECK(refusal(table + "stiffness = -1e-9\n") == "some.toml:8: 'stiffness' must not be negative");
  CHECK(refusal(table + "friction = -1e-9\n") == "some.toml:8: 'friction' must not be negative");
  CHECK_THAT(refusal(table + "rounds = 0\n"), StartsWith("some.toml:8: 'rounds' must lie"));
}

TEST_CASE("the thickness is less than half the least height at rest", "[scene]") {
  // crossed squares of 2 x 1: triangles over the long sides are 0.5 high
  const auto cloth = [](const std::string& thickness) {
    return scene_of_cloth(
        "shape = \"sheet\"\npattern = \"criss_cross\"\nwidth = 4\nheight = 3\ncolumns = 2\n"
        "rows = 3\n[start]\nstretch = 0.1\n[self_collision]\nthickness = " +
        thickness + "\n");
  };
  CHECK(cloth("0.2499").self_collision->thickness == 0.2499);
  CHECK_THROWS_WITH(cloth("0.25"),
                    "some.toml:12: 'thickness' is 0.25 m; it must be less than half the least "
                    "height of a triangle, 0.25 m");
  CHECK_THROWS_WITH(cloth("0.375"), Contains("'thickness' is 0.375 m; it must be less than half"));
}

TEST_CASE("a start that crosses itself is refused if it is not to be untangled", "[scene]") {
  const auto cloth = [](const std::string& move, const std::string& untangle) {
    return scene_of_cloth(
        "shape = \"sheet\"\nwidth = 1\nheight = 1\ncolumns = 1\nrows = 1\n"
        "copies = { count = 2, move = " +
        move + " }\n[self_collision]\nthickness = 0.1\nuntangle = " + untangle + "\n");
  };
  CHECK_NOTHROW(cloth("[0.25, 0.125, 0]", "true"));
  CHECK_NOTHROW(cloth("[0.25, 0.125, 0.5]", "false"));
  CHECK_THROWS_WITH(
      cloth("[0, 0, 0]", "false"),
      "some.toml:11: the cloth crosses itself at the start, in 4 pairs of triangles: 0 and 2, 0 "
      "and 3, 1 and 2, 1 and 3; with untangle = true it is run and pushed apart");
}
