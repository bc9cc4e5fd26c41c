// Cloth that a case file shapes, copies or folds, and the keys for its self-collision.
#include "reference/mesh/shapes.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/trial_cases.h"

namespace foldproof {

namespace {

Scene cloth_case(const std::string& keys, const std::string& tables = "") {
  return read_scene_text("[cloth]\ndensity = 0.23\n" + keys + tables + short_time, "trial.toml");
}

/// The sheet of the trial cases with more keys of [cloth], and tables.
Scene sheet_case(const std::string& keys, const std::string& tables = "") {
  return read_scene_text(small_sheet + keys + tables + short_time, "trial.toml");
}

bool has_part(const Scene& scene, const std::string& words) {
  const std::vector<std::string> parts = describe_parts(scene, build_system(scene));
  return std::ranges::any_of(
      parts, [&](const auto& part) { return part.find(words) != std::string::npos; });
}

// ---- shapes

void see_shape(Differences& differences, const std::string& name, const Scene& scene, int particles,
               int triangles) {
  differences.is(name + ", particles", scene.mesh.particles() == particles);
  differences.is(name + ", triangles", int(scene.mesh.triangles.size()) == triangles);
}

/// Largest deviation of a particle's distance from the origin from r, in the directions that `axes`
/// keeps [m].
double off_radius(const Scene& scene, const Vector3& axes, double r) {
  const PerParticle3 x = axes.asDiagonal() * scene.x;
  return (x.colwise().norm().array() - r).abs().maxCoeff();
}

Finding shapes_finding() {
  Differences differences;
  const Scene disc = cloth_case("shape = \"disc\"\nradius = 0.31\nrings = 5\n"),
              cylinder = cloth_case(
                  "shape = \"cylinder\"\nradius = 0.17\nheight = 0.41\naround = 9\nalong = 4\n"),
              ball = cloth_case("shape = \"sphere\"\nradius = 0.23\nsubdivisions = 2\n"),
              statue = cloth_case("shape = \"statue\"\nheight = 0.37\nsubdivisions = 3\n"),
              geodesic = cloth_case("shape = \"sphere\"\nradius = 0.19\ndivisions = 3\n"),
              even_statue = cloth_case("shape = \"statue\"\nheight = 0.37\ndivisions = 15\n"),
              hinge = cloth_case("shape = \"hinge\"\nlength = 0.07\nangle = 130\n");
  // of n rings: 1 + 6 (1 + ... + n) particles, 6 n^2 triangles; of s subdivisions: 10
  // 4^s + 2 and 20 4^s
  see_shape(differences, "disc", disc, 1 + 6 * 15, 6 * 25);
  differences.is_near("disc's rim", disc.x.colwise().norm().maxCoeff() - 0.31, 0.31);
  see_shape(differences, "cylinder", cylinder, 9 * 5, 2 * 9 * 4);
  const Vector3 extent = cylinder.x.rowwise().maxCoeff() - cylinder.x.rowwise().minCoeff();
  const int axis = std::abs(extent[1] - 0.41) < 1e-9 ? 1 : 2;
  Vector3 across = Vector3::Ones();
  across[axis] = 0;
  differences.is_near("cylinder's radius", off_radius(cylinder, across, 0.17), 0.17);
  differences.is_near("cylinder's height", extent[axis] - 0.41, 0.41);
  see_shape(differences, "sphere", ball, 162, 320);
  differences.is_near("sphere's radius", off_radius(ball, Vector3::Ones(), 0.23), 0.23);
  see_shape(differences, "sphere of divisions", geodesic, 92, 180);  // of d: 10 d^2 + 2 and 20 d^2
  differences.is_near("its radius", off_radius(geodesic, Vector3::Ones(), 0.19), 0.19);
  see_shape(differences, "statue of divisions", even_statue, 2252, 4500);
  differences.is_near("its height", even_statue.x.row(1).maxCoeff() - 0.37, 0.37);
  see_shape(differences, "statue", statue, 642, 1280);
  const PerParticle3 expected = make_statue(0.37, 3).rest;
  differences.is_near("statue", largest_difference(statue.x, expected), 0.37);
  see_shape(differences, "hinge", hinge, 4, 2);
  const auto angles = read_scene_text(
                          "[cloth]\ndensity = 0.2\nshape = \"hinge\"\nlength = 0.07\nangle = 130\n"
                          "[bending]\nstiffness = 1e-4\n" +
                              short_time,
                          "trial.toml")
                          .rest_angles;
  differences.is_near("hinge's angle in degrees", std::abs(angles.at(0)) - 130 * pi / 180, pi);
  return differences.judged(64, "coordinates of a few dozen roundings each");
}

Finding patterns_finding() {
  Differences differences;
  const auto of = [](const std::string& pattern, const std::string& more = "") {
    return cloth_case(
        "shape = \"sheet\"\nwidth = 0.6\nheight = 0.4\ncolumns = 6\nrows = 4\npattern = \"" +
        pattern + "\"\n" + more);
  };
  const auto area = [](const Scene& scene) {
    return triangle_areas(scene.mesh.triangles, scene.mesh.rest).sum();
  };
  see_shape(differences, "one_diagonal", of("one_diagonal"), 35, 48);
  see_shape(differences, "alternating", of("alternating"), 35, 48);
  see_shape(differences, "union_jack", of("union_jack"), 35, 48);
  see_shape(differences, "criss_cross", of("criss_cross"), 35 + 24, 96);
  // of rows of 6 whole cells and of 7 with a half one at each end: 7 + 8 + 7 + 8 + 7 particles, 13
  // triangles a row
  see_shape(differences, "equilateral", of("equilateral"), 37, 52);
  see_shape(differences, "jittered", of("jittered", "jitter = 0.2\nseed = 3\n"), 37, 52);
  for (const std::string pattern : {"one_diagonal", "alternating", "union_jack", "criss_cross",
                                    "jittered", "random_delaunay", "equilateral"})
    differences.is_near(pattern + ", area", area(of(pattern)) - 0.24, 0.24);
  differences.is("a seed fixes what is random",
                 of("random_delaunay", "seed = 3\n").x == of("random_delaunay", "seed = 3\n").x);
  differences.is(
      "another seed gives another mesh",
      of("jittered", "jitter = 0.2\nseed = 3\n").x != of("jittered", "jitter = 0.2\nseed = 4\n").x);
  const Scene graded = of("one_diagonal", "grading = 1.3\n");
  differences.is(
      "grading leaves the number of triangles and makes cells unequal",
      graded.mesh.triangles.size() == 48 && !graded.x.isApprox(of("one_diagonal").x, 1e-3));
  return differences.judged(
      64, "numbers by counting; an area adds the products of some hundred coordinates");
}

// ---- copies and pleats

Finding copies_finding() {
  const PerParticle3 one = plain_positions();
  const Scene scene = sheet_case(
      "[cloth.copies]\ncount = 3\nmove = [0.1, -0.2, 0.5]\n"
      "turn = { axis = [0, 0, 1], angle = 90 }\n");
  const Eigen::Index n = one.cols();
  const Vector3 middle = one.rowwise().mean(), move(0.1, -0.2, 0.5);
  Differences differences;
  differences.is("particles", scene.x.cols() == 3 * n);
  differences.is("triangles", scene.mesh.triangles.size() == 3 * size_t(2 * 4 * 3));
  differences.is("springs couple no two pieces",
                 std::ranges::all_of(scene.mesh.edges,
                                     [&](const Edge& edge) { return edge.a / n == edge.b / n; }));
  PerParticle3 arm = one.colwise() - middle;
  for (int c = 0; c < 3; ++c) {
    const PerParticle3 expected = arm.colwise() + Vector3(middle + c * move);
    differences.is_near("piece " + std::to_string(c),
                        largest_difference(scene.x.middleCols(c * n, n), expected));
    differences.is_near("rest shape of piece " + std::to_string(c),
                        largest_difference(scene.mesh.rest.middleCols(c * n, n), expected));
    const PerParticle3 turned = arm;  // by a quarter about z, by hand
    arm.row(0) = -turned.row(1);
    arm.row(1) = turned.row(0);
  }
  const Scene pleated_positions = sheet_case("[cloth.pleats]\ncolumns = 2\nangle = 40\n"),
              folded_case =
                  sheet_case("[cloth.pleats]\ncolumns = 2\nangle = 40\nstart_flat = false\n");
  differences.is_near("pleats start flat", largest_difference(pleated_positions.x, one));
  differences.is("and are folded at rest",
                 pleated_positions.mesh.rest.row(2).cwiseAbs().maxCoeff() > 0.05);
  differences.is_near("or start as they rest",
                      largest_difference(folded_case.x, folded_case.mesh.rest));
  differences.is_near("the same rest shape",
                      largest_difference(folded_case.mesh.rest, pleated_positions.mesh.rest));
  return differences.judged(32, "turned and moved twice with a few roundings of lengths below 2 m");
}

Finding shapes_rejected_finding() {
  const auto rejected = [](const std::string& text, const std::string& words) {
    const std::string message =
        rejection_message([&] { read_scene_text(text + short_time, "trial.toml"); });
    return message.starts_with("trial.toml:") && count_missing(message, {words}) == 0;
  };
  const std::string cloth = "[cloth]\ndensity = 0.2\n";
  Differences differences;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {cloth, "either 'shape' or 'mesh'"},
      {cloth + "shape = \"sphere\"\nmesh = \"a.obj\"\n", "either 'shape' or 'mesh'"},
      {cloth + "mesh = \"\"\n", "--set cloth.mesh=FILE.obj"},
      {cloth + "mesh = \"nowhere.obj\"\n", "no mesh file"},
      {cloth + "shape = \"moebius\"\n", "unknown shape 'moebius'"},
      {cloth +
           "shape = \"sheet\"\nwidth = 1\nheight = 1\ncolumns = 2\nrows = 2\npattern = \"plaid\"\n",
       "unknown pattern 'plaid'; known: one_diagonal"},
      {cloth + "shape = \"disc\"\nradius = 1\nrings = 0\n", "'rings' must lie in 1 .. 1,000,000"},
      {cloth + "shape = \"sphere\"\nradius = 1\nsubdivisions = 40\n", "subdivisions"},
      {cloth + "shape = \"sphere\"\nradius = 1\nsubdivisions = 2\ndivisions = 4\n", "not both"},
      {cloth + "shape = \"statue\"\nheight = 1\ndivisions = 14\n", "give 15 to 256"},
      {small_sheet + "seed = 4294967297\n", "'seed' must lie in 0 .. 4294967295"},
      {small_sheet + "fit = 0\n", "'fit' must be > 0"},
      {small_sheet + "fit = 2\n[cloth.pleats]\ncolumns = 2\nangle = 40\n",
       "'fit' does not go with pleats"},
      {small_sheet + "[cloth.copies]\ncount = 1000000\nmove = [0, 0, 1]\n", "count"}};
  for (const auto& [text, words] : cases) differences.is(words, rejected(text, words));
  return differences.judged(0, "each must be refused with file, line and what is known");
}

// ---- a start that is folded

constexpr double gap = 0.03;  // m

std::string folded_case(int layers, const std::string& more = "") {
  return "[start.folded]\nlayers = " + std::to_string(layers) + "\ngap = 0.03\nup = [0, 0, 1]\n" +
         more;
}

/// Point at arc length s [m] of a strip of length `length` in three layers, along and up [m]: each
/// stretch separately.
Eigen::Vector2d in_three_layers(double s, double length) {
  const double turn = pi * gap / 2, run = (length - 2 * turn) / 3, r = gap / 2;
  const auto on_circle = [&](double into) {
    return Eigen::Vector2d(r * std::sin(into / r), r - r * std::cos(into / r));
  };
  if (s <= run) return {s, 0};
  if (s <= run + turn) return Eigen::Vector2d(run, 0) + on_circle(s - run);
  if (s <= 2 * run + turn) return {2 * run + turn - s, gap};
  if (s <= 2 * run + 2 * turn) {
    const Eigen::Vector2d c = on_circle(s - 2 * run - turn);
    return {-c[0], gap + c[1]};
  }
  return {s - 2 * run - 2 * turn, 2 * gap};
}

Finding folded_finding() {
  const PerParticle3 flat =
      cloth_case("shape = \"sheet\"\nwidth = 0.6\nheight = 0.1\ncolumns = 31\nrows = 2\n").x;
  const auto start = [](const std::string& tables) {
    return cloth_case("shape = \"sheet\"\nwidth = 0.6\nheight = 0.1\ncolumns = 31\nrows = 2\n",
                      tables)
        .x;
  };
  const PerParticle3 x = start(folded_case(3));
  Worst miss;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Eigen::Vector2d place = in_three_layers(flat(0, i) - flat.row(0).minCoeff(), 0.6);
    miss.observe(
        (x.col(i) - Vector3(flat.row(0).minCoeff() + place[0], flat(1, i), place[1])).norm());
  }
  const PerParticle3 dipped = start(folded_case(3, "dip = 0.007\n")) - x;
  Eigen::Index deepest = 0;
  const double dip = dipped.row(2).minCoeff(&deepest);
  Differences differences;
  differences.is_near("three layers", miss.value(), 0.6);
  differences.is_near("a dip of the last corner", dip + 0.007, 0.6);
  differences.is("of the last run alone",
                 x(2, deepest) > 1.9 * gap && dipped.row(2).maxCoeff() <= 1e-15);
  const PerParticle3 stretched = start("[start]\nstretch = [1.1, 0.9, 1]\n");
  const Vector3 center = flat.rowwise().mean(), factors(1.1, 0.9, 1);
  const PerParticle3 expected =
      (factors.asDiagonal() * (flat.colwise() - center)).colwise() + center;
  differences.is_near("stretched by a factor for each direction",
                      largest_difference(stretched, expected));
  return differences.judged(
      64, "an arc length of some ten roundings, its sine and cosine, of lengths below 1 m");
}

