// The folder that a command writes into.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace foldproof {

/// Made at once, so that a command that could not write stops before it computes. Folders that it
/// made and that hold nothing when it goes out of scope are removed: a command that is refused
/// leaves nothing.
class OutFolder {
 public:
  /// "" is no folder: nothing is made. Throws InputError saying why the folder cannot be made,
  /// or written into.
  explicit OutFolder(const std::string& path);
  ~OutFolder();
  OutFolder(const OutFolder&) = delete;
  OutFolder& operator=(const OutFolder&) = delete;

 private:
  OutFolder() = default;

  std::vector<std::filesystem::path> made_;  // the outermost first
};

}  // namespace foldproof
