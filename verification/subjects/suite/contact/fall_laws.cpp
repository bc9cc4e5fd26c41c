// A sheet falls on a plane, a box, a ball or a capsule, at 2 and 5 m/s: none of them does work.

#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

/// A sheet at rest, and an obstacle that it meets after a fall.
struct Drop {
  PortableScene scene;
  double depth;  // of the obstacle, that the sheet may hang down around it [m]
};

Drop over_a_plane(double height) {
  PortableScene scene = sheet_on_a_plane({0, 0}, 0.3);
  scene.name = "sheet above a plane";
  scene.planes[0].point -= height * scene.planes[0].normal;
  return {scene, 0};
}

/// A level sheet of 8 x 8 cells.
PortableScene level_sheet(const char* name) {
  PortableScene scene = sheet_of_cells(8);
  scene.name = name;
  scene.gravity = Vector3(0, 0, -weight);
  return scene;
}

Drop over_a_box(double height) {
  constexpr double half = 0.15;  // m
  PortableScene scene = level_sheet("sheet above a box");
  scene.boxes = {{middle_of(scene.x) - Vector3(0, 0, height + half), {0.25, 0.2, half}, 0.3}};
  return {scene, 2 * half};
}

Drop over_a_ball(double height) {
  constexpr double radius = 0.3;  // m
  PortableScene scene = level_sheet("sheet above a ball");
  scene.spheres = {{middle_of(scene.x) - Vector3(0, 0, height + radius), radius, 0.5}};
  return {scene, radius};
}

Drop over_a_capsule(double height) {
  constexpr double radius = 0.15;  // m
  const Vector3 half_axis(0.3, 0.4, 0);
  PortableScene scene = level_sheet("sheet above a capsule");
  const Vector3 middle = middle_of(scene.x) - Vector3(0, 0, height + radius);
  scene.capsules = {{middle - half_axis, middle + half_axis, radius, 0.4}};
  return {scene, 2 * radius};
}

/// The largest kinetic energy beyond what gravity has done [J], until half as long again as it
/// takes to fall so far.
double gained_in_fall(Trial& trial, const PortableScene& scene, double fall) {
  const long count = std::lround(1.5 * std::sqrt(2 * fall / weight) / scene.dt);
  Worst worst;
  for (const Snapshot& now : trial.motion(scene, multiples(1, count)))
    worst.observe(gained_energy(scene, scene.x, now));
  return worst.value();
}

Finding gains_no_energy(Trial& trial, Drop (*over)(double height)) {
  Table measured = table_of(
      "height [m] | speed [m/s] | "
      "gained energy [of the weight times the fall around the obstacle]");
  for (const double height : {0.2, 1.25}) {
    const Drop drop = over(height);
    const double fall = height + drop.depth, gained = gained_in_fall(trial, drop.scene, fall);
    measured.row(height, std::sqrt(2 * weight * height),
                 gained / (drop.scene.mass.sum() * weight * fall));
  }
  return judge_worst(measured, 0.02,
                     "an obstacle at rest does no work; a first order method errs by half a step "
                     "of the fall, g t dt/2 in height, 1 %, and by as much in its elastic energy");
}

Law law_of(const std::string& group, const std::string& obstacle, const char* capability,
           Drop (*over)(double height)) {
  return {group + ".fall-gains-no-energy",
          "A sheet that falls on a " + obstacle + ", at 2 or at 5 m/s, gains no energy from it.",
          "energy", [over](Trial& trial) { return gains_no_energy(trial, over); },
          std::string(capability) + " touches"};
}

}  // namespace

std::vector<Law> fall_laws() {
  return {law_of("contact", "plane", "planes", over_a_plane),
          law_of("box", "box", "boxes", over_a_box), law_of("ball", "ball", "spheres", over_a_ball),
          law_of("capsule", "capsule", "capsules", over_a_capsule)};
}

}  // namespace foldproof
