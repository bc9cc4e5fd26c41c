#include "verification/specimens/moving_sheets.h"

#include <algorithm>

#include "reference/mesh/shapes.h"
#include "verification/seeds.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

Sheet irregular_sheet() {
  return {SheetPattern::random_delaunay, 0.7, 0.55, 5, 4, 0, shifted_seed(31)};
}

Sheet jittered_sheet() { return {SheetPattern::jittered, 0.6, 0, 5, 4, 0.27, shifted_seed(17)}; }

/// Random displacements and velocities: a tenth of an edge in the plane, a third of one across it,
/// and less where triangles are thin, so that none turns over or folds back.
void crumple(Scene& scene, unsigned seed) {
  Random random(seed);
  const Eigen::Index count = scene.x.cols();
  // m
  const double size = std::min(0.013, 0.2 * smallest_height(scene.mesh.triangles, scene.mesh.rest));
  PerParticle3 shift = random.vectors(count, size);
  shift.row(2) *= 3;
  scene.x += shift;
  scene.v = random.vectors(count, size / 0.042);
  for (double& angle : scene.rest_angles) angle = random.uniform(-0.6, 0.7);
}

Scene sheet_of(const Sheet& sheet, unsigned seed) {
  Scene scene = scene_at_rest(make_sheet(sheet), 0.23);
  scene.stretch = StretchMaterial{37, 0.011, 0.97};
  scene.bending = BendingMaterial{3.1e-4, 2.3e-5, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  crumple(scene, seed);
  return scene;
}

}  // namespace

Scene free_sheet() { return sheet_of(irregular_sheet(), 5); }

Scene undamped_sheet() {
  Scene scene = free_sheet();
  scene.stretch->damping = 0;
  scene.bending->damping = 0;
  return scene;
}

Scene waved_sheet(TriangleMesh mesh, double height) {
  Scene scene = scene_at_rest(std::move(mesh), 0.21);
  scene.stretch = StretchMaterial{31, 0.017, 1};
  scene.bending = BendingMaterial{0.0019, 0.00023, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0.03);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    scene.x(2, i) += height * std::sin(37 * scene.x(0, i)) * std::cos(29 * scene.x(1, i));
    scene.v.col(i) = Vector3(std::cos(5 * scene.x(1, i)), std::sin(7 * scene.x(0, i)),
                             std::cos(3 * scene.x(0, i)));
  }
  return scene;
}

Scene partly_prescribed_sheet() {
  Scene scene = sheet_of(jittered_sheet(), 7);
  scene.gravity = Vector3(0.7, -9.1, 1.9);
  Motion swing;
  swing.velocity = Vector3(0.11, -0.07, 0.19);
  swing.amplitude = Vector3(0.013, 0.021, -0.017);
  swing.frequency = 3.7;
  swing.phase = 0.45;
  Motion turn;
  turn.velocity = Vector3(-0.05, 0.23, 0.03);
  turn.center = Vector3(0.37, -0.21, 0.15);
  turn.angular_velocity = Vector3(0.8, -1.3, 2.1);
  scene.prescribed = {
      {0, scene.x.col(0), Motion{}}, {4, scene.x.col(4), swing}, {13, scene.x.col(13), turn}};
  return scene;
}

}  // namespace foldproof
