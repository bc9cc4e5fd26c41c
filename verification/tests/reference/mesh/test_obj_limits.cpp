// OBJ files: every way to write a record, limits at the very bound, lines, groups.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>

#include "reference/mesh/obj.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;

namespace {

std::string repeated(const std::string& text, int times) {
  std::string all;
  all.reserve(text.size() * size_t(times));
  for (int k = 0; k < times; ++k) all += text;
  return all;
}

const std::string four = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// What is said of the text, without the file's name; "" if it is read. Triangles need
/// not make a mesh.
std::string said_of(const std::string& text) {
  try {
    read_obj_soup_text(text, "t.obj");
  } catch (const InputError& error) {
    const std::string message = error.what();
    CHECK(message.starts_with("t.obj"));
    return message.substr(5);
  }
  return "";
}

std::vector<Triangle> triangles_of(const std::string& text) {
  return read_obj_soup_text(text, "t.obj").triangles;
}

Vector3 vertex_of(const std::string& record) {
  return read_obj_soup_text(record + "\nv 0 0 0\nv 1 1 1\nf 1 2 3\n", "t.obj").rest.col(0);
}

const std::string no_corner = " is no corner of a face; write a, a/b, a//c or a/b/c";

}  // namespace

TEST_CASE("words of an OBJ record are parted by every blank, and end at a comment") {
  for (const std::string blank : {" ", "\t", "\r", "\v", "\f", "\\\n", "\\\r\n", " \\\n\t"}) {
    INFO(int(blank[0]));
    CHECK(vertex_of("v" + blank + "0.5" + blank + "-7" + blank + "2.25" + blank) ==
          Vector3(0.5, -7, 2.25));
  }
  CHECK(vertex_of("v 3 4 5 # 6 7 8 9 10") == Vector3(3, 4, 5));
  CHECK(said_of("v 3 4 5#6\n") == ":1: '5#6' is not a number; a vertex is written 'v x y z'");
  CHECK(said_of("v 3 4 \\ 5\n") == ":1: '\\' is not a number; a vertex is written 'v x y z'");
  CHECK(said_of("v 3 4 5\\x\n") == ":1: '5\\x' is not a number; a vertex is written 'v x y z'");
  CHECK(said_of("v 3 4 5\\") == ":1: '5\\' is not a number; a vertex is written 'v x y z'");
  CHECK(said_of("v 3 4 5\\\rx\n") == ":1: '5\\' is not a number; a vertex is written 'v x y z'");
}

TEST_CASE("lines of an OBJ file are counted over continued records, comments and what is ignored") {
  CHECK(said_of("vt 0 \\\n0\n\n# c \\\nv 1 2\n") == ":5: a vertex of 2 numbers; write 'v x y z'");
  CHECK(said_of("vt 0 \\\nf 9 9\nv 1\n") == ":3: a vertex of 1 numbers; write 'v x y z'");
  CHECK(said_of("v 1 \\\r\n2 \\\n\nv\n") == ":1: a vertex of 2 numbers; write 'v x y z'");
  CHECK(said_of(four + "f 1 \\\n2 \\\n x\n") == ":7: 'x'" + no_corner);
  CHECK(said_of(four + "f 1 2 \\\n 3 4 7\n\n") ==
        ":5: index 7 is out of range; the file has 4 vertices");
  for (const std::string text : {"v 1 2 3", "v 1 2 3\n", "\n"})
    CHECK(said_of(text) == ":1: the file ends without a face; give f records");
  for (const std::string text : {"v 1 2 3\n\n", "v 1 2 3\n#", "\n#\n"})
    CHECK(said_of(text) == ":2: the file ends without a face; give f records");
  const TriangleSoup soup =
      read_obj_soup_text("#\nv 0 0 \\\n0\nv 1 0 0\n\nv 0 1 0\nf 1 \\\n2 3 1\nf 3 2 1", "t.obj");
  CHECK(soup.origin.file == "t.obj");
  CHECK(soup.origin.vertex_lines == std::vector<int>{2, 4, 6});
  CHECK(soup.origin.triangle_lines == std::vector<int>{7, 7, 9});
}

