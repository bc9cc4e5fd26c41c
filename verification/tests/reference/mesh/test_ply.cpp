// PLY files: every type in both byte orders, blanks, limits at the very bound, refusals.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>

#include "reference/mesh/mesh_reading.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;

namespace {

/// The number's bytes in the file's order.
template <class Number>
std::string bytes_of(Number value, bool is_big) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (is_big) std::ranges::reverse(bytes);
  return bytes;
}

MeshFile read(const std::string& text) { return read_ply_text(text, "t.ply"); }

/// The refusal without the file's name; "" if the text is read.
std::string said_of_ply(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    const std::string message = error.what();
    CHECK(message.find('\n') == std::string::npos);
    return message.substr(5);
  }
  return "";
}

const std::string start = "ply\nformat ascii 1.0\n";
const std::string places = "property double x\nproperty double y\nproperty double z\n";
const std::string corners = "property list uchar int vertex_indices\n";
const std::string four_vertices = "0.5 7 8\n1 0 0\n1 1 0\n0 1 0\n";
const std::string one_face = "3 0 1 2\n";
const std::string too_short = "the file ends before its last element";

/// Four vertices and the faces.
std::string ascii(const std::string& header_lines, int count, const std::string& faces) {
  return start + header_lines + "element vertex 4\n" + places + "element face " +
         std::to_string(count) + "\n" + corners + "end_header\n" + four_vertices + faces;
}

std::string binary_start(bool is_big) {
  return std::string("ply\nformat binary_") + (is_big ? "big" : "little") + "_endian 1.0\n";
}

/// Binary triangles, with the value of a type as the y of the second of three vertices, and as the
/// number of an index.
template <class Number>
void check_type(std::initializer_list<std::string> names, Number value, bool is_big) {
  std::string data;
  for (int v = 0; v < 3; ++v)
    data += bytes_of(0.3 * v, is_big) + bytes_of(v == 1 ? value : Number(v), is_big) +
            bytes_of(-1.7 * v, is_big);
  data += '\3';
  for (const int v : {2, 0, 1}) data += bytes_of(Number(v), is_big);
  for (const std::string& name : names) {
    INFO(name);
    const std::string header = binary_start(is_big) +
                               "element vertex 3\nproperty double x\nproperty " + name +
                               " y\nproperty double z\nelement face 1\nproperty list uchar " +
                               name + " vertex_index\nend_header\n";
    const MeshFile mesh = read(header + data);
    CHECK(mesh.soup.rest.col(1) == Vector3(0.3, double(value), -1.7));
    CHECK(mesh.soup.rest.col(2) == Vector3(0.6, 2, -3.4));
    CHECK(mesh.soup.triangles == std::vector<Triangle>{{2, 0, 1}});
    CHECK(said_of_ply(header + data.substr(0, data.size() - 1)).starts_with(": " + too_short));
  }
}

}  // namespace