Finding folded_rejected_finding() {
  return rejected_cases(
      {{folded_case(1), {"layers", "2 .. 1000"}},
       {folded_case(1001), {"layers", "2 .. 1000"}},
       {"[start.folded]\nlayers = 3\ngap = 0\n", {"gap"}},
       {folded_case(3, "along = [0, 0, 1]\n"), {"'up' must be square to 'along'"}},
       {folded_case(3, "along = [0, 0, 0]\n"), {"and both be directions"}},
       {"[start.folded]\nlayers = 3\ngap = 0.03\n", {"must lie flat, square to 'up'"}},
       {folded_case(40), {"too short for so many layers"}},
       {"[start]\nstretch = [1, 0, 1]\n", {"'stretch' must be > 0"}},
       {"[start]\nstretch = -1\n", {"stretch"}}});
}

// ---- self-collision

const std::string crossed =
    "[cloth.copies]\ncount = 2\nmove = [0.01, 0, 0.02]\nturn = { axis = [1, 0, 0], angle = 80 }\n";

Finding self_collision_finding() {
  const std::string table = "[self_collision]\nthickness = 0.002\n";
  const SelfCollisionSettings
      usual = *trial_scene(table).self_collision,
      all = *trial_scene(table + "stiffness = 170\nfriction = 0.3\nrounds = 7\nuntangle = false\n")
                 .self_collision;
  const Scene tangled = sheet_case(crossed, table),
              balls = trial_scene(
                  "[[object]]\nshape = \"sphere\"\nradius = 0.1\nmove = [0, 0, 3]\n" + table);
  Differences differences;
  differences.is("thickness", usual.thickness == 0.002);
  differences.is("stiffness and friction are zero by default",
                 usual.stiffness == 0 && usual.friction == 0);
  differences.is("untangles by default", usual.untangle && !all.untangle);
  differences.is("stiffness, friction", all.stiffness == 170 && all.friction == 0.3);
  differences.is("rounds", all.rounds == 7);
  differences.is("a run says what was built",
                 has_part(trial_scene(table + "friction = 0.3\n"),
                          "self-collision (thickness 0.002 m, friction 0.3)"));
  differences.is("and that it starts crossed", has_part(tangled, "which starts crossing itself"));
  const System system = build_system(balls);
  differences.is(
      "cloth meets itself after objects",
      system.filters.size() == 2 && std::holds_alternative<SelfCollision>(system.filters[1]));
  differences.is("absent, it is not built", build_system(trial_scene("")).filters.empty());
  return differences.judged(0,
                            "a number is read as written; parts that are not named are not built");
}

