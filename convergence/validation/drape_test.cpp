#include "convergence/validation/drape_test.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "convergence/validation/freedoms.h"
#include "verification/oracles/exact_crossings.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr double ring_width = specimen_radius - plate_radius;  // m

/// Ring j has 6 j vertices, from `first`, which is half a row inside the plate, to
/// `last`, the edge.
struct Rings {
  int first, last;
  double spacing;  // m

  double radius(int j) const { return plate_radius + (j - first - 0.5) * spacing; }
};

/// Triangles are equilateral halfway between the rim and the edge.
Rings rings_of(int rows) {
  const double spacing = ring_width / (rows + 0.5);
  const double middle = (specimen_radius + plate_radius) / 2 * std::numbers::sqrt3 / 2;
  // 6 j edges of length spacing / (sqrt(3)/2) around the middle
  const double j = 2 * pi * middle / (6 * spacing);
  const int first = int(std::lround(j - (rows + 0.5) / 2 - 0.5));
  return {first, first + rows + 1, spacing};
}

TriangleMesh ring_mesh(const Rings& rings) {
  const auto start = [&](int j) { return 3 * (j * (j - 1) - rings.first * (rings.first - 1)); };
  const auto vertex = [&](int j, int k) { return start(j) + k % (6 * j); };
  PerParticle3 rest(3, start(rings.last + 1));
  for (int j = rings.first; j <= rings.last; ++j)
    for (int k = 0; k < 6 * j; ++k) {
      const double angle = 2 * pi * k / (6 * j);
      rest.col(vertex(j, k)) = rings.radius(j) * Vector3(std::cos(angle), std::sin(angle), 0);
    }
  std::vector<Triangle> triangles;
  for (int j = rings.first; j < rings.last; ++j)
    for (int sector = 0; sector < 6; ++sector)
      for (int k = 0; k <= j; ++k) {
        const int inner = sector * j + k, outer = sector * (j + 1) + k;
        triangles.push_back({vertex(j, inner), vertex(j + 1, outer), vertex(j + 1, outer + 1)});
        if (k < j)
          triangles.push_back({vertex(j, inner), vertex(j + 1, outer + 1), vertex(j, inner + 1)});
      }
  return make_triangle_mesh(std::move(rest), std::move(triangles));
}

/// The rigidity of narrow strips of such a mesh over ke, in the mean of two directions [1].
double rigidity_ratio() {
  static const double ratio = [] {
    const FabricOnMesh on =
        fabric_on_mesh({"unit", "", "", "", "", 1, {1, 1}, nan, {}}, ring_mesh(rings_of(60)));
    return on.rigidity_ratio * (1 + on.second_over_first) / 2;
  }();
  return ratio;
}

double largest_strain(const TriangleMesh& mesh, const PerParticle3& x) {
  const Eigen::VectorXd rest = rest_lengths(mesh);
  double largest = 0;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const double length = (x.col(mesh.edges[e].a) - x.col(mesh.edges[e].b)).norm();
    largest = std::max(largest, std::abs(length / rest[Eigen::Index(e)] - 1));
  }
  return largest;
}

}  // namespace

const std::vector<DrapeFabric>& drape_fabrics() {
  static const std::vector<DrapeFabric> fabrics{{"wool", 5.29e-6, 0.168},
                                                {"denim", 20.143504e-6, 0.324},
                                                {"interlock", 4.682415e-6, 0.187},
                                                {"ponte-roma", 9.188245e-6, 0.284},
                                                {"rib-knit", 9.810185e-6, 0.276}};
  return fabrics;
}

double bending_length(const DrapeFabric& fabric) {
  return std::cbrt(fabric.rigidity / (fabric.density * gravity));
}

const std::vector<MeasuredDrape>& measured_drapes() {
  static const std::vector<MeasuredDrape> drapes{{{"polyester-twill", 1.28e-6, 0.13517}, 41, 0.223},
                                                 {{"polyester-plain", 0.59e-6, 0.08366}, 46, 0.228},
                                                 {{"wool-twill", 2.07e-6, 0.1787}, 50, 0.349},
                                                 {{"viscose-twill", 2.685e-6, 0.28613}, 61, 0.286},
                                                 {{"elastane-plain", 3.55e-6, 0.242}, 57, 0.443},
                                                 {{"cotton-twill", 5.565e-6, 0.25336}, 126, 0.549}};
  return drapes;
}

Scene ring_of_cloth(const DrapeTest& test) {
  const Rings rings = rings_of(test.rows);
  Scene scene = scene_at_rest(ring_mesh(rings), test.fabric.density);
  add_flat_hinges(scene, test.fabric.rigidity / rigidity_ratio(), 0);
  scene.stretch = StretchMaterial{test.stretch * test.fabric.density * gravity * ring_width, 0, 1};
  scene.gravity = Vector3(0, 0, -gravity);
  const double rim = rings.radius(rings.first + 1);
  for (int i = 0; i < scene.mesh.particles(); ++i) {
    const Vector3 at = scene.mesh.rest.col(i);
    const double beyond = at.norm() - rim;
    if (beyond < 0.5 * rings.spacing)
      scene.prescribed.push_back({i, at, Motion{}});
    else  // not along the mesh's own six axes
      scene.x(2, i) += beyond * std::cos(test.waves * (std::atan2(at.y(), at.x()) - 0.1));
  }
  return scene;
}

Drape drape(const Subject& subject, const DrapeTest& test) {
  const Scene scene = ring_of_cloth(test);
  const Equilibrium rest = equilibrium_of(subject, scene);
  Drape result{oracles::outline_of(rest.x, scene.mesh.triangles, plate_radius, 1440),
               0,
               0,
               rest.unbalanced,
               rest.stable,
               0,
               largest_strain(scene.mesh, rest.x)};
  result.coefficient = oracles::drape_coefficient(result.outline, drape_radii);
  result.folds = oracles::folds_of(result.outline, least_fold);
  result.crossings = long(oracles::exact_crossings(rest.x, scene.mesh.triangles).size());
  return result;
}

}  // namespace foldproof
