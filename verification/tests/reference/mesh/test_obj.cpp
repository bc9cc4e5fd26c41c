// OBJ files, what meshes and shapes refuse, and Delaunay triangulations.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include "reference/mesh/delaunay.h"
#include "reference/mesh/obj.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

const double infinity = std::numeric_limits<double>::infinity();
const double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// A file that lasts as long as this object.
struct TemporaryFile {
  std::string path;
  explicit TemporaryFile(const std::string& text) {
    const std::string name = "test_obj_" + std::to_string(std::random_device{}()) + ".obj";
    path = (std::filesystem::temp_directory_path() / name).string();
    std::ofstream(path, std::ios::binary) << text;
  }
  ~TemporaryFile() { std::remove(path.c_str()); }
};

TriangleMesh read_text(const std::string& text) {
  const TemporaryFile file(text);
  return read_obj(file.path);
}

template <class Action>
std::string rejection_message(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

/// The message with the file's name taken away: ":LINE: reason; what to do".
std::string rejection_of(const std::string& text) {
  const TemporaryFile file(text);
  std::string message = rejection_message([&] { read_obj(file.path); });
  if (message.starts_with(file.path)) message.erase(0, file.path.size());
  return message;
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

PerParticle3 five_points() {
  PerParticle3 x(3, 5);
  x << 0, 1.1, 0.2, 1.3, -0.9,  //
      0, 0.1, 0.9, 1.2, -0.4,   //
      0, 0.3, 0.1, -0.2, 0.7;
  return x;
}

}  // namespace

TEST_CASE("obj: what is written is read back bit for bit") {
  TriangleMesh mesh = make_sheet({SheetPattern::jittered, 1.3, 0, 9, 7, 0.3, 3});
  mesh.rest.row(2).setRandom();
  mesh.rest.col(5) << 0.1, -0.0, 1e-300;
  mesh.rest.col(6) << 1.0 / 3, -7100 / 9.0, std::numeric_limits<double>::epsilon();
  const TemporaryFile file("");
  write_obj(file.path, mesh.rest, mesh.triangles);
  const TriangleMesh again = read_obj(file.path);
  CHECK(again.rest == mesh.rest);
  CHECK(std::signbit(again.rest(1, 5)));
  CHECK(again.triangles == mesh.triangles);
}

TEST_CASE("obj: every way to write a face gives the same square") {
  const std::vector<Triangle> fan = {{0, 1, 2}, {0, 2, 3}};
  for (const std::string face :
       {"f 1 2 3 4\n", "f 1/1 2/2 3/3 4/4", "f 1//5 2//5 3//5 4//5\n",
        "f 1/1/1 2/2/2 3/3/3 4/4/4\n", "f -4 -3 -2 -1\n", "f 1 -3 3/7 -1//2\n",
        "f 1 2 3\nf 1 3 4\n", "f 1 2 \\\n 3 4\n", "f 1 2\\\r\n3 4\r\n",
        "\tf  1\t2 3   4  # a comment\n",
        "o thing\ng a b\ns 1\nusemtl m\nvt 0 0\nvn 0 0 1\nl 1 2\np 1\nf 1 2 3 4\n"}) {
    INFO(face);
    CHECK(read_text(square + face).triangles == fan);
    const bool relative = face.find('-') != std::string::npos;
    if (!relative) CHECK(read_text(face + "\n" + square).triangles == fan);
  }
}

TEST_CASE(
    "obj: numbers may carry plus signs, w, colours, comments, CR LF, a byte order mark; any "
    "locale") {
  const TriangleMesh plain = read_text("v 0.5 0 0\nv 1e1 0 0\nv 1 .25 0\nf 1 2 3\n");
  CHECK(plain.rest.col(0) == Vector3(0.5, 0, 0));
  CHECK(plain.rest.col(1) == Vector3(10, 0, 0));
  CHECK(plain.rest.col(2) == Vector3(1, 0.25, 0));
  const std::string decorated =
      "\xEF\xBB\xBF# head\r\n\r\nv +0.5 0 0 1\r\nv 1e+1 0 0 .1 .2 .3\r\n   v 1 0.25 0 # c\r\nf 1 2 "
      "3";
  CHECK(read_text(decorated).rest == plain.rest);
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // writes 0,5 where a machine has it
  CHECK(read_text(decorated).rest == plain.rest);
  std::setlocale(LC_ALL, "C");
}

TEST_CASE("obj: every refusal names the file, the line, the reason and a remedy") {
  const std::vector<std::array<std::string, 2>> cases = {
      {"", ":1: the file is empty; give v and f records"},
      {square, ":4: the file ends without a face; give f records"},
      {"v 1 2\n", ":1: a vertex of 2 numbers; write 'v x y z'"},
      {"\nv 1 2 3 4 5 6 7 8\n", ":2: a vertex of 8 numbers; write 'v x y z'"},
      {"v 1 2 x3\n", ":1: 'x3' is not a number; a vertex is written 'v x y z'"},
      {"v 1 2,5 3\n", ":1: '2,5' is not a number; a vertex is written 'v x y z'"},
      {"# a\nv 1 2 \\\n3e999\n",
       ":3: '3e999' does not fit a double; a vertex is written 'v x y z'"},
      {square + "f 1 2 3\nf 1 2\n", ":6: a face of 2 vertices; give at least three"},
      {square + "f\n", ":5: a face of 0 vertices; give at least three"},
      {square + "f 1 0 3\n", ":5: index 0 in '0'; vertices are counted from 1"},
      {square + "f 1 2 3 -5\n", ":5: index -5 is out of range; 4 vertices come before this face"},
      {square + "f 1 2 3 4\nf 1 2 9\n", ":6: index 9 is out of range; the file has 4 vertices"},
      {square + "f 1 2 3.5\n", ":5: '3.5' is no corner of a face; write a, a/b, a//c or a/b/c"},
      {square + "f 1/ 2/ 3/\n", ":5: '1/' is no corner of a face; write a, a/b, a//c or a/b/c"},
      {square + "f 1/1/1/1 2 3\n",
       ":5: '1/1/1/1' is no corner of a face; write a, a/b, a//c or a/b/c"},
      {square + "v 2 nan 0\nf 1 2 3 4 5\n", ":5: a coordinate is not finite; give numbers in m"},
      {square + "v 5 5 5\n\nv 6 6 6\nf 1 2 3 4\n",
       ":5: in no triangle, the first of 2 unused vertices (they would have no mass); remove them"},
      {square + "v 2 0 0\nf 1 2 3 4\nf 1 2 5\n",
       ":7: no area: vertex 1 (line 1), vertex 2 (line 2) and vertex 5 (line 5) lie on a line "
       "(area at most 1e-12 of the longest side squared); remove or repair the triangle"},
      {square + "f 1 2 3\n\nf 1 4 3\n",
       ":7: opposite orientation to its neighbour, the face of line 5: both run along the edge "
       "between vertex 1 (line 1) and vertex 3 (line 3) the same way; reverse the order of one "
       "triangle's vertices"},
      {square + "v 0 0 1\nf 1 2 3\nf 1 3 4\nf 3 1 5\n",
       ":8: the edge between vertex 1 (line 1) and vertex 3 (line 3) has three triangles or more "
       "(the face of line 6, the face of line 7 and this one); a manifold has one or two. Remove "
       "one: repair = \"split\" parts fans at a vertex, and cannot tell which two of these stay "
       "joined"},
      {square + "v 2 1 0\nv 2 2 0\nf 1 2 3 4\n\nf 3 5 6\n",
       ":3: its triangles form more than one fan (the face of line 7 and the face of line 9 meet "
       "in this vertex only); give each fan a vertex of its own, or, for cloth, set repair = "
       "\"split\""}};
  for (const auto& [text, message] : cases) CHECK(rejection_of(text) == message);
}

TEST_CASE("obj: a file that cannot be opened, read or written is named") {
  const std::string folder = std::filesystem::temp_directory_path().string();
  CHECK(rejection_message([] { read_obj("no_such_file.obj"); }) ==
        "no_such_file.obj: cannot be opened (No such file or directory); check the path");
  CHECK(rejection_message([&] { read_obj(folder); }) ==
        folder + ": cannot be read; give a regular file");
  CHECK(rejection_message([&] {
          write_obj(folder, five_points(), {{0, 1, 2}});
        }) == folder + ": cannot be written; check the folder and the space left");
  CHECK(rejection_message([&] {
          write_obj("unused.obj", five_points(), {{0, 1, 2}, {3, 4, 5}});
        }) == "write_obj: triangle 1: vertex index 5 is out of range; there are 5 positions");
}

TEST_CASE("mesh: what is no oriented manifold is refused, with the triangle or the vertex") {
  const auto rejection_of = [](const PerParticle3& x, const std::vector<Triangle>& triangles) {
    return rejection_message([&] { make_triangle_mesh(x, triangles); });
  };
  PerParticle3 x = five_points();
  CHECK(rejection_of(x, {}) == "mesh: no triangles; give at least one");
  CHECK(rejection_of(x, {{0, 1, 2}, {1, 3, 5}})
            .starts_with("mesh: triangle 1: vertex index 5 is out of range"));
  CHECK(rejection_of(x, {{0, -1, 2}})
            .starts_with("mesh: triangle 0: vertex index -1 is out of range"));
  CHECK(rejection_of(x, {{0, 1, 2}})
            .starts_with("mesh: vertex 3: in no triangle, the first of 2 unused vertices"));
  CHECK(rejection_of(x, {{0, 1, 2}, {3, 4, 3}}).starts_with("mesh: triangle 1: no area"));
  CHECK(rejection_of(x, {{0, 1, 2}, {0, 1, 3}, {3, 1, 4}})
            .starts_with("mesh: triangle 1: opposite orientation"));
  CHECK(rejection_of(x, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}})
            .starts_with("mesh: triangle 2: the edge between vertex 0"));
  CHECK(rejection_of(x, {{0, 1, 2}, {0, 3, 4}})
            .starts_with("mesh: vertex 0: its triangles form more than one fan"));
  for (double bad : {not_a_number, infinity}) {
    x(1, 3) = bad;
    CHECK(rejection_of(x, {{0, 1, 2}, {2, 3, 4}})
              .starts_with("mesh: vertex 3: a coordinate is not finite"));
  }
  // two closed fans about one vertex: no edge is wrong, and there is no border
  PerParticle3 seven(3, 7);
  seven << 0, 1, 0, 0, -1, 0, 0,  //
      0, 0, 1, 0, 0, -1, 0,       //
      0, 0, 0, 1, 0, 0, -1;
  const std::vector<Triangle> two_tetrahedra = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3},
                                                {0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}};
  CHECK(rejection_of(seven, two_tetrahedra)
            .starts_with("mesh: vertex 0: its triangles form more than one fan"));
  CHECK_THROWS_AS(make_triangle_mesh(x, {{0, 1, 2}, {2, 3, 4}}, {"a.obj", {1, 2}, {3}}),
                  std::logic_error);
}

