#include "verification/cases/replaced_shape.h"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

namespace foldproof {

namespace {

/// Describes a replacement: the original and the new shape.
struct Replaced {
  std::vector<std::string> written, used;

  void add(const std::string& was, const std::string& is) {
    written.push_back(was);
    used.push_back(is);
  }
};

/// The two paths, that of the case file relative to its folder, name one file.
bool is_one_file(const std::filesystem::path& folder, const std::string& written,
                 const std::string& used) {
  std::error_code none;  // what is not there is no one file
  return std::filesystem::equivalent(folder / written, used, none);
}

/// Looks at the keys of [cloth] or of an [[object]] that say what it is.
void look_at(const KeyTable& keys, const std::filesystem::path& folder, Replaced& all) {
  for (const char* key : {"mesh", "shape", "frames"}) {
    const auto found = keys.replaced.find(key);
    if (found == keys.replaced.end()) continue;
    const auto* written = std::get_if<std::string>(&found->second.data);
    std::string used;  // under another key, if this one was unset
    for (const char* now : {"mesh", "shape", "frames", key})
      if (keys.is_text(now)) used = keys.text(now);
    const bool is_file = std::string(key) != "shape";
    if (!written || (is_file ? is_one_file(folder, *written, used) : *written == used)) continue;
    all.add(*written, used);
  }
}

}  // namespace

std::string replaced_shape(const CaseKeys& of) {
  const KeyTable& keys = *of.keys;
  const std::filesystem::path folder = std::filesystem::path(of.path).parent_path();
  Replaced all;
  for (const char* table : {"cloth", "object"})
    if (keys.replaced.contains(table))
      all.add(fmt::format("the file's '{}'", table), fmt::format("another '{}'", table));
  if (const auto cloth = keys.table("cloth")) look_at(*cloth, folder, all);
  for (const auto& object : keys.tables("object")) look_at(*object, folder, all);
  if (all.used.empty()) return "";
  return fmt::format("written for {}; this run uses {}", fmt::join(all.written, " and "),
                     fmt::join(all.used, " and "));
}

}  // namespace foldproof
