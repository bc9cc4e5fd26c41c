// A limp strip over a fixed horizontal capsule, a weight at each end: how it lies, when it slips.

#include "reference/mesh/shapes.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/relaxation.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr double radius = 0.2;           // m, of the capsule
constexpr double edge = 0.04;            // m, of each of the strip's cells: it is one cell wide
constexpr int cells = 24;                // 16 of them on the capsule
constexpr double density = 0.2;          // kg/m^2
constexpr double line = density * edge;  // kg/m
constexpr double light = 0.004;          // kg, at the light end

//        .-- theta --.        T(theta) is the strip's tension, theta from its light leg to its
//       /             \       heavy leg, lambda its mass per length, a its acceleration.
//      |               |
//      |               |      N r = T + lambda g r sin(theta)       per angle, normal force
//     M1               |      T'  = mu N r + lambda r (g cos(theta) + a)
//                      M2
//                             T(0) = M1 (g + a),  T(pi) = M2 (g - a);  M with the leg's own mass
//
// With E = exp(mu pi), T(pi) = E T(0) + lambda g r 2 mu (1 + E)/(1 + mu^2) + lambda r a (E - 1)/mu.

double arc_weight(double mu) {
  return 2 * mu * (1 + std::exp(mu * pi)) / (1 + mu * mu);  // over lambda g r [1]
}

constexpr double leg = (cells * edge - pi * radius) / 2;  // m

/// The mass at the heavy end for which the strip just does not slip [kg].
double mass_that_holds(double mu) {
  const double light_leg = light + line * leg;
  return std::exp(mu * pi) * light_leg + line * radius * arc_weight(mu) - line * leg;
}

/// Of the strip that slips, or would without friction [m/s^2].
double acceleration(double heavy, double mu) {
  const double down = heavy + line * leg, up = light + line * leg, e = std::exp(mu * pi);
  const double arc = mu > 0 ? (e - 1) / mu : pi;
  return weight * (down - e * up - line * radius * arc_weight(mu)) /
         (down + e * up + line * radius * arc);
}

int row_of(const PortableScene& scene, Eigen::Index i) {
  return int(std::lround(scene.mesh.rest(0, i) / edge));
}

/// Heavy at the end towards x. The capsule is along y; its middle is not the strip's.
PortableScene strip_over_a_capsule(double heavy, double friction) {
  PortableScene scene = resting(
      "strip over a capsule", make_sheet({SheetPattern::alternating, cells * edge, edge, cells, 1}),
      {.density = density, .young = 1200});
  scene.own_masses = true;
  const double turn = 2 * std::asin(edge / (2 * radius));  // rad, from row to row
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const int row = row_of(scene, i) - cells / 2;
    const double angle = std::clamp(row * turn, -pi / 2, pi / 2);
    scene.x(0, i) = radius * std::sin(angle);
    scene.x(2, i) = radius * std::cos(angle) - (std::abs(row * turn) - std::abs(angle)) * radius;
    if (std::abs(row) == cells / 2) scene.mass[i] += (row > 0 ? heavy : light) / 2;
  }
  scene.gravity = Vector3(0, 0, -weight);
  scene.capsules = {{{0, -0.2, 0}, {0, 0.4, 0}, radius, friction}};
  scene.dt = 2e-4;
  return scene;
}

/// At rest, with more friction than it needs.
Relaxed laid(Trial& trial, const PortableScene& scene) {
  PortableScene rough = scene;
  rough.capsules[0].friction *= 2;
  return relaxed(trial, rough, {scene.x, cells * edge, 1e-4, 0.004});
}

constexpr long slip_steps = 1500;
constexpr double share_of_way = 0.02;

