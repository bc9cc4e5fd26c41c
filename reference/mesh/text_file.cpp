#include "reference/mesh/text_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include "reference/types.h"

namespace foldproof {

namespace {

/// Counts lines and their lengths as text is read.
class LineCounter {
 public:
  explicit LineCounter(std::size_t longest) : longest_(longest) {}

  /// False if a line is too long.
  bool count_lines(const char* at, std::size_t count) {
    const char* const end = at + count;
    while (const void* found = std::memchr(at, '\n', std::size_t(end - at))) {
      const char* const line_end = static_cast<const char*>(found);
      if (length_ + std::size_t(line_end - at) > longest_) return false;
      length_ = 0;
      ++line_;
      at = line_end + 1;
    }
    length_ += std::size_t(end - at);
    return length_ <= longest_;
  }

  long line() const { return line_; }

 private:
  std::size_t longest_, length_ = 0;
  long line_ = 1;
};

/// Throws InputError for anything but a regular file: a pipe or a device might never end.
void reject_unless_regular(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    throw InputError(path + ": cannot be opened (" +
                     (error ? error.message() : std::generic_category().message(ENOENT)) +
                     "); check the path");
  if (!std::filesystem::is_regular_file(status))
    throw InputError(path + ": cannot be read; give a regular file");
}

[[noreturn]] void reject_size(const std::string& path, std::size_t most) {
  throw InputError(path + ": longer than " + std::to_string(most) +
                   " bytes, the most that is read");
}

}  // namespace

std::string read_text_file(const std::string& path, const TextLimits& limits) {
  reject_unless_regular(path);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw InputError(path + ": cannot be opened (" + std::generic_category().message(errno) +
                     "); check the path");
  std::error_code unknown;
  if (const auto size = std::filesystem::file_size(path, unknown); !unknown && size > limits.bytes)
    reject_size(path, limits.bytes);
  std::string text;
  std::vector<char> chunk(1 << 16);
  LineCounter lines(limits.line);
  while (file) {
    file.read(chunk.data(), std::streamsize(chunk.size()));
    const auto count = std::size_t(file.gcount());
    if (!lines.count_lines(chunk.data(), count))
      throw InputError(path + ":" + std::to_string(lines.line()) + ": a line of more than " +
                       std::to_string(limits.line) + " bytes; the most that is read");
    if (text.size() + count > limits.bytes) reject_size(path, limits.bytes);
    text.append(chunk.data(), count);
  }
  if (!file.eof()) throw InputError(path + ": cannot be read; give a regular file");
  return text;
}

std::string plain_text(std::string text, const std::string& file) {
  if (text.starts_with(utf8_mark)) text.erase(0, utf8_mark.size());
  const std::string_view start = std::string_view(text).substr(0, 1 << 12);
  if (start.starts_with("\xFF\xFE") || start.starts_with("\xFE\xFF"))
    throw InputError(file + ":1: the file is in UTF-16 or UTF-32; save it as UTF-8");
  if (start.find('\0') != std::string_view::npos)
    throw InputError(file +
                     ":1: holds zero bytes, as UTF-16 and binary files do; give text in "
                     "UTF-8, or PLY, which begins with the line 'ply'");
  if (text.find('\n') == std::string::npos) std::ranges::replace(text, '\r', '\n');
  return text;
}

}  // namespace foldproof
