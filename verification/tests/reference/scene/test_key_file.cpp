// The reader of case files: every message names its place.
#include <catch2/catch.hpp>

#include "reference/scene/key_file.h"

using namespace foldproof;
using Catch::Matchers::Contains;

TEST_CASE("an empty text, and a mark of its encoding alone, have no keys") {
  for (const std::string nothing : {"", "\xEF\xBB\xBF"})
    CHECK(parse_keys(nothing, "some.toml")->entries.empty());
}

TEST_CASE("tables nested deeper than anyone needs are refused with their line") {
  std::string lists = "a = ", key = "a";
  for (int depth = 0; depth < 40; ++depth) {
    lists += "[";
    key += ".a";
  }
  CHECK_THROWS_WITH(parse_keys("\n" + lists + std::string(40, ']'), "some.toml"),
                    Contains("some.toml:2: tables and lists in more than 32 others"));
  CHECK_THROWS_WITH(parse_keys(key + " = 1", "some.toml"), Contains("more than 32 others"));
  for (int dots = 0; dots < 200; ++dots) key += ".a";
  CHECK_THROWS_WITH(parse_keys("\n" + key + " = 1", "some.toml"),
                    Contains("some.toml:2: more than 200 dots"));
  const auto root = parse_keys("", "some.toml");
  CHECK_THROWS_WITH(set_key(*root, key + "=1"), Contains("more than 32 tables"));
}

TEST_CASE("letters outside ASCII stand in quotes and comments, and are refused elsewhere") {
  const auto root = parse_keys(
      "\xEF\xBB\xBF# gr\u00f6\u00dfe\na = \"\u0496 \\\" \u0496\"\nb = '''\n\u00b5''''\nc = "
      "'\u0496'\n",
      "some.toml");
  CHECK(root->text("a") == "\u0496 \" \u0496");
  CHECK(root->text("b") == "\u00b5'");
  CHECK(root->text("c") == "\u0496");
  CHECK_THROWS_WITH(parse_keys("a = 1\n2\u0496", "some.toml"),
                    Contains("some.toml:2: a character outside ASCII"));
  CHECK_THROWS_WITH(parse_keys("b = \"\"\"\n\n\"\"\"\n\u00b5 = 1", "some.toml"),
                    Contains("some.toml:4: a character"));
  set_key(*root, "title=\u0496");
  CHECK(root->text("title") == "\u0496");
}

TEST_CASE("quotes begin a text after a sign or a blank, not inside a word") {
  CHECK(parse_keys("a=\"\xC3\xA9\"\n", "some.toml")->text("a") == "\xC3\xA9");
  CHECK_THROWS_WITH(parse_keys("a = b\"\xC3\xA9\"\n", "some.toml"), Contains("outside ASCII"));
}
