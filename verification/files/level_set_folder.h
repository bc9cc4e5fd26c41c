// A folder of level sets, so that what one run made serves all that follow (BMF03 section 5.1).
#pragma once

#include <functional>
#include <string>

#include "reference/bodies/level_set_provider.h"

namespace foldproof {

/// Makers that keep what they make in the folder, one file each, named after the key of all that it
/// is computed from. `log_line` is told of every file that is loaded, written, or refused and
/// replaced, and why. A folder or file that cannot be written throws.
LevelSetProvider caching_provider(const std::string& folder,
                                  std::function<void(const std::string&)> log_line);

}  // namespace foldproof
