// Strips that meet a floor: when the tip of a pressed one slips.

#include "verification/oracles/elastica.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/relaxation.h"
#include "verification/subjects/suite/strips.h"

namespace foldproof {

namespace {

using namespace suite;
using oracles::EndHold, oracles::HeavyStrip;

//   =  row 0, held        A weightless strip hangs from a clamp. The floor presses its tip up, so
//   =  row 1, held        that it buckles; friction alone holds the tip there. Under too little of
//    \                    it the tip slips, and the farther it is the harder it is pushed.
//     )
//   ./    row n, on the floor
constexpr StripShape shape{3, 16, 0.04};
constexpr double given = 8e-3;  // B of the scene [N m]
constexpr double young = 500;   // N/m

// Where triangles fold at edges, bending begins in the middle of the held panel, elsewhere
// at its inner row.
const double h = shape.row_height(), length = shape.length() - h / 2;  // from that middle [m]

PortableScene flat_strip() {
  return free_strip(shape, {.young = young, .bending_rigidity = given}, 2e-4);
}

/// On the branch that bulges to one side, as a clamped and pinned column does.
HeavyStrip pressed(double across, double up) {
  const double slope = 2 * std::sqrt(1 + up);
  return {0, -pi / 2, {{slope - pi / 2, across, up, EndHold::pinned}}, -slope};
}

/// In the elastica's shape, on a floor under its tip.
PortableScene strip_on_floor(double compression) {
  PortableScene scene = flat_strip();
  scene.name = fmt::format("strip pressed by {:.0f} % of its length", 100 * compression);
  std::vector<double> arcs;
  for (int k = 2; k <= shape.rows; ++k) arcs.push_back((k - 0.5) * h / length);
  const oracles::StripShape bent = oracles::strip_by_collocation(pressed(0, compression - 1), arcs);
  const std::vector<int> row_of = rows_of(scene, shape);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const int row = row_of[size_t(i)];
    scene.x.col(i) << scene.mesh.rest(0, i), 0, (0.5 - row) * h;
    if (row < 2) {
      scene.held.push_back(int(i));
    } else {
      const oracles::StripPoint& point = bent.points[size_t(row - 2)];
      scene.x.col(i).tail<2>() << length * point.across, length * point.up;
    }
  }
  scene.planes = {{{0, 0, (compression - 1) * length}, Vector3::UnitZ(), 0}};
  return scene;
}

Eigen::Vector2d tip_of(const PortableScene& scene, const PerParticle3& x) {
  return mean_rows(scene, shape, x).rightCols<1>();
}

struct Threshold {
  double friction;  // 1
  double load;      // on the tip, upward [B/L^2]
};

/// Of the elastica with its tip there, and bending from `inside` the middle of the held panel on.
Threshold threshold_of(Eigen::Vector2d tip, double inside, double strain) {
  const double free = (length - inside) * (1 - strain);
  const std::vector<double> end{1};
  const oracles::StripShape bent =
      oracles::strip_by_collocation(pressed(tip.x() / free, (tip.y() + inside) / free), end);
  return {std::abs(bent.force_across / bent.force_up), bent.force_up * std::pow(length / free, 2)};
}

constexpr double radians = 5.3;  // of the slowest vibration, that are waited for
constexpr double far = 0.0025;   // that a tip goes which slips, over the length [1]

/// The strip at rest, its tip held by three times the friction that it needs.
struct Pressed {
  PortableScene scene;
  Eigen::Vector2d tip;  // m
  double last_move;     // m
  double strain;        // 1
  double time;          // that is waited for [s]

  double least() const { return threshold_of(tip, 0, strain).friction; }
  double most() const { return threshold_of(tip, h / 2, strain).friction; }
};

Pressed strip_at_rest(Trial& trial, double compression, double rigidity) {
  PortableScene scene = strip_on_floor(compression);
  const Eigen::Vector2d start = tip_of(scene, scene.x);
  const Threshold needed = threshold_of(start, 0, 0);
  const double load = needed.load * rigidity / (length * length);  // N/m
  scene.planes[0].friction = 3 * needed.friction;
  // the load grows as the strip is pressed: its work is less than the last load's
  const double stored = load * shape.width() * compression * length;
  const Relaxed end = relaxed(trial, scene, {scene.x, length, 1e-5, 1e-3, stored});
  scene.x = end.x, scene.dt = end.dt;
  const Eigen::Vector2d tip = tip_of(scene, end.x);
  if (!((tip - start).norm() < 0.2 * compression * length))
    throw FailedWithoutNumber(
        fmt::format("the floor does not hold the tip: with three times the friction that it needs, "
                    "it goes {:.2g} m across and {:.2g} m up",
                    tip.x() - start.x(), tip.y() - start.y()),
        "a tip on the floor is compared");
  const double slowest =  // of a clamped and pinned strip [1/s]
      15.42 * std::sqrt(rigidity / scene.material.density) / (length * length);
  return {scene, tip, end.last_move, load / young, radians / slowest};
}

bool slips(Trial& trial, const Pressed& strip, double friction) {
  constexpr int glances = 8;
  PortableScene scene = strip.scene;
  scene.planes[0].friction = friction;
  trial.prepare(scene);
  for (int k = 0; k < glances; ++k) {
    const long steps = std::lround(strip.time / glances / scene.dt);
    const PerParticle3 x = trial.solver().advance(scene.dt, steps).x;
    if (!(tip_of(scene, x).x() - strip.tip.x() <= far * length)) return true;
  }
  return false;
}

Finding slips_as_the_elastica(Trial& trial) {
  const double rigidity = measured_rigidity(trial, flat_strip(), shape);
  require_resistance("bending", rigidity, given);
  Table measured = table_of(
      "compression [L] | measured rigidity [N m] | mu that just holds | at least [1] | "
      "at most [1] | last move [L] | outside of both [mu]");
  for (const double compression : {0.1, 0.2}) {
    const Pressed strip = strip_at_rest(trial, compression, rigidity);
    const double least = strip.least(), most = strip.most();
    const Interval tried{0.7 * least, 1.3 * most},
        last = bisected(tried, 0.01 * least, [&](double mu) { return !slips(trial, strip, mu); });
    const double found = middle(last);
    measured.row(compression, rigidity, found_text(last, tried), least, most,
                 strip.last_move / length, std::max({0.0, 1 - found / least, found / most - 1}));
  }
  return judge_worst(
      measured, 0.02,
      "half of the last bracket is 0.5 %; sixteen folds instead of a curve, (1/16)^2, 0.4 %; a "
      "strip that has 0.25 % too little friction slips just far enough to be seen in the time; a "
      "first order method and the strip's own waves are allowed as much. Bending begins at the "
      "held row or half a row before it");
}

}  // namespace

std::vector<Law> floor_laws() {
  return {
      {"floor.pressed-strip-slips-as-the-elastica",
       "The tip of a strip that is pressed on a floor slips at the friction at which the "
       "elastica's does.",
       "Romero et al. 2021", slips_as_the_elastica, "L1 held planes bending",
       "compression | mu that just holds | at least | at most"},
  };
}

}  // namespace foldproof
