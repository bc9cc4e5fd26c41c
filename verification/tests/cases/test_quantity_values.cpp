// Quantities of [expect] on a sheet whose places and speeds give answers by hand, and those of a
// whole run.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"
#include "verification/cases/quantities.h"

using namespace foldproof;

namespace {

Approx exactly(double value) { return Approx(value).epsilon(1e-10).margin(1e-13); }

PerParticle3 random_places(int count, double reach, unsigned seed) {
  std::mt19937 bits(seed);
  std::uniform_real_distribution<double> within(-reach, reach);
  PerParticle3 x(3, count);
  for (double& number : x.reshaped()) number = within(bits);
  return x;
}

/// Cloth of 20 particles in the plane z = 0.4, with everything that quantities need.
Scene scene_of_everything() {
  TriangleMesh mesh = make_sheet({SheetPattern::union_jack, 0.5, 0.33, 4, 3});
  mesh.rest.row(2).setConstant(0.4);
  Scene scene = scene_at_rest(make_triangle_mesh(mesh.rest, mesh.triangles), 0.23);
  scene.gravity = Vector3(1, -7, 2);
  scene.stretch = StretchMaterial{30, 0, 0.93};
  scene.bending = BendingMaterial{1e-3};
  const PerParticle3 angles = random_places(int(scene.mesh.hinges.size()), 3.1, 7);
  for (std::size_t h = 0; h < scene.mesh.hinges.size(); ++h)
    scene.rest_angles.push_back(angles(1, Eigen::Index(h)));
  scene.strain_limits = StrainLimits{0.13, 0.07};
  scene.x += random_places(20, 0.05, 3);
  return scene;
}

double value(const char* key, const Scene& scene, const State& s,
             std::span<const Object> objects = {}) {
  return value_at(*find_quantity(key), scene, objects, s);
}

}  // namespace

TEST_CASE("quantities of objects: depths of free particles, and what two objects pinch") {
  Scene scene = scene_of_everything();
  scene.prescribed.push_back({0, Vector3::Zero(), {}});
  State s{0.7, scene.x.array() + 5, scene.v};
  s.x.col(0) = Vector3(0, 0, 0.15);     // held, 5 cm deep in the first ball
  s.x.col(7) = Vector3(0.17, 0, 0);     // 3 cm deep in it
  s.x.col(4) = Vector3(0, 0.16, 0);     // 4 cm deep in it, 6 cm in the second
  s.x.col(19) = Vector3(0.17, 0.3, 0);  // 3 cm deep in the second, 2 cm in the third
  std::vector<Object> objects;
  for (const auto& [radius, place] :
       {std::pair(0.2, Vector3(0, 0, 0)), {0.2, Vector3(0, 0.3, 0)}, {0.1, {0.25, 0.3, 0}}}) {
    RigidObject body{Sphere{radius}, {}, {}};
    body.place.translation = place;
    objects.push_back({"ball", body, 0.3});
  }
  RunResult result;
  result.last = s;
  const Repetition repetition(scene, computing_provider());
  for (int turn = 0; turn < 3; ++turn) {
    CHECK(value("stays_outside", scene, s, objects) == exactly(0.03));
    CHECK(value("faces_outside", scene, s, objects) == exactly(0.03));
    CHECK(value("is_pinched", scene, s, objects) == 2);
    CHECK(value("stays_between", scene, s, objects) == exactly(0.01));
    CHECK(find_quantity("lies_inside")->of_run({scene, {}, result, repetition, objects}) ==
          exactly(0.03));
    std::ranges::rotate(objects, objects.begin() + 1);
  }
}

TEST_CASE("quantities of a run: energies, momenta, contacts and steps from its diagnostics") {
  const Scene scene = scene_of_everything();
  DiagnosticsSummary summary;
  // until 2 s; the last tenth begins at 1.8 s; momenta are along x, 0 at the start
  const auto record = [&](double time, const Energies& energy, double damped, double momentum) {
    Diagnostics row;
    row.time = time, row.step = time < 1 ? 0.1 : 0.3, row.energy = energy;
    row.damping_work = damped, row.linear_momentum = Vector3(momentum, 0, 0);
    row.angular_momentum = 2 * row.linear_momentum;
    row.work.object_contacts = time == 1 ? 7 : 2;
    summary.record(row, 2);
  };
  Energies e;
  e.kinetic = 1, e.stretch = 2, e.bending = 3, e.gravity = 4;
  record(0, e, 0, 0), record(0.2, e, -0.5, -2), record(0.21, e, -3, 1);
  for (const auto term :
       {&Energies::kinetic, &Energies::stretch, &Energies::bending, &Energies::gravity}) {
    Energies more = e;
    more.*term += 2;
    record(1, more, 2, 0);
    CHECK(std::exchange(summary.largest_exchange, 0) == 2);
  }
  e.bending -= 2.5, record(1.79, e, -2.5, 0), e.bending += 2.5;
  e.kinetic = 0.5, e.stretch = 2.5, record(1.8, e, 0.25, 0), record(2, e, 0, 0);
  RunResult result;
  result.last = start_state(scene);
  result.steps = 37, result.work.unfinished_solves = 5;
  const Repetition repetition(scene, computing_provider());
  const auto of_run = [&](const char* key) {
    return find_quantity(key)->of_run({scene, summary, result, repetition});
  };
  const double momentum = std::sqrt(2 * 0.23 * 0.5 * 0.33 * 3);
  for (const double farther : {1.3, 1 / 1.3}) {  // from the origin at the end, or at the start
    result.last.x = farther * scene.x;
    const double reach = scene.x.colwise().norm().maxCoeff() * std::max(1.0, farther);
    CHECK(of_run("angular_momentum_is_conserved") == exactly(4 / (reach * momentum)));
  }
  CHECK(of_run("energy_is_accounted_for") == exactly(3 / 2.5));
  CHECK(of_run("energy_does_not_drift") == exactly((0.25 + 0.125) / 2.5));
  CHECK(of_run("linear_momentum_is_conserved") == exactly(2 / momentum));
  CHECK(of_run("comes_to_rest") == exactly(0.5 / 3));
  CHECK(of_run("makes_contact") == 7);
  CHECK(of_run("takes_steps") == 37);
  CHECK(of_run("solves_converge") == 5);
  CHECK(of_run("runs_to_its_end") == 0);
  result.stop = Stop{"it stops", 1.9, 4, 2};
  CHECK(of_run("runs_to_its_end") == 1);
}
