// Vertices with several fans are split: each fan gets its own vertex, in the same place and held as
// the original was.
#include <fstream>
#include <random>
#include <set>

#include "reference/mesh/shapes.h"
#include "reference/mesh/split_fans.h"
#include "verification/oracles/exact_crossings.h"
#include "verification/seeds.h"
#include "verification/specimens/check.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/specimens/trial_cases.h"
#include "verification/specimens/ugly_solids.h"

namespace foldproof {

namespace {

// ---- meshes connected at points

std::set<int> neighbours_of(const TriangleSoup& soup, int v) {
  std::set<int> found{v};
  for (const Triangle& t : soup.triangles)
    if (std::ranges::find(t, v) != t.end()) found.insert(t.begin(), t.end());
  return found;
}

/// Replaces b by a, if they have no neighbour in common, so that no edge gains a triangle.
void glue(int a, int b, TriangleSoup& soup) {
  const std::set<int> of_a = neighbours_of(soup, a), of_b = neighbours_of(soup, b);
  if (std::ranges::any_of(of_a, [&](int v) { return of_b.contains(v); })) return;
  for (Triangle& t : soup.triangles)
    for (int& corner : t)
      if (corner == b) corner = a;
}

TriangleSoup without_unused(const TriangleSoup& soup) {
  std::set<int> used;
  for (const Triangle& t : soup.triangles) used.insert(t.begin(), t.end());
  const std::vector<int> kept(used.begin(), used.end());
  TriangleSoup left{soup.rest(Eigen::all, kept), soup.triangles, {}};
  for (Triangle& t : left.triangles)
    for (int& corner : t) corner = int(std::distance(used.begin(), used.find(corner)));
  return left;
}

/// A jittered sheet, a sphere and a tube, with pairs of vertices glued at random; some are
/// glued repeatedly.
TriangleSoup random_hangings(std::mt19937& random, int pairs) {
  TriangleSoup soup{PerParticle3(3, 0), {}, {}};
  soup = join(soup, soup_of(make_sheet({SheetPattern::jittered, 0.7, 0.5, 7, 5, 0.2, 5})),
              {-0.3, 0.1, 0.9});
  soup = join(soup, soup_of(make_icosphere(0.31, 1)), {0.4, 1.3, -0.2});
  soup = join(soup, soup_of(make_cylinder(0.17, 0.6, 7, 5)), {-1.1, -0.7, 0.3});
  const int count = int(soup.rest.cols());
  std::shuffle(soup.triangles.begin(), soup.triangles.end(), random);
  for (int k = 0; k < pairs; ++k) {
    const int a = int(random() % unsigned(count)) / 3 * 3;  // every third one: some are glued again
    glue(a, int(random() % unsigned(count)), soup);
  }
  return without_unused(soup);
}

// ---- fans by their definition

bool share_an_edge_at(const Triangle& s, const Triangle& t, int v) {
  return std::ranges::any_of(s,
                             [&](int w) { return w != v && std::ranges::find(t, w) != t.end(); });
}

/// The triangles of the fan of v that contains triangle `first`, found by walking over edges at v.
std::set<int> fan_at(const TriangleSoup& soup, int v, int first) {
  std::vector<int> fan{first};
  for (size_t i = 0; i < fan.size(); ++i)
    for (int t = 0; t < int(soup.triangles.size()); ++t) {
      const Triangle& other = soup.triangles[size_t(t)];
      if (std::ranges::find(other, v) == other.end() || std::ranges::find(fan, t) != fan.end())
        continue;
      if (share_an_edge_at(soup.triangles[size_t(fan[i])], other, v)) fan.push_back(t);
    }
  return {fan.begin(), fan.end()};
}

/// Expected result of a split.
struct Expected {
  std::vector<Triangle> triangles;
  std::vector<int> copy_of;
  PerParticle3 place;  // 3 x N' [m]
  int split = 0;       // vertices
};

Expected expected_of(const TriangleSoup& soup) {
  Expected expected{soup.triangles, {}, soup.rest, 0};
  const int count = int(soup.rest.cols());
  // in the order of their first triangles
  std::vector<std::vector<std::set<int>>> fans{size_t(count)};
  std::vector<std::vector<int>> particles{size_t(count)};
  for (int v = 0; v < count; ++v) expected.copy_of.push_back(v);
  for (int t = 0; t < int(soup.triangles.size()); ++t)
    for (size_t k = 0; k < 3; ++k) {
      const int v = soup.triangles[size_t(t)][k];
      auto& known = fans[size_t(v)];
      size_t which = 0;
      while (which < known.size() && !known[which].contains(t)) ++which;
      if (which == known.size()) {
        known.push_back(fan_at(soup, v, t));
        particles[size_t(v)].push_back(which == 0 ? v : int(expected.copy_of.size()));
        if (which > 0) expected.copy_of.push_back(v);
      }
      expected.triangles[size_t(t)][k] = particles[size_t(v)][which];
    }
  expected.place = soup.rest(Eigen::all, expected.copy_of);
  for (int v = 0; v < count; ++v) {
    if (fans[size_t(v)].size() == 1) continue;
    ++expected.split;
    for (size_t which = 0; which < fans[size_t(v)].size(); ++which) {
      Vector3 middles = Vector3::Zero();
      for (const int t : fans[size_t(v)][which])
        for (const int w : soup.triangles[size_t(t)])
          if (w != v) middles += soup.rest.col(w) / 2;
      const Vector3 x = soup.rest.col(v);
      expected.place.col(particles[size_t(v)][which]) =
          0.999 * x + 0.001 * middles / double(fans[size_t(v)][which].size());
    }
  }
  return expected;
}

// ---- findings

Finding numbers_finding() {
  std::mt19937 random(shifted_seed(83));
  Table wrong("split vertices [1]; particles [1]; wrong corners [1]");
  for (const int pairs : {0, 9, 40, 90}) {
    const TriangleSoup soup = random_hangings(random, pairs);
    const Expected expected = expected_of(soup);
    const SplitMesh found = split_fans(soup);
    double count = std::abs(double(found.mesh.triangles.size()) - double(soup.triangles.size())) +
                   (found.copy_of == expected.copy_of ? 0 : 1);
    for (size_t t = 0; t < std::min(found.mesh.triangles.size(), expected.triangles.size()); ++t)
      for (size_t k = 0; k < 3; ++k)
        count += found.mesh.triangles[t][k] == expected.triangles[t][k] ? 0 : 1;
    wrong.row(expected.split, expected.copy_of.size(), count);
  }
  return {{wrong.worst("wrong corners"), 0, 0, "corners", "particles are numbered, not computed"},
          wrong,
          "A wrong list of copies counts as one wrong corner."};
}

Finding places_finding() {
  std::mt19937 random(shifted_seed(89));
  Worst off;
  Table moved{{"split vertices", "1"}, {"farthest moved", "m"}};
  for (const int pairs : {9, 60}) {
    const TriangleSoup soup = random_hangings(random, pairs);
    const Expected expected = expected_of(soup);
    const SplitMesh found = split_fans(soup);
    const double size = soup.rest.cwiseAbs().maxCoeff();
    Worst most;
    for (int i = 0; i < int(expected.copy_of.size()); ++i) {
      const Vector3 difference = found.mesh.rest.col(i) - expected.place.col(i);
      off.observe(difference.cwiseAbs().maxCoeff() / (epsilon * size));
      most.observe((expected.place.col(i) - soup.rest.col(expected.copy_of[size_t(i)])).norm());
    }
    moved.row(expected.split, most.value());
  }
  return {{off.value(), 4, 0, "epsilon of the size",
           "a mean of a few middles, a thousandth of it, and a sum: one rounding of the largest "
           "coordinate for each of the two ways to write it, and two to spare"},
          moved};
}

/// Two triangles in a plane and two cones, apex to apex; a corner that stands on a sheet; three
/// sheets at a corner.
std::vector<TriangleSoup> touching_fans() {
  const auto soup = [](std::vector<Vector3> places, std::vector<Triangle> triangles) {
    PerParticle3 x(3, Eigen::Index(places.size()));
    for (size_t i = 0; i < places.size(); ++i) x.col(Eigen::Index(i)) = places[i];
    return TriangleSoup{x, std::move(triangles), {}};
  };
  std::vector<TriangleSoup> all;
  all.push_back(soup({{0.3, 0.7, 0}, {-1, -1, 0}, {-1, 1.1, 0}, {1.2, 2, 0}, {1.4, -0.9, 0}},
                     {{0, 1, 2}, {0, 3, 4}}));
  std::vector<Vector3> cones{{0.1, 0.2, 0.3}};
  std::vector<Triangle> of_cones;
  for (int cone = 0; cone < 2; ++cone)
    for (int k = 0; k < 6; ++k) {
      const double angle = k * pi / 3 + cone, r = cone == 0 ? 0.8 : 1.3;
      cones.push_back(cones[0] +
                      Vector3(r * std::cos(angle), cone == 0 ? 1 : -0.7, r * std::sin(angle)));
      of_cones.push_back({0, 1 + 6 * cone + k, 1 + 6 * cone + (k + 1) % 6});
    }
  all.push_back(soup(cones, of_cones));
  all.push_back(soup(
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {-0.3, 0.2, 1}, {0.4, 0.1, 1.2}},
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {0, 5, 6}}));
  all.push_back(soup({{0, 0, 0},
                      {1, 0, 0},
                      {0.4, 1, 0},
                      {0, 0, 1},
                      {-1, 0.1, 0.6},
                      {-0.6, -1, -0.2},
                      {0.3, -1, 0.1},
                      {0.9, -0.8, 0.2}},
                     {{0, 1, 2}, {0, 3, 4}, {0, 5, 6}, {0, 6, 7}}));
  return all;
}

