// A file of JSON lines with one writer: what was written stays, what was cut off is ignored.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace foldproof {

/// A name that no other process on any machine takes: host, process, time and a count.
std::string new_shard_name();

/// The name of this machine.
std::string host_name();

/// Appends lines to a file that no one else writes to. Each line is one write, so a process that is
/// killed leaves at most a torn last line.
class ShardFile {
 public:
  /// Creates nothing before the first line; then also the file's folder.
  explicit ShardFile(std::string path) : path_(std::move(path)) {}
  ~ShardFile();
  ShardFile(const ShardFile&) = delete;
  ShardFile& operator=(const ShardFile&) = delete;

  /// line: without its end. Throws std::runtime_error naming the file if it is not written whole;
  /// what was written of it is then a line of its own, which readers ignore.
  void append(const std::string& line);

  /// Waits until all lines are on the disk. Throws std::runtime_error naming the file.
  void flush_to_disk();

  const std::string& path() const { return path_; }

  /// Of the open file, for a signal handler; -1 before the first line.
  int descriptor() const { return file_; }

 private:
  std::string path_;
  int file_ = -1;
  bool is_torn_ = false;
};

/// Hands every whole line from byte `offset` on to `visit`, without its end. Returns the byte
/// after the last whole line: a torn tail is left for the next call. A file that cannot be
/// read has no lines.
std::uint64_t read_whole_lines(const std::string& path, std::uint64_t offset,
                               const std::function<void(const std::string&)>& visit);

}  // namespace foldproof
