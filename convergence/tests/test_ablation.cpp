// Basis of the verdicts of `foldproof ablate`: finer meshes that are the same cloth, a coarser one
// compared, parts that are toggled one by one, needs.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "convergence/any_case/ablation.h"
#include "convergence/any_case/coarser_mesh.h"
#include "reference/forces/bending.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/refine_cloth.h"

using namespace foldproof;

namespace {

constexpr const char* text = R"([cloth]
shape = "sheet"
pattern = "alternating"
width = 0.3
height = 0.2
columns = 6
rows = 4
density = 0.2
pleats = { columns = 2, angle = 40 }
[gravity]
[stretch]
stiffness = 40
damping = 0.02
[bending]
stiffness = 1e-3
[self_collision]
thickness = 0.004
[[object]]
name = "floor"
shape = "half_space"
turn = { axis = [1, 0, 0], angle = -90 }
move = [0, -0.02, 0]
friction = 0.3
[[hold]]
box = [[-1, 0.19, -1], [1, 1, 1]]
[time]
end = 0.05
frames_per_second = 100
)";

Scene trial(const std::vector<std::string>& overrides = {}) {
  return read_scene_text(text, "trial.toml", overrides);
}

double energy_of(const Scene& scene, const PerParticle3& x) {
  double energy = 0;
  const State s{0, x, PerParticle3::Zero(3, x.cols())};
  for (const Force& force : build_system(scene).forces)
    if (const auto* bending = std::get_if<Bending>(&force))
      energy += bending->energy(s, bending->shapes_at(x));
  return energy;
}

const ScenePart& part_named(const std::vector<ScenePart>& parts, const std::string& name) {
  for (const ScenePart& one : parts)
    if (one.name == name) return one;
  throw InputError("no part " + name);
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
  CHECK(lumped_masses(finer.mesh, finer.density).sum() ==
        Approx(lumped_masses(scene.mesh, scene.density).sum()).epsilon(1e-13));
  CHECK(energy_of(finer, finer.mesh.rest) < 1e-12 * energy_of(scene, scene.x));
  CHECK(finer.self_collision->thickness == 0.004);
  CHECK(finer.prescribed.size() == 7 + 6);  // a row of particles, and the middles of its edges
  for (const PrescribedParticle& p : finer.prescribed) CHECK(p.start == finer.x.col(p.particle));
}

TEST_CASE("halves of a hinge's edge have its rest angle, new edges have none") {
  Scene scene = trial();
  for (size_t h = 0; h < scene.rest_angles.size(); ++h) scene.rest_angles[h] = 0.01 * double(h + 1);
  Scene finer = scene;
  refine_cloth(finer);
  double sum = 0, of_halves = 0;
  for (const double angle : scene.rest_angles) sum += angle;
  for (const double angle : finer.rest_angles) of_halves += angle;
  CHECK(of_halves == Approx(2 * sum).epsilon(1e-13));
  for (size_t h = 0; h < finer.rest_angles.size(); ++h) {
    const Edge& edge = finer.mesh.edges[size_t(finer.mesh.hinges[h].edge)];
    CHECK((finer.rest_angles[h] > 0) == (edge.a < scene.mesh.particles()));
  }
}

TEST_CASE("each part of a scene can be toggled by itself") {
  const Scene scene = trial();
  const std::vector<ScenePart> parts = parts_of(scene);
  CHECK_FALSE(part_named(parts, "gravity").toggled(scene).gravity);
  CHECK(part_named(parts, "damping of springs").toggled(scene).stretch->damping == 0);
  CHECK_FALSE(part_named(parts, "bending").toggled(scene).bending);
  CHECK(part_named(parts, "rest angles").toggled(scene).rest_angles[0] == 0);
  CHECK(part_named(parts, "object 'floor'").toggled(scene).objects.empty());
  CHECK(part_named(parts, "friction of objects").toggled(scene).objects[0].object.friction == 0);
  CHECK(part_named(parts, "held particles").toggled(scene).prescribed.empty());
  CHECK_FALSE(part_named(parts, "self-collision").toggled(scene).self_collision);
  CHECK_FALSE(part_named(parts, "strain limits").is_present);
  CHECK(part_named(parts, "strain limits").toggled(scene).strain_limits);
  CHECK_FALSE(part_named(parts, "points between particles").is_present);
  for (const ScenePart& one : parts) CHECK_NOTHROW(build_system(one.toggled(scene)));
}

TEST_CASE("positions differ by the root mean square over particles, in the worst frame") {
  ObservedRun a, b;
  a.x = {PerParticle3::Zero(3, 2), PerParticle3::Zero(3, 2)};
  b.x = a.x;
  b.x[1].col(0) = Vector3(0, 3, 4);
  CHECK(position_difference(a, b, PerParticle::Constant(2, 0.7)) == Approx(5 / std::sqrt(2)));
  CHECK(position_difference(a, b, Eigen::Vector2d(0.1, 0.3)) == Approx(5 / 2.0));
  b.x[0](0, 0) = std::nan("");
  CHECK(std::isnan(position_difference(a, b, PerParticle::Constant(2, 0.7))));
}

