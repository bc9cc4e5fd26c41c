// OBJ files: corners, indices, lines and groups.
#include <catch2/catch.hpp>

#include "reference/mesh/mesh_file.h"

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
