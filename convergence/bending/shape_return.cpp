// shape-recovery: a sculpted shell is pulled out of shape, let go, and damped until it rests.

#include "convergence/study.h"
#include "reference/forces/bending.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double size = 0.11;    // radius of the ball, half of the figure's height [m]
constexpr double young = 40;     // Y [N/m]
constexpr double density = 0.2;  // kg/m^2
// ke [J]: a twenty-fifth of Y size^2, so that hinges resist what springs let go
constexpr double bending = 0.02;
constexpr double delay = 0.012;    // damping over stiffness, of springs and hinges [s]
constexpr double duration = 0.45;  // s

/// Radial bumps of a ball: no symmetry is left [1].
double bump(const Vector3& unit) {
  return 1 + 0.17 * std::sin(3.1 * unit.x() + 0.4) * std::cos(2.3 * unit.y() - 0.7) +
         0.11 * std::sin(4.3 * unit.z() + 1.9 * unit.x());
}

struct Shell {
  std::string words;
  TriangleMesh mesh;
};

Shell bumpy_ball(int subdivisions) {
  TriangleMesh mesh = make_icosphere(1, subdivisions);
  for (Eigen::Index i = 0; i < mesh.rest.cols(); ++i) {
    const Vector3 unit = mesh.rest.col(i);
    mesh.rest.col(i) = size * bump(unit) * unit;
  }
  const std::string triangles = std::to_string(mesh.triangles.size());
  return {"bumpy ball, " + triangles + " triangles", std::move(mesh)};
}

Shell statue() { return {"seated figure, 1280 triangles", make_statue(2 * size, 3)}; }

enum class RestAngles { own, flat };

/// Smoothly squeezed, sheared and dented by up to a fifth of its size, at rest.
Scene pulled_out_of_shape(const Shell& shell, RestAngles angles) {
  Scene scene = scene_at_rest(shell.mesh, density);
  scene.stretch = StretchMaterial{young, young * delay, 1};
  scene.bending = BendingMaterial{bending, bending / 2 * delay, Weighting::rest,
                                  DampingFactor::edge_squared_over_area};
  scene.rest_angles = hinge_angles(shell.mesh, shell.mesh.rest);
  if (angles == RestAngles::flat) scene.rest_angles.assign(scene.rest_angles.size(), 0);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const Vector3 p = shell.mesh.rest.col(i) / size;
    scene.x.col(i) +=
        0.09 * size *
        Vector3(-1.3 * p.x() + 0.8 * std::sin(2 * p.y()), 0.9 * p.y() + 0.7 * std::cos(3 * p.z()),
                -0.6 * p.z() + std::sin(2.5 * p.x() + 0.3));
  }
  return scene;
}

/// 1 for a right-handed frame, -1 for a left-handed one.
double handedness(const Eigen::Matrix3d& frame) {
  return frame.col(0).cross(frame.col(1)).dot(frame.col(2)) < 0 ? -1 : 1;
}

/// Root mean square distance of x from the rest shape, over the particles, after the best
/// rigid motion [m].
double distance_from(const PerParticle3& rest, const PerParticle3& x) {
  const PerParticle3 a = rest.colwise() - rest.rowwise().mean(),
                     b = x.colwise() - x.rowwise().mean();
  const Eigen::Matrix3d covariance = b * a.transpose();
  const oracles::SingularParts parts = oracles::singular_parts(covariance);
  const Eigen::Matrix3d U = parts.U, V = parts.V;
  Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity();
  mirror(2, 2) = handedness(U) * handedness(V);
  const Eigen::Matrix3d turn = U * mirror * V.transpose();
  return std::sqrt((b - turn * a).colwise().squaredNorm().mean());
}

/// The distance from the rest shape over time.
struct Return {
  Table history{{"time", "s"}, {"distance", "m"}};
  double left = 0;  // largest distance in the last tenth of the time [m]
};