TEST_CASE("a coarser mesh is compared where it lies on the finer one") {
  const TriangleMesh fine = make_geodesic_sphere(1, 12), coarse = make_geodesic_sphere(1, 5);
  const double r = coarseness(fine, coarse);
  CHECK(r == Approx(12 / 5.0).epsilon(1e-12));
  const auto bulged = [](const PerParticle3& x, double by) {
    PerParticle3 moved = x;
    moved.row(1).array() += by * x.row(0).array().square();
    return moved;
  };
  ObservedRun run, coarser;
  run.x = {fine.rest, bulged(fine.rest, 0.1)};
  coarser.x = {coarse.rest, bulged(coarse.rest, 0.1)};
  // the same motion: what is left, e^2 / 8 of x^2 for sides e = 0.1, is that facets
  // are moved linearly
  CHECK(error_from_coarser(run, fine, coarser, coarse) < 0.1 * 0.1 * 0.1 / 8 / (r - 1) * 2);
  // another one: by 0.02 x^2, whose square has the mean 1/5 on the sphere
  coarser.x[1] = bulged(coarse.rest, 0.12);
  CHECK(error_from_coarser(run, fine, coarser, coarse) ==
        Approx(0.02 / std::sqrt(5.0) / (r - 1)).epsilon(0.1));
  // carried away as one: by 0.3 m, wherever its particles are
  coarser.x[1] = coarse.rest.colwise() + Vector3(0, 0.3, 0);
  run.x[1] = fine.rest;
  CHECK(error_from_coarser(run, fine, coarser, coarse) == Approx(0.3 / (r - 1)).epsilon(1e-12));
  CHECK(std::isnan(error_from_coarser(ObservedRun{}, fine, coarser, coarse)));
  CHECK_THROWS_AS(coarseness(coarse, fine), InputError);
  CHECK_THROWS_AS(coarseness(fine, make_geodesic_sphere(1, 11)), InputError);
}

TEST_CASE("a case names its coarser mesh beside its reasons") {
  const std::string path = "coarser_mesh_trial.toml";
  std::ofstream(path)
      << text << "[ablation]\ncoarser_mesh = \"cloth.rows=2\"\n\"gravity\" = \"a reason\"\n";
  const Case input_case = read_case(path);
  CHECK(input_case.coarser_mesh == std::vector<std::string>{"cloth.rows=2"});
  REQUIRE(input_case.declared.size() == 1);
  CHECK(input_case.declared[0].part == "gravity");
  std::filesystem::remove(path);
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
  ObservedRun sinks = made_up_run(0);
  sinks.deepest = 0.011;
  for (const double moved : {0.011, 0.029})
    for (const bool is_present : {true, false})
      CHECK(judge_need(is_present, scene, made_up_run(moved)) == Need::cannot_tell);
  CHECK(judge_need(true, scene, sinks) == Need::cannot_tell);
  CHECK(judge_need(false, scene, sinks) == Need::no_effect);
  CHECK(judge_need(false, sinks, scene) == Need::cannot_tell);
  JudgedPart part{"gravity", true, Need::cannot_tell, "", 0, 0, "", {}};
  CHECK(part.is_justified());
  part.declared = "a reason";
  CHECK(part.is_justified());
}

TEST_CASE("a part is needed where cloth fails without it, however little it moves") {
  const ObservedRun scene = made_up_run(0);
  const auto with = [](auto change) {
    ObservedRun run = made_up_run(0);
    change(run);
    return run;
  };
  const ObservedRun stops = with([](ObservedRun& r) { r.stopped = "it stopped"; });
  const ObservedRun crosses = with([](ObservedRun& r) { r.crossings = 3; });
  const ObservedRun sinks = with([](ObservedRun& r) { r.deepest = 0.031; });
  const ObservedRun fails = with([](ObservedRun& r) { r.failed_keys = {"stays_flat"}; });
  const ObservedRun asks = with([](ObservedRun& r) { r.expected_keys = {"sticks"}; });
  CHECK(judge_need(true, asks, made_up_run(0)) == Need::needed);
  CHECK(judge_need(true, asks, asks) == Need::not_needed);
  CHECK(judge_need(false, asks, made_up_run(0)) == Need::no_effect);
  for (const ObservedRun& broken : {stops, crosses, sinks, fails}) {
    CHECK(judge_need(true, scene, broken) == Need::needed);
    CHECK(judge_need(true, broken, broken) == Need::not_needed);
    CHECK(judge_need(false, broken, scene) == Need::missing);
    CHECK(judge_need(false, scene, broken) == Need::no_effect);
  }
}

TEST_CASE("what a case declares is asked for, and no more than that") {
  JudgedPart part{"gravity", true, Need::needed, "", 0, 0, "", {}};
  CHECK(part.is_justified());
  part.declared = "a reason";
  CHECK_FALSE(part.is_justified());
  part.need = Need::not_needed;
  CHECK(part.is_justified());
  part.declared = "";
  CHECK_FALSE(part.is_justified());

  Case input_case{trial(), {}, {{"strain limits", "a reason"}}};
  const std::vector<ScenePart> parts = parts_of(input_case.scene);
  CHECK(declared_reason(input_case, "strain limits") == "a reason");
  CHECK(declared_reason(input_case, "gravity").empty());
  input_case.declared.push_back({"finer mesh", "two triangles are all there is"});
  CHECK_NOTHROW(reject_unknown_parts(input_case, parts));
  input_case.declared.push_back({"wind", "a reason"});
  CHECK_THROWS_AS(reject_unknown_parts(input_case, parts), InputError);
}
