// Meshes made by code are what they promise to be.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>

#include "reference/mesh/shapes.h"
#include "reference/mesh/triangle_mesh.h"

using namespace foldproof;

namespace {

const double epsilon = std::numeric_limits<double>::epsilon();

const std::vector<SheetPattern> all_patterns = {
    SheetPattern::one_diagonal,   SheetPattern::alternating, SheetPattern::union_jack,
    SheetPattern::criss_cross,    SheetPattern::equilateral, SheetPattern::jittered,
    SheetPattern::random_delaunay};

Sheet sheet_of(SheetPattern pattern) { return {pattern, 1.3, 0.9, 13, 10, 0.3, 7}; }

struct Shape {
  std::string name;
  TriangleMesh mesh;
  int euler;    // V - E + F
  double area;  // m^2; 0: not known
};

std::vector<Shape> all_shapes() {
  std::vector<Shape> shapes;
  for (SheetPattern pattern : all_patterns) {
    shapes.push_back(
        {"sheet " + std::to_string(int(pattern)), make_sheet(sheet_of(pattern)), 1, 1.3 * 0.9});
  }
  const double ico_edge = 4 * 0.7 / std::sqrt(10 + 2 * std::sqrt(5.0));
  shapes.push_back({"disc", make_disc(0.7, 5), 1, 30 * 0.5 * 0.7 * 0.7 * std::sin(2 * pi / 30)});
  shapes.push_back(
      {"cylinder", make_cylinder(0.3, 1.1, 17, 9), 0, 17 * 2 * 0.3 * std::sin(pi / 17) * 1.1});
  shapes.push_back(
      {"icosahedron", make_icosphere(0.7, 0), 2, 5 * std::sqrt(3.0) * ico_edge * ico_edge});
  shapes.push_back({"sphere", make_icosphere(0.7, 3), 2, 0});
  shapes.push_back({"statue", make_statue(1.7, 3), 2, 0});
  shapes.push_back({"hinge", make_hinge(0.3, 0.6), 1, 0.5 * 0.3 * 0.3 * (0.9 + 0.6)});
  return shapes;
}

/// Triangles compared from their smallest particle on: orientation counts, the first
/// corner does not.
Triangle from_smallest(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

double least_angle(const TriangleMesh& mesh) {
  double least = pi;
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vector3 a = mesh.rest.col(t[(k + 1) % 3]) - mesh.rest.col(t[k]);
      const Vector3 b = mesh.rest.col(t[(k + 2) % 3]) - mesh.rest.col(t[k]);
      least = std::min(least, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  return least;
}

/// theta of BMF03 section 4, from N1 to N2 about E.
double fold_angle(const Hinge& hinge, const PerParticle3& x) {
  const auto [v1, v2, v3, v4] = hinge.particles;
  const Vector3 x1 = x.col(v1), x2 = x.col(v2), x3 = x.col(v3), x4 = x.col(v4);
  const Vector3 N1 = (x1 - x3).cross(x1 - x4), N2 = (x2 - x4).cross(x2 - x3), E = x4 - x3;
  return std::atan2(N1.cross(N2).dot(E.normalized()), N1.dot(N2));
}

/// Numbers of edges at the particles off the border, each with how many particles have it.
std::map<int, int> interior_degrees(const TriangleMesh& mesh) {
  std::vector<int> degree(mesh.particles(), 0);
  std::vector<char> border(mesh.particles(), 0);
  for (const Edge& edge : mesh.edges) {
    for (int v : {edge.a, edge.b}) {
      ++degree[v];
      if (edge.triangles[1] < 0) border[v] = 1;
    }
  }
  std::map<int, int> counts;
  for (int v = 0; v < mesh.particles(); ++v) {
    if (!border[v]) ++counts[degree[v]];
  }
  return counts;
}

double six_volumes(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// Edges that pierce a triangle with which they share no particle, by more than 1e-9 m on both
/// sides (a flat base does not count).
int piercings(const TriangleMesh& mesh) {
  int count = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vector3 a = mesh.rest.col(t[0]), b = mesh.rest.col(t[1]), c = mesh.rest.col(t[2]);
    const Vector3 lower = a.cwiseMin(b).cwiseMin(c), upper = a.cwiseMax(b).cwiseMax(c);
    for (const Edge& edge : mesh.edges) {
      if (std::count(t.begin(), t.end(), edge.a) + std::count(t.begin(), t.end(), edge.b) > 0)
        continue;
      const Vector3 p = mesh.rest.col(edge.a), q = mesh.rest.col(edge.b);
      if ((p.cwiseMax(q).array() < lower.array()).any() ||
          (p.cwiseMin(q).array() > upper.array()).any())
        continue;
      const Vector3 normal = (b - a).cross(c - a).normalized();
      const double side_p = normal.dot(p - a), side_q = normal.dot(q - a);
      if (!(std::min(side_p, side_q) < -1e-9 && std::max(side_p, side_q) > 1e-9)) continue;
      const double s = six_volumes(p, q, a, b), u = six_volumes(p, q, b, c),
                   w = six_volumes(p, q, c, a);
      count += (s >= 0 && u >= 0 && w >= 0) || (s <= 0 && u <= 0 && w <= 0);
    }
  }
  return count;
}

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    sum += six_volumes(Vector3::Zero(), mesh.rest.col(t[0]), mesh.rest.col(t[1]),
                       mesh.rest.col(t[2])) /
           6;
  }
  return sum;
}

}  // namespace

