#include "reference/mesh/mesh_file.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <utility>

#include "reference/mesh/mesh_locations.h"
#include "reference/mesh/mesh_reading.h"
#include "reference/mesh/polygon.h"
#include "reference/mesh/text_file.h"

namespace foldproof {

std::errc read_number(std::string_view word, double& value) {
  // from_chars knows no plus sign
  const size_t plus = word.size() > 1 && word[0] == '+' && word[1] != '-' ? 1 : 0;
  const char *begin = word.data() + plus, *end = word.data() + word.size();
  std::from_chars_result result = std::from_chars(begin, end, value);
  if (result.ec == std::errc::result_out_of_range) {
    long double wide = 0;  // of a larger range: whether the number is large or small
    const bool is_held = std::from_chars(begin, end, wide).ec == std::errc();
    if (is_held ? std::abs(wide) < 1 : word.find("e-") != word.npos || word.find("E-") != word.npos)
      value = double(wide), result.ec = {};
  }
  if (result.ec == std::errc() && result.ptr != end) return std::errc::invalid_argument;
  return result.ec;
}

void reject_bad_place(const Vector3& x, const std::string& where) {
  if (!x.allFinite()) throw InputError(where + "a coordinate is not finite; give numbers in m");
  if (x.cwiseAbs().maxCoeff() > largest_coordinate)
    throw InputError(where + "a coordinate is too large, beyond 1e75 m; give numbers in m");
}

void reject_bad_places(const PerParticle3& x, const std::string& file) {
  for (Eigen::Index v = 0; v < x.cols(); ++v)
    reject_bad_place(x.col(v), file + ": vertex " + std::to_string(v) + ": ");
}

bool FaceList::add(int vertex) {
  corners_.push_back(vertex);
  if (corners() > 2) ++triangles_;
  return triangles_ <= most_triangles;
}

std::vector<int> FaceList::cut_into(TriangleSoup& soup, int first_vertex) const {
  const int vertices = int(soup.rest.cols());
  for (int v = 0; v < vertices && starts_.empty(); ++v)  // points alone
    reject_bad_place(soup.rest.col(v), vertex_location(soup.origin, v));
  std::vector<int> face_of_triangle;
  double largest = 0;  // coordinate [m]
  for (size_t f = 0; f < starts_.size(); ++f) {
    const auto reject = [&](const std::string& reason) {
      const std::string where =
          lines_[f] > 0 ? ":" + std::to_string(lines_[f]) : ": face " + std::to_string(f);
      throw InputError(soup.origin.file + where + ": " + reason);
    };
    const size_t end = f + 1 < starts_.size() ? starts_[f + 1] : corners_.size();
    const std::span<const int> corners(corners_.data() + starts_[f], end - starts_[f]);
    for (const int v : corners) {
      if (v < 0 || v >= vertices)
        reject("index " + std::to_string(v + first_vertex) + " is out of range; the file has " +
               std::to_string(vertices) + " vertices");
      reject_bad_place(soup.rest.col(v), vertex_location(soup.origin, v));
      largest = std::max(largest, soup.rest.col(v).cwiseAbs().maxCoeff());
    }
    const std::vector<Triangle> cut = triangles_of_polygon(corners, soup.rest);
    if (cut.empty())
      reject("a polygon of " + std::to_string(corners.size()) +
             (int(corners.size()) > most_concave_corners
                  ? " corners that is not convex; so many are cut"
                    " only if it is"
                  : " corners whose sides cross or touch") +
             "; cut it into triangles");
    for (const Triangle& triangle : cut) {
      soup.triangles.push_back(triangle);
      face_of_triangle.push_back(int(f));
      if (lines_[f] > 0) soup.origin.triangle_lines.push_back(lines_[f]);
    }
  }
  if (largest > 0 && largest < smallest_mesh)
    throw InputError(soup.origin.file +
                     ": no coordinate is as large as 1e-75 m, and areas would "
                     "vanish; give numbers in m");
  return face_of_triangle;
}

MeshFile read_mesh_text(std::string text, const std::string& file, Needs needs) {
  const std::string_view start = std::string_view(text).substr(0, 8);
  const size_t mark = start.starts_with(utf8_mark) ? utf8_mark.size() : 0;
  const std::string_view line = start.substr(mark, 4);
  if (line.starts_with("ply") && (line.size() < 4 || line[3] <= ' '))
    return read_ply_text(std::string_view(text).substr(mark), file, needs);
  return read_obj_text(plain_text(std::move(text), file), file, needs);
}

MeshFile read_mesh_file(const std::string& path, Needs needs) {
  return read_mesh_text(read_text_file(path, mesh_limits), path, needs);
}

TriangleMesh read_mesh(const std::string& path) {
  TriangleSoup soup = read_mesh_file(path).soup;
  return make_triangle_mesh(std::move(soup.rest), std::move(soup.triangles), soup.origin);
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
