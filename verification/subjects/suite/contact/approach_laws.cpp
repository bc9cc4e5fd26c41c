// Obstacles that cloth comes near to: of any size, listed twice, and side by side.

#include "verification/subjects/suite/contact/obstacle_scenes.h"

namespace foldproof {

namespace {

using namespace suite;

/// A box, a ball or a capsule of a given size, with a point of its surface.
struct Approached {
  std::string name, capability;
  Vector3 point, normal;
  std::function<void(PortableScene& scene)> add;
};

std::vector<Approached> approached(double size) {
  const Vector3 at(0.3, -0.2, 0.4), slant(0.48, -0.6, 0.64), axis(0.6, 0.8, 0);
  const Vector3 half = size * Vector3(1.1, 0.9, 0.7), across = axis.cross(Vector3::UnitZ());
  const double radius = 0.8 * size;
  const std::string of_size = fmt::format("of {:g} m", size);
  return {
      {"side of a box " + of_size, "boxes", at + half.y() * Vector3::UnitY(), Vector3::UnitY(),
       [=](PortableScene& scene) {
         scene.boxes = {{at, half, 0.3}};
       }},
      {"top of a box " + of_size, "boxes", at + half.z() * Vector3::UnitZ(), Vector3::UnitZ(),
       [=](PortableScene& scene) {
         scene.boxes = {{at, half, 0.3}};
       }},
      {"ball " + of_size, "spheres", at + radius * slant, slant,
       [=](PortableScene& scene) {
         scene.spheres = {{at, radius, 0.3}};
       }},
      {"capsule " + of_size, "capsules", at + radius * across, across, [=](PortableScene& scene) {
         scene.capsules = {{at - size * axis, at + size * axis, radius, 0.3}};
       }}};
}

/// Flies at the surface, and is asked where it is shortly before it meets it.
Finding is_free_until_it_meets(Trial& trial) {
  Table measured =
      table_of("obstacle | gap that is left [m] | free way [m] | difference from it [of the way]");
  constexpr double speed = 0.5, way = 0.03;  // m/s, m
  for (const double size : {0.05, 0.3, drawn("a large obstacle", 8, 14)})
    for (const Approached& one : approached(size)) {
      if (!trial.declaration().offers(one.capability)) continue;
      PortableScene scene = limp_sheet(2, 0.01);
      scene.name = "sheet that flies at the " + one.name;
      one.add(scene);
      lay(scene, {one.name, one.point, one.normal, one.normal.unitOrthogonal()}, 0);
      scene.gravity.setZero();
      const long steps = std::lround(way / speed / scene.dt);
      const double left = drawn("gap before a " + one.capability, 0.0015, 0.0025);  // m
      scene.x = scene.mesh.rest.colwise() + (way + left) * one.normal;
      scene.v.colwise() = -speed * one.normal;
      const PerParticle3 moved = trial.after(scene, steps).x - scene.x;
      const PerParticle3 off = moved.colwise() + way * one.normal;
      measured.row(one.name, left, way, largest(off) / way);
    }
  if (measured.rows() == 0) throw NotOffered{"boxes, spheres or capsules"};
  return judge_worst(measured, 0.02, "what has not met the cloth does nothing to it");
}

constexpr long count = 12;

/// How a sheet slides on an obstacle, and how it rebounds from it.
struct Touch {
  double slid = 0, rebound = 0, deepest = 0;  // of what gravity alone would do, of the free way, m
};

Touch touch_of(Trial& trial, PortableScene scene, const Side& side) {
  Touch touch;
  const double time = double(count) * scene.dt, speed = 0.8;  // s, m/s
  const std::vector<Snapshot> states = trial.motion(scene, {count, 2 * count});
  const Vector3 bent = (states[1].x - 2 * states[0].x + scene.x).rowwise().mean();
  touch.slid = bent.dot(side.down) / (scene.gravity.dot(side.down) * time * time);
  scene.gravity.setZero();
  scene.v.colwise() = -speed * side.normal;
  const PerParticle3 after = trial.after(scene, count).x;
  touch.rebound = (after - scene.x).rowwise().mean().dot(side.normal) / (speed * time);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    touch.deepest = std::max(touch.deepest, -clearance(scene, after.col(i)));
  return touch;
}

Finding twice_is_once(Trial& trial) {
  Table measured = table_of(
      "obstacle | slides by [of that without friction] | slides by, listed twice [of it] | "
      "rebounds "
      "by [of the free way] | rebounds by, listed twice [of it] | deepest [m] | deepest, listed "
      "twice [m] | largest part of what is allowed [1]");
  for (const ObstacleKind& kind : obstacle_kinds()) {
    if (!trial.declaration().offers(kind.capability)) continue;
    const double mu = drawn("friction of a " + kind.name + " twice", 0.35, 0.45);
    const Side side = kind.sides(0)[0];
    PortableScene scene = sheet_on(kind, side, 0.9, mu);
    const Touch once = touch_of(trial, scene, side);
    scene.name = "sheet on a " + kind.name + " that is listed twice";
    kind.add(scene, 0, mu);
    const Touch twice = touch_of(trial, scene, side);
    measured.row(
        kind.name, once.slid, twice.slid, once.rebound, twice.rebound, once.deepest, twice.deepest,
        std::max({std::abs(twice.slid - once.slid) / 0.06, (twice.rebound - once.rebound) / 0.1,
                  (twice.deepest - once.deepest) / allowance(trial.declaration(), scene).depth}));
  }
  if (measured.rows() == 0) throw NotOffered{"obstacles"};
  return judge_worst(measured, 1,
                     "two obstacles in one place are that obstacle; empirical: 6 % of what slides, "
                     "a tenth of the way, and a millimetre, which cannot be seen");
}

/// A floor of 6 x 6 boxes side by side, or one box of its size, with its top at z = 0.
void add_floor(PortableScene& scene, const Vector3& middle, int boxes, double friction) {
  const double side = 0.3 / boxes;  // m, half of a box
  for (int k = 0; k < boxes * boxes; ++k)
    scene.boxes.push_back({middle + Vector3(side * (2 * (k % boxes) + 1) - 0.3,
                                            side * (2 * (k / boxes) + 1) - 0.3, -0.07),
                           {side, side, 0.07},
                           friction});
}

Finding slides_over_seams(Trial& trial) {
  if (trial.declaration().contact_offset > 0)
    throw NotOffered{"boxes that touch: smaller by its contact_offset they leave grooves"};
  constexpr long steps = 90;
  Table measured = table_of(
      "way along | mu [1] | way over one box [m] | way over its parts [m] | difference [of it]");
  for (const Vector3& along : {Vector3(1, 0, 0), Vector3(0, -1, 0), Vector3(-0.6, 0.8, 0)})
    for (const double mu : {0.0, drawn("friction of boxes side by side", 0.15, 0.2)}) {
      const auto way_over = [&](const std::string& name, int boxes) {
        PortableScene scene = limp_sheet(2, 0.02);
        scene.name = name;
        const Vector3 middle(0.3, -0.2, 0), aside(0.0037, 0.0053, 0);  // off the seams
        add_floor(scene, middle, boxes, mu);
        lay(scene, {"", middle - 0.11 * along + aside, Vector3::UnitZ(), along}, 0);
        scene.v.colwise() = drawn("speed over seams", 1.2, 1.4) * along;
        return Vector3((trial.after(scene, steps).x - scene.x).rowwise().mean());
      };
      const Vector3 whole = way_over("sheet that slides on a box", 1),
                    parts = way_over("sheet that slides on boxes side by side", 6);
      measured.row(fmt::format("{:g}, {:g}", along.x(), along.y()), mu, whole.norm(),
                   parts.dot(along), (parts - whole).norm() / whole.norm());
    }
  return judge_worst(measured, 0.05,
                     "the sides that boxes share are inside the solid that they make together");
}

}  // namespace

std::vector<Law> approach_laws() {
  return {
      {"obstacles.cloth-is-free-until-it-meets-one",
       "Cloth that flies at an obstacle, small or large, flies freely until it meets it.",
       "inertia", is_free_until_it_meets, "", "obstacle | gap that is left | difference from it"},
      {"obstacles.listed-twice-is-one",
       "An obstacle that is listed twice has its friction once, and throws nothing back.",
       "Coulomb; impenetrability", twice_is_once, "",
       "obstacle | slides by | slides by, listed twice | rebounds by, listed twice"},
      {"box.seams-of-a-floor-hold-nothing-back",
       "A sheet slides over a floor of boxes side by side as over one box of its size.", "Coulomb",
       slides_over_seams, "boxes", "way along | mu | way over one box | way over its parts"},
  };
}

}  // namespace foldproof
