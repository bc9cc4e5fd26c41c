// Parts that the readers of OBJ and PLY share. All other files include mesh_file.h.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "reference/mesh/mesh_file.h"

namespace foldproof {

// Twice the largest cloth in the speed measurements.
constexpr size_t most_vertices = 2'000'000, most_triangles = 4'000'000;

// [m]; areas square the squares of lengths, which beyond these limits overflow, or vanish.
constexpr double largest_coordinate = 1e75, smallest_mesh = 1e-75;

/// Throws InputError, beginning with `where`, for a place that is not finite, or too far away.
void reject_bad_place(const Vector3& x, const std::string& where);
void reject_bad_places(const PerParticle3& x, const std::string& file);

/// The number whose bytes begin here, in this machine's order or, `is_swapped`, in the other.
template <class Number>
double number_at(const char* from, bool is_swapped) {
  std::array<char, sizeof(Number)> copy;
  std::memcpy(copy.data(), from, sizeof(Number));
  if (is_swapped) std::ranges::reverse(copy);
  return double(std::bit_cast<Number>(copy));
}

/// A type of numbers in binary files: its names in PLY, the code of NumPy, and how it is read.
struct NumberType {
  std::string_view name, other, code;
  std::size_t bytes;
  double (*read)(const char* from, bool is_swapped);
};

template <class Number>
constexpr NumberType number_type(std::string_view name, std::string_view other,
                                 std::string_view code) {
  return {name, other, code, sizeof(Number), number_at<Number>};
}

inline constexpr std::array number_types = {number_type<std::int8_t>("char", "int8", "i1"),
                                            number_type<std::uint8_t>("uchar", "uint8", "u1"),
                                            number_type<std::int16_t>("short", "int16", "i2"),
                                            number_type<std::uint16_t>("ushort", "uint16", "u2"),
                                            number_type<std::int32_t>("int", "int32", "i4"),
                                            number_type<std::uint32_t>("uint", "uint32", "u4"),
                                            number_type<float>("float", "float32", "f4"),
                                            number_type<double>("double", "float64", "f8"),
                                            number_type<std::int64_t>({}, {}, "i8"),
                                            number_type<std::uint64_t>({}, {}, "u8")};

/// Reads a whole word as a number, with or without a plus sign. What is too small for a double is
/// 0. invalid_argument: it is none; result_out_of_range: it is too large.
std::errc read_number(std::string_view word, double& value);

/// The faces of a file, until all its vertices are known.
class FaceList {
 public:
  /// line: of the file; 0 in a binary one.
  void begin(int line) {
    starts_.push_back(corners_.size());
    lines_.push_back(line);
  }
  /// Adds a corner to the last face; false if that makes more than most_triangles.
  bool add(int vertex);
  /// Corners of the last face.
  size_t corners() const { return corners_.size() - starts_.back(); }
  bool empty() const { return starts_.empty(); }

  /// Cuts the faces into triangles over the vertices of `soup`, and returns the face of each.
  /// first_vertex: the number of the first vertex in the file, for messages. Throws InputError for
  /// indices out of range, used vertices that are not finite, and faces that cannot be cut.
  std::vector<int> cut_into(TriangleSoup& soup, int first_vertex) const;

 private:
  std::vector<int> corners_;    // of all faces, one after the other
  std::vector<size_t> starts_;  // the first corner of each
  std::vector<int> lines_;
  size_t triangles_ = 0;
};

MeshFile read_obj_text(std::string_view text, const std::string& file, Needs needs = Needs::faces);
MeshFile read_ply_text(std::string_view text, const std::string& file, Needs needs = Needs::faces);

}  // namespace foldproof
