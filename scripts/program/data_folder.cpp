#include "scripts/program/data_folder.h"

#include <filesystem>

#include "reference/types.h"
#include "scripts/program/provenance.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;

/// PREFIX/bin/foldproof has PREFIX/share/foldproof.
fs::path installed_data() {
  return fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share" / "foldproof";
}

bool holds_data(const fs::path& folder) {
  std::error_code unreadable;
  return fs::is_directory(folder / "cases", unreadable);
}

}  // namespace

std::string data_folder() {
  for (const fs::path& folder : {installed_data(), fs::path(source_folder())})
    if (holds_data(folder)) return folder.string();
  throw InputError("shipped cases and reports are neither in " + installed_data().string() +
                   " nor in " + source_folder() +
                   "; install foldproof again, with its share folder");
}

std::string program_command() {
  return holds_data(installed_data()) ? "foldproof" : "build/foldproof";
}

}  // namespace foldproof