TEST_CASE("an OBJ file may begin with the mark of UTF-8, and holds nothing if it ends with it") {
  CHECK(triangles_of("\xEF\xBB\xBF" + four + "f 2 3 4\n") == std::vector<Triangle>{{1, 2, 3}});
  CHECK(said_of("") == ":1: the file is empty; give v and f records");
  CHECK(said_of("\xEF\xBB\xBF") == ":1: the file is empty; give v and f records");
  CHECK(said_of("\xEF\xBB\xBF\n") == ":1: the file ends without a face; give f records");
}

TEST_CASE("numbers of a vertex are doubles, with a plus sign or without") {
  CHECK(vertex_of("v +5 +0.5 +.25") == Vector3(5, 0.5, 0.25));
  CHECK(vertex_of("v -5 -.5e+1 1E-2") == Vector3(-5, -5, 0.01));
  for (const std::string word : {"+", "+-3", "++3", "-+3", "0x10", "1.5.2", "1,5", "1e", "--1"}) {
    CHECK(said_of("v 1 2 " + word + "\n") ==
          ":1: '" + word + "' is not a number; a vertex is written 'v x y z'");
  }
  for (const std::string word : {"1e999", "-1e999", "+1e400", "1e-999"}) {
    CHECK(said_of("v 1 2 " + word + "\n") ==
          ":1: '" + word + "' does not fit a double; a vertex is written 'v x y z'");
  }
  for (const std::string word : {"nan", "inf", "-inf"})
    CHECK(said_of("v 1 0 0\nv 0 1 " + word + "\nv 0 0 1\nf 1 2 3\n") ==
          ":2: a coordinate is not finite; give numbers in m");
}

TEST_CASE("a vertex has three to seven numbers, and the first three count") {
  CHECK(vertex_of("v 3 4 5") == Vector3(3, 4, 5));
  CHECK(vertex_of("v 3 4 5 6 7 8 nan") == Vector3(3, 4, 5));
  CHECK(said_of("v 3 4 5 6 7 8 9 10\n") == ":1: a vertex of 8 numbers; write 'v x y z'");
  CHECK(said_of("v 3 4\n") == ":1: a vertex of 2 numbers; write 'v x y z'");
  CHECK(said_of("v\n") == ":1: a vertex of 0 numbers; write 'v x y z'");
}

TEST_CASE("a corner is a, a/b, a//c or a/b/c") {
  for (const std::string corner : {"3", "3/7", "3//7", "3/7/8", "3/-2/-9", "3//-1", "-2"})
    CHECK(triangles_of(four + "f 1 2 " + corner) == std::vector<Triangle>{{0, 1, 2}});
  for (const std::string corner :
       {"3/",   "3//",   "3/7/",       "3/7/8/",      "3/7/8/9", "3x",  "3/x",
        "3//x", "3/7x",  "3/7/8x",     "/3",          "//3",     "+3",  "3.",
        "x",    "3///7", "2147483648", "-2147483649", "3 /",     "3-7", "3/7-8"})
    CHECK(said_of(four + "f 1 2 " + corner) ==
          ":5: '" + (corner == "3 /" ? "/" : corner) + "'" + no_corner);
}

TEST_CASE("indices count from 1, or back from the last vertex so far") {
  CHECK(triangles_of(four + "f 4 1 3") == std::vector<Triangle>{{3, 0, 2}});
  CHECK(triangles_of(four + "f -1 -4 2\nv 5 5 5\nf -1 -5 -2") ==
        std::vector<Triangle>{{3, 0, 1}, {4, 0, 3}});
  CHECK(triangles_of("f 3 2 1\n" + four) == std::vector<Triangle>{{2, 1, 0}});
  CHECK(said_of(four + "f 1 2 0/5\n") == ":5: index 0 in '0/5'; vertices are counted from 1");
  CHECK(said_of(four + "f 1 2 -0\n") == ":5: index 0 in '-0'; vertices are counted from 1");
  CHECK(said_of(four + "f 1 2 -5/3\n") ==
        ":5: index -5 is out of range; 4 vertices come before this face");
  CHECK(said_of(four + "f 1 2 -2147483648\n") ==
        ":5: index -2147483648 is out of range; 4 vertices come before this face");
  CHECK(said_of("v 0 0 0\nf -1 -1 -2\n" + four) ==
        ":2: index -2 is out of range; 1 vertices come before this face");
  for (const std::string face : {"f 5 1 2", "f 1 5 2", "f 1 2 5"})
    CHECK(said_of(four + "f 1 2 3\n" + face + "\nf 6 6 6\n") ==
          ":6: index 5 is out of range; the file has 4 vertices");
}

