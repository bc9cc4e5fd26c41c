#include "scripts/program/command_line/input_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <vector>

#include "reference/types.h"
#include "scripts/program/run_case.h"
#include "scripts/program/command_line/suggestions.h"
#include "scripts/program/data_folder.h"

namespace foldproof {

namespace fs = std::filesystem;

const FileKind case_kind{".toml", "a case file"};
const FileKind run_kind{".h5", "a stored run"};
const FileKind mesh_kind{".obj", "a mesh", ".ply"};
const FileKind table_kind{".csv", "a table of numbers"};

namespace {

/// Suggestions, from file names without folder and extension.
std::map<std::string, std::string> candidates(const fs::path& typed, const FileKind& kind) {
  std::map<std::string, std::string> words;
  if (&kind == &case_kind)
    for (const std::string& name : shipped_cases())
      words.emplace(fs::path(name).filename().string(), name);
  std::error_code ignored;
  const fs::path folder = typed.parent_path();
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored))
    if (has_ending(entry.path().string(), kind))
      words[entry.path().stem().string()] = (folder / entry.path().filename()).string();
  return words;
}

std::string missing_text(const FileKind& kind) {
  return &kind == &case_kind ? "case file, and no shipped case of that name" : "file";
}

std::string suggestion(const std::string& typed, const FileKind& kind) {
  const std::map<std::string, std::string> words = candidates(typed, kind);
  std::vector<std::string> names, meant;
  for (const auto& [name, word] : words) names.push_back(name);
  for (const std::string& name : nearest_names(fs::path(typed).stem().string(), names))
    meant.push_back(words.at(name));
  if (!meant.empty()) return did_you_mean(meant);
  return &kind == &case_kind ? "; `" + program_command() + " list cases` shows the shipped ones"
                             : "; check the path";
}

}  // namespace

bool has_ending(const std::string& path, const FileKind& kind) {
  std::string ending = fs::path(path).extension().string();
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  return ending == kind.ending || (ending == kind.other && !ending.empty());
}

void require_input(const std::string& path, const FileKind& kind) {
  const std::string give = fmt::format("give {}, NAME{}{}", kind.what, kind.ending,
                                       kind.other.empty() ? "" : " or NAME" + kind.other);
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found)
    throw InputError(path + ": there is no such " + missing_text(kind) + suggestion(path, kind));
  if (fs::is_directory(status)) throw InputError(fmt::format("{}: is a folder; {}", path, give));
  for (const FileKind* other : {&case_kind, &run_kind, &mesh_kind, &table_kind})
    if (other->ending != kind.ending && has_ending(path, *other))
      throw InputError(fmt::format("{}: is {} by its name; {}", path, other->what, give));
  if (fs::is_regular_file(status) && fs::file_size(path, error) == 0)
    throw InputError(fmt::format("{}: is empty; {}", path, give));
}

std::string case_file(const std::string& typed) {
  const std::string name =
      typed.ends_with(case_kind.ending) ? fs::path(typed).replace_extension().string() : typed;
  std::error_code unreadable;
  for (const std::string& file : {typed, name + case_kind.ending})
    if (fs::is_regular_file(file, unreadable)) {
      require_input(file, case_kind);
      return file;
    }
  if (std::ranges::count(shipped_cases(), name)) return shipped_case_file(name);
  require_input(typed, case_kind);
  return typed;
}

}  // namespace foldproof
