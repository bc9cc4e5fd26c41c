#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "convergence/damping/damped_motion.h"
#include "convergence/damping/monotonicity.h"
#include "convergence/damping/sheet_modes.h"
#include "convergence/integrators/oracle_problem.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/random.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double runaway = 1e9;

/// Coordinates of a state along fixed directions: sum over particles of weights . (x - x0) and
/// of weights . v.
struct Coordinates {
  PerParticle3 start;                 // x0, 3 x N [m]
  std::vector<PerParticle3> weights;  // 3 x N each
  std::vector<double> ways, speeds;   // the whole way [m], the speed at the start [m/s], of each

  std::vector<double> progress(const State& s) const {
    std::vector<double> list;
    for (size_t i = 0; i < weights.size(); ++i)
      list.push_back(weights[i].cwiseProduct(s.x - start).sum() / ways[i]);
    return list;
  }
  std::vector<double> speed(const State& s) const {
    std::vector<double> list;
    for (size_t i = 0; i < weights.size(); ++i)
      list.push_back(weights[i].cwiseProduct(s.v).sum() / speeds[i]);
    return list;
  }
};

void measure_by(const Coordinates& coordinates, DampedMotion& motion) {
  const auto shared = std::make_shared<Coordinates>(coordinates);
  motion.progress = [shared](const State& s) { return shared->progress(s); };
  motion.speed = [shared](const State& s) { return shared->speed(s); };
}

Vector3 row3(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

/// Total change of the hinge's angle [rad], by an oracle that integrates until e^-40 of the
/// motion is left.
double whole_fold(const DampedMotion& motion) {
  const ExactEnd end = exact_end(motion.scene, oracle_of(motion.scene), 40 / motion.rate, 1e-11);
  return hinge_angles(motion.scene.mesh, end.state.x).front() -
         hinge_angles(motion.scene.mesh, motion.scene.x).front();
}

}  // namespace

DampedMotion expanding_triangle() {
  // m, kg/m^2, N s/m, m
  constexpr double edge = 0.37, density = 0.19, damping = 0.013, path_length = 1e-6;
  const double radius = edge / std::sqrt(3.0);
  PerParticle3 rest(3, 3), outward(3, 3);
  for (int i = 0; i < 3; ++i) {
    const double angle = 0.3 + 2 * EIGEN_PI / 3 * i;
    outward.col(i) = row3({std::cos(angle), std::sin(angle), 0});
    rest.col(i) = radius * outward.col(i);
  }
  DampedMotion motion{"triangle",
                      "an expanding triangle",
                      scene_at_rest(make_triangle_mesh(rest, {{0, 1, 2}}), density),
                      9 * damping / (density * edge * edge),
                      {},
                      {},
                      {}};
  motion.scene.stretch = StretchMaterial{0, damping, 1};
  motion.scene.solver.tolerance = 1e-13;
  const double speed = path_length * motion.rate, rate = motion.rate;
  motion.scene.v = speed * outward;
  motion.exact = [rest, outward, path_length, speed, rate](double t) {
    const double left = std::exp(-rate * t);
    return State{t, rest + path_length * (1 - left) * outward, speed * left * outward};
  };
  measure_by({rest, {outward / 3}, {path_length}, {speed}}, motion);
  return motion;
}

DampedMotion folding_hinge() {
  constexpr double length = 0.23, density = 0.31, damping = 0.0017, spring_damping = 0.011,
                   fold = 0.8;
  const TriangleMesh mesh = make_hinge(length, -0.35);
  DampedMotion motion{"hinge", "a folding hinge", scene_at_rest(mesh, density), 0, {}, {}, {}};
  Scene& scene = motion.scene;
  scene.stretch = StretchMaterial{0, spring_damping, 1};
  scene.bending = BendingMaterial{0, damping};
  scene.rest_angles = {0};
  scene.solver.tolerance = 1e-11;

  // v = -s M^{-1} u turns the angle at the rate s sum |u_i|^2/m_i, damped at the rate kd |E|
  // sum |u_i|^2/m_i
  const PerParticle mass = lumped_masses(mesh, density);
  const Eigen::Matrix<double, 3, 4> mode =
      bending_mode(hinge_shape(scene.x.col(0), scene.x.col(1), scene.x.col(2), scene.x.col(3)));
  const double mobility = mode.colwise().squaredNorm().dot(mass.cwiseInverse().transpose());
  motion.rate = damping * length * mobility;
  scene.v = -fold * motion.rate / mobility * mode * mass.cwiseInverse().asDiagonal();

  motion.exact = [scene](double t) {
    const oracles::ClothState end = exact_end(scene, oracle_of(scene), t, 1e-11).state;
    return State{t, end.x, end.v};
  };
  const double start = hinge_angles(mesh, scene.x).front(), path_length = whole_fold(motion);
  motion.progress = [mesh, start, path_length](const State& s) -> std::vector<double> {
    return {(hinge_angles(mesh, s.x).front() - start) / path_length};
  };
  const double speed = fold * motion.rate;
  motion.speed = [speed](const State& s) -> std::vector<double> {
    const Eigen::Matrix<double, 3, 4> u =
        bending_mode(hinge_shape(s.x.col(0), s.x.col(1), s.x.col(2), s.x.col(3)));
    return {-u.cwiseProduct(s.v).sum() / speed};
  };
  return motion;
}

