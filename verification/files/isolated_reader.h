// Reading what may bring the reader down: tried first in a process of its own.
#pragma once

#include <functional>
#include <string>

namespace foldproof {

/// Runs `read` in a copy of this process, which may die of it, run without end or ask for all
/// memory: it gets 20 s of processor time and 1 GB of memory, and more with the size of the file.
/// Returns "" if it came back true, else what became of it, in words. What `read` does to memory is
/// lost. Throws InputError for a path that is no regular file, which might never end, and
/// std::runtime_error if there can be no other process.
std::string failure_in_isolation(const std::string& path, const std::function<bool()>& read);

}  // namespace foldproof
