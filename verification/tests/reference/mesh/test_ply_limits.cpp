// PLY files: every type in both byte orders, the header's words, limits at the very bound.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include "reference/mesh/ply.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;

namespace {

template <class Number>
std::string bytes_of(Number value, bool is_big) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (is_big) std::ranges::reverse(bytes);
  return bytes;
}

std::string said_of(const std::string& text) {
  try {
    read_ply_text(text, "t.ply");
  } catch (const InputError& error) {
    const std::string message = error.what();
    CHECK(message.starts_with("t.ply"));
    return message.substr(5);
  }
  return "";
}

const std::string start = "ply\nformat ascii 1.0\n";
const std::string places = "property double x\nproperty double y\nproperty double z\n";
const std::string corners = "property list uchar int vertex_indices\n";
const std::string four_vertices = "0.5 7 8\n1 0 0\n1 1 0\n0 1 0\n";

/// Four vertices and the faces.
std::string ascii(const std::string& header_lines, int count, const std::string& faces) {
  return start + header_lines + "element vertex 4\n" + places + "element face " +
         std::to_string(count) + "\n" + corners + "end_header\n" + four_vertices + faces;
}

const std::string one_face = "3 0 1 2\n";

PlyMesh read(const std::string& text) { return read_ply_text(text, "t.ply"); }

/// A binary triangle, with the value of a type as the y of the second of three vertices, and as the
/// number of an index.
template <class Number>
void check_type(const std::string& name, Number value, bool is_big) {
  const std::string header = std::string("ply\nformat binary_") + (is_big ? "big" : "little") +
                             "_endian 1.0\nelement vertex 3\nproperty double x\nproperty " + name +
                             " y\nproperty double z\nelement face 1\nproperty list uchar " + name +
                             " vertex_index\nend_header\n";
  std::string data;
  for (int v = 0; v < 3; ++v)
    data += bytes_of(0.3 * v, is_big) + bytes_of(v == 1 ? value : Number(v), is_big) +
            bytes_of(-1.7 * v, is_big);
  data += '\3' + bytes_of(Number(2), is_big) + bytes_of(Number(0), is_big) +
          bytes_of(Number(1), is_big);
  const PlyMesh mesh = read(header + data);
  INFO(name);
  CHECK(mesh.soup.rest.col(1) == Vector3(0.3, double(value), -1.7));
  CHECK(mesh.soup.rest.col(2) == Vector3(0.6, 2, -3.4));
  CHECK(mesh.soup.triangles == std::vector<Triangle>{{2, 0, 1}});
  CHECK(said_of(header + data.substr(0, data.size() - 1)) ==
        ": the file ends before its last element; write it anew");
}

}  // namespace

TEST_CASE("numbers of a PLY file have eight types of two names each, in both byte orders") {
  for (const bool is_big : {false, true}) {
    for (const std::string name : {"char", "int8"}) check_type(name, std::int8_t(-113), is_big);
    for (const std::string name : {"uchar", "uint8"}) check_type(name, std::uint8_t(213), is_big);
    for (const std::string name : {"short", "int16"})
      check_type(name, std::int16_t(-30111), is_big);
    for (const std::string name : {"ushort", "uint16"})
      check_type(name, std::uint16_t(60111), is_big);
    for (const std::string name : {"int", "int32"})
      check_type(name, std::int32_t(-2000000111), is_big);
    for (const std::string name : {"uint", "uint32"})
      check_type(name, std::uint32_t(4000000111u), is_big);
    for (const std::string name : {"float", "float32"}) check_type(name, 0.1f, is_big);
    for (const std::string name : {"double", "float64"}) check_type(name, 0.1, is_big);
  }
  CHECK(said_of(start + "element vertex 3\nproperty int64 x\nend_header\n") ==
        ":4: 'int64' is no type; write char, uchar, short, ushort, int, uint, float or double");
}

TEST_CASE("words of a PLY file are parted by every blank") {
  const std::string text = "ply\r\nformat\tascii\v1.0\r\nelement \f vertex\t4\n" + places +
                           " element face 1\n" + corners +
                           "\n  \nend_header \r\n0.5\t7\v8\f\r\n1 0\n\n0 1 1 0 0 1 0\n 3 0 1\n2";
  const PlyMesh mesh = read(text);
  CHECK(mesh.soup.rest.col(0) == Vector3(0.5, 7, 8));
  CHECK(mesh.soup.triangles == std::vector<Triangle>{{0, 1, 2}});
  // the header has eleven lines; a vertex is of the line of its last number
  CHECK(mesh.soup.origin.vertex_lines == std::vector<int>{12, 15, 15, 15});
  CHECK(mesh.soup.origin.triangle_lines == std::vector<int>{17});
  CHECK(mesh.soup.origin.file == "t.ply");
}

