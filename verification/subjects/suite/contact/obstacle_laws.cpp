// Planes, boxes, balls and capsules, one by one: where they are, their friction on all sides, what
// they do to a sheet that is thrown at them, or leaves them.

#include "verification/subjects/suite/contact/obstacle_scenes.h"

namespace foldproof {

namespace {

using namespace suite;

struct Grip {
  double slope, friction;  // a tangent; mu [1]
};

/// None, little friction, a slope where friction half as large again would hold, and rough ground.
std::vector<Grip> grips_on(const std::string& side) {
  const double middle = drawn("friction on " + side, 0.45, 0.65);
  return {{0.4, 0},
          {0.5, drawn("little friction on " + side, 0.12, 0.25)},
          {1.3 * middle, middle},
          {1.2, drawn("rough " + side, 1.5, 1.7)}};
}

Finding each_side_has_its_friction(Trial& trial, const ObstacleKind& kind) {
  Slides slides;
  for (const Side& side : kind.sides(0))
    for (const auto& [slope, mu] : grips_on(side.name))
      slides.measure(trial, sheet_on(kind, side, slope, mu), side, mu);
  return slides.judged();
}

/// The extremes of the sheet's distances to the obstacles [m].
struct Distances {
  double depth = 0, height = 0;
};

Distances distances(const PortableScene& scene, const PerParticle3& x) {
  Distances most;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const double out = clearance(scene, x.col(i));
    most.depth = std::max(most.depth, -out), most.height = std::max(most.height, out);
  }
  return most;
}

/// The sides, and for faces, whose corners may be round, also places 5 mm from two of their edges.
std::vector<Side> places_on(const ObstacleKind& kind, const PortableScene& sheet) {
  std::vector<Side> places = kind.sides(0);
  if (kind.group != "box") return places;
  PortableScene box = sheet;
  kind.add(box, 0, 0);
  const double reach = largest(sheet.x.colwise() - middle_of(sheet.x)) + 0.005;  // m
  for (size_t k = 0, count = places.size(); k < count; ++k) {
    Side corner = places[k];
    corner.name += ", a corner";
    const Vector3 in_plane = Vector3::Ones() - corner.normal.cwiseAbs();
    corner.down = in_plane.cwiseProduct(k % 2 ? Vector3(1, -1, 1) : Vector3(-1, 1, 1)).normalized();
    const Vector3 to_edges = (box.boxes[0].half_extents.array() - reach).matrix();
    corner.point += to_edges.cwiseProduct(std::sqrt(2.0) * corner.down);
    places.push_back(corner);
  }
  return places;
}

/// A row: the sheet starts on the surface, at the place, and is pressed on it.
void press(Trial& trial, PortableScene scene, const Side& place, Table& measured) {
  constexpr long steps = 40;
  const Allowance allowed = allowance(trial.declaration(), scene);
  lay(scene, place, 0);
  const Distances most = distances(scene, trial.after(scene, steps).x);
  measured.row(place.name, most.depth, most.height,
               std::max(most.depth / allowed.depth, most.height / allowed.height));
}

Table table_of_pressed() {
  return table_of("side | deepest [m] | highest [m] | largest part of what is allowed [1]");
}

constexpr const char* why_on_the_surface =
    "the sheet starts on the surface and is pressed on it: 80 ms, in which it could fall by 31 mm. "
    "Empirical: a depth of 1 mm cannot be seen; a tenth of an edge, 2 mm, is allowed for a "
    "thickness";

Finding is_where_it_is_for(Trial& trial, const ObstacleKind& kind, double thickness) {
  Table measured = table_of_pressed();
  PortableScene sheet = limp_sheet(2, 0.02);
  sheet.thickness = thickness;
  for (const Side& place : places_on(kind, sheet)) {
    PortableScene scene = sheet;
    scene.name = "sheet pressed on a " + kind.name + ", " + place.name;
    kind.add(scene, 0, 0.5);
    press(trial, scene, place, measured);
  }
  return judge_worst(measured, 1, why_on_the_surface);
}

Finding is_where_the_scene_says(Trial& trial, const ObstacleKind& kind) {
  return is_where_it_is_for(trial, kind, 0);
}

Finding is_there_for_thick_cloth(Trial& trial, const ObstacleKind& kind) {
  return is_where_it_is_for(trial, kind, drawn("thickness on a " + kind.name, 0.006, 0.008));
}

/// A box of these half extents, both of its faces across this axis.
void press_on_box(Trial& trial, const Vector3& half, int axis, Table& measured) {
  if (half.minCoeff() <= trial.declaration().contact_offset) return;
  for (const int sign : {1, -1}) {
    const Vector3 centre(0.3, -0.2, 0.4), out = sign * Vector3::Unit(axis);
    PortableScene scene = limp_sheet(2, 0.02);
    scene.name = "sheet pressed on a thin or large box";
    scene.boxes = {{centre, half, 0.5}};
    press(trial, scene,
          {fmt::format("{}{}, half extent {:.2g} m", sign > 0 ? '+' : '-', "xyz"[axis], half[axis]),
           centre + half[axis] * out, out, out.unitOrthogonal()},
          measured);
  }
}

/// Round bodies with the axis a to b: beside its middle, near its ends, and on the caps.
void press_on_round(Trial& trial, double length, double radius, Table& measured) {
  const Vector3 axis(0.48, -0.6, 0.64), beside = axis.unitOrthogonal(), centre(0.3, -0.2, 0.4);
  for (const auto& [name, along, out] : {std::tuple("beside the axis", 0.0, beside),
                                         {"near an end", 0.48, Vector3(-beside)},
                                         {"cap b", 0.5, Vector3(0.8 * axis + 0.6 * beside)},
                                         {"cap a", -0.5, Vector3(-axis)}}) {
    if (length == 0 && along == 0.48) continue;
    PortableScene scene = limp_sheet(2, 0.02);
    scene.name = "sheet pressed on a round body";
    if (length > 0)
      scene.capsules = {{centre - length / 2 * axis, centre + length / 2 * axis, radius, 0.5}};
    else
      scene.spheres = {{centre, radius, 0.5}};
    press(trial, scene,
          {fmt::format("radius {:.2g} m, length {:.2g} m, {}", radius, length, name),
           centre + along * length * axis + radius * out, out, out.unitOrthogonal()},
          measured);
  }
}

/// Thin and large ones, slender and stout ones.
Finding has_any_size(Trial& trial, const ObstacleKind& kind) {
  Table measured = table_of_pressed();
  if (kind.group == "box") {
    press_on_box(trial, {0.3, 0.25, drawn("a very thin box", 0.002, 0.003)}, 2, measured);
    press_on_box(trial, {drawn("a thin box", 0.006, 0.009), 0.4, 0.2}, 0, measured);
    press_on_box(trial, {0.2, 0.015, 0.3}, 1, measured);
    press_on_box(trial, {25, 0.05, drawn("a large box", 8, 20)}, 2, measured);
  } else {
    const bool is_long = kind.group == "capsule";
    for (const double radius : {drawn("a small " + kind.name, 0.06, 0.09), 0.3, 25.0})
      for (const double length : is_long ? std::vector<double>{0.05, 1.3, 12} : std::vector{0.0})
        press_on_round(trial, length, radius, measured);
  }
  return judge_worst(measured, 1, why_on_the_surface);
}

/// Thrown at the side so that it meets it in the first step and a half.
PortableScene thrown_at(const ObstacleKind& kind, const Side& side, double speed, double slide) {
  PortableScene scene = sheet_on(kind, side, 0, drawn("friction of throws", 0.3, 0.5));
  scene.name = "sheet thrown at a " + kind.name + ", " + side.name;
  scene.gravity.setZero();
  scene.x.colwise() += 0.5 * speed * scene.dt * side.normal;
  scene.v.colwise() = slide * side.down - speed * side.normal;
  return scene;
}

/// Of the speed into an obstacle, that may come back [1]. A two-step scheme whose contacts stop the
/// speed of one step extrapolates from it and the one before: 1/3 + 1/9 + ..., a half, comes back.
double allowed_rebound(const Declaration& declared) {
  return declared.offers("history") ? 0.6 : 0.1;
}

double friction_of(const PortableScene& scene) {
  for (const PortablePlane& plane : scene.planes) return plane.friction;
  for (const PortableBox& box : scene.boxes) return box.friction;
  for (const PortableSphere& ball : scene.spheres) return ball.friction;
  return scene.capsules.at(0).friction;
}

Vector3 mean_way(const Snapshot& from, const Snapshot& to) {
  return (to.x - from.x).rowwise().mean();
}

Finding stops_without_rebound(Trial& trial, const ObstacleKind& kind) {
  Table measured = table_of(
      "side | speed [m/s] | deepest [way of a step] | depth five steps later [m] | "
      "rebound [of the speed] | largest part of what is allowed [1]");
  for (const Side& side : kind.sides(0))
    for (const double speed : {0.3, 4.0, 30.0}) {
      const PortableScene scene = thrown_at(kind, side, speed, 0);
      const double step = speed * scene.dt;
      const std::vector<Snapshot> states = trial.motion(scene, {1, 2, 3, 7, 17});
      double deepest = 0;
      for (const Snapshot& now : states) deepest = std::max(deepest, distances(scene, now.x).depth);
      const double left = distances(scene, states[3].x).depth,
                   back = mean_way(states[3], states[4]).dot(side.normal) / (10 * step);
      measured.row(side.name, speed, deepest / step, left, back,
                   std::max({deepest / step, left / allowance(trial.declaration(), scene).depth,
                             back / allowed_rebound(trial.declaration())}));
    }
  return judge_worst(
      measured, 1,
      "a contact that is found after the step lets a particle in by what it travels "
      "in a step; five steps later a depth of 1 mm is allowed; obstacles stop the "
      "cloth, a tenth of the speed is allowed for its own waves; 0.6 where `history` "
      "is declared: a scheme of two steps gives half of it back");
}

Finding takes_coulomb_s_impulse(Trial& trial, const ObstacleKind& kind) {
  Table measured = table_of(
      "side | speed along it [m/s] | lost of it [m/s] | by Coulomb's law [m/s] | "
      "difference [of Coulomb's]");
  for (const Side& side : kind.sides(0))
    for (const double slide : {0.9, 4.0}) {
      const double speed = 1;  // m/s, inward
      const PortableScene scene = thrown_at(kind, side, speed, slide);
      const std::vector<Snapshot> states = trial.motion(scene, {5, 15});
      const double lost = slide - mean_way(states[0], states[1]).dot(side.down) / (10 * scene.dt),
                   expected = friction_of(scene) * speed;
      measured.row(side.name, slide, lost, expected, std::abs(lost - expected) / expected);
    }
  return judge_worst(
      measured, 0.05 + allowed_rebound(trial.declaration()),
      "the impulse that stops it has mu times as much friction, at any speed; the "
      "side turns by up to 5 % of the slide, and lets go of what flies past it; what comes "
      "back has its own impulse");
}

Finding lets_go(Trial& trial, const ObstacleKind& kind) {
  constexpr long steps = 20;
  Table measured = table_of("side | way [m] | free way [m] | difference [of the free way]");
  for (const Side& side : kind.sides(0)) {
    PortableScene scene = sheet_on(kind, side, 0, 0.8);
    scene.name = "sheet that leaves a " + kind.name + ", " + side.name;
    scene.gravity.setZero();
    scene.v.colwise() = drawn("speed that leaves", 0.15, 0.25) * (side.normal + 0.5 * side.down);
    const Vector3 way = (trial.after(scene, steps).x - scene.x).rowwise().mean(),
                  free = double(steps) * scene.dt * scene.v.col(0);
    measured.row(side.name, way.norm(), free.norm(), (way - free).norm() / free.norm());
  }
  return judge_worst(measured, 0.05,
                     "nothing holds cloth that leaves an obstacle; the step in which it lies on it "
                     "may count as contact, one of 20");
}

Finding large_sheet_slides(Trial& trial, const ObstacleKind& kind) {
  Slides slides;
  const Side side = kind.sides(0)[0];
  const double little = drawn("friction of the large sheet", 0.2, 0.35);
  for (const auto& [slope, mu] : {Grip{0.6, little}, {0.5, 0.8}}) {
    PortableScene scene = limp_sheet(30, 0.012);
    scene.name = "sheet of 961 particles on a " + kind.name;
    kind.add(scene, 0, mu);
    lay(scene, side, slope);
    slides.measure(trial, scene, side, mu);
  }
  return slides.judged();
}

Finding stuck_sheet_does_not_creep(Trial& trial, const ObstacleKind& kind) {
  Table measured = table_of("side | slope over mu [1] | time [s] | creep [um/s]");
  const Side side = kind.sides(0)[0];
  const double mu = drawn("friction that holds", 0.5, 0.7);
  for (const double part : {0.5, 0.9}) {
    PortableScene scene = sheet_on(kind, side, part * mu, mu);
    scene.name = "sheet that sticks to a " + kind.name;
    scene.material.young /= 20, scene.dt = 0.005;
    const long count = kind.group == "contact" && part > 0.5 ? 2000 : 300;
    const std::vector<Snapshot> states = trial.motion(scene, {count / 2, count});
    const double time = double(count) * scene.dt;
    measured.row(side.name, part, time, 2e6 * mean_way(states[0], states[1]).norm() / time);
  }
  return judge_worst(measured, 100,
                     "empirical: a millimetre in ten seconds cannot be seen; from half of the time "
                     "on, so that a late start is no creep");
}

Finding holds_beside_held(Trial& trial, const ObstacleKind& kind) {
  Table measured = table_of("side | largest displacement [mm]");
  const Side side = kind.sides(0)[0];
  const double mu = drawn("friction beside held particles", 0.5, 0.7);
  PortableScene scene = sheet_on(kind, side, 0.9 * mu, mu);
  scene.name = "sheet with a held corner on a " + kind.name;
  scene.material.young /= 20;
  scene.held = {0, int(scene.x.cols()) - 1};
  measured.row(side.name, 1e3 * largest(trial.after(scene, 100).x - scene.x));
  return judge_worst(measured, 0.5,
                     "what sticks stays, beside held particles, too: without friction they would "
                     "go centimetres; a step before contact begins is 0.04 mm");
}

Finding each_of_several_counts(Trial& trial, const ObstacleKind& kind) {
  Slides slides;
  const int count = kind.group == "contact" ? 3 : 6;
  for (const int which : {0, count / 2, count - 1}) {
    PortableScene scene = limp_sheet(2, 0.03);
    scene.name = fmt::format("sheet on {} {} of {}", kind.name, which + 1, count);
    const auto friction = [](int k) {
      return drawn(fmt::format("friction {} of several", k), 0.1, 0.13) + 0.13 * k;
    };
    for (int k = 0; k < count; ++k) kind.add(scene, k, friction(k));
    Side side = kind.sides(which)[0];
    lay(scene, side, 0.9);
    side.name = fmt::format("{} {} of {}", kind.name, which + 1, count);
    slides.measure(trial, scene, side, friction(which));
  }
  return slides.judged();
}

void add_laws(std::vector<Law>& all, const ObstacleKind& kind) {
  const auto add = [&](const char* name, const std::string& claim, const char* source,
                       Finding (*run)(Trial&, const ObstacleKind&), const char* headline,
                       const char* needs = "") {
    all.push_back({kind.group + "." + name, claim, source,
                   [kind, run](Trial& trial) { return run(trial, kind); }, kind.capability + needs,
                   headline});
  };
  const std::string a = "a " + kind.name;
  add("surface-is-where-the-scene-says",
      "A sheet that is pressed on " + a + ", on each of its sides, stays on its surface.",
      "impenetrability", is_where_the_scene_says, "side | deepest | highest", " still");
  if (kind.group != "contact")
    add("surface-is-there-for-thick-cloth",
        "The thickness of cloth against itself leaves the surface of " + a + " where it is.",
        "PROTOCOL.md", is_there_for_thick_cloth, "side | deepest | highest",
        " self_collision still");
  if (kind.group != "contact")
    add("of-any-size-is-where-the-scene-says",
        "A sheet that is pressed on a thin, slender, stout or large " + kind.name +
            " stays on its surface.",
        "impenetrability", has_any_size, "side | deepest | highest", " still");
  add("each-side-has-its-friction",
      "On each side of " + a + " a sheet sticks, or slides, as Coulomb's law says.", "Coulomb",
      each_side_has_its_friction, slides_headline);
  add("stops-without-rebound",
      "A sheet that is thrown at " + a + ", slowly or fast, is stopped there.", "impenetrability",
      stops_without_rebound, "side | speed | deepest | rebound");
  add("impact-has-coulomb-s-friction",
      "A sheet that hits " + a + " aslant loses mu times its speed into it, at any speed along it.",
      "Coulomb", takes_coulomb_s_impulse, "side | lost of it | by Coulomb's law");
  add("lets-go", "A sheet leaves " + a + " freely.", "inertia", lets_go, "side | way | free way");
  add("stuck-sheet-does-not-creep", "A sheet that sticks to " + a + " stays where it is.",
      "Coulomb", stuck_sheet_does_not_creep, "slope over mu | creep", " still");
  add("friction-holds-beside-held-particles",
      "A sheet with held corners sticks to " + a + " all over.", "Coulomb", holds_beside_held,
      "side | largest displacement", " held still");
  add("large-sheet-slides-as-coulomb-says",
      "A sheet of 961 particles sticks to " + a + ", or slides, as Coulomb's law says.", "Coulomb",
      large_sheet_slides, slides_headline);
  add("each-of-several-has-its-friction",
      "Of several obstacles, each " + kind.name + " has its own place and friction.", "Coulomb",
      each_of_several_counts, slides_headline);
}

}  // namespace

std::vector<Law> obstacle_laws() {
  std::vector<Law> all;
  for (const ObstacleKind& kind : obstacle_kinds()) add_laws(all, kind);
  return all;
}

}  // namespace foldproof
