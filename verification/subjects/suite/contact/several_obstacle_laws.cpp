// Several obstacles in one scene, and in scenes that follow each other.

#include <Eigen/Geometry>

#include "reference/mesh/shapes.h"
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

//          |
//   second |  along points out of the page: the sheet's middle row lies on the crease, on both
//          o------       obstacles; one row lies on each of them alone
//            first
struct Crease {
  std::string name;
  std::vector<std::string> kinds;  // capabilities
  Vector3 first, second;           // outward normals at the crease
  std::function<void(PortableScene& scene, double first, double second)> add;  // frictions
};

const Vector3 crease_point{0.4, -0.3, 0.7};  // m

/// Of two planes with these normals, stated by points that are so far apart along the crease [m].
Crease crease_of_planes(const std::string& name, const Vector3& one, const Vector3& two,
                        double apart) {
  return {name, {"planes"}, one, two, [=](PortableScene& scene, double first, double second) {
            scene.planes = {{crease_point + 0.4 * apart * one.cross(two), one, first},
                            {crease_point - 0.6 * apart * one.cross(two), two, second}};
          }};
}

std::vector<Crease> creases() {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.9, Vector3(0.5, 0.6, -0.4).normalized()).toRotationMatrix();
  const Vector3 a = turn.col(0), b = turn.col(1), z = Vector3::UnitZ(), x = Vector3::UnitX();
  const auto boxes = [=](PortableScene& scene, double first, double second) {
    scene.boxes = {{crease_point - 0.3 * z, {2, 1.8, 0.3}, first},
                   {crease_point - 0.4 * x, {0.4, 2, 1}, second}};
  };
  const auto ball_on_plane = [=](PortableScene& scene, double first, double second) {
    constexpr double radius = 8;  // m
    scene.planes = {{crease_point + a, b, first}};
    scene.spheres = {{crease_point - radius * a, radius, second}};
  };
  const auto capsule_on_box = [=](PortableScene& scene, double first, double second) {
    constexpr double radius = 1.2;  // m
    const Vector3 axis = z.cross(x), middle = crease_point - radius * x;
    scene.capsules = {{middle - 2 * axis, middle + 1.7 * axis, radius, second}};
    scene.boxes = {{crease_point - 0.2 * z, {1, 1.5, 0.2}, first}};
  };
  const auto inclined = [&](double degrees) {  // between the planes
    const double turned = pi - degrees * pi / 180;
    return Vector3(std::cos(turned) * a + std::sin(turned) * b);
  };
  const Vector3 wide = inclined(drawn("a wide crease", 130, 150)),
                narrow = inclined(drawn("a narrow crease", 55, 70));
  return {crease_of_planes("two planes", a, b, 0.5),
          {"a floor and a wall of boxes", {"boxes"}, z, x, boxes},
          {"a ball half in a plane", {"planes", "spheres"}, b, a, ball_on_plane},
          {"a capsule half in a box", {"boxes", "capsules"}, z, x, capsule_on_box},
          crease_of_planes("two planes, wide", a, wide, 0.5),
          crease_of_planes("two planes, narrow", a, narrow, 0.5)};
}

/// Two columns of cells of 3 cm, one on each side of the crease, that slide along it at 1 m/s. Its
/// weight presses it on each obstacle by that part of it.
PortableScene sheet_in_a_crease(const Crease& crease, const Vector3& pressed_along) {
  constexpr double edge = 0.03;  // m
  PortableScene scene = resting(
      "sheet in a crease of " + crease.name,
      make_sheet({.width = 2 * edge, .height = 2 * edge, .columns = 2, .rows = 2}), {.young = 1.6});
  const Vector3 along = crease.first.cross(crease.second).normalized(),
                on_first = along.cross(crease.first), on_second = crease.second.cross(along);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double across = scene.mesh.rest(0, i) - edge, out = std::abs(across);
    scene.x.col(i) = crease_point + (scene.mesh.rest(1, i) - edge) * along +
                     out * (across < 0 ? on_first : on_second);
  }
  scene.mesh.rest = scene.x;
  scene.v.colwise() = 1.0 * along;
  scene.dt = 0.002;
  scene.gravity = weight * (pressed_along[2] * along - pressed_along[0] * crease.first -
                            pressed_along[1] * crease.second);
  return scene;
}

