// PLY files: what is read, to the bit, and what is refused in a line.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>

#include "reference/mesh/ply.h"

using namespace foldproof;

namespace {

const std::string ascii_quad =
    "ply\r\nformat ascii 1.0\ncomment time 0.25 s\nelement vertex 4\nproperty float x\n"
    "property uchar red\nproperty double y\nproperty list uchar int neighbours\nproperty double z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 255 0.1 2 7 8 -3\n1 0 0 0 0.5\n1 0 1 1 9 0\n0 3 1 0 1e-3\n4 0 1 2 3\n";

/// The number's bytes in the file's order.
template <class Number>
void put(std::string& text, Number value, bool is_big) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  if (is_big) std::reverse(bytes, bytes + sizeof value);
  text.append(bytes, sizeof value);
}

std::string binary_triangle(bool is_big) {
  std::string text = std::string("ply\nformat binary_") + (is_big ? "big" : "little") +
                     "_endian 1.0\nelement vertex 3\nproperty double x\nproperty float y\n"
                     "property short z\nelement extra 1\nproperty list uint ushort many\n"
                     "element face 1\nproperty uchar flag\n"
                     "property list char uint vertex_index\nend_header\n";
  const double x[] = {0.1, 1.7, -2.3};
  for (int v = 0; v < 3; ++v) {
    put(text, x[v], is_big);
    put(text, float(0.5f + 3 * float(v)), is_big);
    put(text, std::int16_t(-300 * v), is_big);
  }
  put(text, std::uint32_t(2), is_big);
  put(text, std::uint16_t(5), is_big);
  put(text, std::uint16_t(6), is_big);
  text += '\1';
  text += '\3';
  for (const unsigned v : {2u, 0u, 1u}) put(text, v, is_big);
  return text;
}

}  // namespace

TEST_CASE("an ASCII PLY file is read, whatever else its vertices hold") {
  const PlyMesh mesh = read_ply_text(ascii_quad, "quad.ply");
  CHECK(mesh.time == 0.25);
  REQUIRE(mesh.soup.rest.cols() == 4);
  CHECK(mesh.soup.rest.col(0) == Vector3(0, 0.1, -3));
  CHECK(mesh.soup.rest.col(2) == Vector3(1, 1, 0));
  CHECK(mesh.soup.rest.col(3) == Vector3(0, 1, 1e-3));
  CHECK(mesh.soup.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("binary PLY files of both byte orders hold the same mesh, to the bit") {
  for (const bool is_big : {false, true}) {
    const PlyMesh mesh = read_ply_text(binary_triangle(is_big), "triangle.ply");
    CHECK_FALSE(mesh.time);
    CHECK(mesh.soup.rest.col(1) == Vector3(1.7, 3.5, -300));
    CHECK(mesh.soup.rest.col(2) == Vector3(-2.3, 6.5, -600));
    CHECK(mesh.soup.triangles == std::vector<Triangle>{{2, 0, 1}});
  }
}

TEST_CASE("PLY files are refused in a line that says what is wrong") {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = ascii_quad;
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string whole = binary_triangle(false);
  for (const auto& [text, said] : std::vector<std::pair<std::string, std::string>>{
           {"", "bad.ply:1: the file does not begin with the line 'ply'"},
           {"solid stl\n", "does not begin"},
           {"ply\nformat ascii 1.0\n", "has no end_header"},
           {"ply\nend_header\n", "names no format"},
           {"ply\nformat ascii 1.0\nend_header\n", "has no face"},
           {with("ascii", "text"), "bad.ply:2: 'text' is no format"},
           {with("property float x", "property half x"), "bad.ply:5: 'half' is no type"},
           {with("element vertex 4", "element vertex -4"), "bad.ply:4: an element is written"},
           {with("end_header\n", "element vertex 0\nproperty float x\nend_header\n"),
            "bad.ply:12: a second element 'vertex'"},
           {with("vertex 4", "vertex 9"), "ends before its last element"},
           {with("list uchar int vertex", "list float int vertex"), "no whole number"},
           {with("4 0 1 2 3", "4 0 1 2 4"), "bad.ply:17: an index of a vertex is not from 0 to 3"},
           {with("4 0 1 2 3", "4 0 1 2 -1"), "an index of a vertex"},
           {with("4 0 1 2 3", "2 0 1"), "fewer than three"},
           {with("0 255 0.1", "nan 255 0.1"), "vertex 0 lacks a finite"},
           {with("property double z", "property double w"), "lacks a finite"},
           {with("0 255 0.1", "0 255 o.1"), "'o.1' is not a number"},
           {with("vertex 4", "vertex 9000000"), "more than 2000000 vertices"},
           {whole.substr(0, whole.size() - 1), "bad.ply: the file ends before"}}) {
    INFO(said);
    try {
      read_ply_text(text, "bad.ply");
      FAIL("was read");
    } catch (const InputError& error) {
      CHECK_THAT(error.what(), Catch::Contains(said));
      CHECK(std::string(error.what()).find('\n') == std::string::npos);
    }
  }
}
