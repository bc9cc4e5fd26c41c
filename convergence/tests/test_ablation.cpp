// Basis of the verdicts of `foldproof ablate`: finer meshes that are the same cloth, a coarser one
// compared, parts that are toggled one by one, needs.
#include <catch2/catch.hpp>
#include <map>

#include "convergence/any_case/ablation.h"
#include "reference/forces/bending.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/refine_cloth.h"

using namespace foldproof;

namespace {

Scene trial(const std::vector<std::string>& overrides = {}) {
  return read_scene_text(
      "[cloth]\nshape = \"sheet\"\npattern = \"alternating\"\nwidth = 0.3\nheight = 0.2\n"
      "columns = 6\nrows = 4\ndensity = 0.2\npleats = { columns = 2, angle = 40 }\n[gravity]\n"
      "[stretch]\nstiffness = 40\ndamping = 0.02\n[bending]\nstiffness = 1e-3\n"
      "[self_collision]\nthickness = 0.004\n[[object]]\nname = \"floor\"\n"
      "shape = \"half_space\"\nturn = { axis = [1, 0, 0], angle = -90 }\nmove = [0, -0.02, 0]\n"
      "friction = 0.3\n[[hold]]\nbox = [[-1, 0.19, -1], [1, 1, 1]]\n[time]\nend = 0.05\n"
      "frames_per_second = 100\n",
      "trial.toml", overrides);
}

double bending_energy_of(const Scene& scene, const PerParticle3& x) {
  double energy = 0;
  for (const Force& force : build_system(scene).forces)
    if (const auto* bending = std::get_if<Bending>(&force))
      energy += bending->energy({0, x, 0 * x}, bending->shapes_at(x));
  return energy;
}

/// A run of one particle that is at x in both of its frames.
ObservedRun made_up_run(double x) {
  ObservedRun run;
  run.times = {0, 1};
  run.x = {Vector3(x, 0, 0), Vector3(x, 0, 0)};
  run.energy = {1, 1};
  return run;
}

Need judge_need(bool is_present, const ObservedRun& scene, const ObservedRun& toggled) {
  const ScenePart one{"part", is_present, {}};
  const DiscretisationError error{{0.005, 0.01, ""}, {0.005, 0.02, ""}, 1e-6};
  return judge_part(one, scene, toggled, error, PerParticle::Constant(1, 0.5)).need;
}

}  // namespace

TEST_CASE("a finer mesh is the same cloth") {
  const Scene scene = trial(), finer = trial({"cloth.refine=1"});
  CHECK(finer.mesh.triangles.size() == 4 * scene.mesh.triangles.size());
  CHECK(finer.x.leftCols(scene.x.cols()) == scene.x);
  CHECK(bending_energy_of(finer, finer.mesh.rest) < 1e-12 * bending_energy_of(scene, scene.x));
  CHECK(finer.prescribed.size() == 7 + 6);  // a row of particles, and the middles of its edges
  for (const PrescribedParticle& p : finer.prescribed) CHECK(p.start == finer.x.col(p.particle));
}

TEST_CASE("halves of a hinge's edge have its rest angle, new edges have none") {
  Scene scene = trial();
  double sum = 0;
  for (size_t h = 0; h < scene.rest_angles.size(); ++h)
    sum += scene.rest_angles[h] = 0.01 * double(h + 1);
  Scene finer = scene;
  refine_cloth(finer);
  for (size_t h = 0; h < finer.rest_angles.size(); ++h) {
    const Edge& edge = finer.mesh.edges[size_t(finer.mesh.hinges[h].edge)];
    CHECK((finer.rest_angles[h] > 0) == (edge.a < scene.mesh.particles()));
    sum -= finer.rest_angles[h] / 2;
  }
  CHECK(sum == Approx(0).margin(1e-10));
}

TEST_CASE("each part of a scene can be toggled by itself") {
  const Scene scene = trial();
  std::map<std::string, Scene> without;
  for (const ScenePart& one : parts_of(scene)) {
    without[one.name] = one.toggled(scene);
    CHECK_NOTHROW(build_system(without[one.name]));
  }
  CHECK_FALSE(without.at("gravity").gravity);
  CHECK(without.at("damping of springs").stretch->damping == 0);
  CHECK_FALSE(without.at("bending").bending);
  CHECK(without.at("rest angles").rest_angles[0] == 0);
  CHECK(without.at("object 'floor'").objects.empty());
  CHECK(without.at("friction of objects").objects[0].object.friction == 0);
  CHECK(without.at("held particles").prescribed.empty());
  CHECK_FALSE(without.at("self-collision").self_collision);
  CHECK(without.at("strain limits").strain_limits);
}

TEST_CASE("parts are taken from every fabric, and put into every one") {
  Scene scene = trial();
  const auto damping = [](const Scene& of) {
    double sum = 0;
    const System system = build_system(of);
    for (const Force& one : system.forces) {
      if (const auto* springs = std::get_if<StretchSprings>(&one))
        for (const Spring& spring : springs->springs) sum += spring.damping;
      if (const auto* bending = std::get_if<Bending>(&one)) sum += bending->material.damping;
    }
    return sum;
  };
  ClothFabric hem = fabrics_of(scene).front();
  hem.friction = 0.4;
  scene.fabrics.fabrics = {fabrics_of(scene).front(), hem};
  scene.fabrics.of_triangle.assign(scene.mesh.triangles.size(), 0);
  scene.fabrics.of_triangle[1] = 1;
  CHECK(damping(scene) > 0);
  std::map<std::string, Scene> without;
  for (const ScenePart& one : parts_of(scene)) without[one.name] = one.toggled(scene);
  Scene still = without.at("damping of springs");
  still.bending.reset();
  CHECK(damping(still) == 0);
  CHECK(friction_of(without.at("friction of objects")).maxCoeff() == 0);
  Scene apart = without.at("self-collision");
  apart.self_collision = SelfCollisionSettings{0.003};
  CHECK(layers_of(apart).thickness.minCoeff() == Approx(0.003));
}

