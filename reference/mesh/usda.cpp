#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include "reference/mesh/mesh_frames.h"
#include "reference/mesh/mesh_reading.h"
#include "reference/mesh/polygon.h"

namespace foldproof {

namespace {

using Values = std::map<std::string, std::string_view, std::less<>>;  // as written, by name

constexpr std::size_t most_numbers = 100'000'000;  // of a list

[[noreturn]] void reject(const std::string& file, const std::string& reason) {
  throw InputError(file + ": " + reason);
}

/// For a message: its beginning, in one line.
std::string shown(std::string_view word) {
  std::string text(word.substr(0, 40));
  std::ranges::replace_if(
      text, [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return text;
}

/// Words, strings and brackets of a layer; blanks, commas, semicolons and comments part them.
struct Cursor {
  std::string_view text;
  const std::string& file;
  std::size_t at = 0;

  void skip_blanks() {
    while (at < text.size()) {
      if (text[at] == '#')
        at = std::min(text.find('\n', at), text.size());
      else if (std::string_view(" \t\r\n,;").find(text[at]) == std::string_view::npos)
        return;
      else
        ++at;
    }
  }

  bool is_at(char c) {
    skip_blanks();
    return at < text.size() && text[at] == c;
  }

  /// A string or a path with its quotes, a bracket, or a word; empty at the end.
  std::string_view next() {
    skip_blanks();
    const std::size_t start = at;
    if (at == text.size()) return {};
    const char first = text[at];
    if (first == '"' || first == '\'' || first == '@' || first == '<') {
      const std::string_view triple = text.substr(at, 3);
      const bool is_long = first != '<' && triple == std::string(3, first);
      const std::string end =
          is_long ? std::string(triple) : std::string(1, first == '<' ? '>' : first);
      at += end.size();
      while (at < text.size() && text.substr(at, end.size()) != end)
        at += text[at] == '\\' && first != '@' ? 2 : 1;
      if (at >= text.size()) reject(file, "a string does not end; write it anew");
      at += end.size();
    } else if (std::string_view("()[]{}=:").find(first) != std::string_view::npos) {
      ++at;
    } else {
      at = std::min(text.find_first_of(" \t\r\n,;#()[]{}=\"'@<", at), text.size());
      // a time code ends at its colon, a name holds some
      if (at > start && text[at - 1] == ':') --at;
    }
    return text.substr(start, at - start);
  }

  /// A value as written: a word, or all between brackets that match.
  std::string_view value() {
    skip_blanks();
    const std::size_t start = at;
    long depth = 0;
    do {
      const std::string_view word = next();
      if (word.empty()) reject(file, "ends within a value; write it anew");
      if (word == "(" || word == "[" || word == "{") ++depth;
      if (word == ")" || word == "]" || word == "}") --depth;
    } while (depth > 0);
    return text.substr(start, at - start);
  }
};

double number(const std::string& file, std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    reject(file, "'" + shown(word) + "' is no finite number");
  return value;
}

/// All numbers of a value, whatever brackets are around them.
std::vector<double> numbers(const std::string& file, std::string_view value) {
  Cursor cursor{value, file};
  std::vector<double> all;
  for (std::string_view word = cursor.next(); !word.empty(); word = cursor.next())
    if (word != "(" && word != ")" && word != "[" && word != "]") {
      if (all.size() == most_numbers) reject(file, "a list is longer than 100000000 numbers");
      all.push_back(number(file, word));
    }
  return all;
}

double number_or(const std::string& file, const Values& values, std::string_view name,
                 double other) {
  const auto found = values.find(name);
  return found == values.end() ? other : number(file, found->second);
}

bool is_identity(const std::string& file, std::string_view name, std::string_view value) {
  const std::vector<double> all = numbers(file, value);
  const bool is_matrix = all.size() == 16, is_scale = name.find("scale") != name.npos;
  const bool is_quaternion = name.find("orient") != name.npos;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k] != (is_scale || (is_matrix && k % 5 == 0) || (is_quaternion && k == 0) ? 1 : 0))
      return false;
  return true;
}

/// All that is written as NAME = VALUE: metadata and attributes, of a layer whose only mesh nothing
/// moves.
Values values_of(std::string_view text, const std::string& file) {
  if (!text.starts_with("#usda 1.0"))
    reject(file, "does not begin with #usda 1.0; give USD as text");
  Cursor cursor{text, file};
  Values values;
  int meshes = 0;
  std::string_view name;
  for (std::string_view word = cursor.next(); !word.empty(); word = cursor.next()) {
    if (word == "def" && cursor.next() == "Mesh") ++meshes;
    if (word != "=") {
      name = word;
      continue;
    }
    const std::string_view value = cursor.value();
    if (name.starts_with("xformOp:") &&
        (name.ends_with(".timeSamples") || !is_identity(file, name, value)))
      reject(file, shown(name) +
                       " moves the mesh, which is not read; apply all transforms before export");
    values[std::string(name)] = value;
  }
  if (meshes != 1)
    reject(file, "holds " + std::to_string(meshes) + " meshes; give a file with one Mesh alone");
  for (const char* needed : {"faceVertexCounts", "faceVertexIndices", "points.timeSamples"})
    if (!values.contains(needed))
      reject(file, std::string("its Mesh lacks ") + needed + "; export an animated mesh");
  return values;
}

std::vector<Triangle> faces_of(const Values& mesh, const PerParticle3& x, const std::string& file) {
  const Eigen::Index points = x.cols();
  const std::vector<double> counts = numbers(file, mesh.find("faceVertexCounts")->second);
  const std::vector<double> corners = numbers(file, mesh.find("faceVertexIndices")->second);
  for (const double corner : corners)
    if (!(corner >= 0 && corner < double(points) && corner == std::floor(corner)))
      reject(file, "faceVertexIndices name no point from 0 to " + std::to_string(points - 1));
  std::vector<Triangle> triangles;
  std::size_t first = 0;
  for (const double count : counts) {
    if (!(count >= 3 && count <= double(corners.size() - first) && count == std::floor(count)))
      reject(file, "faceVertexCounts do not fit faceVertexIndices; write it anew");
    const std::vector<int> polygon(corners.begin() + long(first),
                                   corners.begin() + long(first) + long(count));
    const std::vector<Triangle> cut = triangles_of_polygon(polygon, x);
    if (cut.empty()) reject(file, "a polygon whose sides cross; cut it into triangles");
    triangles.insert(triangles.end(), cut.begin(), cut.end());
    first += std::size_t(count);
  }
  return triangles;
}

/// 3 x N, in metres, y up.
PerParticle3 points_of(const std::vector<double>& numbers, double metres, bool is_z_up) {
  PerParticle3 x =
      Eigen::Map<const PerParticle3>(numbers.data(), 3, Eigen::Index(numbers.size() / 3));
  if (metres != 1) x *= metres;
  if (!is_z_up) return x;
  PerParticle3 turned(3, x.cols());
  turned << x.row(0), x.row(2), -x.row(1);
  return turned;
}

}  // namespace

std::vector<MeshFrame> read_usda_text(std::string_view text, const std::string& file) {
  const Values values = values_of(text, file);
  const double rate = number_or(file, values, "timeCodesPerSecond", 24);
  const double metres = number_or(file, values, "metersPerUnit", 0.01);
  const double start = number_or(file, values, "startTimeCode", 0);
  if (!(rate > 0) || !(metres > 0))
    reject(file, "timeCodesPerSecond and metersPerUnit must be positive");
  const auto up = values.find("upAxis");
  const bool is_z_up = up != values.end() && up->second.find('Z') != std::string_view::npos;
  Cursor samples{values.find("points.timeSamples")->second, file};
  std::vector<MeshFrame> frames;
  std::vector<Triangle> triangles;
  samples.next();  // the bracket
  while (!samples.is_at('}')) {
    const double code = number(file, samples.next());
    samples.next();  // a colon
    const std::vector<double> points = numbers(file, samples.value());
    const std::string name = file + " sample " + std::to_string(frames.size());
    if (points.empty() || points.size() % 3 != 0) reject(name, "no points of three coordinates");
    const PerParticle3 x = points_of(points, metres, is_z_up);
    reject_bad_places(x, name);
    if (frames.empty())
      triangles = faces_of(values, x, file);
    else if (x.cols() != frames.front().x.cols())
      reject(name, "another number of points than the first sample; all must have the same mesh");
    frames.push_back({name, code, (code - start) / rate, x, triangles});
  }
  if (frames.empty()) reject(file, "points.timeSamples hold no sample");
  return frames;
}

}  // namespace foldproof
