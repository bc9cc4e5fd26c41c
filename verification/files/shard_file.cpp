#include "verification/files/shard_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace foldproof {

namespace {

std::atomic<int> shards_named = 0;  // by this process

}  // namespace

std::string host_name() {
  char host[64] = "host";
  gethostname(host, sizeof host - 1);
  return host;
}

std::string new_shard_name() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return host_name() + "-" + std::to_string(getpid()) + "-" +
         std::to_string(std::chrono::duration_cast<std::chrono::microseconds>(now).count()) + "-" +
         std::to_string(shards_named++);
}

ShardFile::~ShardFile() {
  if (file_ >= 0) close(file_);
}

void ShardFile::append(const std::string& line) {
  if (file_ < 0) {
    std::filesystem::create_directories(std::filesystem::path(path_).parent_path());
    file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  }
  const std::string text = (is_torn_ ? "\n" : "") + line + "\n";
  const ssize_t written = file_ < 0 ? -1 : write(file_, text.data(), text.size());
  if (written == ssize_t(text.size())) {
    is_torn_ = false;
    return;
  }
  const std::string why = written < 0 ? std::strerror(errno) : "the disk is full";
  is_torn_ = is_torn_ || written > 0;
  throw std::runtime_error(path_ + ": cannot be written: " + why);
}

void ShardFile::flush_to_disk() {
  if (file_ >= 0 && fdatasync(file_) != 0)
    throw std::runtime_error(path_ + ": cannot be written: " + std::strerror(errno));
}

std::uint64_t read_whole_lines(const std::string& path, std::uint64_t offset,
                               const std::function<void(const std::string&)>& visit) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(std::streamoff(offset));
  for (std::string line; std::getline(file, line) && !file.eof();) {
    offset += line.size() + 1;
    visit(line);
  }
  return offset;
}

}  // namespace foldproof