constexpr const char* crease_columns =
    "crease of | mu of the first [1] | of the second [1] | acceleration along it [g] | by "
    "Coulomb's law [g] | deepest [m] | largest part of what is allowed [1]";

struct Grips {
  double first, second;  // mu [1]
};

/// The deceleration along the crease, from places at three times, and the depth in either obstacle.
void measure_in_crease(Trial& trial, const Crease& crease, const Grips& mu, Table& rows) {
  const Vector3 pressed(0.8, 0.45, 0.1);
  PortableScene scene = sheet_in_a_crease(crease, pressed);
  crease.add(scene, mu.first, mu.second);
  const std::vector<Snapshot> states = trial.motion(scene, {8, 36, 64});
  const Vector3 along = scene.v.col(0);
  const double time = 28 * scene.dt,
               gained = along.dot((states[2].x - 2 * states[1].x + states[0].x).rowwise().mean()) /
                        (weight * time * time),
               coulomb = pressed[2] - mu.first * pressed[0] - mu.second * pressed[1];
  double depth = 0;
  for (const Snapshot& now : states)
    for (Eigen::Index i = 0; i < now.x.cols(); ++i)
      depth = std::max(depth, -clearance(scene, now.x.col(i)));
  rows.row(crease.name, mu.first, mu.second, gained, coulomb, depth,
           std::max(std::abs(gained - coulomb) / 0.05,
                    depth / allowance(trial.declaration(), scene).depth));
}

/// Where obstacles meet at a right angle each is pressed on by its part of the weight, whatever the
/// other does: so frictions are told apart there alone.
Finding both_act_in_a_crease(Trial& trial) {
  Table rows = table_of(crease_columns);
  const double little = drawn("little friction in a crease", 0.1, 0.16),
               much = drawn("much friction in a crease", 0.5, 0.6);
  for (const Crease& crease : creases()) {
    if (!std::ranges::all_of(crease.kinds, [&](const std::string& kind) {
          return trial.declaration().offers(kind);
        }))
      continue;
    const bool is_right = std::abs(crease.first.dot(crease.second)) < 1e-9;
    for (const Grips& mu :
         is_right ? std::vector<Grips>{{little, much}, {much, little}} : std::vector<Grips>{{0, 0}})
      measure_in_crease(trial, crease, mu, rows);
  }
  if (rows.rows() == 0) throw NotOffered{"planes or boxes"};
  return judge_worst(rows, 1,
                     "the acceleration to 0.05 g, an eighth of the friction: the sheet's waves "
                     "across the crease, and the ball's curvature; a depth of 1 mm cannot be seen");
}

Finding planes_with_one_point_are_two(Trial& trial) {
  Table rows = table_of(crease_columns);
  const Vector3 one(0.48, -0.6, 0.64), two(-0.6, 0.64, 0.48);
  measure_in_crease(trial, crease_of_planes("two planes with one point", one, two, 0), {0, 0},
                    rows);
  return judge_worst(rows, 1, "as of planes that are stated by other points");
}

/// Obstacles that fit into the cell around this place: of the solver's kinds, of any size and way.
/// Planes are left out, since they reach everywhere.
void add_in_cell(PortableScene& scene, const std::vector<ObstacleKind>& kinds, int cell,
                 const Vector3& place) {
  const auto any = [&](const char* what, double least, double most) {
    return drawn(fmt::format("{} in cell {}", what, cell), least, most);
  };
  const ObstacleKind& kind = kinds[size_t(cell) % kinds.size()];
  const double friction = any("friction", 0.1, 0.7);
  if (kind.group == "box") {
    scene.boxes.push_back(
        {place, {any("x", 0.012, 0.04), any("y", 0.012, 0.04), any("z", 0.01, 0.03)}, friction});
  } else if (kind.group == "ball") {
    scene.spheres.push_back({place, any("radius", 0.015, 0.045), friction});
  } else {
    const double heading = any("heading", 0, 2 * pi), length = any("length", 0.02, 0.035);
    const Vector3 axis(std::cos(heading), std::sin(heading), any("rise", -0.5, 0.5));
    const Vector3 aside(-axis.y(), axis.x(), -axis.z());  // of an elbow, with its end at `place`
    const double radius = any("radius", 0.012, 0.02);
    scene.capsules.push_back({place - length * axis, place, radius, friction});
    scene.capsules.push_back({place, place + length * aside, radius, friction});
  }
}

