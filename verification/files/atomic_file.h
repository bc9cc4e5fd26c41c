// Atomic files: complete or absent, even after a crash of the program or the machine.
#pragma once

#include <string>

namespace foldproof {

/// Flushes `from` to disk, renames it to `to` in the same folder, and flushes the folder. Throws
/// std::runtime_error naming the file and saying why.
void durable_rename(const std::string& from, const std::string& to);

/// Writes a text file under the name "<path>.partial" and renames it. Throws
/// std::runtime_error naming the file and saying why; what was at `path` is then still there,
/// and no partial file is left.
void write_text(const std::string& path, const std::string& text);

/// Call before a long computation: throws std::runtime_error if the path cannot become a file
/// because something else has this name.
void require_replaceable(const std::string& path);

}  // namespace foldproof