/// Whether the top of it goes more than that share of the way that it would go without
/// friction, in the second half of the time: in the first, the strip also settles to the
/// friction, and stretches.
bool slips(Trial& trial, const PortableScene& scene, double heavy) {
  const double time = double(slip_steps) * scene.dt;
  const std::vector<Snapshot> states = trial.motion(scene, {slip_steps / 2, slip_steps});
  const PerParticle3 moved = states[1].x - states[0].x;
  double way = 0;  // m
  for (Eigen::Index i = 0; i < moved.cols(); ++i)
    if (row_of(scene, i) == cells / 2) way += moved(0, i) / 2;
  return !(way <= share_of_way * acceleration(heavy, 0) * time * time / 2 * 3 / 4);
}

/// The friction with which a strip of these ends goes that share of the way.
double friction_of_that_share(double heavy, double most) {
  double least = 0;
  for (int k = 0; k < 60; ++k) {
    const double mu = (least + most) / 2;
    (acceleration(heavy, mu) > share_of_way * acceleration(heavy, 0) ? least : most) = mu;
  }
  return (least + most) / 2;
}

Finding slips_at_euler_s_ratio(Trial& trial) {
  Table measured = table_of(
      "heavy over light end [1] | mu that just holds | by Euler's law [1] | difference [of mu]");
  for (const double mu : {0.23, 0.41}) {
    const double heavy = mass_that_holds(mu), expected = friction_of_that_share(heavy, mu);
    PortableScene scene = strip_over_a_capsule(heavy, mu);
    scene.x = laid(trial, scene).x;
    const Interval tried{0.7 * mu, 1.3 * mu},
        found = bisected(tried, 0.01 * mu, [&](double middle) {
          scene.capsules[0].friction = middle;
          return !slips(trial, scene, heavy);
        });
    measured.row(heavy / light, found_text(found, tried), expected,
                 std::abs(middle(found) - expected) / mu);
  }
  return judge_worst(
      measured, 0.021,
      "the strip turns by d = edge/r from row to row, so that its ratio errs by (1 + mu^2) d^2 (mu "
      "pi/12 + 1/8), 1.1 % of mu pi; half of the last bracket is 0.5 %; 1500 steps of a first "
      "order method and the strip's own waves are allowed as much");
}

Finding strip_lies_on_the_capsule(Trial& trial) {
  constexpr double mu = 0.41;
  const PortableScene scene = strip_over_a_capsule(mass_that_holds(mu), mu);
  const Relaxed end = laid(trial, scene);
  double deepest = 0, highest = 0;  // m
  for (Eigen::Index i = 0; i < end.x.cols(); ++i) {
    if (std::abs(row_of(scene, i) - cells / 2) > cells / 4) continue;  // a leg
    const double out = std::hypot(end.x(0, i), end.x(2, i)) - radius;
    deepest = std::max(deepest, -out), highest = std::max(highest, out);
  }
  Table measured("of; measured [m]; allowed [m]; ratio [1]");
  const double above = edge / 10 + edge * edge / (8 * radius), below = edge / 100;
  measured.row("deepest particle", deepest, below, deepest / below);
  measured.row("highest particle", highest, above, highest / above);
  return judge_worst(measured, 1,
                     "empirical: a depth of a hundredth of an edge cannot be seen in a picture; "
                     "above the capsule, a tenth of an edge is allowed for a thickness, and L^2/(8 "
                     "r) for edges that stay outside");
}

}  // namespace

std::vector<Law> capstan_laws() {
  return {
      {"capstan.strip-lies-on-the-capsule",
       "A strip that hangs over a capsule with a weight at each end lies on it.", "impenetrability",
       strip_lies_on_the_capsule, "L1 capsules masses"},
      {"capstan.slips-at-euler-s-ratio",
       "A strip over a capsule slips where the ratio of its tensions is exp(mu pi), and more by "
       "its own weight.",
       "Euler, Eytelwein", slips_at_euler_s_ratio, "L1 capsules masses",
       "heavy over light end | mu that just holds | by Euler's law"},
  };
}

}  // namespace foldproof
