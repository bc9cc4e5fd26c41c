// Panels of a garment that are sewn where their vertices coincide.
#include <fstream>
#include <random>

#include "reference/mesh/mesh_file.h"
#include "reference/mesh/seams.h"
#include "reference/mesh/shapes.h"
#include "verification/seeds.h"
#include "verification/specimens/check.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/specimens/trial_cases.h"

namespace foldproof {

namespace {

/// By definition, vertex by vertex: the first near vertex that stays; -1 for a vertex that itself
/// stays.
std::vector<int> join_by_trying(const PerParticle3& x, double distance) {
  std::vector<int> becomes;
  for (Eigen::Index v = 0; v < x.cols(); ++v) {
    becomes.push_back(-1);
    for (Eigen::Index other = 0; other < v && becomes.back() < 0; ++other)
      if (becomes[size_t(other)] < 0 && (x.col(v) - x.col(other)).norm() <= distance)
        becomes.back() = int(other);
  }
  return becomes;
}

/// Points in a box of side 1, far from the origin or near it, and triangles that keep three
/// distinct corners.
TriangleSoup random_soup(const std::vector<int>& becomes, PerParticle3 x, std::mt19937& random) {
  TriangleSoup soup{std::move(x), {}, {}};
  const auto end_of = [&](int v) { return becomes[size_t(v)] < 0 ? v : becomes[size_t(v)]; };
  while (soup.triangles.size() < 60) {
    const Triangle t{int(random() % becomes.size()), int(random() % becomes.size()),
                     int(random() % becomes.size())};
    if (end_of(t[0]) != end_of(t[1]) && end_of(t[1]) != end_of(t[2]) &&
        end_of(t[2]) != end_of(t[0]))
      soup.triangles.push_back(t);
  }
  return soup;
}

Finding seams_finding() {
  std::mt19937 random(shifted_seed(41));
  std::uniform_real_distribution<double> inside(-0.5, 0.5);
  Table wrong("distance [m]; joined vertices [1]; wrong corners [1]");
  for (const double distance : {0.013, 0.07, 0.19, 0.31}) {
    const Vector3 place = distance < 0.1 ? Vector3(0, 0, 0) : Vector3(-37.3, 11.9, 203.7);  // m
    PerParticle3 x(3, 173);
    for (double& number : x.reshaped()) number = inside(random);
    x.colwise() += place;
    const std::vector<int> becomes = join_by_trying(x, distance);
    const TriangleSoup soup = random_soup(becomes, x, random);
    const TriangleSoup sewn = close_seams(soup, distance);
    double bad = std::abs(double(sewn.rest.cols()) - double(std::ranges::count(becomes, -1)));
    for (size_t t = 0; t < soup.triangles.size(); ++t)
      for (size_t k = 0; k < 3; ++k) {
        const int v = soup.triangles[t][k];
        const int end = becomes[size_t(v)] < 0 ? v : becomes[size_t(v)];
        bad += sewn.rest.col(sewn.triangles[t][k]) == x.col(end) ? 0 : 1;
      }
    wrong.row(distance, 173 - std::ranges::count(becomes, -1), bad);
  }
  return {{wrong.worst("wrong corners"), 0, 0, "corners",
           "vertices are chosen, not computed: every corner must be the very one"},
          wrong};
}

/// Two panels of a tube as an OBJ file: each half has its own vertices along both seams,
/// a little apart.
std::string two_panels(double apart) {
  std::string text;
  for (int panel = 0; panel < 2; ++panel)
    for (int ring = 0; ring < 4; ++ring)
      for (int k = 0; k <= 5; ++k) {
        const double angle = (5 * panel + k) * pi / 5, r = 0.2 + (panel == 1 ? apart : 0);
        text += "v " + std::to_string(r * std::cos(angle)) + " " + std::to_string(0.1 * ring) +
                " " + std::to_string(r * std::sin(angle)) + "\n";
      }
  for (int panel = 0; panel < 2; ++panel)
    for (int ring = 0; ring < 3; ++ring)
      for (int k = 0; k < 5; ++k) {
        const int a = 24 * panel + 6 * ring + k + 1;
        text += "f " + std::to_string(a) + " " + std::to_string(a + 6) + " " +
                std::to_string(a + 7) + " " + std::to_string(a + 1) + "\n";
      }
  return text;
}

Finding panels_finding() {
  const ScratchFolder folder;
  std::ofstream(folder.file("tube.obj")) << two_panels(0.001);
  const auto scene = [&](const std::string& seams) {
    const std::string text = "[cloth]\nmesh = \"tube.obj\"\ndensity = 0.2\n" + seams;
    return read_scene_text(text + short_time, folder.file("trial.toml"));
  };
  const auto rejected = [&](const std::string& seams, const std::string& words) {
    return is_rejected([&] { scene(seams); }, words);
  };
  const auto borders = [](const TriangleMesh& mesh) {
    return std::ranges::count_if(mesh.edges,
                                 [](const Edge& edge) { return edge.triangles[1] < 0; });
  };
  Differences differences;
  const Scene apart = scene(""), sewn = scene("seams = 0.002\n"), open = scene("seams = 0.0005\n");
  differences.is("two panels are two pieces", borders(apart.mesh) == 2 * (2 * 5 + 2 * 3));
  differences.is("sewn they are a tube: a ring of edges above and below",
                 borders(sewn.mesh) == 2 * 10);
  differences.is("of 40 particles", sewn.mesh.particles() == 40);
  differences.is("what is farther apart stays open", borders(open.mesh) == borders(apart.mesh));
  differences.is("a distance of zero is refused", rejected("seams = 0\n", "'seams' must be"));
  differences.is("a triangle that would be lost is refused",
                 rejected("seams = 0.11\n", "tube.obj:49: two corners"));
  return differences.judged(0, "edges and particles are counted");
}

}  // namespace

std::vector<Check> seam_checks() {
  const std::string source = "cases/KEYS.md";
  return {
      {"mesh.seams-join-nearby-vertices",
       "Each vertex merges with the first one that stays within the distance, and with no other.",
       source, seams_finding},
      {"scene.panels-are-sewn", "Panels whose borders meet become one cloth if a case says so.",
       source, panels_finding},
  };
}

}  // namespace foldproof
