// The reader of PLY files: whatever the bytes, a mesh whose indices and coordinates are sound, or
// an InputError in one line.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "reference/mesh/mesh_reading.h"
#include "verification/fuzz/finding.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace foldproof;
  try {
    const MeshFile mesh =
        read_ply_text(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz.ply");
    require(!mesh.time || std::isfinite(*mesh.time), "the time of a mesh is finite");
    require(!mesh.soup.triangles.empty(), "a mesh has triangles");
    for (const Triangle& triangle : mesh.soup.triangles)
      for (const int v : triangle) {
        require(v >= 0 && v < mesh.soup.rest.cols(), "corners of a triangle are vertices");
        require(mesh.soup.rest.col(v).allFinite(), "corners of a triangle are finite");
      }
  } catch (const InputError& error) {
    require(std::string_view(error.what()).starts_with("fuzz.ply:"), "a refusal names its file");
  }
  return 0;
}