TEST_CASE("an ASCII PLY file is read, whatever else its vertices hold") {
  const MeshFile mesh = read(
      "ply\r\nformat\tascii\v1.0\r\ncomment time 0.25 s\n element \f vertex\t4\n\nproperty float "
      "x\n"
      "property uchar red\nproperty double y\nproperty list uchar int neighbours\n"
      "property double z\nelement face 2\nproperty list uchar int vertex_indices\nend_header \r\n"
      "0\t255\v0.1 2 7\f8 -3\r\n1 0 0\n\n0 0.5\n1 0 1 1 9 0 0 3 1 0 1e-3\n 5 0 1 2\n3 0\n0");
  CHECK(mesh.time == 0.25);
  REQUIRE(mesh.soup.rest.cols() == 4);
  CHECK(mesh.soup.rest.col(0) == Vector3(0, 0.1, -3));
  CHECK(mesh.soup.rest.col(2) == Vector3(1, 1, 0));
  CHECK(mesh.soup.rest.col(3) == Vector3(0, 1, 1e-3));
  CHECK(mesh.soup.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
  // the header has thirteen lines; a vertex is of the line of its last number
  CHECK(mesh.soup.origin.vertex_lines == std::vector<int>{14, 17, 18, 18});
  CHECK(mesh.soup.origin.triangle_lines == std::vector<int>{19, 19});
  CHECK(mesh.soup.origin.file == "t.ply");
}

TEST_CASE("binary PLY files of both byte orders hold the same mesh, to the bit") {
  for (const bool is_big : {false, true}) {
    std::string text = binary_start(is_big) +
                       "element vertex 3\nproperty double x\nproperty float y\nproperty short z\n"
                       "element extra 1\nproperty list uint ushort many\nelement face 1\n"
                       "property uchar flag\nproperty list char uint vertex_index\nend_header\n";
    const auto put = [&](auto number) { text += bytes_of(number, is_big); };
    for (int v = 0; v < 3; ++v)
      put(std::array{0.1, 1.7, -2.3}[size_t(v)]), put(0.5f + 3 * float(v)), put(short(-300 * v));
    put(2u), put(short(5)), put(short(6)), put('\1'), put('\3');
    for (const unsigned v : {2u, 0u, 1u}) put(v);
    const MeshFile mesh = read(text);
    CHECK_FALSE(mesh.time);
    CHECK(mesh.soup.rest.col(1) == Vector3(1.7, 3.5, -300));
    CHECK(mesh.soup.rest.col(2) == Vector3(-2.3, 6.5, -600));
    CHECK(mesh.soup.triangles == std::vector<Triangle>{{2, 0, 1}});
  }
}

TEST_CASE("numbers of a PLY file have eight types of two names each, in both byte orders") {
  for (const bool is_big : {false, true}) {
    check_type({"char", "int8"}, std::int8_t(-113), is_big);
    check_type({"uchar", "uint8"}, std::uint8_t(213), is_big);
    check_type({"short", "int16"}, std::int16_t(-30111), is_big);
    check_type({"ushort", "uint16"}, std::uint16_t(60111), is_big);
    check_type({"int", "int32"}, std::int32_t(-2000000111), is_big);
    check_type({"uint", "uint32"}, std::uint32_t(4000000111u), is_big);
    check_type({"float", "float32"}, 0.1f, is_big);
    check_type({"double", "float64"}, 0.1, is_big);
  }
}

TEST_CASE("a PLY file may have plus signs, faces before vertices, strips, any line ends, a mark") {
  const std::string strips =
      start + "element tristrips 1\nproperty list int int vertex_indices\nelement vertex 5\n" +
      places + "end_header\n10 0 1 2 3 3 3 -1 4 2 1\n+0 0 0\n+1e0 0 0\n0 1 0\n1 1 0\n2 2 0\n";
  const std::vector<Triangle> wanted{{0, 1, 2}, {2, 1, 3}, {4, 2, 1}};
  CHECK(read(strips).soup.triangles == wanted);
  std::string other = strips;
  std::ranges::replace(other, '\n', '\r');
  CHECK(read_mesh_text(other, "t.ply").soup.triangles == wanted);
  CHECK(read_mesh_text("\xEF\xBB\xBF" + strips, "t.ply").soup.triangles == wanted);
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
  const MeshFile mesh = read(text);
  CHECK(mesh.soup.rest.col(0) == Vector3(0.5, 7, 8));
  CHECK(mesh.soup.rest.col(3) == Vector3(0, 1, 0));
  CHECK(mesh.soup.triangles == std::vector<Triangle>{{3, 0, 2}, {0, 1, 2}, {1, 2, 3}});
  CHECK(said_of_ply(text.substr(0, text.size() - 2)).starts_with(":31: " + too_short));
}

TEST_CASE("PLY files are refused in a line that says what is wrong") {
  const std::string whole = ascii("", 1, one_face);
  const std::string vertices = start + "element vertex 200000";
  struct Row {
    std::string said, from;
    std::vector<std::string> to;  // each in place of `from`, the first time that it is found
  };
  for (const auto& [said, from, to] : std::vector<Row>{
           {":1: the file does not begin", whole, {"", "plyx\n", "PLY\n"}},
           {":3: the header has no end_header", whole, {start + "end_header"}},
           {":2: the header names no format", whole, {"ply\nend_header\n"}},
           {":2: '" + std::string(40, 'b') + "' is no format", "ascii", {std::string(50, 'b')}},
           {":5: 'int64' is no type; write char, uchar", "double y", {"int64 y"}},
           {":7: a second element 'vertex'", "element face", {"element vertex"}},
           {":3: a property before any element", "element vertex 4", {"property int x"}},
           {":3: an element is written", "x 4", {"x", "x 4 5", "x 4x", "x -1", "x 4.0"}},
           {":4: a property is written", "double x", {"int", "int x y", "list uchar int"}},
           {":4: a property is written", "double x", {"lost uchar int x", "list char int x y"}},
           {":8: the length of a list is no whole", "t uchar", {"t float", "t float64"}},
           {":10: the element vertex has no property z", "double z", {"double w"}},
           {":12: a coordinate is not finite", "1 1 0\n", {"1 nan 0\n"}},
           {":12: 'o' is not a number", "1 1 0\n", {"1 1 o\n"}},
           {":14: a face of fewer than three vertices", "3 0 1 2", {"2 0 1"}},
           {":14: the length of a face is not from 0 to", "3 0", {"-3 0", "999 0"}},
           {":14: an index of a vertex is not", "1 2\n", {"-1 2", "1.5 2", "nan"}},
           {":14: index 4 is out of range; the file has 4", "1 2\n", {"4 2"}},
           {":14: '2x' is not a number", "1 2\n", {"1 2x\n"}},
           {":14: " + too_short, "1 2\n", {"1"}},
           {":14: the file has no face", "vertex_indices", {"others"}},
           {":15: data behind the last element", "3 0 1 2\n", {"3 0 1 2\n3 0 2 3\n"}},
           {":12: '1e400' does not fit a double", "1 1 0\n", {"1 1e400 0\n"}},
           {":8: " + too_short, whole, {vertices + "0\n" + places + "end_header\n"}},
           {":8: more than 2000000", whole, {vertices + "1\n" + places + "end_header\n"}}})
    for (const std::string& word : to) {
      std::string text = whole;
      text.replace(text.find(from), from.size(), word);
      CHECK_THAT(said_of_ply(text), Catch::StartsWith(said));
    }
}