TEST_CASE("mesh: every hinge names the triangles (x1, x3, x4) and (x2, x4, x3) of its edge") {
  for (const Shape& shape : all_shapes()) {
    const TriangleMesh& mesh = shape.mesh;
    INFO(shape.name);
    size_t hinge = 0, wrong = 0;
    for (int e = 0; e < int(mesh.edges.size()); ++e) {
      const Edge& edge = mesh.edges[e];
      wrong += !(edge.a < edge.b);
      if (e > 0)
        wrong += !(std::pair{mesh.edges[e - 1].a, mesh.edges[e - 1].b} < std::pair{edge.a, edge.b});
      if (edge.triangles[1] < 0) continue;
      const auto [x1, x2, x3, x4] = mesh.hinges.at(hinge).particles;
      wrong += mesh.hinges[hinge].edge != e || x3 != edge.a || x4 != edge.b;
      wrong += from_smallest(mesh.triangles[edge.triangles[0]]) != from_smallest({x1, x3, x4});
      wrong += from_smallest(mesh.triangles[edge.triangles[1]]) != from_smallest({x2, x4, x3});
      ++hinge;
    }
    CHECK(wrong == 0);
    CHECK(hinge == mesh.hinges.size());
    CHECK(3 * mesh.triangles.size() == mesh.edges.size() + mesh.hinges.size());
  }
}

TEST_CASE("mesh: shapes have the Euler characteristic and the area of what they stand for") {
  for (const Shape& shape : all_shapes()) {
    INFO(shape.name);
    CHECK(euler_characteristic(shape.mesh) == shape.euler);
    CHECK((shape.mesh.hinges.size() == shape.mesh.edges.size()) == (shape.euler == 2));
    const double total = triangle_areas(shape.mesh.triangles, shape.mesh.rest).sum();
    const double rounding = 4 * double(shape.mesh.triangles.size()) * epsilon * total;
    if (shape.area > 0) CHECK(std::abs(total - shape.area) <= rounding);
    CHECK(std::abs(lumped_masses(shape.mesh, 0.37).sum() - 0.37 * total) <= rounding);
    CHECK(std::abs(edge_areas(shape.mesh).sum() - 3 * total) <= 3 * rounding);
    CHECK(lumped_masses(shape.mesh, 0.37).minCoeff() > 0);
  }
}

