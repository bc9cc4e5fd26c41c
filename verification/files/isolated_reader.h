// Reads untrusted files in a child process first, so a corrupt one cannot crash us.
#pragma once

#include <functional>
#include <string>

namespace foldproof {

/// Runs `read` in a fork of this process, which may crash, loop forever or exhaust memory: it gets
/// 20 s of processor time and 1 GB of memory, and more with the size of the file. Returns "" if it
/// returned true, else a description of the failure. Changes that `read` makes in memory are lost.
/// Throws InputError for a path that is not a regular file, which might never end, and
/// std::runtime_error if the process cannot be created.
std::string failure_in_isolation(const std::string& path, const std::function<bool()>& read);

}  // namespace foldproof
