// Several fabrics in one cloth: masses, springs and hinges of each, and a strip of two against the
// beam.
#include "reference/scene/cloth_fabrics.h"

#include "reference/mesh/mesh_file.h"
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

const std::string right_half = "[[fabric]]\nbox = [[0.3, -1, -1], [1, 1, 1]]\n";

/// The particles of one fabric only: -1 of the left one, 1 of the right one, 0 of both.
std::vector<int> sides_of(const Scene& scene) {
  std::vector<int> left(size_t(scene.x.cols()), 0), right = left;
  for (int t = 0; t < int(scene.mesh.triangles.size()); ++t)
    for (const int i : scene.mesh.triangles[size_t(t)])
      (is_right(scene, t) ? right : left)[size_t(i)] = 1;
  for (size_t i = 0; i < left.size(); ++i) left[i] = right[i] - left[i];
  return left;
}

template <class Wanted>
const Wanted& filter_of(const System& system) {
  for (const Filter& filter : system.filters)
    if (const auto* wanted = std::get_if<Wanted>(&filter)) return *wanted;
  throw std::logic_error("the system has no such filter");
}

/// A sheet that its velocity would stretch, and compress, beyond all limits in one step.
Finding limits_finding() {
  const Scene scene = trial_scene(
      "[stretch]\nstiffness = 300\n[strain_limits]\nextension = 0.2\ncompression = 0.1\n"
      "sweeps = 4000\ntolerance = 1e-7\n" +
      right_half + "strain_limits = { extension = 0.04, compression = 0.02 }\n");
  const System system = build_system(scene);
  const State s = start_state(scene);
  const double h = 0.01;
  Differences differences;
  for (const double strain : {0.6, -0.6}) {
    PerParticle3 v = strain / h * s.x;
    Work work;
    filter_of<StrainLimiter>(system).correct({0, h, h}, s, v, work);
    double most[2] = {0, 0};  // of edges of one fabric, signed as the strain
    for (const Edge& edge : scene.mesh.edges) {
      const Vector3 before = s.x.col(edge.b) - s.x.col(edge.a),
                    after = before + h * (v.col(edge.b) - v.col(edge.a));
      const double of_edge = (after.norm() / before.norm() - 1) * (strain > 0 ? 1 : -1);
      bool right = false;
      for (const int t : edge.triangles) right = right || (t >= 0 && is_right(scene, t));
      most[right] = std::max(most[right], of_edge);
    }
    const double limits[2] = {strain > 0 ? 0.2 : 0.1, strain > 0 ? 0.04 : 0.02};
    for (const int right : {0, 1})
      differences.is_near(strain > 0 ? "extension" : "compression",
                          std::abs(most[right] - limits[right]), 1e-6 / epsilon);
  }
  return differences.judged(1,
                            "within ten times the tolerance of the sweeps, 1e-7: springs that "
                            "end a sweep are at their limit to that, others left it since");
}

/// Particles slide over the ground at v, pressed down at w for a step: Coulomb takes mu w, and the
/// least of the two where it stops them.
Finding friction_finding() {
  const std::string ground = "[[object]]\nshape = \"half_space\"\nfriction = 0.3\n";
  Differences differences;
  for (const bool own : {false, true}) {
    const Scene scene =
        trial_scene(ground + right_half + (own ? "friction = 0.9\n" : "density = 0.4\n"));
    const System system = build_system(scene);
    const State s = start_state(scene);  // at z = 0, on the ground
    PerParticle3 v = PerParticle3::Zero(3, s.x.cols());
    v.row(0).setConstant(2);
    v.row(2).setConstant(-0.7);
    Work work;
    filter_of<ObjectCollision>(system).correct({0, 0.01, 0.01}, s, v, work);
    const std::vector<int> sides = sides_of(scene);
    for (const int side : {-1, 1}) {
      double error = 0;
      for (size_t i = 0; i < sides.size(); ++i) {
        if (sides[i] != side) continue;
        const double mu = own && side > 0 ? 0.9 : 0.3;
        error = std::max(error, std::abs(v(0, Eigen::Index(i)) - (2 - 0.7 * mu)));
      }
      differences.is_near(own ? "a coefficient of its own" : "the ground's", error, 2);
    }
  }
  return differences.judged(8, "a product and a difference");
}