TEST_CASE("mesh: masses, lengths and areas of one cell are those worked out by hand") {
  const TriangleMesh mesh = make_sheet({SheetPattern::one_diagonal, 3, 4, 1, 1, 0, 0});
  const PerParticle masses = lumped_masses(mesh, 0.5);  // triangles of 6 m^2: 1 kg to each corner
  CHECK(masses == Eigen::Vector4d(2, 1, 1, 2));
  REQUIRE(mesh.edges.size() == 5);
  const Eigen::VectorXd lengths = rest_lengths(mesh), areas = edge_areas(mesh);
  const std::vector<std::array<double, 4>> by_hand = {
      {0, 1, 3, 6}, {0, 2, 4, 6}, {0, 3, 5, 12}, {1, 3, 4, 6}, {2, 3, 3, 6}};  // a, b, length, area
  for (int e = 0; e < 5; ++e) {
    CHECK(std::array<double, 4>{double(mesh.edges[e].a), double(mesh.edges[e].b), lengths[e],
                                areas[e]} == by_hand[e]);
  }
  CHECK(mesh.hinges[0].particles == std::array<int, 4>{2, 1, 0, 3});
}

TEST_CASE("mesh: patterns have the vertex degrees that define them") {
  const auto degrees = [](SheetPattern pattern) {
    return interior_degrees(make_sheet(sheet_of(pattern)));
  };
  CHECK(degrees(SheetPattern::one_diagonal) == std::map<int, int>{{6, 108}});
  CHECK(degrees(SheetPattern::alternating) == std::map<int, int>{{6, 108}});
  // the first triangle of the second row of cells tells the two apart
  CHECK(make_sheet(sheet_of(SheetPattern::one_diagonal)).triangles[26] == Triangle{14, 15, 29});
  CHECK(make_sheet(sheet_of(SheetPattern::alternating)).triangles[26] == Triangle{14, 15, 28});
  CHECK(degrees(SheetPattern::union_jack) == std::map<int, int>{{4, 54}, {8, 54}});
  CHECK(degrees(SheetPattern::criss_cross) == std::map<int, int>{{4, 130}, {8, 108}});
  CHECK(degrees(SheetPattern::equilateral) == std::map<int, int>{{6, 5 * 13 + 4 * 12}});
  CHECK(degrees(SheetPattern::jittered).size() > 2);
  CHECK(degrees(SheetPattern::random_delaunay).size() > 2);
}

TEST_CASE("mesh: sheets lie in z = 0, face +z, fill their rectangle and repeat bit for bit") {
  for (SheetPattern pattern : all_patterns) {
    const TriangleMesh mesh = make_sheet(sheet_of(pattern));
    CHECK(mesh.rest.rowwise().minCoeff() == Vector3(0, 0, 0));
    CHECK(mesh.rest.rowwise().maxCoeff() == Vector3(1.3, 0.9, 0));
    int turned = 0;
    for (const Triangle& t : mesh.triangles) {
      const Vector3 a = mesh.rest.col(t[0]), b = mesh.rest.col(t[1]), c = mesh.rest.col(t[2]);
      turned += !((b - a).cross(c - a).z() > 0);
    }
    CHECK(turned == 0);
    CHECK(make_sheet(sheet_of(pattern)).rest == mesh.rest);
    CHECK(make_sheet(sheet_of(pattern)).triangles == mesh.triangles);
  }
}

TEST_CASE("mesh: graded sheets grow by one factor from cell to cell, and refuse what cannot grow") {
  const double growth = std::pow(1000.0, 1.0 / 7);
  const TriangleMesh mesh = make_sheet({SheetPattern::union_jack, 1.3, 0.9, 8, 5, 0, 0, 1000});
  const auto width = [&](int column) { return mesh.rest(0, column + 1) - mesh.rest(0, column); };
  for (int column = 0; column < 7; ++column)
    CHECK(width(column + 1) / width(column) == Approx(growth));
  CHECK(width(7) / width(0) == Approx(1000));
  CHECK(mesh.rest.rowwise().maxCoeff() == Vector3(1.3, 0.9, 0));
  CHECK(triangle_areas(mesh.triangles, mesh.rest).sum() == Approx(1.3 * 0.9));
  const TriangleMesh crossed = make_sheet({SheetPattern::criss_cross, 1.3, 0.9, 8, 5, 0, 0, 30});
  CHECK(triangle_areas(crossed.triangles, crossed.rest).minCoeff() > 0);

  CHECK_THROWS_WITH(make_sheet({SheetPattern::one_diagonal, 1.3, 0.9, 8, 5, 0, 0, -2}),
                    Catch::Matchers::Contains("grading is -2"));
  CHECK_THROWS_WITH(make_sheet({SheetPattern::jittered, 1.3, 0.9, 8, 5, 0.1, 0, 3}),
                    Catch::Matchers::Contains("union_jack"));
  CHECK_THROWS_WITH(make_sheet({SheetPattern::one_diagonal, 1.3, 0.9, 8, 1, 0, 0, 3}),
                    Catch::Matchers::Contains("two columns and rows"));
}

