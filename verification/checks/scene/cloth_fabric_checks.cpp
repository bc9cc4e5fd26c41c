// Several fabrics in one cloth: masses, springs and hinges of each, and a strip of two against the
// beam.
#include "reference/scene/cloth_fabrics.h"

#include "reference/mesh/rigidity_map.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/trial_cases.h"

namespace foldproof {

namespace {

const std::string two_fabrics = R"(
[stretch]
stiffness = 300
damping = 0.01

[bending]
stiffness = 2e-5
damping = 1e-6

[[fabric]]
box = [[0.3, -1, -1], [1, 1, 1]]
density = 0.41
stretch = { stiffness = 700 }
bending = { stiffness = 9e-5, damping = 5e-6 }
)";

bool is_right(const Scene& scene, int t) {
  double x = 0;
  for (const int i : scene.mesh.triangles[size_t(t)]) x += scene.x(0, i) / 3;
  return x >= 0.3;
}

Finding parts_finding() {
  const Scene scene = trial_scene(two_fabrics);
  const System system = build_system(scene);
  const Eigen::VectorXd areas = triangle_areas(scene.mesh.triangles, scene.x),
                        lengths = rest_lengths(scene.mesh);
  Differences differences;
  PerParticle mass = PerParticle::Zero(scene.x.cols());
  for (int t = 0; t < areas.size(); ++t)
    for (const int i : scene.mesh.triangles[size_t(t)])
      mass[i] += (is_right(scene, t) ? 0.41 : 0.23) * areas[t] / 3;
  differences.is_near("masses", (system.mass - mass).cwiseAbs().maxCoeff(), mass.maxCoeff());
  double stiffness = 0, most = 0;
  int hinges[2][2] = {};
  for (const Force& force : system.forces) {
    if (const auto* all = std::get_if<StretchSprings>(&force))
      for (size_t e = 0; e < all->springs.size(); ++e) {
        double k = 0;
        for (const int t : scene.mesh.edges[e].triangles)
          if (t >= 0) k += (is_right(scene, t) ? 700 : 300) * areas[t];
        k /= lengths[Eigen::Index(e)] * lengths[Eigen::Index(e)];
        most = std::max(most, k);
        stiffness = std::max(stiffness, std::abs(all->springs[e].stiffness - k));
      }
    if (const auto* all = std::get_if<Bending>(&force))
      for (const BendingHinge& hinge : all->hinges)
        for (const Hinge& of_mesh : scene.mesh.hinges) {
          if (of_mesh.particles != hinge.particles) continue;
          const auto& [t1, t2] = scene.mesh.edges[size_t(of_mesh.edge)].triangles;
          const double one = is_right(scene, t1) ? 9e-5 : 2e-5,
                       other = is_right(scene, t2) ? 9e-5 : 2e-5;
          ++hinges[is_right(scene, t1)][is_right(scene, t2)];
          differences.is_near("a hinge's compliance",
                              1 / all->material.stiffness - (1 / one + 1 / other) / 2, 1 / one);
        }
  }
  differences.is_near("springs", stiffness, most);
  differences.is("hinges of both fabrics, and between them",
                 hinges[0][0] > 0 && hinges[1][1] > 0 && hinges[0][1] + hinges[1][0] > 0 &&
                     hinges[0][0] + hinges[1][1] + hinges[0][1] + hinges[1][0] ==
                         int(scene.mesh.hinges.size()));
  return differences.judged(8, "sums of two or six products");
}

/// The deflection of the end of a clamped strip of two halves under its weight, from the matrix at
/// rest; and, of a beam of the same rigidities, by integration of the moment.
struct Strip {
  double hinges, beam;  // m
};

Strip strip_of(int columns, double ratio) {
  const double L = 0.2, ke = 1e-5, g = 1e-3, sigma[2] = {0.1, 0.25};
  Scene scene = scene_at_rest(
      make_sheet({SheetPattern::equilateral, L, 0, columns, std::max(2, columns / 10)}), sigma[0]);
  scene.bending = BendingMaterial{.stiffness = ke};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0.0);
  BendingMaterial stiff{.stiffness = ratio * ke};
  scene.fabrics.fabrics = {{"soft", sigma[0], {}, *scene.bending}, {"stiff", sigma[1], {}, stiff}};
  for (const Triangle& t : scene.mesh.triangles) {
    double x = 0;
    for (const int i : t) x += scene.x(0, i) / 3;
    scene.fabrics.of_triangle.push_back(x > L / 2);
  }
  const System system = build_system(scene);
  const State rest = start_state(scene);
  Work work;
  const Eigen::MatrixXd K = -matrix_of(
      elastic_differential_at(system.forces, rest, Definiteness::exact, work), rest.x.cols());
  const double edge = L / columns, clamp = 1.01 * edge;  // two columns of particles are held
  std::vector<Eigen::Index> free;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(K.rows()), u = load;
  for (Eigen::Index i = 0; i < rest.x.cols(); ++i) {
    load[3 * i + 2] = -system.mass[i] * g;
    if (rest.x(0, i) > clamp) free.push_back(3 * i + 2);
  }
  u(free) = oracles::solve_linear(K(free, free), Eigen::VectorXd(load(free)));
  Strip strip{0, 0};
  int ends = 0;
  for (Eigen::Index i = 0; i < rest.x.cols(); ++i)
    if (rest.x(0, i) > L - 1e-9) strip.hinges += u[3 * i + 2], ++ends;
  strip.hinges /= ends;
  RestPlane plane;
  is_flat(scene.mesh, plane);
  const double of_ke = rigidity_of(scene.mesh, plane).of_strip(0);
  const int parts = 4000;
  for (int k = 0; k < parts; ++k) {
    const double s = edge + (L - edge) * (k + 0.5) / parts,
                 B = of_ke * ke * (s > L / 2 ? ratio : 1);
    // of the weight beyond s
    const double middle = std::max(s, L / 2);
    const double left = std::max(0.0, L / 2 - s);
    const double moment =
        g * (sigma[1] * (L - middle) * ((L + middle) / 2 - s) + sigma[0] * left * left / 2);
    strip.beam -= moment / B * (L - s) * (L - edge) / parts;
  }
  return strip;
}

