// A strip drawn round a drum: the capstan's law.
#include <algorithm>
#include <cmath>

#include "reference/dynamics/simulate.h"
#include "reference/mesh/shapes.h"
#include "verification/checks/filters/filter_checks.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/contact_scenes.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double radius = 0.1, straight = 0.08, width = 0.016;  // m
constexpr double strained = 1.02;  // the strip's length at the start over its own
constexpr double speed = 0.04;     // at which one end is drawn [m/s]

/// The point of the strip's middle line at the way s [m] along a straight piece, the drum and a
/// straight piece.
Vector3 on_path(double s, double wrap) {
  const auto on_drum = [](double a) {
    return Vector3(0, radius * std::cos(a), radius * std::sin(a));
  };
  const auto along = [](double a) { return Vector3(0, -std::sin(a), std::cos(a)); };
  if (s < straight) return on_drum(0) + (s - straight) * along(0);
  if (s < straight + radius * wrap) return on_drum((s - straight) / radius);
  return on_drum(wrap) + (s - straight - radius * wrap) * along(wrap);
}

Scene wrapped_strip(double wrap, double friction) {
  const double length = 2 * straight + radius * wrap;
  const int rows = int(std::lround(length / width));
  Scene scene = scene_at_rest(
      make_sheet({SheetPattern::criss_cross, width, length / strained, 1, rows}), 0.2);
  scene.stretch = StretchMaterial{60, 0.1, 1};
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double across = scene.x(0, i) - width / 2, s = scene.x(1, i) * strained;
    scene.x.col(i) = on_path(s, wrap) + Vector3(across, 0, 0);
    Motion motion;
    motion.velocity = speed * Vector3(0, -std::sin(wrap), std::cos(wrap));
    if (s < 1e-9) scene.prescribed.push_back({int(i), scene.x.col(i), {}});
    if (s > length - 1e-9) scene.prescribed.push_back({int(i), scene.x.col(i), motion});
  }
  SceneObject drum =
      object_at("drum", Capsule{radius, 1},
                {oracles::rotation_between(Vector3::UnitZ(), Vector3::UnitX()), Vector3::Zero()});
  drum.object.friction = friction;
  scene.objects.push_back(drum);
  return scene;
}

/// Pull on the ends [N], held and drawn, and the turn of the strip between them [rad].
struct Pull {
  double held = 0, drawn = 0, turn = 0;
};

Pull pull_after(const Subject& subject, const Scene& scene, double seconds) {
  Stepper stepper(subject, scene, "C");
  State s = stepper.start();
  const double h = 0.4 * elastic_limit(build_system(scene), s);
  while (s.time < seconds) s = stepper.step(s, h);
  const PerParticle3 force = stepper.elastic_forces(s);
  Vector3 held = Vector3::Zero(), drawn = Vector3::Zero();
  for (const PrescribedParticle& end : scene.prescribed)
    (end.motion.velocity.norm() > 0 ? drawn : held) += force.col(end.particle);
  return {held.norm(), drawn.norm(), std::acos(-held.dot(drawn) / (held.norm() * drawn.norm()))};
}

Finding capstan_finding(const Subject& subject) {
  Table pulls{{"friction", "1"}, {"turn", "rad"}, {"ratio of tensions", "1"}, {"e^(mu turn)", "1"}};
  Worst worst;
  for (const auto& [mu, wrap] :
       {std::pair{0.17, 2.9}, std::pair{0.43, 1.3}, std::pair{0.34, 2.2}}) {
    const Pull pull = pull_after(subject, wrapped_strip(wrap, mu), 0.5);
    const double ratio = pull.drawn / pull.held;
    pulls.row(mu, pull.turn, ratio, std::exp(mu * pull.turn));
    worst.observe(std::abs(std::log(ratio) / (mu * pull.turn) - 1));
  }
  return {{worst.value(), 0.02, 0, "of the exponent",
           "the strip turns by 0.08 rad at a row, where (1 + mu tan(d/2))/(1 - mu tan(d/2)) "
           "differs from e^(mu d) by d^2/12 of the exponent, 0.0005; inertia of the sliding strip, "
           "rho v^2 over its tension, is smaller; two percent allow for vibrations that damping "
           "has not yet removed"},
          pulls,
          ""};
}

}  // namespace

std::vector<Check> capstan_checks() {
  return {{"contact.a-drum-obeys-the-capstan-equation",
           "In a strip that slides over a drum, round which it is wrapped by an angle, the pulled "
           "side has e^(mu angle) times the tension of the other.",
           "Euler and Eytelwein", capstan_finding}};
}

}  // namespace foldproof
