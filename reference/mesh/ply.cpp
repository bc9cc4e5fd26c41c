// Reads PLY files.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "reference/mesh/mesh_reading.h"

namespace foldproof {
namespace {

constexpr std::size_t most_parts = 64;  // elements and properties of a header

struct Property {
  std::string_view name;
  const NumberType& type;
  const NumberType* count_type = nullptr;  // of a list's length; null if it is no list
};

struct Element {
  std::string_view name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

enum class Form { ascii, little_endian, big_endian };

struct Header {
  Form form = Form::ascii;
  std::vector<Element> elements;
  std::optional<double> time;
};

/// A place in the file.
struct Reader {
  std::string_view text;
  const std::string& file;
  std::size_t at = 0;
  int line = 1;             // of the header and of ASCII
  Form form = Form::ascii;  // of the next value to read
  char line_end = '\n';     // or '\r', if the file's first line ends with that alone
};

[[noreturn]] void reject(const Reader& reader, const std::string& reason) {
  if (reader.form != Form::ascii) throw InputError(reader.file + ": " + reason);
  throw InputError(reader.file + ":" + std::to_string(reader.line) + ": " + reason);
}

std::string quote(std::string_view word) { return "'" + std::string(word.substr(0, 40)) + "'"; }

// --- the header ---

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view blanks = " \t\r\v\f";
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(blanks); at < line.size();
       at = line.find_first_not_of(blanks, at)) {
    const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

/// The next line of the header; in a file that is not PLY lines may be long, and are not split.
std::vector<std::string_view> header_line(Reader& reader) {
  const std::size_t end = reader.text.find(reader.line_end, reader.at);
  if (end == std::string_view::npos)
    reject(reader, "the header has no end_header; give a PLY file");
  const std::string_view line = reader.text.substr(reader.at, end - reader.at);
  if (line.size() > 4096) reject(reader, "a line of the header is longer than 4096 bytes");
  reader.at = end + 1;
  return words_of(line);
}

const NumberType& type_named(const Reader& reader, std::string_view word) {
  for (const NumberType& type : number_types)
    if (word == type.name || word == type.other) return type;
  reject(reader,
         quote(word) + " is no type; write char, uchar, short, ushort, int, uint, float or double");
}

template <class Number>
bool is_number(std::string_view word, Number& value) {
  if constexpr (std::is_same_v<Number, double>) {
    return read_number(word, value) == std::errc();
  } else {
    const char* const end = word.data() + word.size();
    const std::from_chars_result result = std::from_chars(word.data(), end, value);
    return result.ec == std::errc() && result.ptr == end;
  }
}

void read_format(Reader& reader, const std::vector<std::string_view>& words, Header& header) {
  const std::string_view form = words.size() > 1 ? words[1] : std::string_view();
  if (form == "ascii")
    header.form = Form::ascii;
  else if (form == "binary_little_endian")
    header.form = Form::little_endian;
  else if (form == "binary_big_endian")
    header.form = Form::big_endian;
  else
    reject(reader,
           quote(form) + " is no format; write ascii, binary_little_endian or binary_big_endian");
}

void read_element(Reader& reader, const std::vector<std::string_view>& words, Header& header) {
  Element element;
  if (words.size() != 3 || !is_number(words[2], element.count))
    reject(reader, "an element is written 'element NAME COUNT'");
  element.name = words[1];
  if (std::ranges::count(header.elements, element.name, &Element::name) > 0)
    reject(reader, "a second element " + quote(element.name) + "; name each once");
  header.elements.push_back(element);
}

void read_property(Reader& reader, const std::vector<std::string_view>& words, Header& header) {
  if (header.elements.empty()) reject(reader, "a property before any element");
  std::vector<Property>& properties = header.elements.back().properties;
  if (words.size() == 3) {
    properties.push_back({words[2], type_named(reader, words[1])});
  } else if (words.size() == 5 && words[1] == "list") {
    const NumberType& count = type_named(reader, words[2]);
    if (count.other.starts_with("float"))
      reject(reader, "the length of a list is no whole number; give it an integer type");
    properties.push_back({words[4], type_named(reader, words[3]), &count});
  } else {
    reject(reader, "a property is written 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
  }
}

Header read_header(Reader& reader) {
  Header header;
  if (reader.text.starts_with("ply\r") && !reader.text.starts_with("ply\r\n"))
    reader.line_end = '\r';
  if (words_of(reader.text.substr(0, reader.text.find(reader.line_end))) !=
      std::vector<std::string_view>{"ply"})
    reject(reader, "the file does not begin with the line 'ply'; give a PLY file");
  bool has_format = false;
  for (std::size_t parts = 0; parts <= most_parts;) {
    const std::vector<std::string_view> words = header_line(reader);
    const std::string_view first = words.empty() ? std::string_view() : words[0];
    double time = 0;
    if (first == "format") read_format(reader, words, header), has_format = true;
    if (first == "element") read_element(reader, words, header), ++parts;
    if (first == "property") read_property(reader, words, header), ++parts;
    if (first == "comment" && words.size() == 4 && words[1] == "time" && words[3] == "s" &&
        is_number(words[2], time) && std::isfinite(time))
      header.time = time;
    if (first == "end_header" && !has_format) reject(reader, "the header names no format");
    ++reader.line;
    if (first == "end_header") return header;
  }
  reject(reader, "more than 64 elements and properties, the most that is read");
}

// --- the data ---

std::string_view next_word(Reader& reader) {
  const auto is_blank = [](char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
  };
  while (reader.at < reader.text.size() && is_blank(reader.text[reader.at]))
    reader.line += reader.text[reader.at++] == reader.line_end ? 1 : 0;
  const std::size_t start = reader.at;
  while (reader.at < reader.text.size() && !is_blank(reader.text[reader.at])) ++reader.at;
  return reader.text.substr(start, reader.at - start);
}

double binary_number(Reader& reader, const NumberType& type) {
  static_assert(std::endian::native == std::endian::little);
  if (reader.text.size() - reader.at < type.bytes)
    reject(reader, "the file ends before its last element; write it anew");
  reader.at += type.bytes;
  return type.read(reader.text.data() + reader.at - type.bytes, reader.form == Form::big_endian);
}

double next_number(Reader& reader, const NumberType& type) {
  if (reader.form != Form::ascii) return binary_number(reader, type);
  const std::string_view word = next_word(reader);
  double value = 0;
  if (word.empty()) reject(reader, "the file ends before its last element; write it anew");
  const std::errc error = read_number(word, value);
  if (error == std::errc::result_out_of_range)
    reject(reader, quote(word) + " does not fit a double");
  if (error != std::errc()) reject(reader, quote(word) + " is not a number");
  return value;
}

/// A whole number in [0, below), or an InputError that names it.
std::size_t next_whole(Reader& reader, const NumberType& type, std::size_t below, const char* of) {
  const double value = next_number(reader, type);
  if (!(value >= 0 && value < double(below) && value == std::floor(value)))
    reject(reader,
           std::string(of) + " is not from 0 to " + std::to_string(below > 0 ? below - 1 : 0));
  return std::size_t(value);
}

void skip(Reader& reader, const Property& property) {
  std::size_t count = 1;
  if (property.count_type)
    count = next_whole(reader, *property.count_type, reader.text.size(), "the length of a list");
  for (std::size_t k = 0; k < count; ++k) next_number(reader, property.type);
}

/// Which lines a mesh has: none in a binary file.
int line_of(const Reader& reader) { return reader.form == Form::ascii ? reader.line : 0; }

void read_vertices(Reader& reader, const Element& element, TriangleSoup& soup) {
  if (element.count > most_vertices)
    reject(reader, "more than 2000000 vertices, the most that is read");
  for (const std::string_view axis : {"x", "y", "z"})
    if (std::ranges::find(element.properties, axis, &Property::name) == element.properties.end())
      reject(reader, "the element vertex has no property " + std::string(axis));
  std::vector<Vector3> all;
  for (std::size_t v = 0; v < element.count; ++v) {
    Vector3 place = Vector3::Constant(std::nan(""));
    for (const Property& property : element.properties) {
      const std::size_t axis = std::string_view("xyz").find(property.name);
      if (!property.count_type && property.name.size() == 1 && axis < 3)
        place[Eigen::Index(axis)] = next_number(reader, property.type);
      else
        skip(reader, property);
    }
    all.push_back(place);
    if (line_of(reader) > 0) soup.origin.vertex_lines.push_back(line_of(reader));
  }
  soup.rest.resize(3, Eigen::Index(all.size()));
  for (std::size_t v = 0; v < all.size(); ++v) soup.rest.col(Eigen::Index(v)) = all[v];
}

void add_corner(const Reader& reader, double vertex, FaceList& faces) {
  if (!(vertex >= 0 && vertex < double(most_vertices) && vertex == std::floor(vertex)))
    reject(reader, "an index of a vertex is not a whole number from 0 on");
  if (!faces.add(int(vertex))) reject(reader, "more than 4000000 triangles, the most that is read");
}

void read_polygon(Reader& reader, const Property& property, FaceList& faces) {
  const std::size_t corners =
      next_whole(reader, *property.count_type, reader.text.size(), "the length of a face");
  if (corners == 0) return;
  if (corners < 3) reject(reader, "a face of fewer than three vertices; give at least three");
  for (std::size_t k = 0; k < corners; ++k) {
    const double vertex = next_number(reader, property.type);
    if (k == 0) faces.begin(line_of(reader));
    add_corner(reader, vertex, faces);
  }
}

/// Each vertex of a strip makes a triangle with the two before it; every second one is turned.
void read_strips(Reader& reader, const Property& property, FaceList& faces) {
  const std::size_t count =
      next_whole(reader, *property.count_type, reader.text.size(), "the length of a strip");
  std::vector<double> strip;
  for (std::size_t k = 0; k < count; ++k) {
    const double vertex = next_number(reader, property.type);
    strip.push_back(vertex);
    if (vertex == -1) strip.clear();
    if (strip.size() < 3) continue;
    const std::size_t last = strip.size() - 1;
    const double a = strip[last - 2], b = strip[last - 1];
    if (a == b || b == vertex || vertex == a) continue;  // joins two strips
    faces.begin(line_of(reader));
    for (const double corner : {last % 2 == 0 ? a : b, last % 2 == 0 ? b : a, vertex})
      add_corner(reader, corner, faces);
  }
}

bool has_corners(const Property& property) {
  return property.count_type &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// An element without properties has no data whose end would stop a loop over an untrusted count.
void read_element_data(Reader& reader, const Element& element, TriangleSoup& soup,
                       FaceList& faces) {
  if (element.properties.empty()) return;
  if (element.name == "vertex") return read_vertices(reader, element, soup);
  for (std::size_t k = 0; k < element.count; ++k)
    for (const Property& property : element.properties)
      if (element.name == "face" && has_corners(property))
        read_polygon(reader, property, faces);
      else if (element.name == "tristrips" && has_corners(property))
        read_strips(reader, property, faces);
      else
        skip(reader, property);
}

/// Data behind the last element are elements that the header does not count.
void require_end(Reader& reader) {
  if (!next_word(reader).empty())
    reject(reader, "data behind the last element; the counts of the header do not fit");
}

/// reader: behind the header.
MeshFile read_data(Reader& reader, const Header& header, Needs needs) {
  const std::string& file = reader.file;
  MeshFile mesh;
  mesh.time = header.time;
  mesh.soup.origin.file = file;
  mesh.soup.rest.resize(3, 0);
  FaceList faces;
  for (const Element& element : header.elements)
    read_element_data(reader, element, mesh.soup, faces);
  if (faces.empty() && needs == Needs::faces)
    reject(reader, "the file has no face; give them as a property list vertex_indices of face");
  require_end(reader);
  if (mesh.soup.rest.cols() == 0) reject(reader, "the file has no vertex; give a mesh or points");
  faces.cut_into(mesh.soup, 0);
  return mesh;
}

/// The other count of vertices that fits the data, in words; "" if none nearby does.
std::string fitting_count(const Reader& start, Header header, Needs needs) {
  const auto vertex = std::ranges::find(header.elements, "vertex", &Element::name);
  if (vertex == header.elements.end()) return "";
  const std::size_t count = vertex->count;
  for (const int more : {-1, 1, -2, 2, -3, 3, -4, 4}) {
    vertex->count = count + std::size_t(more);
    Reader reader = start;
    try {
      read_data(reader, header, needs);
      return "the header counts " + std::to_string(count) + " vertices; " +
             std::to_string(vertex->count) + " fit the file";
    } catch (const InputError&) {
    }
  }
  return "";
}

}  // namespace

MeshFile read_ply_text(std::string_view text, const std::string& file, Needs needs) {
  Reader reader{text, file};
  const Header header = read_header(reader);
  reader.form = header.form;
  const Reader start = reader;
  try {
    return read_data(reader, header, needs);
  } catch (const InputError& error) {
    const std::string why = fitting_count(start, header, needs);
    throw InputError(error.what() + (why.empty() ? "" : "; " + why));
  }
}

}  // namespace foldproof