TEST_CASE(
    "mesh: equilateral sheets of free height have equal edges, but for the halves on the border") {
  const TriangleMesh mesh = make_sheet({SheetPattern::equilateral, 1.3, 0, 13, 10, 0, 0});
  const Eigen::VectorXd lengths = rest_lengths(mesh);
  const double edge = 1.3 / 13;
  int whole = 0, half = 0;
  for (const Hinge& hinge : mesh.hinges) {
    whole += std::abs(lengths[hinge.edge] - edge) < 20 * epsilon;
    half += std::abs(lengths[hinge.edge] - edge / 2) < 20 * epsilon;
  }
  CHECK(half == 2 * 5);  // both ends of the five odd rows
  CHECK(whole + half == int(mesh.hinges.size()));
  CHECK(std::abs(mesh.rest.row(1).maxCoeff() - 10 * edge * std::sqrt(0.75)) < 20 * epsilon);
}

TEST_CASE(
    "mesh: jitter moves interior vertices by at most its fraction of the edge, and no others") {
  Sheet sheet = sheet_of(SheetPattern::jittered);
  sheet.height = 0;
  const PerParticle3 jittered = make_sheet(sheet).rest;
  sheet.pattern = SheetPattern::equilateral;
  const PerParticle3 regular = make_sheet(sheet).rest;
  int moved = 0;
  for (int v = 0; v < int(regular.cols()); ++v) {
    const double distance = (jittered.col(v) - regular.col(v)).norm();
    CHECK(distance <= 0.3 * 0.1 * (1 + 8 * epsilon));
    moved += distance > 0;
  }
  CHECK(moved == 5 * 13 + 4 * 12);
}

TEST_CASE(
    "mesh: random sheets keep their least distance, leave no slivers and depend on the seed") {
  Sheet sheet = {SheetPattern::random_delaunay, 1.2, 0.8, 30, 20, 0, 11};
  const TriangleMesh mesh = make_sheet(sheet);
  CHECK(rest_lengths(mesh).minCoeff() >= 0.8 * 0.04 * (1 - 8 * epsilon));
  CHECK(least_angle(mesh) > 20 * pi / 180);
  CHECK(std::abs(mesh.particles() - 660) < 66);
  sheet.seed = 12;
  CHECK(make_sheet(sheet).triangles != mesh.triangles);
}

TEST_CASE("mesh: the statue is the figure that its limbs make") {
  const TriangleMesh statue = make_statue(1, 3);
  const PerParticle3& x = statue.rest;
  PerParticle area = PerParticle::Zero(x.cols());
  double volume = 0;
  for (const Triangle& t : statue.triangles) {
    const Vector3 a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]);
    volume += a.cross(b).dot(c) / 6;
    for (const int i : t) area[i] += (b - a).cross(c - a).norm() / 6;
  }
  // as it was designed: every limb and fold has a part in these
  const std::array<double, 3> moments{0.0594365028, 0.268083368, 0.0301511016};  // m^4
  CHECK(volume == Approx(0.116025753).epsilon(1e-8));
  for (int axis = 0; axis < 3; ++axis)
    CHECK(x.row(axis).cwiseAbs2().dot(area.transpose()) ==
          Approx(moments[size_t(axis)]).epsilon(1e-8));
}