Finding touching_finding() {
  double count = 0;
  Table touching{{"pairs that touch where they were", "1"}, {"pairs that touch when apart", "1"}};
  for (const TriangleSoup& soup : touching_fans()) {
    const SplitMesh found = split_fans(soup);
    const PerParticle3 together = soup.rest(Eigen::all, found.copy_of);
    const auto before = oracles::exact_crossings(together, found.mesh.triangles).size();
    const auto after = oracles::exact_crossings(found.mesh.rest, found.mesh.triangles).size();
    touching.row(before, after);
    count += double(after) + (before > 0 ? 0 : 1);
  }
  return {{count, 0, 0, "pairs", "touching is decided exactly"},
          touching,
          "A specimen that does not touch at the start counts as a pair."};
}

constexpr const char* three_fans = R"(v 0 0 0
v -1 -1 0
v -1 1 0
v 1 -1 0
v 1 1 0
v -1 0 2
v 0 0.3 2
v 1 0 2
g left
f 1 3 2
g right
f 1 4 5
g top
f 1 6 7 8
)";

/// Reads cases with this mesh.
class ThreeFans {
 public:
  ThreeFans() {
    std::ofstream(folder_.file("fans.obj")) << three_fans;
    std::ofstream(folder_.file("edge.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\n"
                                               "f 1 2 3\nf 2 1 4\nf 1 2 5\n";
  }

  Scene scene(const std::string& cloth, const std::string& tables = "",
              const std::string& mesh = "fans") const {
    const std::string head = "[cloth]\nmesh = \"" + mesh + ".obj\"\ndensity = 0.2\n";
    return read_scene_text(head + cloth + tables + short_time, folder_.file("trial.toml"));
  }

  bool is_rejected(const std::string& cloth, const std::string& words,
                   const std::string& mesh = "fans") const {
    return foldproof::is_rejected([&] { scene(cloth, "", mesh); }, words);
  }

 private:
  ScratchFolder folder_;
};

std::set<int> held(const Scene& scene) {
  std::set<int> found;
  for (const PrescribedParticle& p : scene.prescribed) found.insert(p.particle);
  return found;
}

std::string sticky(const std::string& of, const std::string& particles) {
  return "[[sticky]]\nstiffness = 3\nforecast_time = 0.01\nnear = 0.1\nfar = "
         "0.2\n[sticky.surface]\nof = \"cloth\"\n" +
         of + "[sticky.particles]\n" + particles;
}

const std::string split = "repair = \"split\"\n";

void see_particles(const ThreeFans& fans, Differences& differences) {
  using Set = std::set<int>;
  const auto hold = [&](const std::string& which, const std::string& cloth = split) {
    return held(fans.scene(cloth, "[[hold]]\n" + which));
  };
  differences.is("the vertex is held in all fans", hold("particles = [0]\n") == Set{0, 8, 9});
  differences.is("the last copy alone", hold("particles = [9]\n") == Set{9});
  differences.is("both at once", hold("particles = [0, 9]\n") == Set{0, 8, 9});
  differences.is("another vertex alone", hold("particles = [3]\n") == Set{3});
  differences.is("by a box", hold("box = [[-0.1, -0.1, -0.1], [0.1, 0.1, 0.1]]\n") == Set{0, 8, 9});
  differences.is("in the second of two pieces",
                 hold("particles = [10]\n", split + "copies = { count = 2, move = [0, 0, 9] }\n") ==
                     Set{10, 18, 19});
  const auto stuck = [&](const std::string& particles) {
    return fans.scene(split, sticky("group = \"left\"\n", particles)).sticky.front();
  };
  differences.is("a group has the copy of its fan",
                 stuck("group = \"right\"\n").particles == std::vector{3, 4, 8});
  differences.is("and its triangles", stuck("").triangles == std::vector<Triangle>{{0, 2, 1}});
  differences.is("what sticks by number does so in all fans",
                 stuck("particles = [0, 3]\n").particles == std::vector{0, 3, 8, 9});
}

Finding scene_finding() {
  const ThreeFans fans;
  Differences differences;
  const Scene found = fans.scene(split);
  differences.is("ten particles of eight vertices", found.mesh.particles() == 10);
  differences.is("four triangles", found.mesh.triangles.size() == 4);
  const PerParticle masses = lumped_masses(found.mesh, found.density);
  for (const auto& [particle, area] : {std::pair{0, 1.0}, {8, 1.0}, {9, 2.109}})
    differences.is("the mass of particle " + std::to_string(particle),
                   std::abs(masses[particle] / (0.2 * area / 3) - 1) < 0.005);
  const auto parts = describe_parts(found, build_system(found));
  differences.is("it is said",
                 std::ranges::find(parts, "1 vertex split into 3 particles") != parts.end());
  see_particles(fans, differences);
  differences.is("seams join before", fans.scene("seams = 0.01\n" + split).mesh.particles() == 10);
  differences.is("refused without it, with a remedy",
                 fans.is_rejected("", "for cloth, set repair = \"split\""));
  differences.is("an edge of three triangles",
                 fans.is_rejected(split, "cannot tell which two", "edge"));
  differences.is("another word", fans.is_rejected("repair = \"mend\"\n", "known: refuse, split"));
  return differences.judged(0,
                            "particles are counted; the mass of a fan's particle is a third of its "
                            "triangles, less a thousandth of their height");
}

}  // namespace

std::vector<Check> split_fan_checks() {
  const std::string source = "cases/README.md";
  return {
      {"mesh.split-gives-each-fan-a-particle",
       "A vertex of several fans is split into one particle for each, and no triangle is lost.",
       source, numbers_finding},
      {"mesh.split-moves-a-thousandth",
       "Split particles move a thousandth of the way into their fans; nothing else moves.", source,
       places_finding},
      {"mesh.split-fans-do-not-touch",
       "Fans that touched in a vertex touch nowhere once it is split.", source, touching_finding},
      {"scene.split-vertices-stay-held",
       "Masses, holds, groups and sticky patches follow a split vertex if a case asks for the "
       "split.",
       source, scene_finding},
  };
}

}  // namespace foldproof
