#include "verification/subjects/suite/portrait.h"

#include <fmt/format.h>

#include "reference/mesh/shapes.h"
#include "verification/subjects/suite/scenes.h"

namespace foldproof::suite {

namespace {

constexpr double width = 1;            // m
constexpr double radius = 0.25;        // m
constexpr double gap = 0.03;           // m, that the sheet falls before it meets the ball
constexpr int cells = 20;              // along each side
constexpr double friction = 0.5;       // 1
constexpr double dt = 1e-3;            // s
constexpr long steps = 500;            // in which the corners swing past the ball
constexpr double young = 20;           // N/m: stable in this step
const Vector3 off_middle(0.05, 0, 0);  // m, of the ball: a picture has no symmetry to hide in

PortableScene sheet_over_a_ball() {
  PortableScene scene = resting("sheet on a ball, for a picture",
                                make_sheet({SheetPattern::alternating, width, width, cells, cells}),
                                {.young = young});
  scene.gravity = Vector3(0, 0, -9.81);
  scene.dt = dt;
  const Vector3 middle(width / 2, width / 2, 0);
  scene.spheres = {{middle + off_middle - Vector3(0, 0, gap + radius), radius, friction}};
  return scene;
}

std::string words_of_scene() {
  return fmt::format(
      "A limp sheet of {} m, {} s after it was let go {} m above a ball of radius {} m: {} x {} "
      "cells, {} steps of {} s, Young's modulus {} N/m, friction {}, no damping.",
      width, double(steps) * dt, gap, radius, cells, cells, steps, dt, young, friction);
}

}  // namespace

Portrait portrait_of(const SolverCommand& command) {
  Portrait portrait{sheet_over_a_ball(), words_of_scene(), {}, ""};
  Trial trial(command);
  try {
    trial.require("spheres");
    portrait.x = trial.after(portrait.scene, steps).x;
  } catch (const NotOffered& missing) {
    portrait.why_none = "it does not offer " + missing.operation;
  } catch (const SolverFailure& failure) {
    portrait.why_none = failure.what();
  } catch (const TimeIsUp& end) {
    portrait.why_none = end.what();
  }
  if (portrait.why_none.empty() && !portrait.x.allFinite()) {
    portrait.x.resize(3, 0);
    portrait.why_none = "its positions are not finite";
  }
  return portrait;
}

}  // namespace foldproof::suite
