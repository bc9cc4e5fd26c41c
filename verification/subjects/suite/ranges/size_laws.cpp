// The number of particles, and of edges at one: a sheet moves as it does in a scene with many
// others, far apart, and the hub of a fan alike from each way between two spokes.

#include "verification/subjects/suite/contact/obstacle_scenes.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr long steps = 4;
constexpr int aside = 5;  // copies along each side of a floor of them

PortableScene moving_sheet_that_is_held() {
  PortableScene scene = moving_sheet();
  scene.gravity = Vector3(1.2, -0.7, -9.4);
  scene.held = {3, 0, 24};
  for (const int i : scene.held) scene.v.col(i).setZero();
  return scene;
}

PortableScene moving_sheet_that_bends() {
  PortableScene scene = moving_sheet();
  scene.material.bending_rigidity = drawn("rigidity in many sheets", 0.002, 0.005);
  return scene;
}

PortableScene moving_sheet_with_rest_angles() {
  PortableScene scene = moving_sheet_that_bends();
  scene.name = "moving sheet with rest angles";
  for (size_t k = 0; k < scene.mesh.hinges.size(); ++k)
    scene.rest_angles.push_back(0.6 * std::sin(1.7 * double(k) + 0.2));
  return scene;
}

/// From its first place to that of copy k [m].
Vector3 place_of(int k) {
  return {0.8 * (k % aside), 0.75 * (k / aside % aside), 0.3 * (k / (aside * aside))};
}

PortableScene copies_of(const PortableScene& one, int count) {
  std::vector<PortableScene> copies;
  for (int k = 0; k < count; ++k) copies.push_back(shifted(one, place_of(k)));
  return together(fmt::format("{} {}s", count, one.name), copies);
}

Finding many_move_as_one(Trial& trial, const PortableScene& one) {
  const Eigen::Index particles = one.x.cols();
  const PerParticle3 alone = trial.after(one, steps).x;
  Table measured = table_of(
      "sheets [1] | particles [1] | largest difference from one sheet [m] | over rounding [1]");
  for (const double thousands : {drawn("fewer particles", 0.9, 1.1), drawn("more", 3, 3.4)}) {
    const int count = int(std::lround(1000 * thousands / double(particles)));
    const PortableScene all = copies_of(one, count);
    const PerParticle3 x = trial.after(all, steps).x;
    double most = 0;
    for (int k = 0; k < count; ++k)
      update_worst(
          most, largest((x.middleCols(k * particles, particles) - alone).colwise() - place_of(k)));
    const double rounding = largest(all.x) * rounding_error(all, steps, trial.declaration());
    measured.row(count, all.x.cols(), most,
                 most / (2 * largest(alone - one.x) *
                         narrow(rounding / largest(alone - one.x), trial.declaration())));
  }
  return judge_worst(measured, 1, "sheets that do not touch; both runs round differently");
}

double energy_of(Trial& trial, const PortableScene& scene) {
  trial.prepare(scene);
  return trial.solver().energy({scene.x, scene.v}, 0);
}

/// Without gravity, so that it does not matter where the copies are.
Finding energies_add_up(Trial& trial) {
  const PortableScene one = moving_sheet();
  const double alone = energy_of(trial, one);
  Table measured = table_of("sheets [1] | energy [J] | of one [J] | difference [roundings]");
  for (const int count : {7, int(std::lround(drawn("sheets with energy", 35, 45)))}) {
    const double all = energy_of(trial, copies_of(one, count));
    const double size = largest(place_of(count)) / 0.1;  // places over lengths of edges
    measured.row(count, all, alone,
                 std::abs(all / count - alone) / alone / (size * trial.declaration().rounding()));
  }
  return judge_worst(measured, 64, "strains of some percent lose two digits of an edge's length");
}

/// One alone, and hundreds beside each other, on a plane or a box with friction.
Finding many_slide_as_one(Trial& trial) {
  const bool has_planes = trial.declaration().offers("planes");
  if (!has_planes && !trial.declaration().offers("boxes")) throw NotOffered{"planes or boxes"};
  PortableScene one = limp_sheet(2, 0.03);
  one.name = "sheet that slides";
  const double friction = drawn("friction under many", 0.25, 0.35);
  const Vector3 point(0.2, -0.3, 0.4), normal = Vector3::UnitZ(), down = Vector3::UnitX();
  if (has_planes)
    one.planes = {{point, normal, friction}};
  else
    one.boxes = {{point - 0.2 * normal, {4, 4, 0.2}, friction}};
  lay(one, {"", point, normal, down}, 0.9);
  one.v.colwise() = Vector3(0.1, 0.2, 0);
  constexpr long count = 20;
  const PerParticle3 alone = trial.after(one, count).x;
  const Eigen::Index particles = one.x.cols();
  Table measured = table_of(
      "sheets [1] | particles [1] | way [m] | largest difference from one sheet [of the way]");
  for (const int row : {9, int(std::lround(drawn("sheets in a row", 18, 20)))}) {
    std::vector<PortableScene> sheets;
    for (int k = 0; k < row * row; ++k)
      sheets.push_back(shifted(one, {0.1 * (k % row), 0.1 * (k / row), 0}));
    const PortableScene all = together(fmt::format("{} {}s", row * row, one.name), sheets);
    const PerParticle3 moved = trial.after(all, count).x - all.x;
    double most = 0;
    for (int k = 0; k < row * row; ++k)
      update_worst(most, largest(moved.middleCols(k * particles, particles) - (alone - one.x)));
    const double way = largest(alone - one.x);
    measured.row(row * row, all.x.cols(), way, most / way);
  }
  return judge_worst(measured, 0.03, "sheets that do not touch, each on the same ground");
}