TEST_CASE("mesh: a made hinge is folded at the angle asked for, from N1 to N2 about E") {
  for (double angle : {-3.1, -0.7, 0.0, 0.3, 2.2}) {
    const TriangleMesh mesh = make_hinge(0.13, angle);
    REQUIRE(mesh.hinges.size() == 1);
    CHECK(mesh.hinges[0].particles == std::array<int, 4>{0, 1, 2, 3});
    CHECK(std::abs(fold_angle(mesh.hinges[0], mesh.rest) - angle) < 8 * epsilon);
  }
}

TEST_CASE("mesh: pleats keep every length and fold the pleat lines alone, up and down in turn") {
  for (SheetPattern pattern : {SheetPattern::one_diagonal, SheetPattern::alternating,
                               SheetPattern::union_jack, SheetPattern::criss_cross}) {
    const TriangleMesh sheet = make_sheet(sheet_of(pattern));
    TriangleMesh folded = sheet;
    folded.rest = pleated_positions(sheet, 3, 1.1);
    CHECK((rest_lengths(folded) - rest_lengths(sheet)).cwiseAbs().maxCoeff() < 8 * epsilon);
    std::map<double, int> folds;  // signed angle for E along +y, rounded to 1e-9
    for (const Hinge& hinge : sheet.hinges) {
      ++folds[std::round(fold_angle(hinge, folded.rest) * 1e9) / 1e9 + 0.0];
    }
    // ridges at columns 3 and 9, valleys at 6 and 12, ten edges each; E runs along +y
    CHECK(folds[1.1] == 20);
    CHECK(folds[-1.1] == 20);
    CHECK(folds[0] == int(sheet.hinges.size()) - 40);
    CHECK(folds.size() == 3);
    CHECK(std::abs(folded.rest.row(2).maxCoeff() - 0.3 * std::sin(0.55)) < 4 * epsilon);
  }
}

TEST_CASE(
    "mesh: a finer icosphere has four times the triangles, normals outward, the coarse vertices "
    "first") {
  const TriangleMesh coarse = make_icosphere(0.7, 2), fine = make_icosphere(0.7, 3);
  CHECK(fine.triangles.size() == 20 * 64);
  CHECK((fine.rest.leftCols(coarse.particles()) - coarse.rest).cwiseAbs().maxCoeff() <= epsilon);
  CHECK((fine.rest.colwise().norm().array() - 0.7).abs().maxCoeff() < 4 * epsilon);
  CHECK(volume(fine) == Approx(4 * pi / 3 * 0.343).epsilon(0.02));
  CHECK(volume(fine) < 4 * pi / 3 * 0.343);
}

TEST_CASE("mesh: the statue is clean, stands on its base and does not pierce itself") {
  const TriangleMesh mesh = make_statue(1.7, 4);
  CHECK(mesh.triangles.size() == 5120);
  CHECK(least_angle(mesh) > 20 * pi / 180);
  CHECK(mesh.rest.row(1).minCoeff() == 0);
  CHECK(std::abs(mesh.rest.row(1).maxCoeff() - 1.7) < 4 * epsilon);
  CHECK((mesh.rest.row(1).array() < 1e-9).count() > 200);
  CHECK(volume(mesh) > 0);
  CHECK(piercings(mesh) == 0);
}

TEST_CASE("mesh: the even statue is clean, too, and its smallest triangle is larger") {
  const TriangleMesh even = make_even_statue(1.7, 32), plain = make_statue(1.7, 5);
  REQUIRE(even.triangles.size() == plain.triangles.size());
  const double of_even = triangle_areas(even.triangles, even.rest).minCoeff();
  CHECK(of_even > 1.5 * triangle_areas(plain.triangles, plain.rest).minCoeff());
  CHECK(even.rest.row(1).minCoeff() == 0);
  CHECK(std::abs(even.rest.row(1).maxCoeff() - 1.7) < 4 * epsilon);
  CHECK(volume(even) == Approx(volume(plain)).epsilon(0.01));
  CHECK(piercings(even) == 0);
  CHECK_THROWS_WITH(make_even_statue(1.7, 14), Catch::Matchers::Contains("give 15 to 256"));
}
