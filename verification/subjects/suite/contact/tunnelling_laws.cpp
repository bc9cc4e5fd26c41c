// A sheet thrown at a thin box, faster and faster.

#include <Eigen/Geometry>

#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr double thickness = 0.01;  // m
constexpr double gap = 0.02;        // m, of the lowest particle to the box
constexpr long free_steps = 2;      // of the slowest sheet, half the way to the box
constexpr double tilt = 0.05;       // rad: particles meet the box at all phases of a step

/// Thrown straight down at a box, with so many thicknesses in a step.
PortableScene thrown_sheet(double thicknesses) {
  PortableScene scene = sheet_at_rest();
  scene.name = "sheet thrown at a thin box";
  scene.x = Eigen::AngleAxisd(tilt, Vector3(0.6, 0.8, 0)).toRotationMatrix() * scene.mesh.rest;
  scene.x.row(2).array() += gap - scene.x.row(2).minCoeff();
  scene.v.row(2).setConstant(-thicknesses * thickness / scene.dt);
  scene.boxes = {{{0.3, 0.26, -thickness / 2}, {1, 1, thickness / 2}, 0}};
  return scene;
}

/// Particles below the box, when the highest has had time to come twice as far.
long particles_through(Trial& trial, const PortableScene& scene) {
  const double way = 2 * (scene.x.row(2).maxCoeff() + thickness);
  const long steps = long(std::ceil(way / (-scene.v(2, 0) * scene.dt)));
  return (trial.after(scene, steps).x.row(2).array() < -thickness).count();
}

Finding nothing_passes(Trial& trial) {
  constexpr double slowest = 0.45;  // thicknesses
  const PortableScene slow = thrown_sheet(slowest);
  require_start_velocity(slow, trial.after(slow, free_steps).x, free_steps);
  Table measured = table_of(
      "way in a step [thickness] | speed [m/s] | particles through [1] | "
      "those that a step cannot carry through [1]");
  double safe = 0;  // thicknesses
  bool passed = false;
  for (const double thicknesses : {slowest, 0.9, 1.8, 3.6, 7.2, 14.4, 28.8}) {
    const PortableScene scene = thrown_sheet(thicknesses);
    const long through = particles_through(trial, scene);
    passed |= through > 0;
    if (!passed) safe = thicknesses;
    measured.row(thicknesses, -scene.v(2, 0), through, thicknesses < 0.5 ? through : 0);
  }
  return judge_worst(measured, 0,
                     "a step that moves less than half the thickness ends in the nearer half of "
                     "the box, whose nearest face is the one that was passed",
                     fmt::format("nothing gets through at up to {} thicknesses a step", safe));
}

}  // namespace

std::vector<Law> tunnelling_laws() {
  return {
      {"tunnelling.thin-box-stops-a-slow-sheet",
       "Nothing passes through a thin box where a step moves less than half its thickness.",
       "impenetrability", nothing_passes, "boxes"},
  };
}

}  // namespace foldproof