TEST_CASE("mesh: zero area is judged by shape, not by size") {
  for (double size : {1e-160, 1e-9, 1.0, 1e140}) {
    PerParticle3 x = PerParticle3::Zero(3, 3);
    x(0, 1) = size;
    x(0, 2) = 0.4 * size;
    x(1, 2) = 2.1e-12 * size;
    CHECK(make_triangle_mesh(x, {{0, 1, 2}}).edges.size() == 3);
    x(1, 2) = 1.9e-12 * size;
    CHECK_THROWS_AS(make_triangle_mesh(x, {{0, 1, 2}}), InputError);
  }
}

/// Expects the call to be refused in words that begin with `start`.
struct BadCall {
  std::function<void()> call;
  const char* start;
};

void check_refusals(const std::vector<BadCall>& bad_calls) {
  for (const BadCall& bad : bad_calls) {
    INFO(bad.start);
    CHECK(rejection_message(bad.call).starts_with(bad.start));
  }
}

TEST_CASE("shapes: every bad argument of a sheet is refused by name and value") {
  const Sheet good = {SheetPattern::jittered, 1.3, 0.9, 3, 4, 0.2, 7};
  const auto with = [&good](const std::function<void(Sheet&)>& change) {
    Sheet sheet = good;
    change(sheet);
    return [sheet] { make_sheet(sheet); };
  };
  check_refusals({
      {with([](Sheet& s) { s.width = -2; }), "make_sheet: width is -2"},
      {with([](Sheet& s) { s.width = not_a_number; }), "make_sheet: width is nan"},
      {with([](Sheet& s) { s.height = infinity; }), "make_sheet: height is inf"},
      {with([](Sheet& s) { s.height = 0, s.pattern = SheetPattern::union_jack; }),
       "make_sheet: height"},
      {with([](Sheet& s) { s.columns = 0; }), "make_sheet: columns is 0"},
      {with([](Sheet& s) { s.rows = -3; }), "make_sheet: rows is -3"},
      {with([](Sheet& s) { s.columns = s.rows = 20000; }), "make_sheet: columns * rows is 4"},
      {with([](Sheet& s) { s.jitter = 0.5; }), "make_sheet: jitter is 0.5"},
      {with([](Sheet& s) { s.jitter = not_a_number; }), "make_sheet: jitter is nan"},
      {with([](Sheet& s) { s.pattern = SheetPattern(99); }), "make_sheet: pattern is 99"},
      {with([](Sheet& s) { s.pattern = SheetPattern::random_delaunay, s.width = 9; }),
       "make_sheet: cell width over cell height is 13"},
  });
}

