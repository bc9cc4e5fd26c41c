// Several obstacles in one scene, and in scenes that follow each other.

#include "verification/subjects/suite/contact/obstacle_scenes.h"

namespace foldproof {

namespace {

using namespace suite;

/// Two boxes side by side, the sheet's smaller part on the first.
Finding across_two_boxes(Trial& trial) {
  PortableScene scene = limp_sheet(3, 0.03);
  scene.name = "sheet across two boxes";
  constexpr double first = 0.15, second = 0.6;
  const Vector3 half(0.3, 0.4, 0.1), at(0.2, -0.1, 0.3);
  scene.boxes = {{at - Vector3(half.x(), 0, half.z()), half, first},
                 {at + Vector3(half.x(), 0, -half.z()), half, second}};
  const Side side{"across two boxes", at + Vector3(0.03, 0, 0), Vector3::UnitZ(), Vector3::UnitY()};
  lay(scene, side, 0.9);
  double mean = 0;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    mean += scene.mass[i] / scene.mass.sum() * (scene.x(0, i) < at.x() ? first : second);
  Slides slides;
  slides.measure(trial, scene, side, mean);
  return slides.judged();
}

/// The kinds that the solver declares, or throws NotOffered if they are fewer.
std::vector<ObstacleKind> declared_kinds(Trial& trial, size_t least) {
  std::vector<ObstacleKind> kinds;
  for (const ObstacleKind& kind : obstacle_kinds())
    if (trial.declaration().offers(kind.capability)) kinds.push_back(kind);
  if (kinds.size() < least) throw NotOffered{fmt::format("{} kinds of obstacles", least)};
  return kinds;
}

/// One of each kind, none near another; the plane is behind all of them.
Finding kinds_count_together(Trial& trial) {
  const std::vector<ObstacleKind> kinds = declared_kinds(trial, 2);
  const auto number = [](const ObstacleKind& kind) {
    return kind.group == "box" ? 0 : kind.group == "ball" ? 1 : kind.group == "capsule" ? 2 : 3;
  };
  const auto friction = [&](const ObstacleKind& kind) {
    return 0.2 * number(kind) + drawn("friction of a " + kind.name + " among others", 0.1, 0.2);
  };
  Slides slides;
  for (const ObstacleKind& under : kinds) {
    PortableScene scene = limp_sheet(2, 0.03);
    scene.name = "sheet on a " + under.name + " beside other obstacles";
    for (const ObstacleKind& kind : kinds)
      if (kind.group == "contact")
        scene.planes = {{{-20, -15, -9}, Vector3(0.6, 0.64, 0.48), friction(kind)}};
      else
        kind.add(scene, number(kind), friction(kind));
    Side side = under.sides(number(under))[0];
    if (under.group == "contact")
      side = {"", scene.planes[0].point, scene.planes[0].normal, Vector3(0.8, -0.48, -0.36)};
    side.name = under.name;
    lay(scene, side, 0.95);
    slides.measure(trial, scene, side, friction(under));
  }
  return slides.judged();
}

Finding far_ones_change_nothing(Trial& trial) {
  constexpr long steps = 20;
  const PortableScene alone = moving_sheet();
  PortableScene among = alone;
  among.name = "moving sheet, obstacles far away";
  for (const ObstacleKind& kind : declared_kinds(trial, 1))
    if (kind.group == "contact")
      among.planes = {{{0, 0, -25}, Vector3::UnitZ(), 0.5}};
    else
      kind.add(among, 2, 0.5);
  Table measured = table_of("steps [1] | difference [of the sheet's size]");
  const PerParticle3 apart = trial.after(among, steps).x - trial.after(alone, steps).x;
  measured.row(steps, largest(apart) / largest(alone.x));
  return judge_worst(measured, narrow_rounding(trial, alone, steps),
                     "what does not touch the sheet does nothing to it: rounding is allowed");
}

Finding go_with_their_scene(Trial& trial) {
  constexpr long steps = 20;
  PortableScene scene = limp_sheet(2, 0.03);
  scene.name = "sheet that falls where an obstacle was";
  Table measured =
      table_of("obstacle before | fall [m] | free fall [m] | difference [of the free fall]");
  for (const ObstacleKind& kind : declared_kinds(trial, 1)) {
    const PortableScene before = sheet_on(kind, kind.sides(0)[0], 0, 0.5);
    trial.motion(before, {steps});
    PortableScene after = before;
    after.name = scene.name;
    after.planes.clear(), after.boxes.clear(), after.spheres.clear(), after.capsules.clear();
    const double time = double(steps) * scene.dt, free = weight * time * time / 2;
    const Vector3 way = (trial.after(after, steps).x - after.x).rowwise().mean();
    measured.row(kind.name, way.norm(), free,
                 (way - after.gravity * time * time / 2).norm() / free);
  }
  return judge_worst(measured, 0.1, "a first order method errs by 5 % of a fall of 20 steps");
}

}  // namespace

std::vector<Law> several_obstacle_laws() {
  return {
      {"box.sheet-across-two-has-the-friction-of-both",
       "A sheet that lies on two boxes has the friction of each where it lies on it.", "Coulomb",
       across_two_boxes, "boxes", slides_headline},
      {"obstacles.of-several-kinds-each-has-its-friction",
       "Among obstacles of other kinds, each has its own place and friction.", "Coulomb",
       kinds_count_together, "", slides_headline},
      {"obstacles.far-ones-change-nothing", "Obstacles that touch nothing do nothing.", "locality",
       far_ones_change_nothing},
      {"obstacles.go-with-their-scene", "A scene without obstacles has none of the scene before.",
       "inertia", go_with_their_scene},
  };
}

}  // namespace foldproof
