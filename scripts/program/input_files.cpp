#include "scripts/program/input_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <vector>

#include "reference/types.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"
#include "scripts/program/suggestions.h"

namespace foldproof {

namespace fs = std::filesystem;

const FileKind case_file{".toml", "a case file"};
const FileKind stored_run{".h5", "a stored run"};
const FileKind mesh_file{".obj", "a mesh"};
const FileKind number_table{".csv", "a table of numbers"};

namespace {

/// As it can be typed here: relative to the current folder where the file is below it.
std::string shortest_path(const fs::path& path) {
  const fs::path from_here = path.lexically_proximate(fs::current_path());
  return from_here.empty() || from_here.begin()->string() == ".." ? path.string() : from_here.string();
}

/// Files that may have been meant, by their names without folder and ending.
std::map<std::string, std::string> candidates(const fs::path& typed, const FileKind& kind) {
  std::map<std::string, std::string> paths;
  if (&kind == &case_file)
    for (const std::string& name : built_in_cases(Tier::full)) {
      const fs::path path = fs::path(project_folder()) / "cases" / (name + kind.ending);
      paths.emplace(path.stem().string(), shortest_path(path));
    }
  std::error_code ignored;
  const fs::path folder = typed.parent_path();
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored))
    if (entry.path().extension() == kind.ending)
      paths[entry.path().stem().string()] = (folder / entry.path().filename()).string();
  return paths;
}

std::string suggestion(const std::string& typed, const FileKind& kind) {
  const std::map<std::string, std::string> paths = candidates(typed, kind);
  std::vector<std::string> names, meant;
  for (const auto& [name, path] : paths) names.push_back(name);
  for (const std::string& name : nearest_names(fs::path(typed).stem().string(), names))
    meant.push_back(paths.at(name));
  return meant.empty() ? "; check the path" : did_you_mean(meant);
}

}  // namespace

void require_input(const std::string& path, const FileKind& kind) {
  const std::string give = fmt::format("give {}, NAME{}", kind.what, kind.ending);
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found)
    throw InputError(fmt::format("{}: there is no such file{}", path, suggestion(path, kind)));
  if (fs::is_directory(status)) throw InputError(fmt::format("{}: is a folder; {}", path, give));
  for (const FileKind* other : {&case_file, &stored_run, &mesh_file, &number_table})
    if (other->ending != kind.ending && fs::path(path).extension() == other->ending)
      throw InputError(fmt::format("{}: is {} by its name; {}", path, other->what, give));
  if (fs::is_regular_file(status) && fs::file_size(path, error) == 0)
    throw InputError(fmt::format("{}: is empty; {}", path, give));
}

}  // namespace foldproof