TEST_CASE("shapes: every bad argument of a solid or a hinge is refused by name and value") {
  check_refusals({
      {[] { make_disc(-0.5, 3); }, "make_disc: radius is -0.5"},
      {[] { make_disc(0.5, 0); }, "make_disc: rings is 0"},
      {[] { make_cylinder(not_a_number, 1, 5, 4); }, "make_cylinder: radius is nan"},
      {[] { make_cylinder(1, 0, 5, 4); }, "make_cylinder: height is 0"},
      {[] { make_cylinder(1, 3, 2, 4); }, "make_cylinder: around is 2"},
      {[] { make_cylinder(1, 3, 5, 0); }, "make_cylinder: along is 0"},
      {[] { make_icosphere(0, 3); }, "make_icosphere: radius is 0"},
      {[] { make_icosphere(1, 10); }, "make_icosphere: subdivisions is 10"},
      {[] { make_statue(infinity, 4); }, "make_statue: height is inf"},
      {[] { make_statue(1, 2); }, "make_statue: subdivisions is 2"},
      {[] { make_hinge(not_a_number, 1); }, "make_hinge: length is nan"},
      {[] { make_hinge(1, 3.2); }, "make_hinge: angle is 3.2"},
      {[] { lumped_masses(make_hinge(1, 1), -3); }, "lumped_masses: density is -3"},
  });
}

