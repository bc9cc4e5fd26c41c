// Files that are there whole or not at all, whatever happens to the program or the machine.
#pragma once

#include <string>

namespace foldproof {

/// Makes sure that the bytes of `from` are on the disk, then gives it the name `to` in the same
/// folder, and makes sure of that. Throws std::runtime_error naming the file and saying why.
void durable_rename(const std::string& from, const std::string& to);

/// Writes a text file under the name "<path>.partial" and renames it. Throws
/// std::runtime_error naming the file and saying why; what was at `path` is then still there,
/// and no partial file is left.
void write_text(const std::string& path, const std::string& text);

/// For what takes long to make: throws std::runtime_error if a file could not take this name in the
/// end, because something is there that is no file.
void require_replaceable(const std::string& path);

}  // namespace foldproof
