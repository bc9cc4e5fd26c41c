// Which known name a mistyped one may stand for.
#pragma once

#include <string>
#include <vector>

namespace foldproof {

/// The nearest known names, at most three and the nearest first. None of them is reached by editing
/// more than a third of the letters of `typed`, rounded up, nor by two edits more than the nearest.
/// A name with a dot is also compared by what stands behind the dot.
std::vector<std::string> nearest_names(const std::string& typed,
                                       const std::vector<std::string>& known);

/// "; did you mean a, b or c?", or "" for no names.
std::string did_you_mean(const std::vector<std::string>& names);

}  // namespace foldproof
