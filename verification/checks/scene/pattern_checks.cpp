// Cloth sewn from a flat pattern: its masses, lengths and hinges are those of the panels.
#include "reference/mesh/pattern.h"

#include <fstream>
#include <sstream>

#include "reference/mesh/shapes.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/specimens/trial_cases.h"

namespace foldproof {

namespace {

constexpr double density = 0.2;

/// A panel in the plane and the same panel on a body: vertices (3 x N [m]), one numbering.
struct Panel {
  PerParticle3 flat, dressed;
  std::vector<Triangle> triangles;
};

/// Half a tube of radius r about y: `side` 0 in front, 1 behind. In the pattern the cloth is
/// `taller` times as high, and lies `apart` from the other panels.
Panel half_tube(int side, double r, double taller, double apart) {
  const TriangleMesh sheet = make_sheet({SheetPattern::alternating, pi * r, 0.5, 6, 5});
  Panel panel{sheet.rest, sheet.rest, sheet.triangles};
  for (Eigen::Index i = 0; i < sheet.rest.cols(); ++i) {
    const double angle = sheet.rest(0, i) / r + side * pi;
    panel.dressed.col(i) = Vector3(r * std::cos(angle), sheet.rest(1, i), -r * std::sin(angle));
    panel.flat(0, i) += apart;
    panel.flat(1, i) *= taller;
  }
  return panel;
}

void write(const std::string& path, const std::vector<Panel>& panels, PerParticle3 Panel::*places,
           double unit = 1) {
  std::ostringstream text;
  text.precision(17);
  int first = 1;
  for (const Panel& panel : panels)
    for (Eigen::Index i = 0; i < panel.flat.cols(); ++i)
      text << "v " << ((panel.*places).col(i) / unit).transpose() << "\n";
  for (const Panel& panel : panels) {
    for (const Triangle& t : panel.triangles)
      text << "f " << t[0] + first << " " << t[1] + first << " " << t[2] + first << "\n";
    first += int(panel.flat.cols());
  }
  std::ofstream(path) << text.str();
}

const std::string keys =
    "[cloth]\nmesh = \"dressed.obj\"\npattern = \"flat.obj\"\nseams = 1e-6\n"
    "density = 0.2\n";
const std::string forces = "[stretch]\nstiffness = 300\n[bending]\nstiffness = 1e-4\n";

/// The scene of two halves whose panels are moved in the plane first.
Scene tube(const ScratchFolder& folder, std::vector<Panel> panels, const std::string& more = "",
           double unit = 1) {
  write(folder.file("dressed.obj"), panels, &Panel::dressed);
  write(folder.file("flat.obj"), panels, &Panel::flat, unit);
  return read_scene_text(keys + more + forces + short_time, folder.file("trial.toml"));
}

std::vector<Panel> halves(double taller) {
  return {half_tube(0, 0.21, 1, 0), half_tube(1, 0.21, taller, 2)};
}

Finding masses_finding() {
  const ScratchFolder folder;
  Table errors{{"pattern", "1"}, {"mass", "1"}, {"lengths", "1"}, {"weights", "1"}, {"worst", "1"}};
  for (const double taller : {1.0, 1.07}) {
    const std::vector<Panel> panels = halves(taller);
    const Scene scene = tube(folder, panels);
    // panel by panel, before they were sewn
    double mass = 0;
    Worst lengths, weights;
    const Eigen::VectorXd rest = rest_lengths(scene.mesh);
    const Bending bending = make_bending(scene.mesh, *scene.bending, scene.rest_angles);
    int seen = 0, first = 0;
    for (const Panel& panel : panels) {
      const TriangleMesh flat = make_triangle_mesh(panel.flat, panel.triangles);
      mass += lumped_masses(flat, density).sum();
      const Bending of_panel =
          make_bending(flat, *scene.bending, std::vector<double>(flat.hinges.size(), 0.0));
      const Eigen::VectorXd of_flat = rest_lengths(flat);
      for (size_t h = 0; h < flat.hinges.size(); ++h) {
        const Edge& edge = flat.edges[size_t(flat.hinges[h].edge)];
        const std::array<int, 2> wanted{edge.triangles[0] + first, edge.triangles[1] + first};
        for (size_t k = 0; k < scene.mesh.hinges.size(); ++k) {
          const Edge& sewn = scene.mesh.edges[size_t(scene.mesh.hinges[k].edge)];
          if (std::minmax({sewn.triangles[0], sewn.triangles[1]}) !=
              std::minmax({wanted[0], wanted[1]}))
            continue;
          ++seen;
          lengths.observe(
              std::abs(rest[scene.mesh.hinges[k].edge] / of_flat[flat.hinges[h].edge] - 1));
          weights.observe(
              std::abs(bending.hinges[k].rest_weight / of_panel.hinges[h].rest_weight - 1));
        }
      }
      first += int(panel.triangles.size());
    }
    const double of_mass = std::abs(masses_of(scene).sum() / mass - 1);
    const bool all_seen = seen == int(scene.mesh.hinges.size()) - 10;  // five on each of two seams
    errors.row(taller == 1 ? "equal sides" : "sides of two lengths", of_mass, lengths.value(),
               weights.value(),
               all_seen ? std::max({of_mass, lengths.value(), weights.value()}) : nan);
  }
  return judge_worst(errors, 1e-12,
                     "areas and lengths cost a dozen roundings each, and a mass sums 120 of them; "
                     "a hinge of a panel that is missing fails outright");
}

Finding seam_finding() {
  const ScratchFolder folder;
  Table errors{{"taller", "1"}, {"ease", "1"}, {"force", "of Y times the length"}};
  for (const double taller : {1.0, 1.04, 1.3}) {
    const Scene scene = tube(folder, halves(taller));
    const StretchSprings springs = springs_of(scene);
    const std::vector<std::array<EdgeSide, 2>> sides = edge_sides(scene.mesh);
    const Eigen::VectorXd rest = rest_lengths(scene.mesh);
    Worst worst;
    int seams = 0;
    for (size_t e = 0; e < sides.size(); ++e) {
      const auto& [one, other] = sides[e];
      if (other.triangle < 0 || (one.triangle < 60) == (other.triangle < 60)) continue;
      ++seams;
      // what the two panels' edges pull at the spring's rest length, and its stiffness
      const double L = springs.springs[e].rest_length, Y = 300;
      double pull = 0, stiffness = 0;
      for (const EdgeSide& side : sides[e]) {
        pull += Y * side.area / side.length * (L / side.length - 1);
        stiffness += Y * side.area / (side.length * side.length);
      }
      worst.observe(std::abs(pull) / (Y * one.length));
      worst.observe(std::abs(springs.springs[e].stiffness / stiffness - 1));
      worst.observe(std::abs(rest[Eigen::Index(e)] / L - 1));
    }
    const PatternFacts facts = facts_of_pattern(scene.mesh, scene.x);
    const double ease = 2 * (taller - 1) / (taller + 1);
    const bool is_told = facts.panels == 2 && seams == 10 && std::abs(facts.ease - ease) < 1e-12 &&
                         std::abs(facts.seams / (2 * 0.5 * taller) - 1) < 1e-12;
    errors.row(taller, facts.ease, is_told ? worst.value() : nan);
  }
  return judge_worst(errors, 1e-13,
                     "the rest length is a quotient of sums of two; panels, seams and ease that "
                     "are not those made fail outright");
}

Finding moved_finding() {
  const ScratchFolder folder;
  const std::vector<Panel> panels = halves(1.07);
  const Scene plain = tube(folder, panels);
  Table changes{{"panel", "1"}, {"lengths", "1"}, {"masses", "1"}, {"worst", "1"}};
  const auto compare = [&](const std::string& name, const Scene& other) {
    const double lengths = (rest_lengths(other.mesh).array() / rest_lengths(plain.mesh).array() - 1)
                               .abs()
                               .maxCoeff<Eigen::PropagateNaN>(),
                 masses = (masses_of(other).array() / masses_of(plain).array() - 1)
                              .abs()
                              .maxCoeff<Eigen::PropagateNaN>();
    changes.row(name, lengths, masses, std::max(lengths, masses));
  };
  for (const bool mirrored : {false, true}) {
    std::vector<Panel> moved = panels;
    PerParticle3& flat = moved[1].flat;
    const PerParticle3 turned = Eigen::AngleAxisd(0.7, Vector3(0, 0, 1)).toRotationMatrix() * flat;
    flat = turned;
    if (mirrored) flat.row(0) *= -1;
    compare(mirrored ? "mirrored" : "turned", tube(folder, moved));
  }
  compare("in centimetres", tube(folder, panels, "pattern_scale = 0.01\n", 0.01));
  Scene finer = tube(folder, panels, "refine = 1\n");
  const double sum = masses_of(finer).sum() / masses_of(plain).sum() - 1,
               halved =
                   rest_lengths(finer.mesh).minCoeff() / rest_lengths(plain.mesh).minCoeff() * 2 -
                   1;
  changes.row("refined", std::abs(halved), std::abs(sum),
              std::max(std::abs(sum), std::abs(halved)));
  return judge_worst(changes, 1e-12,
                     "a turn and a change of unit cost a few roundings of a place 2 m away");
}

/// The same panels as texture coordinates of the dressed mesh, in units of `unit` [m].
Finding textures_finding() {
  const ScratchFolder folder;
  const std::vector<Panel> panels = halves(1.07);
  const Scene plain = tube(folder, panels);
  const double unit = 2.5;
  std::ostringstream text;
  text.precision(17);
  for (const Panel& panel : panels)
    for (Eigen::Index i = 0; i < panel.flat.cols(); ++i)
      text << "v " << panel.dressed.col(i).transpose() << "\nvt "
           << panel.flat.col(i).head<2>().transpose() / unit << "\n";
  int first = 1;
  for (const Panel& panel : panels) {
    for (const Triangle& t : panel.triangles) {
      text << "f";
      for (const int i : t) text << " " << i + first << "/" << i + first;
      text << "\n";
    }
    first += int(panel.flat.cols());
  }
  std::ofstream(folder.file("dressed.obj")) << text.str();
  const auto read = [&](const std::string& more) {
    return read_scene_text(
        "[cloth]\nmesh = \"dressed.obj\"\npattern = \"vt\"\nseams = 1e-6\n"
        "density = 0.2\n" +
            more + forces + short_time,
        folder.file("trial.toml"));
  };
  const Scene scene = read("pattern_scale = 2.5\n");
  Differences differences;
  differences.is_near("lengths",
                      (rest_lengths(scene.mesh) - rest_lengths(plain.mesh))
                          .cwiseAbs()
                          .maxCoeff<Eigen::PropagateNaN>(),
                      2);
  differences.is_near(
      "masses", (masses_of(scene) - masses_of(plain)).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
      1);
  differences.is("a unit is asked for", is_rejected([&] { read(""); }, "have no unit"));
  write(folder.file("dressed.obj"), panels, &Panel::dressed);
  differences.is("a mesh without them is refused",
                 is_rejected([&] { read("pattern_scale = 1\n"); }, "texture coordinates (f a/b)"));
  return differences.judged(8, "a division and a product by the unit, of places 2 m away");
}

Finding rest_finding() {
  const ScratchFolder folder;
  std::vector<Panel> panels = halves(1);
  for (Panel& panel : panels) panel.dressed = panel.flat;  // laid out: seams apart
  const Scene scene = tube(folder, panels);
  const System system = build_system(scene);
  Work work;
  const PerParticle3 force = elastic_forces(system.forces, start_state(scene), work);
  Table measured{{"force", "of Y times an edge"}};
  measured.row(force.cwiseAbs().maxCoeff() / (300 * rest_lengths(scene.mesh).minCoeff()));
  return judge_worst(measured, 1e-12, "a length 2 m away is known to a rounding of 2 m");
}

Finding rejected_finding() {
  const ScratchFolder folder;
  Differences differences;
  const auto refuses = [&](std::vector<Panel> panels, const std::string& more,
                           const std::string& words) {
    return is_rejected([&] { tube(folder, std::move(panels), more); }, words);
  };
  const std::vector<Panel> good = halves(1);
  std::vector<Panel> bent = good, swapped = good, thin = good;
  bent[0].flat(2, 7) = 0.02;
  thin[1].flat.row(1).setConstant(0.3);
  differences.is("a pattern that is not flat", refuses(bent, "", "the pattern is not flat"));
  differences.is("a triangle without area", refuses(thin, "", "no area in the pattern"));
  differences.is("pleats beside it", refuses(good, "repair = \"split\"\n", "does not go with"));
  write(folder.file("dressed.obj"), good, &Panel::dressed);
  std::swap(swapped[0].triangles[3], swapped[0].triangles[20]);
  write(folder.file("flat.obj"), swapped, &Panel::flat);
  const auto read = [&] { read_scene_text(keys + forces + short_time, folder.file("trial.toml")); };
  differences.is("faces in another order", is_rejected(read, "has its place in the list"));
  write(folder.file("flat.obj"), {good[0]}, &Panel::flat);
  differences.is("another number of faces", is_rejected(read, "both need the same faces"));
  return differences.judged(0, "each is tried");
}

}  // namespace

std::vector<Check> pattern_checks() {
  const std::string source = "cases/KEYS.md";
  return {
      {"pattern.masses-and-lengths-are-the-panels",
       "Masses, lengths and weights of hinges of a sewn cloth are those of its flat panels.",
       source, masses_finding},
      {"pattern.seams-share-their-ease",
       "Where a seam joins sides of two lengths, the spring is both sides' springs together.",
       source, seam_finding},
      {"pattern.panels-may-lie-anywhere",
       "Turning or mirroring a panel, another unit or a refinement change no mass and no length.",
       source, moved_finding},
      {"pattern.texture-coordinates-are-a-pattern",
       "Texture coordinates with a unit give the rest shape that a flat mesh gives.", source,
       textures_finding},
      {"pattern.panels-are-at-rest", "Panels laid out as in their pattern have no forces.", source,
       rest_finding},
      {"pattern.bad-patterns-are-refused", "A pattern that does not fit its cloth is refused.",
       source, rejected_finding},
  };
}

}  // namespace foldproof
