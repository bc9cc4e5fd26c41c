// Reads whole text files, within limits: anything that is not a file, is too long or has no line
// ends is refused before it costs memory.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace foldproof {

struct TextLimits {
  std::size_t bytes;  // of the file
  std::size_t line;   // bytes of a line, without its end
};

/// Ten times the longest case that anyone is likely to write by hand; a list of ten thousand
/// particles fits a line.
constexpr TextLimits case_text_limits = {1 << 20, 1 << 16};

/// A table with as many rows as a mesh file may have vertices, in full precision.
constexpr TextLimits table_text_limits = {std::size_t(1) << 28, 1 << 16};

/// A mesh with the most vertices and triangles that mesh_file.h accepts, in full precision; binary
/// files have no lines.
constexpr TextLimits mesh_limits = {std::size_t(1) << 28, std::size_t(1) << 28};

/// The text of a regular file. Throws InputError "FILE: ..." or "FILE:LINE: ..." for a file that
/// cannot be opened, a folder, pipe or device, and for one that exceeds a limit; it uses no more
/// memory than the limit.
std::string read_text_file(const std::string& path, const TextLimits& limits);

constexpr std::string_view utf8_mark = "\xEF\xBB\xBF";  // that some editors put before UTF-8

/// The text of `file` without utf8_mark, and with '\n' at the ends of lines if it has '\r' alone.
/// Throws InputError "FILE:1: ..." for UTF-16, and for bytes that are no text.
std::string plain_text(std::string text, const std::string& file);

}  // namespace foldproof
