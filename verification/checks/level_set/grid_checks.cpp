// Checks of signed distance on a grid: interpolation, the narrow band, points outside the lattice.
#include "reference/level_set/narrow_band.h"
#include "verification/specimens/check.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/ugly_solids.h"

namespace foldproof {

namespace {

const Lattice odd_lattice{{-0.31, 0.17, 1.9}, 0.043, {9, 7, 11}};

Grid sampled(const Lattice& lattice, const std::function<double(const Vector3&)>& phi) {
  Grid grid{lattice, {}};
  for (long i = 0; i < lattice.size(); ++i)
    grid.phi.push_back(phi(lattice.position(lattice.node(i))));
  return grid;
}

Vector3 inside(Random& random, const Lattice& lattice, double inset) {
  Vector3 p;
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = lattice.spacing * random.uniform(inset, lattice.nodes[axis] - 1 - inset);
  return lattice.origin + p;
}

// phi = c0 + c1 x + c2 y + c3 z + c4 x y + c5 y z + c6 z x + c7 x y z, about the lattice's origin
struct Multilinear {
  std::array<double, 8> c;
  double value(const Vector3& q) const {
    return c[0] + c[1] * q.x() + c[2] * q.y() + c[3] * q.z() + c[4] * q.x() * q.y() +
           c[5] * q.y() * q.z() + c[6] * q.z() * q.x() + c[7] * q.x() * q.y() * q.z();
  }
  Vector3 gradient(const Vector3& q) const {
    return {c[1] + c[4] * q.y() + c[6] * q.z() + c[7] * q.y() * q.z(),
            c[2] + c[4] * q.x() + c[5] * q.z() + c[7] * q.x() * q.z(),
            c[3] + c[5] * q.y() + c[6] * q.x() + c[7] * q.x() * q.y()};
  }
};

Finding cell_is_trilinear() {
  const Multilinear truth{{0.3, -1.1, 0.7, 1.7, 2.3, -3.1, 1.3, 5.9}};
  const Vector3 origin = odd_lattice.origin;
  const Grid grid = sampled(odd_lattice, [&](const Vector3& p) { return truth.value(p - origin); });
  Random random(79);
  Worst value, gradient, at;
  for (int i = 0; i < 1000; ++i) {
    const Vector3 p = inside(random, odd_lattice, 0);
    const Distance found = grid.in_cell(p);
    const double exact = truth.value(p - origin);
    value.observe(std::abs(found.phi - exact) / epsilon);
    at.observe(std::abs(grid.at(p).phi - exact) / epsilon);
    gradient.observe((found.normal - truth.gradient(p - origin)).norm() /
                     (epsilon / odd_lattice.spacing));
  }
  Table measured = roundings_of("(of values near 1, of their differences over h)");
  measured.row("value in the cell", value.value());
  measured.row("value of the blend", at.value());
  measured.row("gradient of the cell", gradient.value());
  return judge_worst(measured, 32,
                     "eight products of three weights, each with a few roundings of values near 1; "
                     "differences of such values are divided by h");
}

/// Differences over two cells are exact for quadratics; so is their interpolation, which is linear.
Finding nodal_gradient_is_exact() {
  Eigen::Matrix3d curvature;
  curvature << 1.9, 0.3, -0.7, 0.3, -1.1, 0.5, -0.7, 0.5, 0.8;
  const Vector3 slope(1.7, -2.3, 3.1), origin = odd_lattice.origin;
  const Grid grid = sampled(odd_lattice, [&](const Vector3& p) {
    const Vector3 q = p - origin;
    return slope.dot(q) + 0.5 * q.dot(curvature * q);
  });
  Random random(83);
  Worst direction;
  for (int i = 0; i < 1000; ++i) {
    const Vector3 p = inside(random, odd_lattice, 1);
    const Vector3 gradient = slope + curvature * (p - origin);
    direction.observe((grid.at(p).normal - gradient.normalized()).norm() /
                      (epsilon / odd_lattice.spacing));
  }
  Table measured = roundings_of("/h of values near 1");
  measured.row("direction", direction.value());
  return judge_worst(
      measured, 32,
      "differences of values near 1 are divided by 2 h, blended and made a unit vector");
}

/// Outside its lattice a sphere's grid must still return the distance: too small only by the
/// border's error, and too large only because the search is cut short.
Finding beyond_is_distance() {
  constexpr double radius = 0.7, too_small = 0.05, too_large = 0.01, turned = 0.13, jumps = 1e-6;
  const Sphere sphere{radius};
  const Lattice lattice =
      lattice_about(Bounds(Vector3::Constant(-radius), Vector3::Constant(radius)), 40, 3);
  const Grid grid = sampled(lattice, [&](const Vector3& p) { return sphere.at(p).phi; });
  Random random(89);
  Worst below, above, normal, jump;
  for (int i = 0; i < 3000; ++i) {
    const Vector3 p = random.vectors(1, 3).col(0);
    if (lattice.bounds().contains(p)) continue;
    const Distance found = grid.at(p), exact = sphere.at(p);
    below.observe((exact.phi - found.phi) / (too_small * lattice.spacing));
    above.observe((found.phi - exact.phi) / (too_large * exact.phi));
    normal.observe((found.normal - exact.normal).norm() / turned);
    const Vector3 edge = p.cwiseMax(lattice.bounds().min()).cwiseMin(lattice.bounds().max());
    const Vector3 out = edge + 1e-9 * (p - edge).normalized();
    jump.observe(std::abs(grid.at(out).phi - grid.at((1 - 1e-9) * edge).phi) /
                 (jumps * lattice.spacing));
  }
  Table measured{{"case", ""}, {"error over what is allowed", "1"}};
  measured.row("phi below the distance", below.value());
  measured.row("phi above the distance", above.value());
  measured.row("direction", normal.value());
  measured.row("jump at the border", jump.value());
  measured.row("no number where there is no point",
               std::isnan(grid.at({0.1, NAN, 0.2}).phi) ? 0 : 2);
  return judge_worst(
      measured, 1,
      "below: h^2/(4 R) of trilinear values is a hundredth of a cell, one-sided differences add as "
      "much; above and direction: a round leaves 4/5 of the angle between the point found and the "
      "nearest, six rounds a quarter of at most half a radian, 0.13, and the distance errs by the "
      "square of that; jump: points 2e-9 apart");
}

Finding band_is_exact() {
  constexpr double cells = 2.5;
  Table measured{{"case", ""}, {"nodes missing, superfluous or with another value", "1"}};
  std::vector<std::pair<std::string, MeshDistance>> meshes;
  meshes.emplace_back("statue", make_mesh_distance(small_statue().rest, small_statue().triangles));
  for (const UglySolid& solid : ugly_solids())
    meshes.emplace_back(solid.name, make_mesh_distance(solid.soup.rest, solid.soup.triangles));
  for (const auto& [name, mesh] : meshes) {
    const Lattice lattice = lattice_about(mesh.tree.nodes[0].bounds, 33, 3);
    const Seeds seeds = narrow_band(mesh, lattice, cells);
    std::vector<double> phi(lattice.size(), NAN);
    for (size_t i = 0; i < seeds.nodes.size(); ++i) phi[seeds.nodes[i]] = seeds.phi[i];
    int wrong =
        int(seeds.nodes.size()) -
        int(std::count_if(phi.begin(), phi.end(), [](double value) { return !std::isnan(value); }));
    const double reach =
        lattice.bounds().min().cwiseAbs().cwiseMax(lattice.bounds().max().cwiseAbs()).norm();  // m
    for (long i = 0; i < lattice.size(); ++i) {
      const double exact = mesh.at(lattice.position(lattice.node(i))).phi,
                   width = cells * lattice.spacing;
      if (std::isnan(phi[i]) ? std::abs(exact) < width * (1 - 1e-12)
                             : !(std::abs(phi[i] - exact) <= 4 * epsilon * reach))
        ++wrong;
    }
    measured.row(name, wrong);
  }
  return judge_worst(measured, 0,
                     "blocks and bounds skip only triangles farther away than the band's width");
}

}  // namespace

std::vector<Check> grid_checks() {
  return {
      {"level-set.cells-interpolate-trilinearly",
       "Between nodes the grid's value and its gradient are those of the trilinear interpolant.",
       "BMF03 section 5.1", cell_is_trilinear},
      {"level-set.nodal-gradient-is-exact-for-quadratics",
       "The blend of the nodes' differences has the direction of a quadratic's gradient, to "
       "rounding.",
       "ours", nodal_gradient_is_exact},
      {"level-set.distance-continues-beyond-the-grid",
       "Outside its lattice a grid gives the distance, without a jump at the border.", "ours",
       beyond_is_distance},
      {"level-set.band-is-exact",
       "The narrow band holds all nodes within its width, with the mesh's exact signed distance.",
       "BMF03 section 5.1", band_is_exact}};
}

}  // namespace foldproof