/// Two layers 4 mm apart at rest: those with 6 mm repel each other, those with 2 mm do not.
Finding layers_finding() {
  const std::string layers =
      "[cloth]\nshape = \"sheet\"\nwidth = 0.6\nheight = 0.43\ncolumns = 4\nrows = 3\n"
      "density = 0.23\ncopies = { count = 2, move = [0, 0, 0.004] }\n"
      "[self_collision]\nthickness = 0.002\nstiffness = 30\nfriction = 0.5\n";
  const Scene scene = read_scene_text(
      layers + right_half + "self_collision = { thickness = 0.006, friction = 0.1 }\n" + short_time,
      "layers.toml");
  const System system = build_system(scene);
  const auto& filter = filter_of<SelfCollision>(system);
  Differences differences;
  const std::vector<int> sides = sides_of(scene);
  const double h = 0.001;
  State s = start_state(scene);
  PerParticle3 still = PerParticle3::Zero(3, s.x.cols()), moved = still;
  const Eigen::Index half = s.x.cols() / 2;
  moved.row(0).tail(half).setConstant(0.3);  // the upper layer slides and comes nearer
  moved.row(2).tail(half).setConstant(-0.5);
  Work work;
  filter.correct({0, h, h}, s, still, work);
  filter.correct({0, 0, h}, s, moved, work);
  double thin = 0, least = INFINITY, slip = 0;
  for (Eigen::Index i = half; i < s.x.cols(); ++i) {
    if (sides[size_t(i)] < 0) thin = std::max(thin, still.col(i).norm());
    if (sides[size_t(i)] > 0) least = std::min(least, still(2, i));
    if (sides[size_t(i)] > 0)
      slip = std::max(slip, std::abs((0.3 - moved(0, i)) - 0.1 * (moved(2, i) + 0.5)));
  }
  differences.is("thin layers 4 mm apart stay as they are", thin == 0);
  differences.is("thick layers 4 mm apart part", least > 0);
  differences.is_near("friction over the push between thick layers", slip, 0.1 / epsilon * 0.05);
  return differences.judged(1,
                            "a vertex over a triangle gives its impulse to three others: the "
                            "ratio of both velocities stays within a twentieth");
}

/// The membrane of each triangle, by the energy that a strain along x stores.
Finding membrane_finding() {
  const Scene scene = trial_scene("[membrane]\nwarp = 200\n" + right_half +
                                  "membrane = { warp = 500, weft = 90 }\n");
  const System system = build_system(scene);
  const Eigen::VectorXd areas = rest_areas(scene.mesh);
  double right = 0;
  for (int t = 0; t < areas.size(); ++t) right += is_right(scene, t) * areas[t];
  const double left = areas.sum() - right, strain = 1e-3,
               E = strain + strain * strain / 2;  // Green's
  Differences differences;
  for (const int axis : {0, 1}) {
    State s = start_state(scene);
    s.x.row(axis) *= 1 + strain;
    const double wanted = (left * 200 + right * (axis == 0 ? 500 : 90)) * E * E / 2;
    differences.is_near(axis == 0 ? "warp" : "weft", energies(system, s).stretch - wanted,
                        wanted / strain);
  }
  return differences.judged(32, "places of size 1 give strains of 1e-3 to 1e-13 of themselves");
}

/// Regions by the records g, o and usemtl of the mesh's file.
Finding materials_finding() {
  Differences differences;
  const MeshFile file = read_mesh_text(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no shirt\nusemtl denim\ng front\nf 1 2 3\n"
      "usemtl lace\nf 1 3 4\n",
      "two.obj");
  const auto is = [&](const std::string& name, const std::vector<int>& triangles) {
    const auto found = file.groups.find(name);
    differences.is(name, found != file.groups.end() && found->second == triangles);
  };
  is("shirt", {0, 1});
  is("front", {0, 1});
  is("denim", {0});
  is("lace", {1});
  return differences.judged(0, "each is named");
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
      {parts + "[[fabric]]\ntriangles = [3]\nmembrane = { warp = 1 }\n", {"[membrane]"}},
      {parts + "[[fabric]]\ntriangles = [3]\nstrain_limits = { extension = 1 }\n",
       {"[strain_limits]"}},
      {parts + "[[fabric]]\ntriangles = [3]\nself_collision = { thickness = 0.001 }\n",
       {"[self_collision]"}},
      {parts + "[[fabric]]\ntriangles = [3]\nfriction = -0.1\n", {"'friction'"}},
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
      {"fabrics.have-limits-of-their-own",
       "Springs of each fabric stay within its strain limits, those between two within the "
       "narrower.",
       source, limits_finding},
      {"fabrics.have-friction-of-their-own",
       "Particles of each fabric slide on an object with its coefficient.", source,
       friction_finding},
      {"fabrics.have-layers-of-their-own",
       "Layers repel each other within the thickness of their fabrics, with its friction.", source,
       layers_finding},
      {"fabrics.have-membranes-of-their-own",
       "Triangles of each fabric store energy by its moduli.", source, membrane_finding},
      {"fabrics.regions-are-named-in-files",
       "Groups, objects and materials of an OBJ file name regions.", source, materials_finding},
      {"fabrics.bad-regions-are-refused", "Regions and values that cannot be are refused.", source,
       rejected_finding},
  };
}

}  // namespace foldproof
