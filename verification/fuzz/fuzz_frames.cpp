// The readers of caches. The first byte of an input chooses one: PC2, NPZ or USD. It must return
// frames whose indices, coordinates and times are sound, or throw an InputError in one line.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "reference/mesh/mesh_frames.h"
#include "verification/fuzz/finding.h"

namespace foldproof {

namespace {

std::vector<MeshFrame> read(char format, std::string_view bytes) {
  if (format == 'p') return read_pc2_bytes(bytes, "fuzz");
  if (format == 'n') return read_npz_bytes(bytes, "fuzz");
  return read_usda_text(bytes, "fuzz");
}

void require_sound(const MeshFrame& frame, const MeshFrame& first) {
  require(std::isfinite(frame.number), "the number of a frame is finite");
  require(!frame.time || std::isfinite(*frame.time), "the time of a frame is finite");
  require(frame.x.cols() == first.x.cols(), "all frames have the same points");
  require(frame.x.allFinite(), "points are finite");
  for (const Triangle& triangle : frame.triangles)
    for (const int v : triangle)
      require(v >= 0 && v < frame.x.cols(), "corners of a triangle are vertices");
}

}  // namespace

}  // namespace foldproof

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace foldproof;
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const std::vector<MeshFrame> frames = read(bytes[0], bytes.substr(1));
    require(!frames.empty(), "a cache has frames");
    for (const MeshFrame& frame : frames) require_sound(frame, frames.front());
  } catch (const InputError& error) {
    require(std::string_view(error.what()).starts_with("fuzz"), "a refusal names its file");
    require(std::string_view(error.what()).find('\n') == std::string_view::npos,
            "a refusal is one line");
  }
  return 0;
}
