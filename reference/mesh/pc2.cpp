#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "reference/mesh/mesh_frames.h"
#include "reference/mesh/mesh_reading.h"

namespace foldproof {

namespace {

struct Header {
  std::array<char, 12> mark;  // "POINTCACHE2" and a zero
  std::int32_t version, points;
  float start, rate;  // frames
  std::int32_t samples;
};
static_assert(sizeof(Header) == 32 && std::endian::native == std::endian::little);

Header header_of(std::string_view bytes, const std::string& file) {
  constexpr std::string_view mark("POINTCACHE2\0", 12);
  Header header{};
  if (!bytes.starts_with(mark) || bytes.size() < sizeof header)
    throw InputError(file + ": does not begin with POINTCACHE2; give a PC2 file");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.version != 1)
    throw InputError(file + ": is of version " + std::to_string(header.version) +
                     " of PC2; only 1 is read");
  if (header.points < 1 || header.samples < 1)
    throw InputError(file + ": holds no points, or no samples; write it anew");
  if (!std::isfinite(header.start) || !(header.rate > 0) || !std::isfinite(header.rate))
    throw InputError(file + ": its start frame is not finite or its sample rate not positive");
  return header;
}

}  // namespace

std::vector<MeshFrame> read_pc2_bytes(std::string_view bytes, const std::string& file) {
  const Header header = header_of(bytes, file);
  const std::size_t count = 3 * std::size_t(header.points);  // numbers of a sample
  if ((bytes.size() - sizeof header) / (count * sizeof(float)) < std::size_t(header.samples))
    throw InputError(file + ": ends before sample " + std::to_string(header.samples - 1) +
                     "; write it anew");
  std::vector<MeshFrame> frames;
  std::vector<float> points(count);
  for (std::int32_t k = 0; k < header.samples; ++k) {
    std::memcpy(points.data(),
                bytes.data() + sizeof header + std::size_t(k) * count * sizeof(float),
                count * sizeof(float));
    MeshFrame frame{file + " sample " + std::to_string(k),
                    double(header.start) + k * double(header.rate),
                    {},
                    {},
                    {}};
    frame.x = Eigen::Map<const Eigen::Matrix3Xf>(points.data(), 3, header.points).cast<double>();
    reject_bad_places(frame.x, frame.file);
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace foldproof
