// Files that are there whole or not at all.
#pragma once

#include <string>

namespace foldproof {

/// Makes sure that the bytes of `from` are on the disk, then gives it the name `to`. Throws
/// std::runtime_error naming the file.
void rename_when_whole(const std::string& from, const std::string& to);

/// Writes a text file under a temporary name and renames it. Throws std::runtime_error naming the file.
void write_text(const std::string& path, const std::string& text);

}  // namespace foldproof
