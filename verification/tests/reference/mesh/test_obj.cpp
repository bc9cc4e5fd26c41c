// OBJ files: every way to write a record, lines, groups, limits at the very bound, refusals.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>

#include "reference/mesh/mesh_file.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;

namespace {

const std::string four = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// The refusal of the text without the file's name; "" if it is read, mesh or not.
std::string said_of(const std::string& text) {
  try {
    read_mesh_text(text, "t.obj");
  } catch (const InputError& error) {
    return error.what() + 5;
  }
  return "";
}

std::vector<Triangle> triangles_of(const std::string& text) {
  return read_mesh_text(text, "t.obj").soup.triangles;
}

TriangleMesh mesh_of(const std::string& text) {
  TriangleSoup soup = read_mesh_text(text, "t.obj").soup;
  return make_triangle_mesh(std::move(soup.rest), std::move(soup.triangles), soup.origin);
}

Vector3 vertex_of(const std::string& record) {
  return read_mesh_text(record + "\nv 0 0 0\nv 1 1 1\nf 1 2 3\n", "t.obj").soup.rest.col(0);
}

}  // namespace

TEST_CASE("words of a vertex are parted by every blank, its numbers doubles; three count") {
  for (const std::string blank : {" ", "\t", "\r", "\v", "\f", "\\\n", "\\\r\n", " \\\n\t"})
    CHECK(vertex_of("v" + blank + "0.5" + blank + "-7" + blank + "2.25" + blank) ==
          Vector3(0.5, -7, 2.25));
  CHECK(vertex_of("v +5 -.5e+1 +.25 # 8") == Vector3(5, -5, 0.25));
  CHECK(vertex_of("v 3 4 5 6 7 8 nan") == Vector3(3, 4, 5));
  CHECK(vertex_of("v 1e-400 -1e-9999 2") == Vector3(0, 0, 2));
  for (const std::string word : {"+", "+-3", "++3", "-+3", "0x10", "1.5.2", "1,5", "1e", "5#6",
                                 "\\ 5", "5\\x", "5\\ ", "5\\\rx"})
    CHECK_THAT(said_of("v 1 2 " + word + "\n"), Catch::Contains("is not a number"));
  for (const std::string word : {"1e999", "-1e999", "+1e400"})
    CHECK_THAT(said_of("v 1 2 " + word + "\n"), Catch::Contains("does not fit a double"));
}

TEST_CASE("an OBJ file may begin with the mark of UTF-8, and holds nothing if it ends with it") {
  CHECK(triangles_of("\xEF\xBB\xBF" + four + "f 2 3 4\n") == std::vector<Triangle>{{1, 2, 3}});
  CHECK(said_of("") == ":1: the file is empty; give v and f records");
  CHECK(said_of("\xEF\xBB\xBF") == ":1: the file is empty; give v and f records");
  CHECK(said_of("\xEF\xBB\xBF\n").starts_with(":1: the file ends without a record v or f"));
}

TEST_CASE("a corner is a, a/b, a//c or a/b/c, and slashes may end it") {
  for (const std::string corner :
       {"3", "3/7", "3//7", "3/7/8", "3/-2/-9", "3//-1", "-2", "3/", "3//", "3/7/"})
    CHECK(triangles_of(four + "f 1 2 " + corner) == std::vector<Triangle>{{0, 1, 2}});
  for (const std::string corner : {"3/7/8/", "3/7/8/9", "3x", "3/x", "3//x", "3/7x", "3/7/8x", "/3",
                                   "//3", "+3", "3.", "x", "3///7", "3 /", "3-7", "3/7-8"})
    CHECK(said_of(four + "f 1 2 " + corner) ==
          ":5: '" + (corner == "3 /" ? "/" : corner) +
              "' is no corner of a face; write a, a/b, a//c or a/b/c");
}

TEST_CASE("indices count from 1, or back from the last vertex so far; convex polygons are fans") {
  CHECK(triangles_of(four + "f 4 1 3") == std::vector<Triangle>{{3, 0, 2}});
  CHECK(triangles_of(four + "f -1 -4 2\nv 5 5 5\nf -1 -5 -2") ==
        std::vector<Triangle>{{3, 0, 1}, {4, 0, 3}});
  CHECK(triangles_of("f 3 2 1\n" + four) == std::vector<Triangle>{{2, 1, 0}});
  CHECK(triangles_of("v 2 0 0\nv 1 2 0\nv -1 2 0\nv -2 0 1\nv -1 -2 0\nv 1 -2 0\nf 3 4 5 6 1 2") ==
        std::vector<Triangle>{{2, 3, 4}, {2, 4, 5}, {2, 5, 0}, {2, 0, 1}});
}

TEST_CASE("lines of an OBJ file are those on which its records begin") {
  const TriangleSoup soup =
      read_mesh_text("#\nv 0 0 \\\n0\nv 1 0 0\r\no a\n\nv 0 1 0\nv 1 1 0\nf 1 \\\n2 4 3\nf 3 2 1",
                     "t.obj")
          .soup;
  CHECK(soup.origin.file == "t.obj");
  CHECK(soup.origin.vertex_lines == std::vector<int>{2, 4, 7, 8});
  CHECK(soup.origin.triangle_lines == std::vector<int>{9, 9, 11});
}