TEST_CASE("the first line of a PLY file is ply, and its header ends") {
  for (const std::string text : {"", "ply", "plyx\n", "PLY\n", "ply \n", "ply\rformat"})
    CHECK(said_of(text) == ":1: the file does not begin with the line 'ply'; give a PLY file");
  CHECK(said_of(start + "end_header") == ":3: the header has no end_header; give a PLY file");
  CHECK(said_of("ply\nend_header\n") == ":2: the header names no format");
  const std::string comment = "comment " + std::string(4096 - 8, 'c');
  CHECK(said_of(ascii(comment + "\n", 1, one_face)) == "");
  CHECK(said_of(ascii(comment + "c\n", 1, one_face)) ==
        ":3: a line of the header is longer than 4096 bytes");
}

TEST_CASE("formats, elements and properties of a PLY file are refused with their line") {
  CHECK(said_of("ply\nformat\n") ==
        ":2: '' is no format; write ascii, binary_little_endian or binary_big_endian");
  CHECK(said_of("ply\nformat " + std::string(50, 'b') + " 1.0\n") ==
        ":2: '" + std::string(40, 'b') +
            "' is no format; write ascii, binary_little_endian or binary_big_endian");
  for (const std::string line : {"element vertex", "element vertex 4 5", "element vertex 4x",
                                 "element vertex -1", "element vertex 4.0"})
    CHECK(said_of(start + line + "\n") == ":3: an element is written 'element NAME COUNT'");
  CHECK(said_of(start + "element a 1\nelement b 1\nelement a 2\n") ==
        ":5: a second element 'a'; name each once");
  CHECK(said_of(start + "property int x\n") == ":3: a property before any element");
  for (const std::string line : {"property int", "property int x y", "property list uchar int",
                                 "property lost uchar int x", "property list uchar int x y"}) {
    CHECK(said_of(start + "element vertex 1\n" + line + "\n") ==
          ":4: a property is written 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
  }
  for (const std::string type : {"float", "double", "float32", "float64"})
    CHECK(said_of(start + "element face 1\nproperty list " + type + " int vertex_index\n") ==
          ":4: the length of a list is no whole number; give it an integer type");
}

TEST_CASE("a PLY header has 64 elements and properties at most") {
  std::string more;  // beside the 2 elements and 4 properties
  for (int k = 0; k < 29; ++k) more += "element e" + std::to_string(k) + " 0\nproperty int p\n";
  CHECK(said_of(ascii(more, 1, one_face)) == "");
  CHECK(said_of(ascii(more + "element last 0\n", 1, one_face)) ==
        ":68: more than 64 elements and properties, the most that is read");
}

TEST_CASE("the time of a PLY mesh stands in a comment 'time T s'") {
  const auto time_of = [](const std::string& comment) {
    return read(ascii(comment + "\n", 1, one_face)).time;
  };
  CHECK(time_of("comment time 0.37 s") == 0.37);
  CHECK(time_of("comment time -3e-2 s") == -0.03);
  CHECK(time_of("comment time 5 s\ncomment time 7 s\ncomment time x s") == 7);
  for (const std::string other :
       {"comment", "comment time 3", "comment time 3 ms", "comment Time 3 s", "comment time 3 s s",
        "comment time inf s", "comment time nan s", "comment time 3x s", "obj_info time 3 s"})
    CHECK_FALSE(time_of(other));
}

TEST_CASE("other properties and elements of a PLY file are passed over") {
  const std::string text =
      start +
      "element first 2\nproperty uchar p\nproperty list uchar float x\n"
      "element vertex 4\nproperty float w\nproperty list int float x\nproperty float xy\n"
      "property float yz\nproperty double z\nproperty double x\nproperty double y\n"
      "element none 900000000000000000\n"
      "element face 2\nproperty int vertex_index\nproperty list uchar int flags\n" +
      corners + "property float last\nelement end 1\nproperty int p\nend_header\n" +
      "7 0\n8 2 0.1 0.2\n"
      "11 1 12 13 14 8 0.5 7\n11 0 13 14 0 1 0\n11 2 12 12 13 14 0 1 1\n11 0 13 14 0 0 1\n"
      "9 1 7 4 3 0 1 2 99\n9 2 7 7 3 1 2 3 99\n5\n";
  const PlyMesh mesh = read(text);
  CHECK(mesh.soup.rest.col(0) == Vector3(0.5, 7, 8));
  CHECK(mesh.soup.rest.col(3) == Vector3(0, 1, 0));
  CHECK(mesh.soup.triangles == std::vector<Triangle>{{3, 0, 1}, {3, 1, 2}, {1, 2, 3}});
  CHECK(said_of(text.substr(0, text.size() - 2)) ==
        ":31: the file ends before its last element; write it anew");
  CHECK(said_of(start + "element vertex 4\n" + places +
                "element face 1\nproperty list uchar int others\nend_header\n" + four_vertices +
                "3 0 1 2\n") == ":14: the file has no face; give a mesh of triangles");
}

TEST_CASE("faces of a PLY file have three corners or more, each a vertex that came before") {
  CHECK(read(ascii("", 2, "4 3 0 1 2\n3 2 1 0\n")).soup.triangles ==
        std::vector<Triangle>{{3, 0, 1}, {3, 1, 2}, {2, 1, 0}});
  CHECK(read(ascii("", 1, "6 3 0 1 2 1 0\n")).soup.triangles ==
        std::vector<Triangle>{{3, 0, 1}, {3, 1, 2}, {3, 2, 1}, {3, 1, 0}});
  CHECK(said_of(ascii("", 2, "3 0 1 2\n2 0 1\n")) ==
        ":15: a face of fewer than three vertices; give at least three");
  for (const std::string bad : {"4", "-1", "1.5", "nan", "inf"})
    CHECK(said_of(ascii("", 2, "3 0 1 2\n3 0 1 " + bad + "\n")) ==
          ":15: an index of a vertex is not from 0 to 3");
  CHECK(said_of(ascii("", 2, "3 0 1 2\n3 0 1 2x\n")) == ":15: '2x' is not a number");
  for (const std::string face : {"3 0 0 0\n", "3 0 1 2\n"})
    CHECK(said_of(start + "element face 1\n" + corners + "element vertex 4\n" + places +
                  "end_header\n" + face + four_vertices) ==
          ":10: an index of a vertex is not from 0 to 0");
  CHECK(said_of(ascii("", 1, "3 0 1")) ==
        ":14: the file ends before its last element; write it anew");
  CHECK(said_of(ascii("", 0, "")) == ":13: the file has no face; give a mesh of triangles");
  CHECK(said_of("ply\nformat binary_big_endian 1.0\nend_header\n") ==
        ": the file has no face; give a mesh of triangles");
}

TEST_CASE("a list of a PLY file is shorter than the file") {
  const std::string whole = ascii("", 1, "123 0 1 2\n");
  const std::string size = std::to_string(whole.size());
  REQUIRE(size.size() == 3);
  CHECK(said_of(ascii("", 1, size + " 0 1 2\n")) ==
        ":14: the length of a face is not from 0 to " + std::to_string(whole.size() - 1));
  CHECK(said_of(ascii("", 1, std::to_string(whole.size() - 1) + " 0 1 2\n")) ==
        ":15: the file ends before its last element; write it anew");
  CHECK(said_of(ascii("", 1, "-3 0 1 2\n")).starts_with(":14: the length of a face is not from"));
  const std::string header = start + "element other 1\nproperty list uchar int some\nend_header\n";
  CHECK(said_of(header + std::to_string(header.size() + 2)) ==
        ":6: the length of a list is not from 0 to " + std::to_string(header.size() + 1));
  CHECK(said_of(header + std::to_string(header.size() + 1)) ==
        ":6: the file ends before its last element; write it anew");
}

TEST_CASE("coordinates of a PLY file are finite, and none is missing") {
  for (const std::string bad : {"nan 0 0", "0 inf 0", "0 0 -inf"}) {
    std::string text = ascii("", 1, one_face);
    text.replace(text.find("1 1 0\n"), 5, bad);
    CHECK(said_of(text) == ":12: vertex 2 lacks a finite x, y or z; give numbers in m");
  }
  for (const std::string axis : {"x", "y", "z"}) {
    std::string text = ascii("", 1, one_face);
    text.replace(text.find("double " + axis), 8, "double w");
    CHECK(said_of(text) == ":10: vertex 0 lacks a finite x, y or z; give numbers in m");
  }
}

TEST_CASE("a PLY file holds 2 million vertices, 4 million triangles, 256 MiB") {
  const auto many = [](const std::string& count) {
    return start + "element vertex " + count + "\n" + places + "end_header\n";
  };
  CHECK(said_of(many("2000000")) == ":8: the file ends before its last element; write it anew");
  CHECK(said_of(many("2000001")) == ":8: more than 2000000 vertices, the most that is read");

  const auto polygon = [](std::uint32_t count) {
    const std::string header =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar "
        "y\nproperty uchar z\nelement face 1\nproperty list uint uchar vertex_indices\n"
        "end_header\nxyz";
    return header + bytes_of(count, false) + std::string(count, '\0');
  };
  CHECK(read(polygon(4'000'002)).soup.triangles.size() == 4'000'000);
  CHECK(said_of(polygon(4'000'003)) == ": more than 4000000 triangles, the most that is read");

  const ScratchFolder folder;
  const std::string path = folder.write("t.ply", ascii("", 1, one_face));
  CHECK(read_ply(path).soup.triangles.size() == 1);
  CHECK(read_ply(path).soup.origin.file == path);
  std::filesystem::resize_file(path, (1 << 28) + 1);  // a file of holes
  CHECK_THROWS_WITH(read_ply(path), path + ": longer than 268435456 bytes, the most that is read");
}
