// The readers of OBJ files: whatever the text, a mesh whose indices and coordinates are sound, a
// body that is closed and points outward, or an InputError.
#include <cstdint>
#include <string_view>

#include "reference/bodies/closed_mesh.h"
#include "reference/mesh/obj.h"
#include "verification/fuzz/finding.h"

namespace foldproof {

namespace {

void require_valid_content(const PerParticle3& rest, const std::vector<Triangle>& triangles) {
  require(rest.allFinite(), "the coordinates of a mesh are finite");
  for (const Triangle& triangle : triangles)
    for (const int v : triangle)
      require(v >= 0 && v < rest.cols(), "the corners of a triangle are vertices of the mesh");
}

/// Passes the result of read(text, name) to `look`; a refusal must name a line. Returns whether
/// there was an answer.
template <class Read, class Look>
bool read_with(const Read& read, std::string_view text, const Look& look) {
  try {
    look(read(text, "fuzz.obj"));
    return true;
  } catch (const InputError& error) {
    require(std::string_view(error.what()).starts_with("fuzz.obj:"),
            "a refusal names file and line");
    return false;
  }
}

}  // namespace
}  // namespace foldproof

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace foldproof;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  size_t triangles = 0;
  const bool is_read = read_with(read_obj_soup_text, text, [&](const TriangleSoup& soup) {
    triangles = soup.triangles.size();
    require_valid_content(soup.rest, soup.triangles);
  });
  if (!is_read) return 0;  // the others refuse it for the same reason
  read_with(read_obj_text, text, [&](const TriangleMesh& mesh) {
    require_valid_content(mesh.rest, mesh.triangles);
    require(mesh.triangles.size() == triangles, "both readers see the same triangles");
    require(euler_characteristic(mesh) <= mesh.particles(), "a mesh has no more faces than edges");
  });
  const auto read_body = [](std::string_view of, const std::string& name) {
    return make_closed_mesh(read_obj_soup_text(of, name));
  };
  read_with(read_body, text, [](const TriangleMesh& body) {
    require(enclosed_volume(body.rest, body.triangles) > 0, "a body's normals point outward");
  });
  read_with(read_obj_groups_text, text, [&](const FaceGroups& groups) {
    for (const auto& [name, members] : groups)
      for (const int t : members)
        require(t >= 0 && std::size_t(t) < triangles, "the triangles of a group are the mesh's");
  });
  return 0;
}
