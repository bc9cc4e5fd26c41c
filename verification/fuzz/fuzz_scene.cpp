// The reader of case files: whatever the text, a scene of finite numbers, or an InputError that
// names its place. Reading computes no level set; OBJ files are read from the folder beside the
// targets alone, and meshes are small.
#include <cstdint>
#include <string>

#include "reference/scene/scene.h"
#include "verification/fuzz/finding.h"

namespace foldproof {

namespace {

// As in a case file's own folder; whatever else a file names is not looked for.
const std::string folder = FUZZ_FOLDER;
constexpr const char* known_files[] = {"tetrahedron.obj", "sheet.obj", "frames"};

bool is_known(const std::string& file) {
  for (const char* known : known_files)
    if (file == known) return true;
  return file.empty();
}

bool names_other_files(const KeyTable& table);

bool names_other_files(const KeyValue& value) {
  if (const auto* below = std::get_if<std::shared_ptr<KeyTable>>(&value.data))
    return names_other_files(**below);
  if (const auto* list = std::get_if<std::vector<KeyValue>>(&value.data))
    for (const KeyValue& entry : *list)
      if (names_other_files(entry)) return true;
  return false;
}

/// Does a key `mesh` or `frames` name a file that is not of the folder?
bool names_other_files(const KeyTable& table) {
  for (const auto& [key, value] : table.entries) {
    const auto* text = std::get_if<std::string>(&value.data);
    if (text && (key == "mesh" || key == "frames") && !is_known(*text)) return true;
    if (names_other_files(value)) return true;
  }
  return false;
}

void require_valid_content(const Scene& scene) {
  const State start = start_state(scene);
  require(start.x.allFinite() && start.v.allFinite(),
          "places and velocities at the start are finite");
  require(scene.mesh.rest.allFinite(), "the rest shape is finite");
  require(start.x.cols() == scene.mesh.particles(), "every particle has a place");
  for (const double angle : scene.rest_angles)
    require(std::isfinite(angle), "rest angles are finite");
  for (const SceneObject& part : scene.objects)
    require(part.vertices.allFinite(), "surfaces are finite");
  for (const StickyPatch& patch : scene.sticky)
    for (const int i : patch.particles)
      require(i >= 0 && i < scene.mesh.particles(), "what sticks is a particle of the cloth");
}

}  // namespace
}  // namespace foldproof

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace foldproof;
  const std::string text(reinterpret_cast<const char*>(data), size);
  constexpr SceneLimits small = {200, 4};
  const std::string path = folder + "/fuzz.toml";
  try {
    if (names_other_files(*parse_keys(text, path))) return -1;
    require_valid_content(read_scene_text(text, path, {}, small));
  } catch (const InputError& error) {
    require(std::string(error.what()).starts_with(folder), "a refusal names its place");
  }
  return 0;
}