Finding self_collision_rejected_finding() {
  // the least height of the sheet's triangles: of legs .15 and .1433 m
  const double least = 0.15 * (0.43 / 3) / std::hypot(0.15, 0.43 / 3);
  char half[40];
  std::snprintf(half, sizeof half, "%.4g m", least / 2);
  Finding finding = rejected_cases(
      {{"[self_collision]\n", {"thickness"}},
       {"[self_collision]\nthickness = 0\n", {"thickness"}},
       {"[self_collision]\nthickness = 0.06\n",
        {"'thickness' is 0.06 m", "half the least height", half}},
       {"[self_collision]\nthickness = 0.001\nstiffness = -1\n", {"stiffness"}},
       {"[self_collision]\nthickness = 0.001\nfriction = -1\n", {"friction"}},
       {"[self_collision]\nthickness = 0.001\nrounds = 0\n", {"rounds"}},
       {"[self_collision]\nthickness = 0.001\nthicknes = 1\n", {"unknown key 'thicknes'"}}});
  const std::string keep = "[self_collision]\nthickness = 0.001\nuntangle = false\n";
  if (!is_rejected([&] { sheet_case(crossed, keep); }, "crosses itself at the start"))
    finding.verdict.measured += 1;
  return finding;
}

}  // namespace

std::vector<Check> scene_cloth_checks() {
  const std::string source = "cases/KEYS.md";
  return {
      {"scene.shapes-are-read",
       "Discs, cylinders, spheres, statues and hinges have the sizes written.", source,
       shapes_finding},
      {"scene.patterns-are-read",
       "Sheets have the pattern, the number of triangles and the area written.", source,
       patterns_finding},
      {"scene.copies-and-pleats-are-read",
       "Each copy is turned and moved from the one before, and pleats are folded.", source,
       copies_finding},
      {"scene.invalid-cloth-is-rejected",
       "Shapes, patterns and copies that make no sense are refused, with the line.", source,
       shapes_rejected_finding},
      {"scene.folded-start-is-read",
       "Cloth that starts folded lies in a serpentine whose lengths are the cloth's own.", source,
       folded_finding},
      {"scene.invalid-folded-start-is-rejected",
       "Folds without a direction, or longer than the cloth, are refused.", source,
       folded_rejected_finding},
      {"scene.self-collision-is-read",
       "A case's settings of self-collision are read as written, and take effect.", source,
       self_collision_finding},
      {"scene.invalid-self-collision-is-rejected",
       "Self-collision with a thickness that the mesh cannot resolve, or with cloth that starts "
       "crossed, is refused.",
       source, self_collision_rejected_finding},
  };
}

}  // namespace foldproof
