#include "reference/mesh/mesh_locations.h"

#include <sstream>

namespace foldproof {

namespace {

/// To begin a message. lines: empty for a binary file.
std::string location(const MeshOrigin& origin, const std::vector<int>& lines, const char* part,
                     int k) {
  const std::string file = origin.file.empty() ? "mesh" : origin.file;
  if (lines.empty()) return file + ": " + part + " " + std::to_string(k) + ": ";
  return file + ":" + std::to_string(lines[size_t(k)]) + ": ";
}

}  // namespace

std::string triangle_location(const MeshOrigin& origin, int t) {
  return location(origin, origin.triangle_lines, "triangle", t);
}

std::string vertex_location(const MeshOrigin& origin, int v) {
  return location(origin, origin.vertex_lines, "vertex", v);
}

std::string mesh_location(const MeshOrigin& origin) {
  return (origin.file.empty() ? "mesh" : origin.file) + ": ";
}

int number_of(const MeshOrigin& origin, int v) {
  return origin.vertex_numbers.empty() ? v + 1 : origin.vertex_numbers[size_t(v)];
}

std::string vertex_name(const MeshOrigin& origin, int v) {
  if (origin.vertex_lines.empty()) return "vertex " + std::to_string(number_of(origin, v) - 1);
  return "vertex " + std::to_string(number_of(origin, v)) + " (line " +
         std::to_string(origin.vertex_lines[v]) + ")";
}

std::string triangle_name(const MeshOrigin& origin, int t) {
  if (origin.triangle_lines.empty()) return "triangle " + std::to_string(t);
  return "the face of line " + std::to_string(origin.triangle_lines[t]);
}

std::string edge_name(const MeshOrigin& origin, int a, int b) {
  return "the edge between " + vertex_name(origin, a) + " and " + vertex_name(origin, b);
}

std::string position_name(const Vector3& x) {
  std::ostringstream text;
  text.precision(4);
  text << "(" << x.x() << ", " << x.y() << ", " << x.z() << ")";
  return text.str();
}

}  // namespace foldproof
