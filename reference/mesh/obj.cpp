#include "reference/mesh/obj.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "reference/mesh/text_file.h"

namespace foldproof {
namespace {

/// A place in the text of a file.
struct Cursor {
  std::string_view text;
  const std::string& file;
  size_t at = 0;  // next character
  int line = 1;
};

struct Contents {
  std::vector<Vector3> vertices;
  std::vector<Triangle> triangles;  // indices from 0; checked for too high ones at the file's end
  MeshOrigin origin;
  FaceGroups groups;
  std::vector<std::string> names_g, names_o;  // of the groups that the next faces belong to
};

[[noreturn]] void reject(const std::string& file, int line, const std::string& reason) {
  throw InputError(file + ":" + std::to_string(line) + ": " + reason);
}

std::string quote(std::string_view token) { return "'" + std::string(token) + "'"; }

// Twice the largest cloth in the speed measurements.
constexpr size_t most_vertices = 2'000'000, most_triangles = 4'000'000;
constexpr size_t most_names = 16;  // of one record g or o

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
  // from_chars knows no plus sign
  const size_t plus = word.size() > 1 && word[0] == '+' && word[1] != '-' ? 1 : 0;
  const char* end = word.data() + word.size();
  double value = 0;
  const std::from_chars_result result = std::from_chars(word.data() + plus, end, value);
  if (result.ec == std::errc() && result.ptr == end) return value;
  const bool too_large = result.ec == std::errc::result_out_of_range;
  reject(cursor.file, cursor.line,
         quote(word) + (too_large ? " does not fit a double" : " is not a number") +
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
  contents.origin.vertex_lines.push_back(line);
}

/// Takes an integer off the front of the word.
std::optional<int> take_index(std::string_view& word) {
  int index = 0;
  const std::from_chars_result result =
      std::from_chars(word.data(), word.data() + word.size(), index);
  if (result.ec != std::errc()) return std::nullopt;
  word.remove_prefix(size_t(result.ptr - word.data()));
  return index;
}

/// Valid suffixes of a vertex index: nothing, /b, //c or /b/c.
bool ends_well(std::string_view rest) {
  if (rest.empty()) return true;
  if (!rest.starts_with('/')) return false;
  rest.remove_prefix(1);
  const bool has_texture = take_index(rest).has_value();
  if (rest.empty()) return has_texture;
  if (!rest.starts_with('/')) return false;
  rest.remove_prefix(1);
  return take_index(rest).has_value() && rest.empty();
}

/// The vertex of a corner, counted from 0. vertices: number of vertices so far.
int vertex_index(const Cursor& cursor, std::string_view word, size_t vertices) {
  std::string_view rest = word;
  const std::optional<int> taken = take_index(rest);
  if (!taken || !ends_well(rest)) {
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

/// A face may belong to an object and to a group of the same name.
void add_once(int triangle, std::vector<int>& group) {
  if (group.empty() || group.back() != triangle) group.push_back(triangle);
}

void read_face(Cursor& cursor, Contents& contents) {
  const int line = cursor.line;
  Triangle fan{};
  int count = 0;
  for (std::string_view word = next_word(cursor); !word.empty();
       word = next_word(cursor), ++count) {
    const int index = vertex_index(cursor, word, contents.vertices.size());
    if (count > 2) fan[1] = fan[2];
    fan[std::min(count, 2)] = index;
    if (count < 2) continue;
    if (contents.triangles.size() == most_triangles)
      reject(cursor.file, line,
             "more than " + std::to_string(most_triangles) + " triangles, the most that is read");
    contents.triangles.push_back(fan);
    contents.origin.triangle_lines.push_back(line);
    for (const auto* names : {&contents.names_g, &contents.names_o})
      for (const std::string& name : *names)
        add_once(int(contents.triangles.size()) - 1, contents.groups[name]);
  }
  if (count < 3)
    reject(cursor.file, line,
           "a face of " + std::to_string(count) + " vertices; give at least three");
}

/// The words of a record, each once. Every following face is entered under each of them: without a
/// limit a file could need memory that grows as the square of its length.
std::vector<std::string> read_names(Cursor& cursor) {
  std::vector<std::string> names;
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

void reject_missing_vertices(const Contents& contents) {
  const int vertices = int(contents.vertices.size());
  for (size_t t = 0; t < contents.triangles.size(); ++t) {
    for (int v : contents.triangles[t]) {
      if (v < vertices) continue;
      reject(contents.origin.file, contents.origin.triangle_lines[t],
             "index " + std::to_string(v + 1) + " is out of range; the file has " +
                 std::to_string(vertices) + " vertices");
    }
  }
}

/// Reads all records of a file, without checks of the mesh.
Contents contents_of(std::string_view text, const std::string& file) {
  // the mark that some editors put before UTF-8
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (text.empty()) reject(file, 1, "the file is empty; give v and f records");
  Contents contents;
  contents.origin.file = file;
  Cursor cursor{text, file};
  while (cursor.at < text.size()) {
    const std::string_view record = next_word(cursor);
    if (record == "v") read_vertex(cursor, contents);
    if (record == "f") read_face(cursor, contents);
    if (record == "g") contents.names_g = read_names(cursor);
    if (record == "o") contents.names_o = read_names(cursor);
    skip_rest_of_record(cursor);
  }
  if (contents.triangles.empty())
    reject(file, cursor.line - 1, "the file ends without a face; give f records");
  reject_missing_vertices(contents);
  return contents;
}

TriangleSoup soup_of(std::string_view text, const std::string& file) {
  Contents contents = contents_of(text, file);
  PerParticle3 rest(3, contents.vertices.size());
  for (size_t v = 0; v < contents.vertices.size(); ++v) rest.col(v) = contents.vertices[v];
  return {std::move(rest), std::move(contents.triangles), std::move(contents.origin)};
}

TriangleSoup finite(TriangleSoup soup, const std::string& file) {
  for (Eigen::Index v = 0; v < soup.rest.cols(); ++v) {
    if (!soup.rest.col(v).allFinite())
      reject(file, soup.origin.vertex_lines[v], "a coordinate is not finite; give numbers in m");
  }
  return soup;
}

}  // namespace

TriangleMesh read_obj_text(std::string_view text, const std::string& file) {
  TriangleSoup soup = soup_of(text, file);
  return make_triangle_mesh(std::move(soup.rest), std::move(soup.triangles), soup.origin);
}

FaceGroups read_obj_groups_text(std::string_view text, const std::string& file) {
  return contents_of(text, file).groups;
}

TriangleSoup read_obj_soup_text(std::string_view text, const std::string& file) {
  return finite(soup_of(text, file), file);
}

TriangleMesh read_obj(const std::string& path) {
  return read_obj_text(read_text_file(path, table_text_limits), path);
}

FaceGroups read_obj_groups(const std::string& path) {
  return read_obj_groups_text(read_text_file(path, table_text_limits), path);
}

TriangleSoup read_obj_soup(const std::string& path) {
  return read_obj_soup_text(read_text_file(path, table_text_limits), path);
}

TriangleSoup read_body_soup(const std::string& path) {
  return finite(without_unused_vertices(soup_of(read_text_file(path, table_text_limits), path)),
                path);
}

void write_obj(const std::string& path, const PerParticle3& positions,
               const std::vector<Triangle>& triangles) {
  std::string text = "# written by foldproof; lengths in m\n";
  char digits[32];
  for (Eigen::Index v = 0; v < positions.cols(); ++v) {
    text += 'v';
    for (int k = 0; k < 3; ++k) {
      // as %.17g, but the same in every locale
      const std::to_chars_result end = std::to_chars(
          digits, digits + sizeof digits, positions(k, v), std::chars_format::general, 17);
      text.append(1, ' ').append(digits, end.ptr);
    }
    text += '\n';
  }
  for (size_t t = 0; t < triangles.size(); ++t) {
    text += 'f';
    for (int v : triangles[t]) {
      if (v < 0 || v >= positions.cols()) {
        throw InputError("write_obj: triangle " + std::to_string(t) + ": vertex index " +
                         std::to_string(v) + " is out of range; there are " +
                         std::to_string(positions.cols()) + " positions");
      }
      text.append(1, ' ').append(std::to_string(v + 1));
    }
    text += '\n';
  }
  std::ofstream file(path, std::ios::binary);
  file << text << std::flush;
  if (!file) throw InputError(path + ": cannot be written; check the folder and the space left");
}

}  // namespace foldproof
