// Reads whole text files, within limits: anything that is not a file, is too long or has no line
// ends is refused before it costs memory.
#pragma once

#include <cstddef>
#include <string>

namespace foldproof {

struct TextLimits {
  std::size_t bytes;  // of the file
  std::size_t line;   // bytes of a line, without its end
};

/// Ten times the longest case that anyone is likely to write by hand; a list of ten thousand
/// particles fits a line.
constexpr TextLimits case_text_limits = {1 << 20, 1 << 16};

/// A mesh with the most vertices and triangles that obj.h accepts, in full precision; a table with
/// as many rows.
constexpr TextLimits table_text_limits = {std::size_t(1) << 28, 1 << 16};

/// The text of a regular file. Throws InputError "FILE: ..." or "FILE:LINE: ..." for a file that
/// cannot be opened, a folder, pipe or device, and for one that exceeds a limit; it uses no more
/// memory than the limit.
std::string read_text_file(const std::string& path, const TextLimits& limits);

}  // namespace foldproof
