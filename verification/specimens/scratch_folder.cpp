#include "verification/specimens/scratch_folder.h"

#include <cstdlib>

#include <cerrno>
#include <fstream>
#include <system_error>

namespace foldproof {

ScratchFolder::ScratchFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "foldproof-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr)
    throw std::system_error(errno, std::generic_category(), pattern);
  path_ = pattern;
}

std::string ScratchFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream(file(name)) << text;
  return file(name);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;  // a folder left behind is no reason to stop
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace foldproof
