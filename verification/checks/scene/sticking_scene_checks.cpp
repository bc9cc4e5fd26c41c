// Sticking in case files: regions, groups of OBJ files, refusals.
#include <fstream>

#include "reference/mesh/mesh_file.h"
#include "verification/specimens/check.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/specimens/trial_cases.h"

namespace foldproof {

namespace {

const std::string ball = R"(
[[object]]
name = "ball"
shape = "sphere"
radius = 0.2
move = [0.3, 0.2, -0.25]
velocity = [0, 0.3, -0.2]
)";

const std::string values = "stiffness = 41\nforecast_time = 0.013\nnear = 0.009\nfar = 0.031\n";

/// The only patch of a case with these regions.
StickyPatch patch_of(const std::string& surface, const std::string& particles,
                     const std::string& more = "") {
  return trial_scene(ball + "[[sticky]]\nsurface = " + surface + "\nparticles = " + particles +
                     "\n" + values + more)
      .sticky.at(0);
}

std::vector<Triangle> chosen_triangles(const Scene& scene,
                                       const std::function<bool(const Vector3&)>& is_in) {
  std::vector<Triangle> chosen;
  for (const Triangle& t : scene.mesh.triangles)
    if (is_in((scene.x.col(t[0]) + scene.x.col(t[1]) + scene.x.col(t[2])) / 3)) chosen.push_back(t);
  return chosen;
}

Finding regions_finding() {
  const Scene sheet = trial_scene("");
  const std::vector<Triangle>& all = sheet.mesh.triangles;
  Differences differences;
  const StickyPatch plain = patch_of("{ of = \"cloth\" }", "{}");
  differences.is("all of the cloth",
                 plain.triangles == all && plain.particles.size() == 20 && !plain.place);
  differences.is("values", plain.stiffness == 41 && plain.forecast_time == 0.013 &&
                               plain.near == 0.009 && plain.far == 0.031 && plain.from == 0 &&
                               std::isinf(plain.until) && plain.release == 0);
  const StickyPatch lists =
      patch_of("{ of = \"cloth\", triangles = [7, 2, 7] }", "{ particles = [11, 3, 11] }",
               "from = 0.1\nuntil = 0.2\nrelease = 0.03\nname = \"seam\"\n");
  differences.is("lists, in order, each once",
                 lists.triangles == std::vector<Triangle>{all[2], all[7]} &&
                     lists.particles == std::vector<int>{3, 11});
  differences.is("times and name", lists.from == 0.1 && lists.until == 0.2 &&
                                       lists.release == 0.03 && lists.name == "seam");
  const StickyPatch box = patch_of("{ of = \"cloth\", box = [[0, 0, -1], [0.31, 0.2, 1]] }",
                                   "{ box = [[0.29, 0.1, -1], [1, 1, 1]] }");
  const auto select_in_box = [](const Vector3& p) { return p.x() <= 0.31 && p.y() <= 0.2; };
  differences.is("box of centres",
                 !box.triangles.empty() && box.triangles == chosen_triangles(sheet, select_in_box));
  const StickyPatch round =
      patch_of("{ of = \"cloth\", sphere = { center = [0.1, 0.1, 0], radius = 0.17 } }",
               "{ sphere = { center = [0.6, 0.43, 0], radius = 0.16 } }");
  const auto in_ball = [](const Vector3& p) { return (p - Vector3(0.1, 0.1, 0)).norm() <= 0.17; };
  differences.is("sphere of centres",
                 !round.triangles.empty() && round.triangles == chosen_triangles(sheet, in_ball));
  std::vector<int> corner;
  for (int i = 0; i < 20; ++i)
    if ((sheet.x.col(i) - Vector3(0.6, 0.43, 0)).norm() <= 0.16) corner.push_back(i);
  differences.is("sphere of particles", !corner.empty() && round.particles == corner);
  return differences.judged(0, "numbers and choices are read as written");
}

Finding carried_finding() {
  Differences differences;
  const StickyPatch cap = patch_of("{ of = \"ball\", box = [[-1, -1, -0.12], [1, 1, 1]] }", "{}");
  const size_t all = patch_of("{ of = \"ball\" }", "{}").triangles.size();
  differences.is("some of the ball's triangles",
                 cap.triangles.size() > all / 8 && cap.triangles.size() < all / 2 && cap.place);
  for (const double t : {0.0, 0.17}) {
    const PerParticle3 x = cap.place(t), v = cap.velocity(t);
    Worst off, above, slow;
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      off.observe(std::abs((x.col(i) - Vector3(0.3, 0.2 + 0.3 * t, -0.25 - 0.2 * t)).norm() - 0.2));
      slow.observe((v.col(i) - Vector3(0, 0.3, -0.2)).norm());
    }
    for (const auto& [a, b, c] : cap.triangles)
      above.observe(std::max(0.0, -0.12 - 0.2 * t - (x(2, a) + x(2, b) + x(2, c)) / 3));
    differences.is_near("vertices on the ball", off.value());
    differences.is_near("velocity", slow.value());
    differences.is_near("centres in the box at the start", above.value());
  }
  return differences.judged(8, "a rigid motion of points of size 1 takes a few roundings");
}

