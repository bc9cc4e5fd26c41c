// Laws of symmetry: a solver must not know where, how turned, or how numbered a sheet is.
#include <numeric>

#include <Eigen/Geometry>

#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr long steps = 20;

const Vector3 earth{0, 0, -9.81};

PortableScene original() {
  PortableScene scene = moving_sheet();
  scene.gravity = earth;
  return scene;
}

/// The scene turned by a matrix (orthogonal) and shifted [m].
PortableScene moved(const Eigen::Matrix3d& turn, const Vector3& shift) {
  PortableScene scene = original();
  scene.mesh.rest = (turn * scene.mesh.rest).colwise() + shift;
  scene.x = (turn * scene.x).colwise() + shift;
  scene.v = turn * scene.v;
  scene.gravity = turn * scene.gravity;
  return scene;
}

/// Two runs round differently, within the bound of one each.
double allowed(Trial& trial, const PortableScene& scene) {
  const Declaration& declared = trial.declaration();
  return narrow(2 * rounding_error(scene, steps, declared), declared);
}

Finding moves_to(Trial& trial, const PortableScene& scene, const PerParticle3& expected,
                 const char* why = "both runs round differently, within the bound of one each") {
  Table measured{{"steps", "1"}, {"difference of positions", "of the largest position"}};
  measured.row(steps, largest(trial.after(scene, steps).x - expected) / largest(scene.x));
  return judge_worst(measured, allowed(trial, scene), why);
}

Finding same_when_moved(Trial& trial, const Eigen::Matrix3d& turn, const Vector3& shift) {
  const PerParticle3 expected = (turn * trial.after(original(), steps).x).colwise() + shift;
  return moves_to(trial, moved(turn, shift), expected);
}

Finding same_elsewhere(Trial& trial) {
  return same_when_moved(trial, Eigen::Matrix3d::Identity(), {1.3, -0.7, 2.1});
}

Finding same_when_turned(Trial& trial) {
  const Eigen::AngleAxisd turn(1.1, Vector3(0.4, -0.7, 0.5).normalized());
  return same_when_moved(trial, turn.toRotationMatrix(), Vector3::Zero());
}

/// Its triangles keep their front to the same side.
Finding same_in_the_mirror(Trial& trial) {
  PortableScene scene = moved(Vector3(-1, 1, 1).asDiagonal(), Vector3::Zero());
  std::vector<Triangle> triangles = scene.mesh.triangles;
  for (Triangle& t : triangles) std::swap(t[1], t[2]);
  scene.mesh = make_triangle_mesh(scene.mesh.rest, triangles);
  PerParticle3 expected = trial.after(original(), steps).x;
  expected.row(0) *= -1;
  return moves_to(trial, scene, expected,
                  "sums in another order round differently, within the bound of one run each");
}

/// The scene in other units of length, mass and time: the same numbers of steps and particles.
Finding same_in_other_units(Trial& trial) {
  constexpr double length = 1.7, mass = 2.3, time = 0.6;  // new units in an old one
  const PortableScene first = original();
  PortableScene scene = first;
  scene.mesh.rest *= length, scene.x *= length;
  scene.v *= length / time, scene.gravity *= length / (time * time);
  scene.mass *= mass, scene.material.density *= mass / (length * length);
  scene.material.young *= mass / (time * time);
  scene.dt *= time;
  return moves_to(trial, scene, length * trial.after(first, steps).x);
}

/// Particle i of the original is number[i].
std::vector<int> shuffled_numbers(int count) {
  std::vector<int> number(size_t(count), 0);
  for (int i = 0; i < count; ++i) number[size_t(i)] = int((long(i) * 31 + 17) % count);
  return number;
}

PortableScene renumbered(const PortableScene& scene, const std::vector<int>& number) {
  PortableScene other = scene;
  std::vector<Triangle> triangles;
  for (const Triangle& t : scene.mesh.triangles)
    triangles.push_back({number[size_t(t[1])], number[size_t(t[2])], number[size_t(t[0])]});
  std::reverse(triangles.begin(), triangles.end());
  PerParticle3 rest = scene.mesh.rest;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    const int to = number[size_t(i)];
    rest.col(to) = scene.mesh.rest.col(i);
    other.x.col(to) = scene.x.col(i);
    other.v.col(to) = scene.v.col(i);
    other.mass[to] = scene.mass[i];
  }
  other.mesh = make_triangle_mesh(rest, triangles);
  return other;
}

/// The original, whose 20 steps are divided into so many of the same total time.
PortableScene original_in_steps(long count) {
  PortableScene scene = original();
  scene.dt *= double(steps) / double(count);
  return scene;
}

/// How far numbering moves a particle [m].
double moved_by_numbers(Trial& trial, long count) {
  const PortableScene scene = original_in_steps(count);
  const std::vector<int> number = shuffled_numbers(scene.mesh.particles());
  const PerParticle3 first = trial.after(scene, count).x;
  const PerParticle3 second = trial.after(renumbered(scene, number), count).x;
  double most = 0;
  for (Eigen::Index i = 0; i < first.cols(); ++i)
    update_worst(most, (second.col(number[size_t(i)]) - first.col(i)).norm());
  return most;
}

/// How far the step's own error moves a particle, by the claimed order or by 1 [m].
double moved_by_the_step(Trial& trial) {
  const PerParticle3 coarse = trial.after(original(), steps).x,
                     fine = trial.after(original_in_steps(2 * steps), 2 * steps).x;
  const double order = std::max(1, trial.declaration().order);
  return largest(coarse - fine) / (1 - std::pow(0.5, order));
}

/// Solvers that treat springs in turn, as Gauss and Seidel did, depend on the numbers by an error
/// of the step, which falls with it. Physics that depends on them stays.
Finding same_when_renumbered(Trial& trial) {
  const PortableScene scene = original();
  const double rounding = allowed(trial, scene) * largest(scene.x);
  const double moved = moved_by_numbers(trial, steps);
  Table measured = table_of(
      "steps [1] | difference of positions [m] | rounding [m] | error of the step [m] | "
      "beyond what both explain [1]");
  if (moved <= rounding) {
    measured.row(steps, moved, rounding, nan, moved / rounding);
  } else {
    const double error = moved_by_the_step(trial);
    measured.row(steps, moved, rounding, error, moved / (error + rounding));
    constexpr double least_fall = 0.75;
    double before = moved;
    for (const long count : {2 * steps, 4 * steps}) {
      const double now = moved_by_numbers(trial, count);
      measured.row(count, now, rounding, nan, now / (least_fall * before + rounding));
      before = now;
    }
  }
  return judge_worst(measured, "beyond what both explain", 1,
                     "sums in another order round differently, within the bound of one run each; "
                     "what treats springs in turn errs by no more than its step does, and half the "
                     "step leaves half of it, and a quarter for the next term of the series");
}

}  // namespace

std::vector<Law> symmetry_laws() {
  return {
      {"symmetry.translation", "A sheet placed elsewhere moves the same way.",
       "homogeneity of space", same_elsewhere},
      {"symmetry.rotation", "A sheet turned together with gravity moves the same way.",
       "isotropy of space", same_when_turned},
      {"symmetry.mirror", "A mirrored sheet moves as the mirror image.", "mirror symmetry of space",
       same_in_the_mirror},
      {"symmetry.units", "A sheet moves the same way in other units of length, mass and time.",
       "dimensions of the equations", same_in_other_units},
      {"symmetry.renumbering",
       "Renumbering particles and triangles changes rounding, or an error that falls with the "
       "step.",
       "numbering is not physical", same_when_renumbered},
  };
}

}  // namespace foldproof