TEST_CASE("without its flat pattern, cloth rests as it starts") {
  Scene scene = trial();
  const Scene folded = scene;
  for (const Triangle& t : scene.mesh.triangles) {
    FlatTriangle flat;
    for (size_t k = 0; k < 3; ++k) flat[k] = 2 * scene.mesh.rest.col(t[k]).head<2>();
    scene.mesh.pattern.push_back(flat);
  }
  std::ranges::fill(scene.rest_angles, 0.0);
  CHECK(masses_of(scene).sum() > 3 * masses_of(folded).sum());
  const std::vector<ScenePart> parts = parts_of(scene);
  const Scene without = std::ranges::find(parts, "flat pattern", &ScenePart::name)->toggled(scene);
  CHECK(masses_of(without) == masses_of(folded));
  CHECK(without.rest_angles == folded.rest_angles);
}

TEST_CASE("a coarser mesh is compared where it lies on the finer one") {
  const TriangleMesh fine = make_geodesic_sphere(1, 12), coarse = make_geodesic_sphere(1, 5);
  const double r = coarseness(fine, coarse);
  CHECK(r == Approx(12 / 5.0).epsilon(1e-12));
  ObservedRun run, coarser;
  run.x = {fine.rest, fine.rest};
  coarser.x = {coarse.rest, coarse.rest};
  coarser.x[1].row(1).array() += 0.3;  // carried away as one
  CHECK(error_from_coarser(run, fine, coarser, coarse) == Approx(0.3 / (r - 1)).epsilon(1e-12));
  CHECK(std::isnan(error_from_coarser(ObservedRun{}, fine, coarser, coarse)));
  CHECK_THROWS_AS(coarseness(coarse, fine), InputError);
  CHECK_THROWS_AS(coarseness(fine, make_geodesic_sphere(1, 11)), InputError);
}

TEST_CASE("a part is needed when it changes more than the scene's own error") {
  const ObservedRun scene = made_up_run(0);
  CHECK(judge_need(true, scene, made_up_run(0.009)) == Need::not_needed);
  CHECK(judge_need(true, scene, made_up_run(0.031)) == Need::needed);
  CHECK(judge_need(false, scene, made_up_run(0.009)) == Need::no_effect);
  CHECK(judge_need(false, scene, made_up_run(0.031)) == Need::missing);
  CHECK(judge_need(true, scene, made_up_run(std::nan(""))) == Need::needed);
}

TEST_CASE("whether a part is needed cannot be told within the error bar of the scene's own error") {
  const ObservedRun scene = made_up_run(0);
  ObservedRun sinks = scene;
  sinks.deepest = 0.011;
  for (const double moved : {0.011, 0.029})
    for (const bool is_present : {true, false})
      CHECK(judge_need(is_present, scene, made_up_run(moved)) == Need::cannot_tell);
  CHECK(judge_need(true, scene, sinks) == Need::cannot_tell);
  CHECK(judge_need(false, scene, sinks) == Need::no_effect);
  CHECK(judge_need(false, sinks, scene) == Need::cannot_tell);
}

TEST_CASE("a part is needed where cloth fails without it, however little it moves") {
  const ObservedRun scene = made_up_run(0);
  ObservedRun stops = scene, crosses = scene, sinks = scene, fails = scene, asks = scene;
  stops.stopped = "it stopped";
  crosses.crossings = 3;
  sinks.deepest = 0.031;
  fails.failed_keys = {"stays_flat"};
  asks.expected_keys = {"sticks"};
  CHECK(judge_need(true, asks, scene) == Need::needed);
  CHECK(judge_need(true, asks, asks) == Need::not_needed);
  CHECK(judge_need(false, asks, scene) == Need::no_effect);
  for (const ObservedRun& broken : {stops, crosses, sinks, fails}) {
    CHECK(judge_need(true, scene, broken) == Need::needed);
    CHECK(judge_need(true, broken, broken) == Need::not_needed);
    CHECK(judge_need(false, broken, scene) == Need::missing);
    CHECK(judge_need(false, scene, broken) == Need::no_effect);
  }
}

TEST_CASE("a need is justified exactly if the case declares it, or neither is there") {
  JudgedPart part{"gravity", true, Need::needed, "", 0, 0, "", {}};
  for (const std::string declared : {"", "a reason"})
    for (const Need need : {Need::needed, Need::not_needed, Need::cannot_tell}) {
      part.declared = declared, part.need = need;
      CHECK(part.is_justified() ==
            (need == Need::cannot_tell || declared.empty() == (need == Need::needed)));
    }
  Case input_case{trial(), {}, {{"strain limits", "a reason"}, {"finer mesh", "a reason"}}};
  const std::vector<ScenePart> parts = parts_of(input_case.scene);
  CHECK(declared_reason(input_case, "strain limits") == "a reason");
  CHECK(declared_reason(input_case, "gravity").empty());
  CHECK_NOTHROW(reject_unknown_parts(input_case, parts));
  input_case.declared.push_back({"wind", "a reason"});
  CHECK_THROWS_AS(reject_unknown_parts(input_case, parts), InputError);
}
