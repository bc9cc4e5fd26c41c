// Whole text files, at the very bounds of what is read.
#include <catch2/catch.hpp>

#include "reference/mesh/mesh_file.h"
#include "reference/mesh/text_file.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;

namespace {

/// The refusal of a file of this text, without its name; "" if the text comes back.
std::string said_of(const std::string& text, const TextLimits& limits) {
  const ScratchFolder folder;
  const std::string path = folder.write("t.txt", text);
  try {
    const std::string read = read_text_file(path, limits);
    CHECK(read == text);
  } catch (const std::exception& error) {
    const std::string message = error.what();
    CHECK(message.starts_with(path));
    return message.substr(path.size());
  }
  return "";
}

}  // namespace

TEST_CASE("a text comes back whole, with every kind of byte and line") {
  std::string text;
  for (int k = 0; k < 256; ++k) text += char(k);
  CHECK(said_of(text, {256, 250}) == "");
  CHECK(said_of("", {0, 0}) == "");
  CHECK(said_of("\n\n\n", {3, 0}) == "");
  CHECK(said_of("no end of line", {14, 14}) == "");
}

TEST_CASE("what is no regular file is refused by its name") {
  const ScratchFolder folder;
  const std::string within = folder.write("file.txt", "text") + "/more";
  CHECK_THROWS_WITH(read_text_file(within, case_text_limits),
                    Catch::StartsWith(within + ": cannot be opened (Not a directory)"));
  for (const std::string path : {"/dev", "/dev/null"})
    CHECK_THROWS_WITH(read_text_file(path, case_text_limits),
                      path + ": cannot be read; give a regular file");
}
