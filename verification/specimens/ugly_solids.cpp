#include "verification/specimens/ugly_solids.h"

#include <cmath>

namespace foldproof {

namespace {

using oracles::Whole2;
using oracles::Whole3;
using oracles::WholePrism;

/// Counter-clockwise about the origin, with every vertex visible from it; the rays' tips are two to
/// nine degrees sharp.
const std::vector<Whole2> star = {{40, 1},  {2, 2},   {3, 31},   {-2, 3},
                                  {-37, 2}, {-3, -2}, {-1, -29}, {2, -3}};

// A shear with whole-number inverse:  X = x + 2 z, Y = y + x + 2 z, Z = z - Y
Vector3 shear(const Vector3& p) {
  const double X = p.x() + 2 * p.z(), Y = p.y() + X;
  return {X, Y, p.z() - Y};
}

Whole3 unshear(const Whole3& p) {
  const long z = p[2] + p[1], y = p[1] - p[0], x = p[0] - 2 * z;
  return {x, y, z};
}

/// Appends the prism's triangles: fans about the centres of its two caps, and the sides,
/// each cut along the diagonal from its lower first corner. shell: even numbers face
/// outward, odd ones inward.
void add_prism(const WholePrism& prism, int shell, std::vector<Vector3>& vertices,
               std::vector<Triangle>& triangles) {
  const int first = int(vertices.size()), n = int(prism.polygon.size());
  for (const long height : {prism.low, prism.high}) {
    vertices.push_back(shear({0, 0, double(height)}));
    for (const Whole2& corner : prism.polygon)
      vertices.push_back(shear({double(corner[0]), double(corner[1]), double(height)}));
  }
  const auto add = [&](int a, int b, int c) {
    triangles.push_back(shell % 2 == 0 ? Triangle{a, b, c} : Triangle{a, c, b});
  };
  for (int k = 0; k < n; ++k) {
    const int a = first + 1 + k, b = first + 1 + (k + 1) % n;  // below; n + 1 further on: above
    add(first, b, a);
    add(first + n + 1, a + n + 1, b + n + 1);
    add(a, b, b + n + 1);
    add(a, b + n + 1, a + n + 1);
  }
}

WholePrism scaled_star(long across, long low, long high) {
  WholePrism prism{star, low, high};
  for (Whole2& corner : prism.polygon)
    for (long& coordinate : corner) coordinate *= across;
  return prism;
}

WholePrism in_units(WholePrism prism) {
  for (Whole2& corner : prism.polygon)
    for (long& coordinate : corner) coordinate *= units;
  return {prism.polygon, prism.low * units, prism.high * units};
}

UglySolid make(const std::string& name, const std::vector<WholePrism>& prisms) {
  std::vector<Vector3> vertices;
  UglySolid solid{name, {}, {}};
  for (size_t shell = 0; shell < prisms.size(); ++shell) {
    add_prism(prisms[shell], int(shell), vertices, solid.soup.triangles);
    solid.prisms.push_back(in_units(prisms[shell]));
  }
  solid.soup.rest.resize(3, Eigen::Index(vertices.size()));
  for (size_t v = 0; v < vertices.size(); ++v) solid.soup.rest.col(Eigen::Index(v)) = vertices[v];
  return solid;
}

}  // namespace

TriangleSoup soup_of(const TriangleMesh& mesh) { return {mesh.rest, mesh.triangles, {}}; }

TriangleSoup join(TriangleSoup first, const TriangleSoup& second, const Vector3& shift) {
  const int before = int(first.rest.cols());
  PerParticle3 rest(3, first.rest.cols() + second.rest.cols());
  rest << first.rest, second.rest.colwise() + shift;
  first.rest = rest;
  for (const Triangle& t : second.triangles)
    first.triangles.push_back({t[0] + before, t[1] + before, t[2] + before});
  return first;
}

std::vector<UglySolid> ugly_solids() {
  return {make("star", {scaled_star(1, -7, 12)}), make("fin", {scaled_star(1, 3, 4)}),
          make("shells", {scaled_star(4, -16, 15), scaled_star(3, -12, 13), scaled_star(2, -9, 8),
                          scaled_star(1, -3, 5)})};
}

int inside_exactly(const UglySolid& solid, const Vector3& p) {
  const Vector3 scaled_star = double(units) * p;
  return oracles::inside_nested(solid.prisms,
                                unshear({std::lround(scaled_star.x()), std::lround(scaled_star.y()),
                                         std::lround(scaled_star.z())}));
}

}  // namespace foldproof
