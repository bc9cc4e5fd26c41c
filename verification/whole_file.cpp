#include "verification/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace foldproof {

void rename_when_whole(const std::string& from, const std::string& to) {
  const int descriptor = open(from.c_str(), O_RDONLY);
  const bool synced = descriptor >= 0 && fsync(descriptor) == 0;
  if (descriptor >= 0) close(descriptor);
  if (!synced || std::rename(from.c_str(), to.c_str()) != 0)
    throw std::runtime_error(to + ": cannot be written");
}

void write_text(const std::string& path, const std::string& text) {
  const std::string partial = path + ".partial";
  std::ofstream out(partial, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(path + ": cannot be written; is the folder there and writable?");
  rename_when_whole(partial, path);
}

}  // namespace foldproof