TEST_CASE("polygons are cut into fans about their first vertex") {
  CHECK(triangles_of(four + "v 7 7 7\nv 8 8 8\nf 2 4 1 5 3 6") ==
        std::vector<Triangle>{{1, 3, 0}, {1, 0, 4}, {1, 4, 2}, {1, 2, 5}});
  CHECK(said_of(four + "f 1 2\n") == ":5: a face of 2 vertices; give at least three");
  CHECK(said_of(four + "f\n") == ":5: a face of 0 vertices; give at least three");
}

TEST_CASE("groups hold the triangles of the faces that follow, once each") {
  const std::string text = four +
                           "f 1 2 3\ng left both\nf 1 2 3 4\no both\nf 2 3 4\ng\nf 3 4 1\n"
                           "g right right\nf 1 2 4\no\nf 4 1 3 2 # end\n";
  const FaceGroups groups = read_obj_groups_text(text, "t.obj");
  CHECK(groups == FaceGroups{{"left", {1, 2, 3}}, {"both", {1, 2, 3, 4, 5}}, {"right", {5, 6, 7}}});
  CHECK(read_obj_groups_text(four + "f 1 2 3\n", "t.obj").empty());
}

TEST_CASE("a record of groups holds sixteen names, counted once each") {
  std::string names = "g";
  for (char c = 'a'; c < 'a' + 16; ++c) names += std::string(" ") + c;
  const FaceGroups groups = read_obj_groups_text(four + names + " a p b \\\np\nf 1 2 3\n", "t.obj");
  CHECK(groups.size() == 16);
  CHECK(groups.at("p") == std::vector<int>{0});
  for (const std::string letter : {"g", "o"}) {
    names[0] = letter[0];
    CHECK(said_of(four + names + " \\\nq\nf 1 2 3\n") ==
          ":6: more than 16 names of groups in a record; give fewer");
  }
}

TEST_CASE("an OBJ file holds 2 million vertices and 4 million triangles") {
  const std::string vertices = repeated("v 0 0 0\n", 2'000'000);
  CHECK(read_obj_groups_text(vertices + "f 2000000 1 2\n", "t.obj").empty());
  CHECK(said_of(vertices + "v 7 7 7\n") ==
        ":2000001: more than 2000000 vertices, the most that is read");
  const std::string polygon = "v 0 0 0\nf" + repeated(" 1", 4'000'002);
  CHECK(read_obj_groups_text(polygon, "t.obj").empty());
  CHECK(said_of(polygon + " 1") == ":2: more than 4000000 triangles, the most that is read");
}

TEST_CASE("an OBJ file is written with 17 digits, indices from 1") {
  const ScratchFolder folder;
  const std::string path = folder.file("out.obj");
  PerParticle3 x(3, 4);
  x << 0.5, 0.1, -1e-7, 6e22,  //
      -1.25, -0.0, 3, 1,       //
      3, 1.0 / 3, 2e9, -1;
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
  CHECK(read_obj_soup(path).rest == x);
  CHECK(read_obj_soup(path).origin.file == path);
  CHECK(read_obj_groups(path).empty());
  for (const int bad : {-1, 4})
    CHECK_THROWS_WITH(write_obj(path, x, {{0, 1, 2}, {1, 2, bad}}),
                      "write_obj: triangle 1: vertex index " + std::to_string(bad) +
                          " is out of range; there are 4 positions");
}
