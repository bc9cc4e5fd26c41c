// The command as it was typed, to be typed again.
#pragma once

#include <string>
#include <vector>

namespace foldproof {

/// A word as a shell reads it back: quoted, unless it is plain.
std::string shell_word(const std::string& word);

/// A line for a shell that does the same; words: what was typed, the program's name first.
std::string typed_again(const std::vector<std::string>& words);

/// A line for a shell that does the same with one more option. --resume and --restart, which
/// exclude each other, are left out of the words.
std::string with_option(const std::vector<std::string>& words, const std::string& option);

}  // namespace foldproof