Return let_go(const Subject& subject, const Shell& shell, RestAngles angles) {
  const Scene scene = pulled_out_of_shape(shell, angles);
  Stepper stepper(subject, scene, "C");
  State s = stepper.start();
  const int steps = int(duration / (0.7 * elastic_limit(build_system(scene), s))) + 1;
  Return result;
  Worst left;
  for (int n = 0; n <= steps; ++n) {
    if (n > 0) s = stepper.step(s, duration / steps);
    const double distance = distance_from(shell.mesh.rest, s.x);
    if (n >= 0.9 * steps) left.observe(distance);
    if (n % 12 != 0 && n < steps) continue;
    result.history.row(s.time, distance);
  }
  result.left = left.value();
  return result;
}

NamedFinding comes_back(const std::vector<Shell>& shells, const std::vector<Return>& returns) {
  const std::string start = "distance at the start",
                    end = "largest distance in the last tenth of the time";
  Worst worst;
  Table distances{{"shell", ""}, {start, "m"}, {end, "m"}};
  for (size_t i = 0; i < shells.size(); ++i) {
    const double first = returns[i].history.numbers("distance").front();
    distances.row(shells[i].words, first, returns[i].left);
    worst.observe(returns[i].left / first);
  }
  const Verdict verdict{
      worst.value(), 1e-3, 0, "of the start",
      "another rest shape, with a dent or a wrong angle, is at least a tenth of the disturbance "
      "away; motion that has not died out would show in the last tenth of the time"};
  return {"shape-recovery.shell-returns-to-its-shape",
          "With its own angles as rest angles, a shell pulled out of shape by about a tenth of its "
          "size returns to it, on coarse and fine meshes.",
          {verdict, distances, "root mean square over the particles, after the best rigid motion"}};
}

NamedFinding angles_matter(const Shell& shell, const Return& own, const Return& flat) {
  const double start = flat.history.numbers("distance").front();
  Table distances(
      "shell; distance at the start [m]; distance with its own angles [m]; distance with flat "
      "angles [m]");
  distances.row(shell.words, start, own.left, flat.left);
  const Verdict verdict{0.1 * start / flat.left, 1, 0, "1",
                        "another rest shape is at least a tenth of the disturbance away"};
  return {
      "shape-recovery.flat-rest-angles-do-not-restore-it",
      "The same shell with flat rest angles does not return: springs alone do not keep the shape.",
      {verdict, std::move(distances),
       "measured is a tenth of the distance at the start over the distance with flat angles"}};
}

StudyResult run_shape_return(const Subject& subject, Tier tier, const Progress& progress) {
  std::vector<Shell> shells = {bumpy_ball(1), bumpy_ball(2)};
  if (tier == Tier::full) shells.push_back(statue());
  StudyResult result;
  Figure figure{"distance",
                "Return of a shell to its shape",
                {"time", "s"},
                {"distance from the rest shape", "m", Scale::log},
                "Root mean square over the particles, after the best rigid motion."};
  std::vector<Return> returns;
  for (const Shell& shell : shells) {
    returns.push_back(let_go(subject, shell, RestAngles::own));
    figure.curves.push_back(curve_of(shell.words, returns.back().history, "time", "distance"));
    progress(double(returns.size()) / double(shells.size() + 1));
  }
  const Return flat = let_go(subject, shells[1], RestAngles::flat);
  figure.curves.push_back(
      curve_of(shells[1].words + ", flat rest angles", flat.history, "time", "distance"));
  result.add({comes_back(shells, returns), angles_matter(shells[1], returns[1], flat)});
  result.figures.push_back(std::move(figure));
  return result;
}

}  // namespace

Study shape_return_study() {
  return {"shape-recovery",
          "A sculpted shell that is pulled out of shape by about a tenth returns to it if its own "
          "angles are its rest angles, and does not if they are flat.",
          {"shell-returns-to-its-shape", "flat-rest-angles-do-not-restore-it"},
          "BMF03 section 4: non-zero rest angles",
          "A closed shell with bumps is squeezed, sheared and dented by about a tenth of its size, "
          "released and damped. Its distance from the rest shape falls until it is invisible, on "
          "coarse and fine meshes alike; with flat rest angles it settles elsewhere.",
          run_shape_return};
}

}  // namespace foldproof
