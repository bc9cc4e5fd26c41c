// Rest: forces that balance, friction inside its cone, stability by dense eigenvalues.
#include "reference/dynamics/settle.h"

#include <Eigen/Eigenvalues>

#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/contact_scenes.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr double g = 9.80665;  // m/s^2

/// A sheet that starts level, held where its rest has y above or below a mark.
struct HeldSheet {
  std::string name;
  Scene scene;
};

HeldSheet held_sheet(const std::string& name, const Sheet& sheet, const Vector3& gravity,
                     double stiffness) {
  HeldSheet held{name, scene_at_rest(make_sheet(sheet), 0.23)};
  Scene& scene = held.scene;
  scene.stretch = StretchMaterial{47, 0, 1};
  add_flat_hinges(scene, stiffness, 0);
  scene.gravity = gravity;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    if (scene.x(1, i) < 0.051) scene.prescribed.push_back({int(i), scene.x.col(i), Motion{}});
  return held;
}

std::vector<HeldSheet> held_sheets() {
  return {held_sheet("a limp sheet, let go level",
                     {SheetPattern::jittered, 0.3, 0.25, 6, 5, 0.2, 3}, {0, 0, -g}, 3e-4),
          held_sheet("a stiff one", {SheetPattern::alternating, 0.2, 0.3, 4, 6}, {0, 0, -g}, 0.02),
          held_sheet("one that stands in its plane", {SheetPattern::union_jack, 0.15, 0.25, 3, 5},
                     {0, -g, 0}, 3e-4),
          held_sheet("one that hangs in its plane", {SheetPattern::union_jack, 0.15, 0.25, 3, 5},
                     {0, g, 0}, 3e-4)};
}

Rest rest_of(const Scene& scene, int saddles = 0) {
  const BuiltScene of = build(scene, computing_provider());
  return settle(of.system, of.start,
                {1e-8, 2 * smallest_height(scene.mesh.triangles, scene.mesh.rest),
                 0.5 * elastic_limit(of.system, of.start), 600, saddles});
}

/// The smallest eigenvalue of the free particles' stiffness over their masses, by dense
/// algebra [1/s^2].
double dense_eigenvalue(const Scene& scene, const State& s) {
  const std::vector<int> free = free_particles(scene);
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  const Eigen::MatrixXd K = -force_derivative(scene, s);
  const Eigen::Index n = 3 * Eigen::Index(free.size());
  Eigen::MatrixXd scaled(n, n);
  for (Eigen::Index r = 0; r < n; ++r)
    for (Eigen::Index c = 0; c < n; ++c) {
      const int a = free[std::size_t(r / 3)], b = free[std::size_t(c / 3)];
      scaled(r, c) = K(3 * a + r % 3, 3 * b + c % 3) / std::sqrt(mass[a] * mass[b]);
    }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly)
      .eigenvalues()[0];
}

Finding forces_vanish(const Subject& subject) {
  Table rests{{"sheet", ""}, {"steps", "1"}, {"largest force over the weight", "1"}};
  for (const HeldSheet& sheet : held_sheets()) {
    const Rest rest = rest_of(sheet.scene);
    const PerParticle3 force = Probe(subject, sheet.scene).elastic(rest.state);
    const PerParticle mass = lumped_masses(sheet.scene.mesh, sheet.scene.density);
    Worst largest;
    for (const int i : free_particles(sheet.scene))
      largest.observe(force.col(i).norm() / (mass[i] * g));
    rests.row(sheet.name, rest.steps, largest.value());
  }
  return judge_worst(std::move(rests), 1e-8, "the limit that the search is given");
}

Finding eigenvalues_agree() {
  Table rests{{"sheet", ""}, {"smallest eigenvalue", "1/s^2"}, {"relative difference", "1"}};
  for (const HeldSheet& sheet : held_sheets()) {
    const Rest rest = rest_of(sheet.scene);
    const double dense = dense_eigenvalue(sheet.scene, rest.state);
    rests.row(sheet.name, rest.smallest_eigenvalue,
              std::abs(rest.smallest_eigenvalue - dense) / std::abs(dense));
  }
  return judge_worst(std::move(rests), 1e-5,
                     "the iteration ends at 1e-7 of the eigenvalue; a wrong sign makes 2");
}

double potential(const Scene& scene, const State& s) {
  const Energies e = energies(build_system(scene), s);
  return e.gravity + e.stretch + e.bending;
}

Finding saddles_are_left() {
  Table rests{{"sheet", ""},
              {"energy at the first rest", "J"},
              {"at the last", "J"},
              {"force over the weight", "1"},
              {"least eigenvalue there", "1/s^2"}};
  double unstable = 0;
  for (const HeldSheet& sheet : held_sheets()) {
    const Rest first = rest_of(sheet.scene), last = rest_of(sheet.scene, 5);
    const double dense = dense_eigenvalue(sheet.scene, last.state),
                 before = potential(sheet.scene, first.state),
                 after = potential(sheet.scene, last.state);
    const bool falls = first.smallest_eigenvalue < 0;
    rests.row(sheet.name, before, after, last.unbalanced.over_weight, dense);
    unstable += !(dense > -1e-4) + (falls ? !(after < before) : after != before);
  }
  return judge_worst(std::move(rests), "force over the weight", unstable == 0 ? 1e-8 : 0,
                     "the limit of the search; a last rest that is not stable, or not lower than a "
                     "saddle, has no bound");
}

