// The readers of OBJ files: whatever the text, a mesh whose indices and coordinates are sound, a
// body that is closed and points outward, or an InputError.
#include <cstdint>
#include <string_view>

#include "reference/bodies/closed_mesh.h"
#include "reference/mesh/mesh_file.h"
#include "verification/fuzz/finding.h"

namespace foldproof {

namespace {

void require_valid_content(const PerParticle3& rest, const std::vector<Triangle>& triangles) {
  for (const Triangle& triangle : triangles)
    for (const int v : triangle) {
      require(v >= 0 && v < rest.cols(), "the corners of a triangle are vertices of the mesh");
      require(rest.col(v).allFinite(), "the corners of a triangle are finite");
    }
}

/// Passes the result of read(text, name) to `look`; a refusal must name a line. Returns whether
/// there was an answer.
template <class Read, class Look>
bool read_with(const Read& read, std::string_view text, const Look& look) {
  try {
    auto answer = read(text, "fuzz.obj");
    look(answer);
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
  MeshFile mesh;
  const auto read_all = [](std::string_view of, const std::string& name) {
    return read_mesh_text(std::string(of), name);
  };
  if (!read_with(read_all, text, [&](MeshFile& read) { mesh = std::move(read); })) return 0;
  const size_t triangles = mesh.soup.triangles.size();
  require_valid_content(mesh.soup.rest, mesh.soup.triangles);
  for (const auto& [name, members] : mesh.groups)
    for (const int t : members)
      require(t >= 0 && std::size_t(t) < triangles, "the triangles of a group are the mesh's");
  const auto read_cloth = [&](std::string_view, const std::string&) {
    return make_triangle_mesh(mesh.soup.rest, mesh.soup.triangles, mesh.soup.origin);
  };
  read_with(read_cloth, text, [&](const TriangleMesh& cloth) {
    require_valid_content(cloth.rest, cloth.triangles);
    require(euler_characteristic(cloth) <= cloth.particles(), "no more faces than edges");
  });
  const auto read_body = [&](std::string_view, const std::string&) {
    return make_closed_mesh(mesh.soup);
  };
  read_with(read_body, text, [](const TriangleMesh& body) {
    require(enclosed_volume(body.rest, body.triangles) > 0, "a body's normals point outward");
  });
  return 0;
}
