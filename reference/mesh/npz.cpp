#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "reference/mesh/mesh_frames.h"
#include "reference/mesh/mesh_reading.h"
#include "reference/mesh/zip_archive.h"

namespace foldproof {

namespace {

using Members = std::map<std::string, ZipMember>;

constexpr double largest_index = 2147483647;

/// An array of numbers, the last index running fastest.
struct Array {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};

/// The text behind 'key': in the header of an array, a dictionary of Python.
std::string_view value_of(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(key);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = header.substr(at + key.size());
  return rest.substr(std::min(rest.find_first_not_of("': "), rest.size()));
}

std::vector<std::size_t> shape_in(std::string_view text) {
  std::vector<std::size_t> shape;
  for (std::size_t at = 1; at < text.size() && shape.size() < 8;) {
    std::size_t length = 0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), length);
    if (error != std::errc()) break;
    shape.push_back(length);
    at = std::min(text.find_first_not_of(", ", std::size_t(end - text.data())), text.size());
  }
  return shape;
}

/// The place in a Fortran-ordered array of the value at place k with the last index fastest.
std::size_t fortran_place(const std::vector<std::size_t>& shape, std::size_t k) {
  std::size_t place = 0;
  for (std::size_t d = shape.size(); d-- > 0;) {
    std::size_t stride = 1;
    for (std::size_t e = 0; e < d; ++e) stride *= shape[e];
    place += k % shape[d] * stride;
    k /= shape[d];
  }
  return place;
}

/// The bytes of a .npy file.
Array array_of(std::string_view bytes, const std::string& where) {
  const std::size_t prefix = bytes.size() > 6 && bytes[6] == 1 ? 10 : 12;
  std::uint32_t length = 0;
  if (!bytes.starts_with("\x93NUMPY") || bytes.size() < prefix)
    throw InputError(where + " is no NumPy array; write it with numpy.savez");
  std::memcpy(&length, bytes.data() + 8, prefix - 8);
  const std::string_view header = bytes.substr(prefix, length);
  const std::string_view data = bytes.substr(std::min(bytes.size(), prefix + length));
  const std::string_view type = value_of(header, "'descr'");
  const auto of = type.size() < 3
                      ? number_types.end()
                      : std::ranges::find(number_types, type.substr(1, 2), &NumberType::code);
  if (of == number_types.end())
    throw InputError(where + " holds no numbers; give float32, float64 or integers");
  Array array{shape_in(value_of(header, "'shape'")), {}};
  std::size_t count = 1;
  for (const std::size_t each : array.shape) {
    if (each > 0 && count > data.size() / each)
      count = data.size() + 1;  // and no overflow
    else
      count *= each;
  }
  if (count * of->bytes != data.size())
    throw InputError(where + " has another size than its shape says; write it anew");
  const bool is_fortran = value_of(header, "'fortran_order'").starts_with("True");
  array.values.resize(count);
  for (std::size_t k = 0; k < count; ++k)
    array.values[k] = of->read(
        data.data() + of->bytes * (is_fortran ? fortran_place(array.shape, k) : k), type[0] == '>');
  return array;
}

/// An array of the archive; empty if it is not there.
Array member(const Members& members, const std::string& name, const std::string& file) {
  const auto found = members.find(name + ".npy");
  if (found == members.end()) return {};
  return array_of(unpacked(found->second, name, file), file + ": '" + name + "'");
}

std::vector<Triangle> faces_of(const Array& faces, std::size_t vertices, const std::string& file) {
  if (faces.shape.empty()) return {};
  if (faces.shape.size() != 2 || faces.shape[1] != 3)
    throw InputError(file + ": 'faces' are not of shape [M, 3]; give triangles");
  std::vector<Triangle> all(faces.shape[0]);
  for (std::size_t k = 0; k < faces.values.size(); ++k) {
    const double corner = faces.values[k];
    if (!(corner >= 0 && corner < double(vertices) && corner == std::floor(corner)))
      throw InputError(file + ": 'faces' row " + std::to_string(k / 3) +
                       " names no vertex from 0 to " + std::to_string(vertices - 1));
    all[k / 3][k % 3] = int(corner);
  }
  return all;
}

/// F times, if the archive states them [s].
std::vector<double> times_of(const Members& members, std::size_t frames, const std::string& file) {
  Array times = member(members, "times", file);
  if (!times.values.empty()) {
    if (times.values.size() != frames)
      throw InputError(file + ": 'times' has " + std::to_string(times.values.size()) +
                       " values for " + std::to_string(frames) + " frames");
    return times.values;
  }
  const Array fps = member(members, "fps", file);
  if (fps.values.empty()) return {};
  if (fps.values.size() != 1 || !(fps.values[0] > 0) || !std::isfinite(fps.values[0]))
    throw InputError(file + ": 'fps' is not one positive number");
  std::vector<double> all;
  for (std::size_t k = 0; k < frames; ++k) all.push_back(double(k) / fps.values[0]);
  return all;
}

}  // namespace

std::vector<MeshFrame> read_npz_bytes(std::string_view bytes, const std::string& file) {
  const Members members = zip_members(bytes, file);
  const Array vertices = member(members, "vertices", file);
  if (vertices.shape.size() != 3 || vertices.shape[2] != 3 || vertices.values.empty() ||
      double(vertices.shape[1]) > largest_index)
    throw InputError(file + ": has no array 'vertices' of shape [F, N, 3]; name it so");
  const std::size_t count = vertices.shape[0], particles = vertices.shape[1];
  const std::vector<Triangle> faces = faces_of(member(members, "faces", file), particles, file);
  const std::vector<double> times = times_of(members, count, file);
  std::vector<MeshFrame> frames;
  for (std::size_t k = 0; k < count; ++k) {
    MeshFrame frame{file + " frame " + std::to_string(k), double(k), {}, {}, faces};
    if (!times.empty()) frame.time = times[k];
    frame.x = Eigen::Map<const PerParticle3>(vertices.values.data() + 3 * particles * k, 3,
                                             Eigen::Index(particles));
    reject_bad_places(frame.x, frame.file);
    if (frame.time && !std::isfinite(*frame.time))
      throw InputError(frame.file + ": its time is not finite; give seconds");
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace foldproof