/// On a floor of 4 x 4 cells of 13 cm, a second one 0.5 m below it, which the cloth does not reach.
PortableScene sheet_above_obstacles(const std::vector<ObstacleKind>& kinds) {
  constexpr double cell = 0.13;  // m
  PortableScene scene = limp_sheet(22, 0.024);
  scene.name = "sheet that falls on many obstacles";
  for (int k = 0; k < 32; ++k) {
    const Vector3 place(cell * (0.5 + k % 4), cell * (0.5 + k / 4 % 4), k < 16 ? -0.5 : 0.0);
    add_in_cell(scene, kinds, k % 16 + 16 * (k / 16), place);
  }
  scene.x.row(2).array() += 0.055;
  scene.mesh.rest = scene.x;
  scene.gravity = Vector3(0.4, -0.3, -9.7);
  scene.v.colwise() = Vector3(0.1, 0.2, -1.2);
  return scene;
}

Finding many_keep_cloth_out(Trial& trial) {
  std::vector<ObstacleKind> kinds = declared_kinds(trial, 1);
  std::erase_if(kinds, [](const ObstacleKind& kind) { return kind.group == "contact"; });
  if (kinds.empty()) throw NotOffered{"boxes, spheres or capsules"};
  const PortableScene scene = sheet_above_obstacles(kinds);
  Table measured = table_of(
      "steps [1] | deepest [m] | particles inside by a millimetre [1] | over what is allowed [1]");
  const std::vector<long> counts = multiples(3, 14);
  const std::vector<Snapshot> states = trial.motion(scene, counts);
  for (size_t k = 0; k < counts.size(); ++k) {
    double deepest = 0;
    int inside = 0;
    for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
      const double depth = -clearance(scene, states[k].x.col(i));
      deepest = std::max(deepest, depth);
      inside += depth > 1e-3;
    }
    const double speed = 1.2 + weight * double(counts[k]) * scene.dt;  // m/s
    measured.row(counts[k], deepest, inside,
                 deepest / (speed * scene.dt + allowance(trial.declaration(), scene).depth));
  }
  return judge_worst(measured, 1,
                     "a contact that is found after the step lets a particle in by what it travels "
                     "in a step; a depth of 1 mm cannot be seen");
}

/// Beyond the edge of a box, over which it slides without friction at 2 m/s.
Finding falls_beyond_the_edge(Trial& trial) {
  constexpr long steps = 60;
  Table measured = table_of("way out | fall [m] | least [m] | most [m] | over what is allowed [1]");
  for (const Vector3& out : {Vector3(1, 0, 0), Vector3(0, -1, 0)}) {
    PortableScene scene = limp_sheet(2, 0.02);
    scene.name = "sheet that slides off a box";
    const Vector3 half(0.12, 0.12, 0.05), top(0.3, -0.2, half.z());
    scene.boxes = {{top - half.z() * Vector3::UnitZ(), half, 0}};
    lay(scene, {"top", top + 0.06 * out, Vector3::UnitZ(), out}, 0);
    const double speed = 2, time = double(steps) * scene.dt;  // m/s, s
    scene.v.colwise() = speed * out;
    const Vector3 mean = (trial.after(scene, steps).x - scene.x).rowwise().mean();
    // its last particle leaves 0.02 m after its middle, the first as much before
    const double most = weight / 2 * std::pow(time - 0.04 / speed, 2),
                 least = weight / 2 * std::pow(time - 0.08 / speed, 2);
    measured.row(out.x() > 0.5 ? "along x" : "against y", -mean.z(), least, most,
                 std::max(0.9 * least / std::max(-mean.z(), 1e-9), -mean.z() / (1.1 * most)));
  }
  return judge_worst(measured, 1,
                     "from when the first and the last particle are beyond the edge; a tenth for "
                     "steps of first order and for what pulls the cloth");
}

