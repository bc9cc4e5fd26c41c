// Laws of symmetry: a solver must not know where, how turned, or how numbered a sheet is.
#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>

#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/scenes.h"

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

Finding same_when_moved(Trial& trial, const Eigen::Matrix3d& turn, const Vector3& shift) {
  const PortableScene scene = moved(turn, shift);
  const PerParticle3 expected = (turn * trial.after(original(), steps).x).colwise() + shift;
  const double error = (trial.after(scene, steps).x - expected).colwise().norm().maxCoeff();
  Table measured{{"steps", "1"}, {"difference of positions", "largest position"}};
  measured.row(steps, error / size_of(scene.x));
  return judge_worst(measured, 2 * rounding_error(scene, steps, trial.declaration()),
                     "both runs round differently, within the bound of one each");
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
  const double error = (trial.after(scene, steps).x - expected).colwise().norm().maxCoeff();
  Table measured{{"steps", "1"}, {"difference of positions", "largest position"}};
  measured.row(steps, error / size_of(scene.x));
  return judge_worst(measured, 2 * rounding_error(scene, steps, trial.declaration()),
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
  const PerParticle3 expected = length * trial.after(first, steps).x;
  const double error = (trial.after(scene, steps).x - expected).colwise().norm().maxCoeff();
  Table measured{{"steps", "1"}, {"difference of positions", "largest position"}};
  measured.row(steps, error / size_of(scene.x));
  return judge_worst(measured, 2 * rounding_error(scene, steps, trial.declaration()),
                     "both runs round differently, within the bound of one each");
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

Finding same_when_renumbered(Trial& trial) {
  const PortableScene scene = original();
  const std::vector<int> number = shuffled_numbers(scene.mesh.particles());
  const PerParticle3 first = trial.after(scene, steps).x;
  const PerParticle3 second = trial.after(renumbered(scene, number), steps).x;
  double error = 0;
  for (Eigen::Index i = 0; i < first.cols(); ++i)
    update_worst(error, (second.col(number[size_t(i)]) - first.col(i)).norm());
  Table measured{{"steps", "1"}, {"difference of positions", "largest position"}};
  measured.row(steps, error / size_of(first));
  return judge_worst(measured, 2 * rounding_error(scene, steps, trial.declaration()),
                     "sums in another order round differently, within the bound of one run each");
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
      {"symmetry.renumbering", "Renumbering particles and triangles changes only rounding.",
       "numbering is not physical", same_when_renumbered},
  };
}

}  // namespace foldproof
