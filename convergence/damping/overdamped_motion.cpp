#include "convergence/damping/monotonicity.h"
#include "convergence/damping/sheet_modes.h"
#include "convergence/integrators/oracle_problem.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/random.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace foldproof {

namespace {

constexpr double least_ratio = 4;     // damping ratio of the slowest mode of either kind
constexpr double path_length = 1e-9;  // kg^1/2 m of every mode's coordinate

/// One mode: q = way (e^-slow t + e^-fast t)/2.
struct Decay {
  double slow, fast;  // 1/s

  double left(double t) const { return (std::exp(-slow * t) + std::exp(-fast * t)) / 2; }
  double rate(double t) const {
    return (slow * std::exp(-slow * t) + fast * std::exp(-fast * t)) / 2;
  }
};

Decay decay_of(const SheetMode& mode, const Relaxation& relaxation) {
  const oracles::Oscillator oscillator = oscillator_of(mode, relaxation);
  const double root = std::sqrt(oscillator.damping * oscillator.damping - 4 * oscillator.stiffness);
  return {2 * oscillator.stiffness / (oscillator.damping + root), (oscillator.damping + root) / 2};
}

double slowest(const std::vector<SheetMode>& modes, ModeKind kind) {
  double least = std::numeric_limits<double>::infinity();
  for (const SheetMode& mode : modes)
    if (mode.kind == kind) least = std::min(least, mode.frequency);
  return least;
}

struct ModeMotion {
  PerParticle3 shape, weight;  // 3 x N: of a unit coordinate, and what finds the coordinate
  double size;                 // of the coordinate at the start, with its sign [kg^1/2 m]
  Decay decay;
};

}  // namespace

DampedMotion overdamped_sheet(int cells) {
  const std::vector<SheetMode> modes = modes_of(sheet_at_rest(cells, {}));
  const Relaxation relaxation{2 * least_ratio / slowest(modes, ModeKind::stretch),
                              2 * least_ratio / slowest(modes, ModeKind::bending)};
  DampedMotion motion{
      "overdamped sheet", "an overdamped sheet", sheet_at_rest(cells, relaxation), 0, {}, {}, {}};
  Scene& scene = motion.scene;
  scene.solver.tolerance = 1e-12;
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  const PerParticle3 rest = scene.mesh.rest;
  std::vector<ModeMotion> moving;
  Random random(97);
  for (const SheetMode& mode : modes) {
    moving.push_back({mode.shape, mode.shape * mass.asDiagonal(),
                      random.uniform(-1, 1) < 0 ? -path_length : path_length,
                      decay_of(mode, relaxation)});
    motion.rate = std::max(motion.rate, oscillator_of(mode, relaxation).damping);
  }
  motion.exact = [rest, moving](double t) {
    State s{t, rest, PerParticle3::Zero(3, rest.cols())};
    for (const ModeMotion& mode : moving) {
      s.x += mode.size * mode.decay.left(t) * mode.shape;
      s.v -= mode.size * mode.decay.rate(t) * mode.shape;
    }
    return s;
  };
  const State start = motion.exact(0);
  scene.x = start.x;
  scene.v = start.v;
  motion.progress = [rest, moving](const State& s) {
    std::vector<double> list;
    for (const ModeMotion& mode : moving)
      list.push_back(1 - mode.weight.cwiseProduct(s.x - rest).sum() / mode.size);
    return list;
  };
  motion.speed = [moving](const State& s) {
    std::vector<double> list;
    for (const ModeMotion& mode : moving)
      list.push_back(-mode.weight.cwiseProduct(s.v).sum() / (mode.size * mode.decay.rate(0)));
    return list;
  };
  return motion;
}

DampedMotion closing_hinge() {
  // m, kg/m^2, rad, rad
  constexpr double length = 0.23, density = 0.31, rest_angle = 0.2, start_angle = 2.1;
  const TriangleMesh mesh = make_hinge(length, rest_angle);
  DampedMotion motion{
      "closing hinge", "a hinge that closes", scene_at_rest(mesh, density), 0, {}, {}, {}};
  Scene& scene = motion.scene;
  scene.x = make_hinge(length, start_angle).rest;
  scene.stretch = StretchMaterial{40, 9, 1};
  scene.bending = BendingMaterial{0.013, 0.019, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles = {rest_angle};
  scene.solver.tolerance = 1e-11;

  for (const int held : {0, 2, 3}) scene.prescribed.push_back({held, scene.x.col(held), {}});

  // the tip, particle 1, turns about the edge: damped at the rate kd |E| |u_2|^2/m
  const double mass = lumped_masses(mesh, density)[1];
  const HingeShape shape =
      hinge_shape(scene.x.col(0), scene.x.col(1), scene.x.col(2), scene.x.col(3));
  motion.rate = scene.bending->damping * length * shape.u2.squaredNorm() / mass;
  motion.exact = [scene](double t) {
    const oracles::ClothState end = exact_end(scene, oracle_of(scene), t, 1e-10).state;
    return State{t, end.x, end.v};
  };
  const double all = rest_angle - start_angle, speed = all * motion.rate;
  motion.progress = [mesh, all](const State& s) -> std::vector<double> {
    return {(hinge_angles(mesh, s.x).front() - start_angle) / all};
  };
  motion.speed = [speed](const State& s) -> std::vector<double> {
    const Eigen::Matrix<double, 3, 4> u =
        bending_mode(hinge_shape(s.x.col(0), s.x.col(1), s.x.col(2), s.x.col(3)));
    return {-u.cwiseProduct(s.v).sum() / speed};
  };
  return motion;
}

}  // namespace foldproof
