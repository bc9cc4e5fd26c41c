// Level sets computed once and reused, by a run or, from a folder, by later ones (BMF03
// section 5.1).
#pragma once

#include <functional>
#include <string>

#include "reference/bodies/level_set_provider.h"

namespace foldproof {

/// A provider that caches its results in the folder, one file each, named by the key of its input.
/// `log_line` receives a message for every file that is loaded, written, or refused and replaced,
/// with the reason. What is missing is computed on that many threads. A folder or file that cannot
/// be written throws.
LevelSetProvider caching_provider(const std::string& folder,
                                  std::function<void(const std::string&)> log_line,
                                  int threads = 1);

/// Calls `provider` once per distinct request and returns the stored result afterwards, from any
/// thread. Copies share the stored results for as long as one of them exists.
LevelSetProvider memoizing_provider(const LevelSetProvider& provider);

}  // namespace foldproof
