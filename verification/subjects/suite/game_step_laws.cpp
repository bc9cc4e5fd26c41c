// A step as games take it, 1/60 s: what a sheet weighs and how stiff it is does not depend on it.

#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/relaxation.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr double game_step = 1.0 / 60;  // s
constexpr double enough = 3e-4;         // of the height, that the last two rounds may move it

/// A sheet in its rest shape that hangs in its own plane from its upper edge.
PortableScene sheet_on_a_rail() {
  PortableScene scene = sheet_at_rest();
  scene.name = "sheet on a rail";
  scene.gravity = Vector3(0, -9.81, 0);
  const double top = scene.x.row(1).maxCoeff();
  for (int i = 0; i < scene.x.cols(); ++i)
    if (scene.x(1, i) > top - 0.01) scene.held.push_back(i);
  return scene;
}

double height_of(const PortableScene& scene) {
  return scene.x.row(1).maxCoeff() - scene.x.row(1).minCoeff();
}

/// How much longer it is at rest under its weight [m].
/// stiffer, lighter: than that sheet, which stretches by a tenth [1].
double static_stretch(Trial& trial, double step, double stiffer, double lighter) {
  PortableScene scene = sheet_on_a_rail();
  scene.dt = step;
  scene.material.young *= stiffer;
  scene.gravity /= lighter;
  const double precision = enough / (stiffer * lighter);
  const NotOffered too_long{
      fmt::format("steps of {:.2g} s: a hanging sheet gains energy in them", step)};
  try {
    const Relaxed end = relaxed(trial, scene, {scene.x, height_of(scene), precision, game_step});
    if (end.dt < step) throw too_long;
    return scene.x.row(1).minCoeff() - end.x.row(1).minCoeff();
  } catch (const FailedWithoutNumber&) {
    if (stiffer > 1) throw too_long;
    throw;
  }
}

/// At rest, a sheet of twice the stiffness under twice the weight has the same shape: short steps
/// are those of a soft sheet under so much less weight, which can take them.
Finding stretch_does_not_depend_on_the_step(Trial& trial) {
  constexpr int parts = 16;
  Table measured = table_of(
      "Young's modulus [N/m] | stretch in steps of 1/60 s [m] | in short steps [m] | "
      "difference [of the second]");
  for (const double stiffer : {1.0, drawn("stiff sheet", 12, 16), 200.0}) {
    const double at_game_step = static_stretch(trial, game_step, stiffer, 1),
                 in_short_steps = static_stretch(trial, game_step / parts, 1, stiffer);
    measured.row(stiffer * sheet_on_a_rail().material.young, at_game_step, in_short_steps,
                 std::abs(at_game_step / in_short_steps - 1));
  }
  return judge_worst(measured, 0.05,
                     "at rest no force depends on the step; each shape is at rest to 0.3 % of the "
                     "stretch, and five times that is allowed");
}

/// From places at three times, the acceleration along the slope, over that without friction [1].
double slide_at_game_step(Trial& trial, double slope, double friction, double stiffer) {
  constexpr long count = 10;
  PortableScene scene = sheet_on_a_plane({std::atan(slope), 0.7}, friction);
  scene.name = "sheet on a slope, in long steps";
  scene.dt = game_step;
  scene.material.young *= stiffer;
  const std::vector<Snapshot> states = trial.motion(scene, {count, 2 * count});
  const PerParticle3 way = seen_from_the_plane(states[1].x) - seen_from_the_plane(scene.x);
  const Vector3 mean = way.rowwise().mean(), down(std::cos(0.7), std::sin(0.7), 0);
  if (!(largest(way.colwise() - mean) < 0.03))
    throw NotOffered{
        fmt::format("steps of {:.2g} s: a sheet that slides gains energy in them", game_step)};
  const Vector3 halfway =
      (seen_from_the_plane(states[0].x) - seen_from_the_plane(scene.x)).rowwise().mean();
  const double free = scene.gravity.norm() * slope / std::hypot(1, slope) *
                      std::pow(double(count) * game_step, 2);  // m
  return down.dot(mean - 2 * halfway) / free;
}

Finding friction_does_not_depend_on_the_step(Trial& trial) {
  Table measured = table_of(
      "Young's modulus [N/m] | slope [1] | mu [1] | acceleration [of that without friction] | by "
      "Coulomb's law [1] | difference [1]");
  const double mu = drawn("friction in long steps", 0.25, 0.35);
  for (const double stiffer : {1.0, 40.0})
    for (const double slope : {2 * mu, 0.8 * mu}) {
      const double slides = slide_at_game_step(trial, slope, mu, stiffer),
                   coulomb = std::max(0.0, 1 - mu / slope);
      measured.row(stiffer * sheet_on_a_rail().material.young, slope, mu, slides, coulomb,
                   std::abs(slides - coulomb));
    }
  return judge_worst(measured, 0.1,
                     "the step in which contact begins is one of 20, and counts from three places");
}

}  // namespace

std::vector<Law> game_step_laws() {
  return {
      {"game-step.static-stretch-is-that-of-short-steps",
       "In steps of 1/60 s, hanging sheets of 5 to 1,000 N/m stretch under their weight as in "
       "short ones.",
       "equilibrium", stretch_does_not_depend_on_the_step, "L1 held",
       "Young's modulus | stretch in steps of 1/60 s | in short steps"},
      {"game-step.slides-as-coulomb-says",
       "In steps of 1/60 s sheets of 5 and 200 N/m slide down a plane, or stick, as Coulomb says.",
       "Coulomb", friction_does_not_depend_on_the_step, "planes",
       "Young's modulus | slope | acceleration | by Coulomb's law"},
  };
}

}  // namespace foldproof
