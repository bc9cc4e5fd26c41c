#include "scripts/program/command_line/typed_words.h"

namespace foldproof {

namespace {

/// A word that a shell reads as it is; others are quoted.
bool is_plain(const std::string& word) {
  const char* const plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  return !word.empty() && word.find_first_not_of(plain) == std::string::npos;
}

}  // namespace

std::string shell_word(const std::string& word) {
  if (is_plain(word)) return word;
  std::string text = "'";
  for (const char letter : word) text += letter == '\'' ? "'\\''" : std::string(1, letter);
  return text + "'";
}

std::string typed_again(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
  return line;
}

std::string with_option(const std::vector<std::string>& words, const std::string& option) {
  std::string line;
  for (const std::string& word : words)
    if (word != "--resume" && word != "--restart") line += shell_word(word) + " ";
  return line + option;
}

}  // namespace foldproof