/// Particles on a slope; nothing holds them together.
Scene particles_on_slope(double angle, double friction) {
  Scene scene = loose_particles(3);
  const Vector3 normal(0, std::cos(angle), std::sin(angle));
  SceneObject slope = object_at(
      "slope", HalfSpace{}, {oracles::rotation_between(Vector3::UnitZ(), normal), Vector3::Zero()});
  slope.object.friction = friction;
  scene.objects.push_back(slope);
  scene.gravity = Vector3(0, -1.3 * g, 0);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    scene.x.col(i) -= scene.x.col(i).dot(normal) * normal;
  return scene;
}

Finding slopes_leave_what_friction_cannot_hold() {
  Table slopes{
      {"angle", "rad"}, {"friction", "1"}, {"left over the weight", "1"}, {"difference", "1"}};
  for (const auto& [angle, friction] :
       {std::pair{0.31, 0.0}, std::pair{0.31, 0.29}, std::pair{0.31, 0.34}, std::pair{0.7, 0.4}}) {
    const BuiltScene of = build(particles_on_slope(angle, friction), computing_provider());
    Work work;
    const double left =
        largest_unbalanced(of.system, unbalanced_forces(of.system, of.start, 0.0017, work))
            .over_weight;
    const double expected = std::max(0.0, std::sin(angle) - friction * std::cos(angle));
    slopes.row(angle, friction, left, std::abs(left - expected));
  }
  return judge_worst(std::move(slopes), 1e-9,
                     "a rounding of a place of half a metre, 1e-16 m, over h^2 g, and a few more");
}

/// A sheet over a ball, without a centre of symmetry, let go just above it.
Scene sheet_on_ball(double radius, double friction) {
  Scene scene =
      scene_at_rest(make_sheet({SheetPattern::jittered, 0.4, 0.4, 10, 10, 0.15, 5}), 0.21);
  scene.stretch = StretchMaterial{31, 0, 1};
  add_flat_hinges(scene, 6e-4, 0);
  scene.gravity = Vector3(0, 0, -g);
  scene.x.row(0).array() -= 0.19;
  scene.x.row(1).array() -= 0.21;
  scene.x.row(2).array() += radius + 0.003;
  SceneObject ball = object_at("ball", Sphere{radius}, Pose{});
  ball.object.friction = friction;
  scene.objects.push_back(ball);
  return scene;
}

/// Forces are the subject's, the ball's normal is by its centre: the filters are not asked.
Finding balls_hold_within_the_cone(const Subject& subject) {
  Table particles{{"friction", "1"},
                  {"touching", "1"},
                  {"least load over the weight", "1"},
                  {"largest excess over the weight", "1"}};
  for (const double friction : {0.37, 0.2}) {
    const double radius = 0.13;
    const Scene scene = sheet_on_ball(radius, friction);
    const Rest rest = rest_of(scene);
    const PerParticle3 force = Probe(subject, scene).elastic(rest.state);
    const PerParticle mass = lumped_masses(scene.mesh, scene.density);
    Worst excess;
    int touching = 0;
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < force.cols(); ++i) {
      const Vector3 x = rest.state.x.col(i), F = force.col(i) / (mass[i] * g), N = x.normalized();
      if (x.norm() > radius + 1e-9) {
        excess.observe(F.norm());
        continue;
      }
      ++touching;
      least = std::min(least, -F.dot(N));
      excess.observe(std::max(0.0, (F - F.dot(N) * N).norm() + friction * F.dot(N)));
      excess.observe(std::max(0.0, radius - x.norm()) / radius);
    }
    particles.row(friction, touching, least, excess.value());
  }
  return judge_worst(std::move(particles), 1e-7,
                     "the search ends at 1e-8; its forecast of a micrometre at a step adds to it");
}

}  // namespace

std::vector<Check> settle_checks() {
  return {{"settle.forces-vanish",
           "Where a held sheet is said to rest, no free particle bears a force beside its weight.",
           "statics", forces_vanish},
          {"settle.smallest-eigenvalue-is-the-stiffness-s",
           "The smallest eigenvalue at rest is that of the dense stiffness over the masses, and "
           "negative for a sheet that stands.",
           "Sylvester 1852", eigenvalues_agree},
          {"settle.saddles-are-left",
           "A sheet that stands falls to a stable rest of less energy; others stay.", "statics",
           saddles_are_left},
          {"settle.slopes-leave-what-friction-cannot-hold",
           "On a slope of angle alpha the filters leave sin(alpha) - mu cos(alpha) of the weight, "
           "or nothing.",
           "Coulomb's law", slopes_leave_what_friction_cannot_hold},
          {"settle.balls-hold-within-the-cone",
           "A sheet at rest on a ball is pushed outwards where it touches, with friction inside "
           "Coulomb's cone, and bears no force elsewhere.",
           "Coulomb's law", balls_hold_within_the_cone}};
}

}  // namespace foldproof