Finding strip_finding() {
  Table errors{{"ratio of rigidities", "1"},
               {"columns", "1"},
               {"strip over beam, to that of one fabric", "1"},
               {"extrapolated", "1"},
               {"error", "1"}};
  for (const double ratio : {0.2, 4.5}) {
    double last = nan;
    for (const int columns : {20, 40, 80}) {
      const auto [hinges, beam] = strip_of(columns, ratio);
      const auto [of_one, beam_of_one] = strip_of(columns, 1);
      const double share = hinges / beam / (of_one / beam_of_one), extrapolated = 2 * share - last;
      errors.row(ratio, columns, share, extrapolated,
                 columns == 80 ? std::abs(extrapolated - 1) : 0);
      last = share;
    }
  }
  return judge_worst(
      errors, 0.01,
      "what a strip of few cells lacks is divided out by one of one fabric; the clamp and "
      "the border between the fabrics are known to half an edge, a first-order error "
      "that extrapolation takes out: what is left is a few times 1/80^2");
}

Finding rejected_finding() {
  const std::string parts = "[stretch]\nstiffness = 300\n";
  return rejected_cases({
      {parts + "[[fabric]]\ndensity = 0.3\n", {"needs one of 'group', 'box', 'triangles'"}},
      {parts + "[[fabric]]\ngroup = \"lining\"\n", {"no group 'lining'"}},
      {parts + "[[fabric]]\nbox = [[9, 9, 9], [10, 10, 10]]\n", {"no triangle lies in this box"}},
      {parts + "[[fabric]]\ntriangles = [3, 400]\n", {"triangle 400 does not exist"}},
      {parts + "[[fabric]]\ntriangles = [3]\ndensity = -1\n", {"'density'"}},
      {parts + "[[fabric]]\ntriangles = [3]\nbending = { stiffness = 1 }\n", {"[bending]"}},
      {parts + "[[fabric]]\ntriangles = [3]\n[[fabric]]\ntriangles = [3]\n",
       {"name all triangles of this one"}},
  });
}

}  // namespace

std::vector<Check> cloth_fabric_checks() {
  const std::string source = "cases/KEYS.md";
  return {
      {"fabrics.each-triangle-has-its-own",
       "Masses, springs and hinges are those of the fabrics that their triangles are of.", source,
       parts_finding},
      {"fabrics.strip-of-two-is-a-composite-beam",
       "A clamped strip of two fabrics sags as the beam of their rigidities.", source,
       strip_finding},
      {"fabrics.bad-regions-are-refused", "Regions and values that cannot be are refused.", source,
       rejected_finding},
  };
}

}  // namespace foldproof