DampedMotion sheet_in_plane(int cells) {
  // s, kg^1/2 m of every mode's coordinate
  constexpr double relaxation = 0.011, path_length = 1e-9;
  const Scene elastic = sheet_at_rest(cells, {relaxation, 0});
  DampedMotion motion{"sheet", "a sheet", elastic, 0, {}, {}, {}};
  Scene& scene = motion.scene;
  scene.stretch->stiffness = 0;
  scene.bending.reset();
  scene.solver.tolerance = 1e-12;

  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  Coordinates coordinates{scene.x, {}, {}, {}};
  std::vector<double> rates;
  std::vector<PerParticle3> shapes;
  Random random(83);
  for (const SheetMode& mode : modes_of(elastic)) {
    if (mode.kind != ModeKind::stretch) continue;
    rates.push_back(relaxation * mode.frequency * mode.frequency);
    const double speed = (random.uniform(-1, 1) < 0 ? -path_length : path_length) * rates.back();
    shapes.push_back(mode.shape);
    coordinates.weights.push_back(mode.shape * mass.asDiagonal());
    coordinates.speeds.push_back(speed);
    coordinates.ways.push_back(speed / rates.back());
    scene.v += speed * mode.shape;
  }
  motion.rate = *std::ranges::max_element(rates);
  motion.exact = [coordinates, rates, shapes](double t) {
    State s{t, coordinates.start, PerParticle3::Zero(3, coordinates.start.cols())};
    for (size_t i = 0; i < rates.size(); ++i) {
      const double left = std::exp(-rates[i] * t);
      s.x += coordinates.ways[i] * (1 - left) * shapes[i];
      s.v += coordinates.speeds[i] * left * shapes[i];
    }
    return s;
  };
  measure_by(coordinates, motion);
  return motion;
}

DampedRun run_damped(const Subject& subject, const DampedMotion& motion, std::string_view method,
                     double a, int steps) {
  const double h = 2 * a / motion.rate;
  Stepper stepper(subject, motion.scene, std::string(method));
  std::vector<State> past = {stepper.start()};
  DampedRun run;
  const PerParticle mass = lumped_masses(motion.scene.mesh, motion.scene.density);
  const double start = motion.scene.v.colwise().squaredNorm().dot(mass.transpose());
  const auto record = [&] {
    run.progress.push_back(motion.progress(past.back()));
    run.speed.push_back(motion.speed(past.back()));
    run.kinetic_energy.push_back(past.back().v.colwise().squaredNorm().dot(mass.transpose()) /
                                 start);
    return std::ranges::all_of(run.progress.back(), [](double p) { return std::abs(p) < runaway; });
  };
  record();
  if (method == "BDF2") {
    past.push_back(motion.exact(h));
    record();
  }
  while (int(run.progress.size()) <= steps) {
    State next = stepper.step_after(past, h);
    if (past.size() > 1) past.erase(past.begin());
    past.push_back(std::move(next));
    if (!record()) break;
  }
  run.work = stepper.work();
  return run;
}

double largest_progress(const DampedRun& run) {
  Worst largest;
  for (const std::vector<double>& row : run.progress)
    for (const double progress : row) largest.observe(progress);
  return largest.value();
}

double largest_reversal(const DampedRun& run) {
  Worst largest;
  for (size_t n = 1; n < run.progress.size(); ++n)
    for (size_t i = 0; i < run.progress[n].size(); ++i)
      largest.observe(run.progress[n - 1][i] - run.progress[n][i]);
  return largest.value();
}

double worst_overshoot_or_reversal(const DampedRun& run) {
  Worst worst;
  worst.observe(largest_reversal(run));
  worst.observe(largest_progress(run) - 1);
  return worst.value();
}

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
  scene.bending = BendingMaterial{0.013, 0.019};
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
