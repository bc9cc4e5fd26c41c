// Reads Wavefront OBJ files.
#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

#include "reference/mesh/mesh_reading.h"

namespace foldproof {
namespace {

/// A place in the text of a file.
struct Cursor {
  std::string_view text;
  const std::string& file;
  size_t at = 0;  // next character
  int line = 1;
};

using Names = std::vector<std::string>;

struct Contents {
  std::vector<Vector3> vertices;
  std::vector<int> vertex_lines;
  FaceList faces;  // indices from 0
  std::vector<Eigen::Vector2d> textures;
  // of each corner of each face its vertex and its texture coordinates, counted from 0 (-1: none),
  // and the first corner of each face
  std::vector<std::array<int, 2>> corners;
  std::vector<size_t> first_corner;
  // of the groups that faces belong to, by g, o and usemtl; and for each face its place in each
  std::array<std::vector<Names>, 3> groups{{{{}}, {{}}, {{}}}};
  std::vector<std::array<size_t, 3>> groups_of_face;
};

[[noreturn]] void reject(const std::string& file, int line, const std::string& reason) {
  throw InputError(file + ":" + std::to_string(line) + ": " + reason);
}

std::string quote(std::string_view token) { return "'" + std::string(token) + "'"; }

constexpr size_t most_names = 16;  // of one record g, o or usemtl

// --- words of a line ---

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// Length of a backslash and the line end behind it, which count as a blank; 0 where there is none.
size_t continuation(const Cursor& cursor) {
  const std::string_view rest = cursor.text.substr(cursor.at, 3);
  if (rest.starts_with("\\\n")) return 2;
  return rest == "\\\r\n" ? 3 : 0;
}

/// The next word of the record; empty at its end or at a comment.
std::string_view next_word(Cursor& cursor) {
  const std::string_view text = cursor.text;
  while (cursor.at < text.size()) {
    const size_t continued = text[cursor.at] == '\\' ? continuation(cursor) : 0;
    if (continued == 0 && !is_blank(text[cursor.at])) break;
    cursor.at += continued > 0 ? continued : 1;
    cursor.line += continued > 0 ? 1 : 0;
  }
  const size_t start = cursor.at;
  if (start < text.size() && text[start] == '#') return {};
  while (cursor.at < text.size() && !is_blank(text[cursor.at]) && text[cursor.at] != '\n') {
    if (text[cursor.at] == '\\' && continuation(cursor) > 0) break;
    ++cursor.at;
  }
  return text.substr(start, cursor.at - start);
}

void skip_rest_of_record(Cursor& cursor) {
  while (!next_word(cursor).empty()) continue;
  cursor.at = std::min(cursor.text.find('\n', cursor.at), cursor.text.size()) + 1;
  ++cursor.line;
}

// --- records ---

double number(const Cursor& cursor, std::string_view word) {
  double value = 0;
  const std::errc error = read_number(word, value);
  if (error == std::errc()) return value;
  const bool is_too_large = error == std::errc::result_out_of_range;
  reject(cursor.file, cursor.line,
         quote(word) + (is_too_large ? " does not fit a double" : " is not a number") +
             "; a vertex is written 'v x y z'");
}

/// x y z, then at most four more numbers (w, colours), which are ignored.
void read_vertex(Cursor& cursor, Contents& contents) {
  const int line = cursor.line;
  Vector3 vertex;
  int count = 0;
  const auto take = [&](double& value) {
    const std::string_view word = next_word(cursor);
    if (word.empty()) return false;
    value = number(cursor, word);
    ++count;
    return true;
  };
  for (double& coordinate : vertex) take(coordinate);
  double unused = 0;
  while (take(unused)) continue;
  if (count < 3 || count > 7)
    reject(cursor.file, line, "a vertex of " + std::to_string(count) + " numbers; write 'v x y z'");
  if (contents.vertices.size() == most_vertices)
    reject(cursor.file, line,
           "more than " + std::to_string(most_vertices) + " vertices, the most that is read");
  contents.vertices.push_back(vertex);
  contents.vertex_lines.push_back(line);
}

/// Takes an integer off the front of the word. is_beyond: it is one, but of no int.
std::optional<int> take_index(std::string_view& word, bool& is_beyond) {
  int index = 0;
  const std::from_chars_result result =
      std::from_chars(word.data(), word.data() + word.size(), index);
  is_beyond = result.ec == std::errc::result_out_of_range;
  if (result.ec != std::errc()) return std::nullopt;
  word.remove_prefix(size_t(result.ptr - word.data()));
  return index;
}

/// Valid suffixes of a vertex index: up to two slashes, each with an index behind it or without.
/// texture: that behind the first; 0 if there is none.
bool ends_well(std::string_view rest, int& texture) {
  for (int slashes = 0; slashes < 2 && rest.starts_with('/'); ++slashes) {
    bool is_beyond = false;  // of no interest
    rest.remove_prefix(1);
    const std::optional<int> index = take_index(rest, is_beyond);
    if (slashes == 0) texture = index.value_or(0);
  }
  return rest.empty();
}

/// Two numbers, or more, which are ignored; NaN for what is none: only those who need texture
/// coordinates refuse them.
void read_texture(Cursor& cursor, Contents& contents) {
  Eigen::Vector2d place = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (double& number : place) {
    double told = 0;
    if (read_number(next_word(cursor), told) == std::errc()) number = told;
  }
  contents.textures.push_back(place);
}

/// The vertex of a corner, counted from 0. vertices: number of vertices so far. texture: as
/// written, 0 for none.
int vertex_index(const Cursor& cursor, std::string_view word, size_t vertices, int& texture) {
  std::string_view rest = word;
  bool is_beyond = false;
  const std::optional<int> taken = take_index(rest, is_beyond);
  if (is_beyond)
    reject(cursor.file, cursor.line,
           "index " + std::string(word) + " is out of range; " + std::to_string(vertices) +
               " vertices come before this face");
  if (!taken || !ends_well(rest, texture)) {
    reject(cursor.file, cursor.line,
           quote(word) + " is no corner of a face; write a, a/b, a//c or a/b/c");
  }
  const int index = *taken;
  if (index == 0)
    reject(cursor.file, cursor.line, "index 0 in " + quote(word) + "; vertices are counted from 1");
  if (index > 0) return index - 1;
  if (size_t(-long(index)) > vertices) {
    reject(cursor.file, cursor.line,
           "index " + std::to_string(index) + " is out of range; " + std::to_string(vertices) +
               " vertices come before this face");
  }
  return int(long(vertices) + index);
}

void read_face(Cursor& cursor, Contents& contents) {
  const int line = cursor.line;
  contents.faces.begin(line);
  auto& groups = contents.groups_of_face.emplace_back();
  for (size_t kind = 0; kind < groups.size(); ++kind)
    groups[kind] = contents.groups[kind].size() - 1;
  contents.first_corner.push_back(contents.corners.size());
  for (std::string_view word = next_word(cursor); !word.empty(); word = next_word(cursor)) {
    int texture = 0;
    const int vertex = vertex_index(cursor, word, contents.vertices.size(), texture);
    if (!contents.faces.add(vertex))
      reject(cursor.file, line,
             "more than " + std::to_string(most_triangles) + " triangles, the most that is read");
    const int before = int(contents.textures.size());
    contents.corners.push_back({vertex, texture < 0 ? before + texture : texture - 1});
  }
  if (contents.faces.corners() < 3)
    reject(
        cursor.file, line,
        "a face of " + std::to_string(contents.faces.corners()) + " vertices; give at least three");
}

/// The words of a record, each once. Every following face is entered under each of them: without a
/// limit a file could need memory that grows as the square of its length.
Names read_names(Cursor& cursor) {
  Names names;
  for (std::string_view word = next_word(cursor); !word.empty(); word = next_word(cursor)) {
    if (std::ranges::find(names, word) != names.end()) continue;
    if (names.size() == most_names)
      reject(
          cursor.file, cursor.line,
          "more than " + std::to_string(most_names) + " names of groups in a record; give fewer");
    names.emplace_back(word);
  }
  return names;
}

/// The groups of the faces that follow. Names without a face are not kept.
void begin_group(Contents& contents, size_t kind, Names names) {
  std::vector<Names>& groups = contents.groups[kind];
  const bool has_face =
      !contents.groups_of_face.empty() && contents.groups_of_face.back()[kind] == groups.size() - 1;
  if (has_face) groups.emplace_back();
  groups.back() = std::move(names);
}

/// Reads all records of a file.
Contents contents_of(std::string_view text, const std::string& file, Needs needs) {
  if (text.empty()) reject(file, 1, "the file is empty; give v and f records");
  Contents contents;
  Cursor cursor{text, file};
  std::string_view first;
  while (cursor.at < text.size()) {
    const std::string_view record = next_word(cursor);
    if (first.empty()) first = record.substr(0, 40);
    if (record == "v") read_vertex(cursor, contents);
    if (record == "f") read_face(cursor, contents);
    if (record == "vt") read_texture(cursor, contents);
    if (record == "g") begin_group(contents, 0, read_names(cursor));
    if (record == "o") begin_group(contents, 1, read_names(cursor));
    if (record == "usemtl") begin_group(contents, 2, read_names(cursor));
    skip_rest_of_record(cursor);
  }
  if (contents.faces.empty() && (needs == Needs::faces || contents.vertices.empty()))
    reject(
        file, cursor.line - 1,
        contents.vertices.empty()
            ? "the file ends without a record v or f" +
                  (first.empty() ? "" : "; its first is " + quote(first)) +
                  "; give an OBJ file (in small letters), or PLY, which begins with the line 'ply'"
            : "the file ends without a face; give f records");
  return contents;
}

/// face_of_triangle: of each triangle.
FaceGroups groups_of(const Contents& contents, const std::vector<int>& face_of_triangle) {
  FaceGroups groups;
  for (size_t t = 0; t < face_of_triangle.size(); ++t) {
    const auto& places = contents.groups_of_face[size_t(face_of_triangle[t])];
    for (size_t kind = 0; kind < places.size(); ++kind)
      for (const std::string& name : contents.groups[kind][places[kind]]) {
        std::vector<int>& group = groups[name];
        // a face may belong to an object and to a group of the same name
        if (group.empty() || group.back() != int(t)) group.push_back(int(t));
      }
  }
  return groups;
}

/// The texture coordinates of the triangles' corners; {} unless all have some.
std::vector<FlatTriangle> textures_of(const Contents& contents,
                                      const std::vector<Triangle>& triangles,
                                      const std::vector<int>& face_of_triangle) {
  std::vector<FlatTriangle> flat;
  if (contents.textures.empty()) return flat;
  for (size_t t = 0; t < triangles.size(); ++t) {
    FlatTriangle corners;
    for (size_t k = 0; k < 3; ++k) {
      auto corner = contents.corners.begin() +
                    std::ptrdiff_t(contents.first_corner[size_t(face_of_triangle[t])]);
      while ((*corner)[0] != triangles[t][k]) ++corner;  // it is one of the face's
      const int texture = (*corner)[1];
      if (texture < 0 || size_t(texture) >= contents.textures.size()) return {};
      corners[k] = contents.textures[size_t(texture)];
    }
    flat.push_back(corners);
  }
  return flat;
}

}  // namespace

MeshFile read_obj_text(std::string_view text, const std::string& file, Needs needs) {
  Contents contents = contents_of(text, file, needs);
  MeshFile mesh;
  mesh.soup.rest.resize(3, Eigen::Index(contents.vertices.size()));
  for (size_t v = 0; v < contents.vertices.size(); ++v)
    mesh.soup.rest.col(Eigen::Index(v)) = contents.vertices[v];
  mesh.soup.origin = {file, std::move(contents.vertex_lines), {}};
  const std::vector<int> faces = contents.faces.cut_into(mesh.soup, 1);
  mesh.groups = groups_of(contents, faces);
  mesh.textures = textures_of(contents, mesh.soup.triangles, faces);
  return mesh;
}

}  // namespace foldproof
