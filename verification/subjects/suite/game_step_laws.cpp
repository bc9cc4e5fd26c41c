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
double static_stretch(Trial& trial, double step) {
  PortableScene scene = sheet_on_a_rail();
  scene.dt = step;
  const Relaxed end = relaxed(trial, scene, {scene.x, height_of(scene), enough, game_step});
  if (end.dt < step)
    throw NotOffered{fmt::format("steps of {:.2g} s: a hanging sheet gains energy in them", step)};
  return scene.x.row(1).minCoeff() - end.x.row(1).minCoeff();
}

Finding stretch_does_not_depend_on_the_step(Trial& trial) {
  constexpr int parts = 16;
  const double at_game_step = static_stretch(trial, game_step),
               in_short_steps = static_stretch(trial, game_step / parts);
  Table measured = table_of(
      "stretch in steps of 1/60 s [m] | in steps of 1/960 s [m] | difference [of the second]");
  measured.row(at_game_step, in_short_steps, std::abs(at_game_step / in_short_steps - 1));
  return judge_worst(measured, 0.05,
                     "at rest no force depends on the step; each shape is at rest to 3e-4 of the "
                     "height, 0.3 % of the stretch, and five times that is allowed");
}

}  // namespace

std::vector<Law> game_step_laws() {
  return {
      {"game-step.static-stretch-is-that-of-short-steps",
       "In steps of 1/60 s, a hanging sheet stretches under its weight as in short ones.",
       "equilibrium", stretch_does_not_depend_on_the_step, "L1 held"},
  };
}

}  // namespace foldproof