TEST_CASE("groups hold the triangles of the faces that follow, once each") {
  const std::string text = four +
                           "f 1 2 3\ng left both\nf 1 2 3 4\no both\nf 2 3 4\ng\nf 3 4 1\n"
                           "g right right\nf 1 2 4\no\nf 4 1 2 3 # end\n";
  const FaceGroups groups = read_mesh_text(text, "t.obj").groups;
  CHECK(groups == FaceGroups{{"left", {1, 2, 3}}, {"both", {1, 2, 3, 4, 5}}, {"right", {5, 6, 7}}});
}

TEST_CASE("an OBJ file holds 2 million vertices, 4 million triangles, 16 names in a record") {
  std::string vertices, polygon = "v 0 0 0\nf 1 1";  // without area
  for (int v = 0; v < 2'000'000; ++v) vertices += "v 0 0 0\n";
  for (int t = 0; t < 4'000'000; ++t) polygon += " 1";
  CHECK(said_of(vertices + "f 2000000 1 2\n") == "");
  CHECK(said_of(vertices + "v 7 7 7\n").starts_with(":2000001: more than 2000000 vertices"));
  CHECK(said_of(polygon) == "");
  CHECK(said_of(polygon + " 1").starts_with(":2: more than 4000000 triangles"));
  for (const std::string letter : {"g", "o"}) {
    const std::string names = four + letter + " a b c d e f g h i j k l m n o p a p b \\\n";
    CHECK(said_of(names + "p\nf 1 2 3\n") == "");
    CHECK(said_of(names + "q\nf 1 2 3\n").starts_with(":6: more than 16 names of groups"));
  }
}

TEST_CASE("what an OBJ file says wrong is refused with its line") {
  CHECK(said_of("v 1 0 0\nv 0 1 nan\nf 1 2 2\n").starts_with(":2: a coordinate is not finite"));
  CHECK(said_of(four + "v nan 0 0\nf 1 2 3\n") == "");  // no face uses it
  const std::string few = " numbers; write 'v x y z'", none = "the file ends without a face";
  for (const auto& [text, said] : std::vector<std::pair<std::string, std::string>>{
           {"v\n", ":1: a vertex of 0" + few},
           {"v 3 4 5 6 7 8 9 10\n", ":1: a vertex of 8" + few},
           {"vt 0 \\\n0\n\n# c \\\nv 1 2\n", ":5: a vertex of 2" + few},
           {"v 1 \\\r\n2 \\\n\nv\n", ":1: a vertex of 2" + few},
           {"v 1 2 \\\n3e999\n", ":2: '3e999' does not fit"},
           {"v 1 2 3", ":1: " + none},
           {"\n#", ":2: the file ends without a record v or f"},
           {four + "f 1 2 3\nf 1 2\n", ":6: a face of 2 vertices"},
           {four + "f 1 3 2 4\n", ":5: a polygon of 4 corners whose sides cross"},
           {four + "f 1 \\\n2 \\\n x\n", ":7: 'x' is no corner of a face"},
           {four + "f 1 2 \\\n 3 4 7\n\n", ":5: index 7 is out of range; the file has 4 vertices"},
           {four + "f 1 2 2147483648\n", ":5: index 2147483648 is out of range"},
           {four + "f 1 2 -2147483649\n", ":5: index -2147483649 is out of range"},
           {four + "f 1 2 -0\n", ":5: index 0 in '-0'"},
           {four + "f 1 2 -2147483648\n", ":5: index -2147483648 is out of range; 4 vertices"},
           {"v 0 0 0\nf -1 -1 -2\n" + four, ":2: index -2 is out of range; 1 vertices come"},
           {four + "v 0 0 1\nf 1 2 3\nf 1 3 4\nf 3 1 5\n",
            ":8: the edge between vertex 1 (line 1) and vertex 3 (line 3) has three triangles"}})
    CHECK_THROWS_WITH(mesh_of(text), Catch::StartsWith("t.obj" + said));
}

TEST_CASE("an OBJ file is written with 17 digits, indices from 1, and read back bit for bit") {
  const ScratchFolder folder;
  const std::string path = folder.file("out.obj");
  PerParticle3 x(3, 4);
  x << 0.5, 0.1, -1e-7, 6e22, -1.25, -0.0, 3, 1, 3, 1.0 / 3, 2e9, -1;
  write_obj(path, x, {{0, 1, 2}, {3, 2, 1}});
  std::ifstream file(path, std::ios::binary);
  CHECK(std::string(std::istreambuf_iterator<char>(file), {}) ==
        "# written by foldproof; lengths in m\n"
        "v 0.5 -1.25 3\n"
        "v 0.10000000000000001 -0 0.33333333333333331\n"
        "v -9.9999999999999995e-08 3 2000000000\n"
        "v 6e+22 1 -1\n"
        "f 1 2 3\n"
        "f 4 3 2\n");
  CHECK(read_mesh_file(path).soup.rest == x);
  CHECK(std::signbit(read_mesh_file(path).soup.rest(1, 1)));
  for (const int bad : {-1, 4})
    CHECK_THROWS_WITH(write_obj(path, x, {{0, 1, 2}, {1, 2, bad}}),
                      Catch::StartsWith("write_obj: triangle 1: vertex index "));
  CHECK_THROWS_WITH(write_obj(folder.file("no/folder"), x, {{0, 1, 2}}),
                    Catch::Contains("no/folder: cannot be written"));
}