/// Away from each rim of the top, without friction: its last row begins 2 mm inside.
Finding slides_in_from_rims(Trial& trial) {
  constexpr long steps = 40;
  Table measured = table_of("way in | way [m] | free way [m] | difference [of it]");
  for (const Vector3& in : {Vector3(1, 0, 0), Vector3(-1, 0, 0), Vector3(0, 1, 0)}) {
    PortableScene scene = limp_sheet(2, 0.02);
    scene.name = "sheet that slides in from the rim of a box";
    const Vector3 half(0.12, 0.15, 0.05), top(0.3, -0.2, half.z());
    scene.boxes = {{top - half.z() * Vector3::UnitZ(), half, 0}};
    const double reach = half.cwiseProduct(in.cwiseAbs()).norm() - 0.022;  // m
    lay(scene, {"", top - reach * in, Vector3::UnitZ(), in}, 0);
    const double speed = drawn("speed from a rim", 0.4, 0.5),
                 free = speed * double(steps) * scene.dt;  // m/s, m
    scene.v.colwise() = speed * in;
    const Vector3 way = (trial.after(scene, steps).x - scene.x).rowwise().mean();
    measured.row(fmt::format("{:g}, {:g}", in.x(), in.y()), way.dot(in), free,
                 (way - free * in).norm() / free);
  }
  return judge_worst(measured, 0.05, "the top of a box is flat up to its rim, and smooth here");
}

/// On the first side of each kind, steep enough to slide.
Finding friction_above_one(Trial& trial) {
  Slides slides;
  for (const ObstacleKind& kind : declared_kinds(trial, 1)) {
    const double mu = drawn("friction above one on a " + kind.name, 1.2, 1.5);
    const Side side = kind.sides(0)[0];
    slides.measure(trial, sheet_on(kind, side, 2.5, mu), side, mu);
  }
  return slides.judged();
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
      {"obstacles.both-act-on-what-touches-both",
       "Cloth that slides in a crease, where two obstacles meet, enters neither and has the "
       "friction of both.",
       "Coulomb; impenetrability", both_act_in_a_crease, "",
       "crease of | acceleration along it | by Coulomb's law | deepest"},
      {"obstacles.planes-with-one-point-are-two",
       "Cloth that slides in the crease of two planes that are stated by the same point enters "
       "neither.",
       "impenetrability", planes_with_one_point_are_two, "planes",
       "crease of | acceleration along it | by Coulomb's law | deepest"},
      {"obstacles.many-keep-cloth-out",
       "Of 32 obstacles of any size and direction, elbows among them, some above others, each "
       "keeps cloth out.",
       "impenetrability", many_keep_cloth_out, "", "steps | deepest"},
      {"box.what-slides-off-falls",
       "A sheet that slides over the edge of a box falls freely beyond it.", "gravity",
       falls_beyond_the_edge, "boxes", "way out | fall | least | most"},
      {"box.rim-holds-nothing-back",
       "A sheet slides freely from the rim of a smooth box towards its middle.", "inertia",
       slides_in_from_rims, "boxes", "way in | way | free way"},
      {"obstacles.friction-above-one-is-coulomb-s",
       "Cloth slides where the slope is steeper than a friction above one.", "Coulomb",
       friction_above_one, "", slides_headline},
      {"obstacles.far-ones-change-nothing", "Obstacles that touch nothing do nothing.", "locality",
       far_ones_change_nothing},
      {"obstacles.go-with-their-scene", "A scene without obstacles has none of the scene before.",
       "inertia", go_with_their_scene},
  };
}

}  // namespace foldproof