/// Three triangles: the first two in an object with two names and one group each, the last in none.
const std::string grouped = R"(v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 2 0 0
o left right
g front left
f 1 2 3
g back back
f 1 3 4
o
g
f 2 5 3
)";

Finding groups_finding() {
  const ScratchFolder folder;
  const std::string file = folder.file("grouped.obj");
  std::ofstream(file) << grouped;
  Differences differences;
  const FaceGroups groups = read_mesh_file(file).groups;
  differences.is(
      "groups",
      groups == FaceGroups{{"back", {1}}, {"front", {0}}, {"left", {0, 1}}, {"right", {0, 1}}});
  const std::string text = "[cloth]\nmesh = \"grouped.obj\"\ndensity = 0.2\n" + short_time +
                           "[[sticky]]\nsurface = { of = \"cloth\", group = \"front\" }\nparticles "
                           "= { group = \"back\" }\n" +
                           values;
  const StickyPatch patch = read_scene_text(text, folder.file("trial.toml")).sticky.at(0);
  differences.is("triangles of a group", patch.triangles == std::vector<Triangle>{{0, 1, 2}});
  differences.is("corners of a group", patch.particles == std::vector<int>{0, 2, 3});
  return differences.judged(0, "names are read as written");
}

std::string sticky(const std::string& keys) { return ball + "[[sticky]]\n" + keys; }

Finding rejections_finding() {
  const std::string regions = "surface = { of = \"ball\" }\nparticles = {}\n",
                    cloth = "surface = { of = \"cloth\" }\n";
  return rejected_cases({
      {sticky("surface = { of = \"ball\" }\n" + values), {"'surface'", "'particles'"}},
      {sticky("surface = { of = \"bell\" }\nparticles = {}\n" + values), {"'bell'", "cloth, ball"}},
      {sticky(regions + "stiffness = 41\nforecast_time = 0.013\nnear = 0.009\n"), {"'far'"}},
      {sticky(regions + "stiffness = 41\nforecast_time = 0.013\nnear = 0\nfar = 0.1\n"),
       {"'near' must be > 0"}},
      {sticky(regions + "stiffness = 41\nforecast_time = -1\nnear = 0.1\nfar = 0.1\n"),
       {"'forecast_time'", "negative"}},
      {sticky(regions + values + "from = 0.2\nuntil = 0.1\n"), {"'until' must be later"}},
      {sticky(regions + values + "until = 0.1\nrelease = 0.2\n"), {"'release'", "longer"}},
      {sticky(regions + values + "stickiness = 3\n"), {"stickiness"}},
      {sticky(cloth + "particles = { particles = [3, 77] }\n" + values), {"particle 77", "20"}},
      {sticky("surface = { of = \"cloth\", triangles = [24] }\nparticles = {}\n" + values),
       {"triangle 24", "24"}},
      {sticky(cloth + "particles = { box = [[7, 7, 7], [8, 8, 8]] }\n" + values), {"no particles"}},
      {sticky(cloth + "particles = { particles = [3], box = [[0, 0, 0], [1, 1, 1]] }\n" + values),
       {"one of"}},
      {sticky(cloth + "particles = { group = \"palm\" }\n" + values), {"'group'", "OBJ"}},
      {sticky(cloth + "particles = { sphere = { center = [0, 0, 0], radius = -1 } }\n" + values),
       {"radius"}},
  });
}

}  // namespace

std::vector<Check> sticking_scene_checks() {
  const std::string source = "cases/KEYS.md";
  return {{"scene.sticky-regions-are-read",
           "The reference reads the lists, boxes, spheres and values of [[sticky]] as written.",
           source, regions_finding},
          {"scene.objects-carry-sticky-surfaces",
           "The reference attaches sticky triangles to the object that their region names.", source,
           carried_finding},
          {"scene.obj-groups-are-kept",
           "The reference keeps the groups and objects of an OBJ file, and regions name them.",
           source, groups_finding},
          {"scene.invalid-sticky-tables-are-rejected",
           "The reference refuses wrong tables [[sticky]] with file, line and what is known.",
           source, rejections_finding}};
}

}  // namespace foldproof