/// A fan of so many triangles about particle 0, which starts a tenth off its place.
PortableScene fan(int spokes, double heading) {
  constexpr double radius = 0.1, omega = 12;  // m, 1/s
  PerParticle3 rest = PerParticle3::Zero(3, spokes + 1);
  std::vector<Triangle> triangles;
  for (int k = 0; k < spokes; ++k) {
    const double angle = 2 * pi * k / spokes;
    rest.col(k + 1) = radius * Vector3(std::cos(angle), std::sin(angle), 0);
    triangles.push_back({0, k + 1, (k + 1) % spokes + 1});
  }
  PortableScene scene = resting("fan", make_triangle_mesh(rest, triangles), {.young = 1});
  scene.material.young = omega * omega * scene.mass[0] / (pi * std::sin(2 * pi / spokes));
  scene.x.col(0) = 0.1 * radius * Vector3(std::cos(heading), std::sin(heading), 0);
  scene.dt = 0.002;
  return scene;
}

/// Half a spoke's angle aside from each of them: all are alike, by symmetry.
Finding hub_moves_alike(Trial& trial) {
  constexpr long count = 12;
  Table measured = table_of(
      "edges of the hub [1] | least way of the hub [m] | largest [m] | difference [of the largest] "
      "| momentum [of the hub's] | over what is allowed [1]");
  for (const double spokes : {9., std::round(drawn("spokes of a fan", 11, 15)), 24.}) {
    double least = std::numeric_limits<double>::infinity(), most = 0, momentum = 0;
    for (int k = 0; k < int(spokes); ++k) {
      const PortableScene scene = fan(int(spokes), 2 * pi * (k + 0.5) / spokes);
      const PerParticle3 moved = trial.after(scene, count).x - scene.x;
      const double way = -moved.col(0).dot(scene.x.col(0).normalized());
      least = std::min(least, way), most = std::max(most, way);
      const Vector3 sum = moved * scene.mass.matrix();
      update_worst(momentum, sum.norm() / (scene.mass[0] * Vector3(moved.col(0)).norm()));
    }
    const double difference = (most - least) / most;
    measured.row(spokes, least, most, difference, momentum,
                 std::max(difference / 0.03, momentum / 0.03));
  }
  return judge_worst(measured, 1,
                     "the symmetry of a fan; sweeps over edges have an order, and forces of "
                     "constraints that do not converge differ by some per cent");
}

}  // namespace

std::vector<Law> size_laws() {
  const std::string among =
      " moves as it does among many others in one scene: work and accuracy "
      "for a sheet do not depend on the number of particles.";
  return {
      {"size.sheet-moves-alike-among-many", "A sheet" + among, "locality of forces",
       in_scene(many_move_as_one, moving_sheet), "",
       "particles | largest difference from one sheet"},
      {"size.bent-sheet-moves-alike-among-many", "A sheet that resists bending" + among,
       "locality of forces", in_scene(many_move_as_one, moving_sheet_that_bends), "bending",
       "particles | largest difference from one sheet"},
      {"size.damped-sheet-moves-alike-among-many", "A sheet with damped edges" + among,
       "locality of forces", in_scene(many_move_as_one, damped_moving_sheet), "damping",
       "particles | largest difference from one sheet"},
      {"size.held-sheet-moves-alike-among-many", "A sheet that is held" + among,
       "locality of forces", in_scene(many_move_as_one, moving_sheet_that_is_held), "held",
       "particles | largest difference from one sheet"},
      {"size.sheet-with-rest-angles-moves-alike-among-many",
       "A sheet that is curved at rest" + among, "locality of forces",
       in_scene(many_move_as_one, moving_sheet_with_rest_angles), "bending",
       "particles | largest difference from one sheet"},
      {"size.sheet-slides-alike-among-many",
       "A sheet slides on an obstacle as it does among many others.", "locality of contact",
       many_slide_as_one, "touches", "particles | way | largest difference from one sheet"},
      {"size.hub-of-many-edges-moves-alike-to-each",
       "The hub of a fan, however many its edges, is pulled back alike from each way between two "
       "of them, and the fan keeps its momentum.",
       "symmetry; Newton's third law", hub_moves_alike, "",
       "edges of the hub | least way of the hub | largest | momentum"},
      {"size.energies-of-many-add-up",
       "The energy of many sheets is that of one, times their number.", "locality of forces",
       energies_add_up, "L2 set_state", "sheets | energy | of one"},
  };
}

}  // namespace foldproof
