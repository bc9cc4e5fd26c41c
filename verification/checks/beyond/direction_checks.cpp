// Warp and weft of springs and hinges: what strips of the built sheet have, against what was asked.
#include "reference/beyond/directions.h"

#include "reference/mesh/shapes.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/trial_cases.h"

namespace foldproof {

namespace {

/// Energy per area of a built sheet is k.C k/2 for the strains, or curvatures, k = (k11, k22, 2
/// k12): C from the energies of six small ones. displaced: the place of a point x of the plane.
template <class Displaced>
Eigen::Matrix3d stiffness_of(const Scene& scene, double area, double small, Displaced displaced) {
  const System system = build_system(scene);
  State s = start_state(scene);
  const auto energy = [&](const Eigen::Vector3d& k) {
    double sum = 0;
    for (const double sign : {-1.0, 1.0}) {
      for (Eigen::Index i = 0; i < s.x.cols(); ++i)
        s.x.col(i) = displaced(Vector3(scene.mesh.rest.col(i)), Eigen::Vector3d(sign * small * k));
      const Energies e = energies(system, s);
      sum += (e.stretch + e.bending) / 2;
    }
    return 2 * sum / (area * small * small);
  };
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d C;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      C(a, b) = a == b ? energy(I.col(a))
                       : (energy(I.col(a) + I.col(b)) - energy(I.col(a)) - energy(I.col(b))) / 2;
  return C;
}

/// The stress, or moment, of a strip along the angle over its strain, or curvature.
double strip(const Eigen::Matrix3d& C, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const Eigen::Vector3d along(c * c, s * s, c * s);
  return 1 / along.dot(C.fullPivLu().solve(along));
}

Vector3 strained(const Vector3& x, const Eigen::Vector3d& k) {
  return {(1 + k[0]) * x.x() + k[2] / 2 * x.y(), k[2] / 2 * x.x() + (1 + k[1]) * x.y(), 0};
}

Vector3 curved(const Vector3& x, const Eigen::Vector3d& k) {
  const double height = (k[0] * x.x() * x.x() + k[1] * x.y() * x.y() + k[2] * x.x() * x.y()) / 2;
  return {x.x(), x.y(), height};
}

Scene sheet_scene(const std::string& pattern, const std::string& tables) {
  return read_scene_text(
      "[cloth]\nshape = \"sheet\"\nwidth = 0.6\nheight = 0.5\ncolumns = 9\n"
      "rows = 7\ndensity = 0.1\npattern = \"" +
          pattern + "\"\n" + tables + short_time,
      "strip.toml");
}

Finding springs_finding() {
  Table errors{{"mesh", "1"},      {"warp at", "degrees"}, {"strip at", "degrees"},
               {"modulus", "N/m"}, {"wanted", "N/m"},      {"error", "1"}};
  for (const auto& [pattern, turn, bias] :
       {std::tuple("one_diagonal", 0., 120.), std::tuple("union_jack", 0., 202.),
        std::tuple("random_delaunay", 0., 165.), std::tuple("random_delaunay", 90., 165.)}) {
    const Scene scene =
        sheet_scene(pattern, "[stretch]\nwarp = 310\nweft = 270\nbias = " + std::to_string(bias) +
                                 "\ndirection = " + std::to_string(turn) + "\n");
    const Eigen::Matrix3d C = stiffness_of(scene, rest_areas(scene.mesh).sum(), 1e-4, strained);
    const double strips[3][2] = {{0, 310}, {90, 270}, {45, bias}};
    for (const auto& [degrees, wanted] : strips) {
      const double modulus = strip(C, (turn + degrees) * pi / 180);
      errors.row(pattern, turn, degrees, modulus, wanted, std::abs(modulus / wanted - 1));
    }
  }
  return judge_worst(errors, 1e-6,
                     "differences of energies over strains of 1e-4 lose 1e-8 to the third order "
                     "and as much to rounding");
}

/// The area that hinges stand for: a third of both triangles.
double area_of_hinges(const TriangleMesh& mesh) {
  const Eigen::VectorXd areas = rest_areas(mesh);
  double sum = 0;
  for (const Hinge& hinge : mesh.hinges)
    for (const int t : mesh.edges[size_t(hinge.edge)].triangles) sum += areas[t] / 3;
  return sum;
}

Finding hinges_finding() {
  Table errors{{"mesh", "1"},       {"fabric", "1"},   {"strip at", "degrees"},
               {"rigidity", "N m"}, {"wanted", "N m"}, {"error", "1"}};
  const auto judge = [&](const std::string& pattern, const std::string& fabric, const Scene& scene,
                         double warp, double weft) {
    const Eigen::Matrix3d C = stiffness_of(scene, area_of_hinges(scene.mesh), 1e-3, curved);
    const double strips[2][2] = {{0, warp}, {90, weft}};
    for (const auto& [degrees, wanted] : strips) {
      const double rigidity = strip(C, degrees * pi / 180);
      errors.row(pattern, fabric, degrees, rigidity, wanted, std::abs(rigidity / wanted - 1));
    }
  };
  for (const std::string pattern : {"equilateral", "union_jack", "random_delaunay"}) {
    judge(pattern, "stated", sheet_scene(pattern, "[bending]\nwarp = 8e-6\nweft = 5e-6\n"), 8e-6,
          5e-6);
    const Scene of_region = sheet_scene(pattern,
                                        "[bending]\nstiffness = 1\n[[fabric]]\n"
                                        "box = [[-9, -9, -9], [9, 9, 9]]\n"
                                        "bending = { warp = 3e-6, weft = 4e-6 }\n");
    judge(pattern, "of a region", of_region, 3e-6, 4e-6);
  }
  return judge_worst(errors, 1e-5,
                     "a curvature of 1e-3 per metre turns hinges by 1e-4: the law's third order is "
                     "1e-8 of it; differences of energies lose 1e-10 to rounding");
}

Finding seam_finding() {
  Table errors{{"panel turned by", "degrees"}, {"difference", "of the largest stiffness"}};
  const Scene flat = sheet_scene("union_jack", "[stretch]\nwarp = 310\nweft = 270\n");
  const StretchSprings wanted = springs_of(flat);
  for (const double degrees : {0.0, 37.0}) {
    Scene worn = flat;
    const Eigen::Rotation2Dd turn(degrees * pi / 180);
    worn.mesh.pattern = flat_corners(flat.mesh, "the panel");
    for (FlatTriangle& corners : worn.mesh.pattern)
      for (Eigen::Vector2d& corner : corners) corner = turn * corner;
    worn.stretch_directions.warp += degrees * pi / 180;
    const StretchSprings springs = springs_of(worn);
    Worst worst;
    double largest = 0;
    for (size_t e = 0; e < springs.springs.size(); ++e) {
      worst.observe(std::abs(springs.springs[e].stiffness - wanted.springs[e].stiffness));
      largest = std::max(largest, wanted.springs[e].stiffness);
    }
    errors.row(degrees, worst.value() / largest);
  }
  return judge_worst(errors, 1e-13, "sines and cosines of two angles differ by roundings");
}

/// The numbers behind these words in a message.
std::vector<double> numbers_after(const std::string& text, const std::string& words) {
  const size_t at = text.find(words);
  if (at == std::string::npos) return {nan, nan};
  double least = nan, greatest = nan;
  if (std::sscanf(text.c_str() + at + words.size(), "%lf to %lf", &least, &greatest) < 1)
    return {nan, nan};
  return {least, greatest};
}

/// A refusal says what the mesh can have: that is accepted, and more is not.
Finding refused_finding() {
  Differences differences;
  const auto message_of = [](const std::string& pattern, const std::string& keys) {
    return rejection_message([&] { sheet_scene(pattern, "[stretch]\n" + keys); });
  };
  const auto weft = [](double value) {
    return "warp = 300\nweft = " + std::to_string(value) + "\n";
  };
  for (const std::string pattern : {"union_jack", "equilateral"}) {
    const std::string message = message_of(pattern, weft(9000));
    const std::vector<double> range = numbers_after(message, "along the weft it can have ");
    differences.is(pattern + ": is refused with its place",
                   message.starts_with("strip.toml:") && range[0] < 300 && range[1] > 300);
    differences.is(pattern + ": the numbers named are accepted",
                   message_of(pattern, weft(1.001 * range[0])).empty() &&
                       message_of(pattern, weft(0.999 * range[1])).empty());
    differences.is(pattern + ": beyond them nothing is",
                   !message_of(pattern, weft(1.1 * range[1])).empty());
  }
  const std::string bias = message_of("equilateral", weft(260) + "bias = 30\n");
  differences.is("three directions cannot have a bias of their own",
                 bias.find("without 'bias' it has ") != std::string::npos);
  return differences.judged(0, "each is tried");
}

Finding rejected_finding() {
  const std::string bending = "[bending]\n", stretch = "[stretch]\n";
  return rejected_cases({
      {stretch + "warp = 300\nstiffness = 4\n", {"give 'stiffness' or 'warp', not both"}},
      {stretch + "warp = -3\n", {"'warp'"}},
      {bending + "warp = 1e-5\nweighting = \"current\"\n", {"weighting = \"rest\""}},
      {bending + "stiffness = 1\ndirections = \"both\"\n", {"no measured 'fabric'"}},
  });
}

}  // namespace

std::vector<Check> direction_checks() {
  const std::string source = "reference/beyond/directions.h";
  return {
      {"directions.springs-have-the-moduli",
       "Strips of springs along warp, weft and bias have the moduli that the case names.", source,
       springs_finding},
      {"directions.hinges-have-the-rigidities",
       "Strips of hinges along warp and weft have the rigidities that the case names.", source,
       hinges_finding},
      {"directions.follow-the-pattern",
       "A panel that lies turned in its pattern has the same springs.", source, seam_finding},
      {"directions.refusals-name-what-can-be-had",
       "What a mesh cannot have is refused with numbers that it can have.", source,
       refused_finding},
      {"directions.bad-keys-are-refused", "Keys that contradict each other are refused.", source,
       rejected_finding},
  };
}

}  // namespace foldproof
