#include "scripts/program/command_line/out_folder.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "reference/types.h"

namespace foldproof {

namespace fs = std::filesystem;

// so that what throws below is undone
OutFolder::OutFolder(const std::string& path) : OutFolder() {
  if (path.empty()) return;
  const auto reject = [&](const std::string& what, const std::error_code& why) {
    throw InputError(path + ": " + what + ": " + why.message() + "; choose another --out");
  };
  std::error_code error;
  fs::path part;
  const auto is_taken = [&] { return fs::exists(part, error) && !fs::is_directory(part, error); };
  for (const fs::path& name : fs::path(path)) {
    part /= name;
    if (is_taken())
      reject("cannot make this folder", std::make_error_code(std::errc::not_a_directory));
    if (fs::create_directory(part, error)) made_.push_back(part);
    if (error) reject("cannot make this folder", error);
  }
  if (access(path.c_str(), W_OK | X_OK) != 0)
    reject("cannot write into this folder", {errno, std::generic_category()});
}

OutFolder::~OutFolder() {
  std::error_code ignored;
  for (auto part = made_.rbegin(); part != made_.rend(); ++part) fs::remove(*part, ignored);
}

}  // namespace foldproof
