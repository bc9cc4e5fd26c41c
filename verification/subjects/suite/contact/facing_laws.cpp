// Planes that face every way, and a capsule that is a ball.

#include "verification/subjects/suite/contact/obstacle_scenes.h"

namespace foldproof {

namespace {

using namespace suite;

/// Floors, walls and ceilings, and planes that are nearly that: gravity presses the sheet on each.
Finding planes_face_all_ways(Trial& trial) {
  Slides slides;
  for (int axis = 0; axis < 3; ++axis)
    for (const int sign : {1, -1})
      for (const double lean : {0.0, drawn(fmt::format("lean {}{}", axis, sign), 0.1, 0.25)}) {
        const Vector3 beside = Vector3::Unit((axis + 1) % 3), flat = sign * Vector3::Unit(axis),
                      normal = std::cos(lean) * flat + std::sin(lean) * beside,
                      down = std::cos(lean) * beside - std::sin(lean) * flat;
        const Side side{fmt::format("plane that faces {}{}{}", sign > 0 ? '+' : '-', "xyz"[axis],
                                    lean > 0 ? " nearly" : ""),
                        Vector3(0.3, -0.4, 0.2), normal, down};
        PortableScene scene = limp_sheet(2, 0.03);
        const double mu = drawn("friction on " + side.name, 0.2, 0.4);
        scene.name = "sheet on a " + side.name;
        scene.planes = {{side.point, normal, mu}};
        lay(scene, side, 0.7);
        slides.measure(trial, scene, side, mu);
      }
  return slides.judged();
}

Finding capsule_of_one_point(Trial& trial) {
  Slides slides;
  const Vector3 centre(0.2, 0.5, -0.3);
  constexpr double radius = 1.2;  // m
  for (const Vector3& out : {Vector3(0, 0.6, 0.8), Vector3(0.8, 0, -0.6)}) {
    const Side side{fmt::format("normal {} {} {}", out[0], out[1], out[2]), centre + radius * out,
                    out, out.unitOrthogonal()};
    PortableScene scene = limp_sheet(2, 0.03);
    const double mu = drawn("friction on a capsule of one point", 0.2, 0.4);
    scene.name = "sheet on a capsule of one point";
    // the point is doubled to rounding only, so that an axis can be made of it
    scene.capsules = {{centre, centre + Vector3(1e-9, 0, 0), radius, mu}};
    lay(scene, side, 0.7);
    slides.measure(trial, scene, side, mu);
  }
  return slides.judged();
}

}  // namespace

std::vector<Law> facing_laws() {
  return {
      {"contact.planes-of-all-ways-have-their-friction",
       "Floors, walls and ceilings hold a sheet, with their friction, as gravity presses it.",
       "Coulomb", planes_face_all_ways, "planes", slides_headline},
      {"capsule.of-one-point-is-a-ball", "A capsule whose ends are one point is a ball.",
       "protocol", capsule_of_one_point, "capsules", slides_headline},
  };
}

}  // namespace foldproof