TEST_CASE("shapes: a sheet that cannot be pleated is refused by name and value") {
  const TriangleMesh sheet = make_sheet({SheetPattern::one_diagonal, 1.3, 0.9, 6, 4, 0, 0});
  check_refusals({
      {[&] { pleated_positions(sheet, 0, 1); }, "pleated: columns_per_pleat is 0"},
      {[&] { pleated_positions(sheet, 2, not_a_number); }, "pleated: angle is nan"},
      {[] { pleated_positions(make_hinge(1, 1), 2, 1); }, "pleated: the sheet is empty or leaves"},
  });
  const TriangleMesh jittered = make_sheet({SheetPattern::jittered, 1.3, 0.9, 3, 4, 0.2, 7});
  CHECK(rejection_message([&] { pleated_positions(jittered, 2, 1); }).find("crosses a fold line") !=
        std::string::npos);
}

TEST_CASE("delaunay: no point lies inside the circle through a triangle's corners") {
  std::mt19937_64 random(5);
  Eigen::Matrix2Xd points(2, 120);
  for (int i = 0; i < 120; ++i)
    points.col(i) << double(random() >> 11) * 0x1p-53, 1.7 * double(random() >> 11) * 0x1p-53;
  const std::vector<Triangle> triangles = delaunay(points);
  int inside = 0;
  for (const Triangle& t : triangles) {
    const Eigen::Vector2d a = points.col(t[0]), b = points.col(t[1]) - a, c = points.col(t[2]) - a;
    const double twice_area = b.x() * c.y() - b.y() * c.x();
    const Eigen::Vector2d centre =
        Eigen::Vector2d(c.y() * b.squaredNorm() - b.y() * c.squaredNorm(),
                        b.x() * c.squaredNorm() - c.x() * b.squaredNorm()) /
        (2 * twice_area);
    for (int i = 0; i < 120; ++i)
      inside += (points.col(i) - a - centre).norm() < centre.norm() * (1 - 1e-6);
  }
  CHECK(inside == 0);
  PerParticle3 x = PerParticle3::Zero(3, 120);
  x.topRows<2>() = points;
  // oriented, manifold, every point used
  const TriangleMesh mesh = make_triangle_mesh(x, triangles);
  const int border = int(mesh.edges.size() - mesh.hinges.size());
  CHECK(int(triangles.size()) == 2 * 120 - 2 - border);
}

TEST_CASE(
    "delaunay: points on common circles are triangulated too, and points on a line but for "
    "rounding") {
  Eigen::Matrix2Xd grid(2, 7 * 9);
  for (int i = 0; i < 63; ++i) grid.col(i) << (i % 7) * 0.3, (i / 7) * 0.3;
  CHECK(delaunay(grid).size() == 2 * 6 * 8);
  const Eigen::Rotation2Dd turn(0.37);
  const Eigen::Matrix2Xd turned = turn.toRotationMatrix() * grid;
  CHECK(delaunay(turned).size() == 2 * 6 * 8);
}

TEST_CASE("delaunay: too few, coincident, collinear and infinite points are refused") {
  Eigen::Matrix2Xd points = Eigen::Matrix2Xd::Random(2, 9);
  CHECK(rejection_message([&] { delaunay(points.leftCols(2)); }) ==
        "delaunay: 2 points; give at least three");
  points.col(7) = points.col(3);
  CHECK(rejection_message([&] {
          delaunay(points);
        }).starts_with("delaunay: points 3 and 7 coincide"));
  points(1, 7) = not_a_number;
  CHECK(rejection_message([&] {
          delaunay(points);
        }).starts_with("delaunay: point 7: a coordinate is not finite"));
  points.setConstant(0.3);
  CHECK(rejection_message([&] {
          delaunay(points);
        }).starts_with("delaunay: the points' extent is 0"));
  points.row(0).setLinSpaced(0.1, 1.7);
  CHECK(rejection_message([&] {
          delaunay(points);
        }).starts_with("delaunay: all points lie on a line"));
}
