// A temporary folder for files that a check writes.
#pragma once

#include <filesystem>
#include <string>

namespace foldproof {

/// Created under the system's temporary folder, and removed with all its contents.
class ScratchFolder {
 public:
  ScratchFolder();  // throws std::system_error if it cannot be made
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }

  /// Writes the text to the file of this name; returns its path.
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

}  // namespace foldproof
