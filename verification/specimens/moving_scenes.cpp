#include "verification/specimens/moving_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/mesh/shapes.h"

namespace foldproof {

namespace {

Sheet irregular_sheet() {
  Sheet sheet;
  sheet.pattern = SheetPattern::random_delaunay;
  sheet.width = 0.7;
  sheet.height = 0.55;
  sheet.columns = 5;
  sheet.rows = 4;
  sheet.seed = shifted(31);
  return sheet;
}

Sheet jittered_sheet() {
  Sheet sheet;
  sheet.pattern = SheetPattern::jittered;
  sheet.width = 0.6;
  sheet.columns = 5;
  sheet.rows = 4;
  sheet.jitter = 0.27;
  sheet.seed = shifted(17);
  return sheet;
}

/// Displaces and sets in motion at random: a tenth of an edge in the plane, a third of one across it, and
/// less where triangles are thin: they are neither to be turned over nor folded back.
void crumple(Scene& scene, unsigned seed) {
  Random random(seed);
  const Eigen::Index count = scene.x.cols();
  const double size = std::min(0.013, 0.2 * least_height(scene.mesh.triangles, scene.mesh.rest));  // m
  PerParticle3 shift = random.vectors(count, size);
  shift.row(2) *= 3;
  scene.x += shift;
  scene.v = random.vectors(count, size / 0.042);
  for (double& angle : scene.rest_angles) angle = random.in(-0.6, 0.7);
}

Scene sheet_of(const Sheet& sheet, unsigned seed) {
  Scene scene = scene_of(make_sheet(sheet), 0.23);
  scene.stretch = StretchMaterial{37, 0.011, 0.97};
  scene.bending = BendingMaterial{3.1e-4, 2.3e-5, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  crumple(scene, seed);
  return scene;
}

}  // namespace

double Random::in_decades(double low, double high) { return std::exp(in(std::log(low), std::log(high))); }

PerParticle3 Random::vectors(Eigen::Index count, double size) {
  PerParticle3 result(3, count);
  for (double& component : result.reshaped()) component = in(-size, size);
  return result;
}

Scene free_sheet() { return sheet_of(irregular_sheet(), 5); }

Scene undamped_sheet() {
  Scene scene = free_sheet();
  scene.stretch->damping = 0;
  scene.bending->damping = 0;
  return scene;
}

Scene led_sheet() {
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
  scene.led = {{0, scene.x.col(0), Motion{}}, {4, scene.x.col(4), swing}, {13, scene.x.col(13), turn}};
  return scene;
}

Stepper::Stepper(const Subject& subject, Scene scene, const std::string& integrator)
    : subject_(subject), scene_(std::move(scene)) {
  scene_.integrator = integrator;
  prepared_ = offered(subject.prepare, "prepare")(scene_);
}

State Stepper::step(const State& s, double h) {
  return offered(subject_.step, "step")(*prepared_, {&s, 1}, h, work_);
}

State Stepper::step_after(const std::vector<State>& past, double h) {
  return offered(subject_.step, "step")(*prepared_, past, h, work_);
}

State Stepper::run(State s, double h, int steps) {
  for (int n = 0; n < steps; ++n) s = step(s, h);
  return s;
}

PerParticle3 Stepper::elastic_forces(const State& s) const {
  return offered(subject_.elastic_forces, "elastic_forces")(*prepared_, s);
}

PerParticle3 Stepper::damping_forces(const State& s, const PerParticle3& v) const {
  return offered(subject_.damping_forces, "damping_forces")(*prepared_, s, v);
}

double growth(Stepper& stepper, const State& start, double h, int steps) {
  const double small = 1e-7 * extent(start.x), duration = steps * h;
  Random random(41);
  State plain = start, disturbed = start;
  disturbed.x += random.vectors(start.x.cols(), small);
  disturbed.v += random.vectors(start.x.cols(), small / duration);
  Worst grown;
  grown.see(1);
  for (int n = 0; n < steps; ++n) {
    plain = stepper.step(plain, h);
    disturbed = stepper.step(disturbed, h);
    grown.see(largest_difference(plain.x, disturbed.x) / small);
    grown.see(largest_difference(plain.v, disturbed.v) * duration / small);
  }
  return grown.value();
}

double largest_difference(const PerParticle3& a, const PerParticle3& b) {
  Worst worst;
  for (Eigen::Index i = 0; i < a.cols(); ++i) worst.see((a.col(i) - b.col(i)).norm());
  return worst.value();
}

double numbers_that_differ(const PerParticle3& a, const PerParticle3& b) {
  return double((a.array() != b.array()).count());
}

double extent(const PerParticle3& x) {
  const Vector3 low = x.rowwise().minCoeff(), high = x.rowwise().maxCoeff();
  return (high - low).norm() / 2 + (high + low).norm() / 2;
}

std::string smallest_defect(double bound, const std::string& scale) {
  return fmt::format("The smallest defect that this notices is {:.1e} of the {}.", bound * epsilon, scale);
}

double largest_speed(const PerParticle3& v) { return largest_difference(v, PerParticle3::Zero(3, v.cols())); }

void add_for_each_scheme(std::vector<Check>& list, const Check& pattern,
                         const std::function<Finding(const Subject&, const std::string& integrator)>& run) {
  for (const Integrator& integrator : paper_schemes()) {
    const std::string name(integrator.name);
    Check check = pattern;
    check.name += "." + name;
    check.claim = "Scheme " + name + ": " + check.claim;
    check.run = [run, name](const Subject& subject) { return run(subject, name); };
    list.push_back(std::move(check));
  }
}

}  // namespace foldproof
