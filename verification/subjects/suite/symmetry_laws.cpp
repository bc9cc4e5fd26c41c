// Laws of symmetry: a solver must not know where, how turned, or how numbered a sheet is.
#include <map>
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

/// Likewise with bending about rest angles of its own.
PortableScene bending_original() {
  PortableScene scene = original();
  scene.name = "moving sheet that bends";
  scene.material.bending_rigidity = drawn("rigidity under symmetries", 0.003, 0.006);
  for (size_t k = 0; k < scene.mesh.hinges.size(); ++k)
    scene.rest_angles.push_back(0.4 * std::sin(2.9 * double(k) + 0.3));
  return scene;
}

PortableScene damped_original() {
  PortableScene scene = damped_moving_sheet();
  scene.gravity = earth;
  return scene;
}

/// The scene turned by a matrix (orthogonal) and shifted [m].
PortableScene moved(PortableScene scene, const Eigen::Matrix3d& turn, const Vector3& shift) {
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

Finding same_when_moved(Trial& trial, const PortableScene& first, const Eigen::Matrix3d& turn,
                        const Vector3& shift) {
  const PerParticle3 expected = (turn * trial.after(first, steps).x).colwise() + shift;
  return moves_to(trial, moved(first, turn, shift), expected);
}

Finding same_elsewhere(Trial& trial, const PortableScene& first) {
  return same_when_moved(trial, first, Eigen::Matrix3d::Identity(), {1.3, -0.7, 2.1});
}

const Eigen::Matrix3d some_turn =
    Eigen::AngleAxisd(1.1, Vector3(0.4, -0.7, 0.5).normalized()).toRotationMatrix();

Finding same_when_turned(Trial& trial, const PortableScene& first) {
  return same_when_moved(trial, first, some_turn, Vector3::Zero());
}

/// Its rest shape stays where it was.
Finding same_when_turned_from_rest(Trial& trial, const PortableScene& first) {
  PortableScene scene = moved(first, some_turn, Vector3::Zero());
  scene.mesh.rest = first.mesh.rest;
  return moves_to(trial, scene, some_turn * trial.after(first, steps).x);
}

/// Rest angles of the hinges of a renumbered mesh: particle i of the first is number[i].
std::vector<double> angles_of(const PortableScene& first, const TriangleMesh& mesh,
                              const std::vector<int>& number) {
  std::map<std::pair<int, int>, double> of_edge;
  for (size_t k = 0; k < first.rest_angles.size(); ++k) {
    const auto& ends = first.mesh.hinges[k].particles;
    of_edge[std::minmax(number[size_t(ends[2])], number[size_t(ends[3])])] = first.rest_angles[k];
  }
  std::vector<double> angles;
  for (const Hinge& hinge : mesh.hinges)
    if (!of_edge.empty())
      angles.push_back(of_edge.at(std::minmax(hinge.particles[2], hinge.particles[3])));
  return angles;
}

/// Its triangles keep their front to the same side.
Finding same_in_the_mirror(Trial& trial, const PortableScene& first) {
  PortableScene scene = moved(first, Vector3(-1, 1, 1).asDiagonal(), Vector3::Zero());
  std::vector<Triangle> triangles = scene.mesh.triangles;
  for (Triangle& t : triangles) std::swap(t[1], t[2]);
  scene.mesh = make_triangle_mesh(scene.mesh.rest, triangles);
  std::vector<int> number(size_t(scene.mesh.particles()));
  std::iota(number.begin(), number.end(), 0);
  scene.rest_angles = angles_of(first, scene.mesh, number);
  PerParticle3 expected = trial.after(first, steps).x;
  expected.row(0) *= -1;
  return moves_to(trial, scene, expected,
                  "sums in another order round differently, within the bound of one run each");
}

struct Units {
  double length, mass, time;  // new units in an old one
};

PortableScene in_units(PortableScene scene, const Units& u) {
  scene.mesh.rest *= u.length, scene.x *= u.length;
  scene.v *= u.length / u.time, scene.gravity *= u.length / (u.time * u.time);
  scene.mass *= u.mass, scene.material.density *= u.mass / (u.length * u.length);
  scene.material.young *= u.mass / (u.time * u.time);
  scene.material.bending_rigidity *= u.mass * u.length * u.length / (u.time * u.time);
  scene.material.stretch_damping *= u.mass / u.time;
  scene.material.bending_damping *= u.mass * u.length / u.time;
  scene.dt *= u.time;
  return scene;
}

/// The same numbers of steps and particles; cells of 7 mm, 17 cm and 2.3 m in place of 10 cm.
Finding same_in_other_units(Trial& trial, const PortableScene& given) {
  PortableScene first = given;
  first.dt /= double(parts_of_step(first.dt, trial.declaration()));  // divided alike in all
  const PerParticle3 x = trial.after(first, steps).x;
  Table measured =
      table_of("length unit [1] | mass [1] | time [1] | difference [of the largest position]");
  for (const Units& u : {Units{1.7, 2.3, 0.6}, {0.07, 0.04, 0.8}, {23, 900, 0.9}}) {
    const PortableScene scene = in_units(first, u);
    measured.row(u.length, u.mass, u.time,
                 largest(trial.after(scene, steps).x - u.length * x) / largest(scene.x));
  }
  return judge_worst(measured, allowed(trial, first),
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
  other.rest_angles = angles_of(scene, other.mesh, number);
  return other;
}

/// The scene, whose 20 steps are divided into so many of the same total time.
PortableScene in_steps(PortableScene scene, long count) {
  scene.dt *= double(steps) / double(count);
  return scene;
}

/// How far numbering moves a particle [m].
double moved_by_numbers(Trial& trial, const PortableScene& original, long count) {
  const PortableScene scene = in_steps(original, count);
  const std::vector<int> number = shuffled_numbers(scene.mesh.particles());
  const PerParticle3 first = trial.after(scene, count).x;
  const PerParticle3 second = trial.after(renumbered(scene, number), count).x;
  double most = 0;
  for (Eigen::Index i = 0; i < first.cols(); ++i)
    update_worst(most, (second.col(number[size_t(i)]) - first.col(i)).norm());
  return most;
}

/// How far the step's own error moves a particle, by the claimed order or by 1 [m].
double moved_by_the_step(Trial& trial, const PortableScene& scene) {
  const PerParticle3 coarse = trial.after(scene, steps).x,
                     fine = trial.after(in_steps(scene, 2 * steps), 2 * steps).x;
  const double order = std::max(1, trial.declaration().order);
  return largest(coarse - fine) / (1 - std::pow(0.5, order));
}

/// Solvers that treat springs in turn, as Gauss and Seidel did, depend on the numbers by an error
/// of the step, which falls with it. Physics that depends on them stays.
Finding same_when_renumbered(Trial& trial, const PortableScene& scene) {
  const double rounding = allowed(trial, scene) * largest(scene.x);
  const double moved = moved_by_numbers(trial, scene, steps);
  Table measured = table_of(
      "steps [1] | difference of positions [m] | rounding [m] | error of the step [m] | "
      "beyond what both explain [1]");
  if (moved <= rounding) {
    measured.row(steps, moved, rounding, nan, moved / rounding);
  } else {
    const double error = moved_by_the_step(trial, scene);
    measured.row(steps, moved, rounding, error, moved / (error + rounding));
    constexpr double least_fall = 0.75;
    double before = moved;
    for (const long count : {2 * steps, 4 * steps}) {
      const double now = moved_by_numbers(trial, scene, count);
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
  struct Symmetry {
    const char *name, *claim, *source;
    Finding (*run)(Trial&, const PortableScene&);
  };
  const Symmetry symmetries[] = {
      {"translation", "placed elsewhere moves the same way.", "homogeneity of space",
       same_elsewhere},
      {"rotation", "turned together with gravity moves the same way.", "isotropy of space",
       same_when_turned},
      {"start-turned-from-rest", "turned against its rest shape moves the same way.",
       "isotropy of space", same_when_turned_from_rest},
      {"mirror", "in the mirror moves as the mirror image.", "mirror symmetry of space",
       same_in_the_mirror},
      {"units", "moves the same way in other units of length, mass and time.",
       "dimensions of the equations", same_in_other_units},
      {"renumbering",
       "with other numbers of particles and triangles moves the same way, to rounding, or to an "
       "error that falls with the step.",
       "numbering is not physical", same_when_renumbered}};
  struct Sheet {
    const char *suffix, *words, *needs;
    PortableScene (*scene)();
  };
  const Sheet sheets[] = {
      {"", "A sheet ", "", original},
      {"-with-bending", "A sheet that resists bending ", "bending", bending_original},
      {"-with-damping", "A damped sheet ", "damping", damped_original}};
  std::vector<Law> laws;
  for (const Sheet& sheet : sheets)
    for (const Symmetry& s : symmetries)
      laws.push_back({std::string("symmetry.") + s.name + sheet.suffix,
                      std::string(sheet.words) + s.claim, s.source, in_scene(s.run, sheet.scene),
                      sheet.needs});
  return laws;
}

}  // namespace foldproof
