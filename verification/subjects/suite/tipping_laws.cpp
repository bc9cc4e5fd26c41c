// A strip on edge, clamped at one end: the weight under which it tips sideways.

#include "verification/oracles/chains_and_ribbons.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/relaxation.h"
#include "verification/subjects/suite/strips.h"

namespace foldproof {

namespace {

using namespace suite;

//   z                    Two rows at y = 0 are held, the strip's width along z. Its weight bends
//   |______________      it in its stiff plane; beyond a load it tips over: it turns about y and
//   |______________|_ y  leaves the plane along x.
constexpr StripShape ribbon{2, 20, 0.04};
constexpr double given = 4e-3;      // B of the scene [N m]
constexpr double young = 750;       // N/m; in its plane it is 100 times as stiff
constexpr double tip_twist = 0.02;  // at the start [rad]
constexpr double radians = 2;       // of the weightless strip's slowest vibration

// Bending begins in the middle of the held panel, or at its inner row: as for the column.
const double h = ribbon.row_height(), longest = (ribbon.rows - 0.5) * h,
             shortest = (ribbon.rows - 1) * h;

PortableScene lying_ribbon() {
  return free_strip(ribbon, {.young = young, .bending_rigidity = given}, 2e-4);
}

PortableScene ribbon_on_edge() {
  PortableScene scene = lying_ribbon();
  scene.name = "ribbon on edge";
  const double middle = ribbon.width() / 2;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double along = scene.mesh.rest(1, i) + ribbon.length() / 2;
    scene.x.col(i) << 0, along, scene.mesh.rest(0, i) - middle;
    if (along < 1.5 * h) scene.held.push_back(int(i));
  }
  return scene;
}

/// What a solver gives the ribbon.
struct Rigidities {
  double bending, twisting;  // B, and GJ over the width [N m]
};

/// Gravity under which a ribbon of these rigidities and length tips [m/s^2].
double tips_under(const Rigidities& rigidities, double length) {
  return gravity_of(oracles::tipping_load_by_series().value,
                    std::sqrt(rigidities.bending * rigidities.twisting), lying_ribbon(), length);
}

/// At the clamp a ribbon cannot warp. The energy of warping, B w^3/12 twist''^2/2, against that of
/// twisting, GJ twist'^2/2, keeps it from twisting over this length [m], the root of their ratio.
double warping_length(const Rigidities& rigidities) {
  return ribbon.width() * std::sqrt(rigidities.bending / rigidities.twisting / 12);
}

/// Twist and deflection of the mode in which a ribbon tips, over the free end's twist; lengths over
/// that of the ribbon, distances from the clamp. The deflection bends it by the weight's moment:
///   u'' = Q/2 sqrt(GJ/EI) t^2 phi,   t = 1 - s.
struct Mode {
  std::vector<double> twist, deflection;  // at equal distances
};

Mode tipping_mode(const Rigidities& rigidities, int parts) {
  const double ds = 1.0 / parts, factor = oracles::tipping_load_by_series().value / 2 *
                                          std::sqrt(rigidities.twisting / rigidities.bending);
  Mode mode;
  double slope = 0, deflection = 0;
  for (int k = 0; k <= parts; ++k) {
    const double t = 1 - k * ds, twist = oracles::tipping_twist(t);
    mode.twist.push_back(twist);
    mode.deflection.push_back(deflection);
    slope += ds * factor * t * t * twist;  // s - ds/2 to s + ds/2, since twist is 0 at the clamp
    deflection += ds * slope;
  }
  return mode;
}

/// The ribbon with the planar deflection of its weight, and the start of tipping added to it.
class Ribbon {
 public:
  Ribbon(Trial& trial, const Rigidities& rigidities)
      : rigidities_(rigidities), on_edge_(ribbon_on_edge()), sag_(on_edge_) {
    sag_.gravity.z() = -tips_under(rigidities, longest) / 2;
    const Relaxed rest = relaxed(trial, sag_, {on_edge_.x, longest, 1e-5, 4e-3});
    on_edge_.dt = rest.dt;
    sag_.x = rest.x;
  }

  PortableScene under(double gravity) const {
    PortableScene scene = on_edge_;
    scene.name = fmt::format("ribbon on edge under {:.4g} m/s^2", gravity);
    scene.gravity = Vector3(0, 0, -gravity);
    scene.x += gravity / sag_.gravity.norm() * (sag_.x - on_edge_.x);
    constexpr int parts = 400;
    const Mode mode = tipping_mode(rigidities_, parts);
    for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
      const double s = std::max(0.0, on_edge_.x(1, i) - h / 2) / longest;
      const size_t k = size_t(std::lround(std::min(1.0, s) * parts));
      const double turn = tip_twist * mode.twist[k];
      scene.x(0, i) += tip_twist * longest * mode.deflection[k] + on_edge_.x(2, i) * std::sin(turn);
      scene.x(2, i) -= on_edge_.x(2, i) * (1 - std::cos(turn));
    }
    return scene;
  }

 private:
  Rigidities rigidities_;
  PortableScene on_edge_, sag_;
};

/// Over its start's, how far the ribbon has moved in the direction of the start, later
/// [1]; above 1 it tips.
double tipping(Trial& trial, const Ribbon& ribbon_at_rest, double rigidity, double gravity) {
  const PortableScene scene = ribbon_at_rest.under(gravity);
  const double slowest = slowest_vibration(rigidity, scene, longest);
  const PerParticle3 end = trial.after(scene, std::lround(radians / slowest / scene.dt)).x;
  const PerParticle weights = scene.mass.cwiseProduct(scene.x.row(0).transpose());
  return end.row(0).dot(weights) / scene.x.row(0).dot(weights);
}

Finding tips_at_its_load(Trial& trial) {
  const double bending = measured_rigidity(trial, lying_ribbon(), ribbon);
  require_resistance("bending", bending, given);
  const double twisting = measured_twisting(trial, lying_ribbon(), ribbon, 0.4);
  require_resistance("twisting", twisting, given);
  const Rigidities rigidities{bending, twisting};
  const double expected = tips_under(rigidities, longest),
               least = std::sqrt(1 - largest_poisson * largest_poisson) * expected,
               most = tips_under(rigidities, shortest - warping_length(rigidities));
  const Ribbon at_rest(trial, rigidities);
  const Bracket bracket = bracketed(
      expected, [&](double gravity) { return !(tipping(trial, at_rest, bending, gravity) < 1); });
  Table measured = table_of(
      "measured rigidity [N m] | of twist, over the width [N m] | stands under | tips under | "
      "at least [m/s^2] | at most [m/s^2] | outside of both [1]");
  measured.row(bending, twisting, bracket.stands_text(), bracket.falls_text(), least, most,
               std::max({0.0, 1 - bracket.falls / least, bracket.stands / most - 1}));
  return judge_worst(
      measured, 0.03,
      "both rigidities are measured to 2 %, and so is the load; it bends in its plane, by one over "
      "the ratio of both rigidities, 1 %; nineteen folds instead of a curve, 0.3 %");
}

}  // namespace

std::vector<Law> tipping_laws() {
  return {
      {"buckling.strip-on-edge-tips-at-its-load",
       "A strip on edge, clamped at one end, tips sideways under the weight that its own "
       "rigidities of bending and twist say.",
       "Prandtl 1899, Timoshenko", tips_at_its_load, "L1 held bending",
       "stands under | tips under | at least | at most"},
  };
}

}  // namespace foldproof
