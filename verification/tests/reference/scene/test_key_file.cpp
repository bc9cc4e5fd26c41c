// The reader of case files: every message names its place.
#include <catch2/catch.hpp>

#include "reference/scene/key_file.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

constexpr const char* text = R"(title = "a case"
[cloth]
width = 1.5
columns = 7
flat = true
corner = [1, 2.5, -3]
ids = [4, 5]

[[hold]]
top = 0.25
[[hold]]
top = 0.5
)";

}  // namespace

TEST_CASE("values come back as they were written") {
  const auto root = parse_keys(text, "some.toml");
  const auto cloth = root->table("cloth");
  CHECK(root->text("title") == "a case");
  CHECK(cloth->number("width") == 1.5);
  CHECK(cloth->number("columns") == 7);
  CHECK(cloth->integer("columns") == 7);
  CHECK(cloth->flag_or("flat", false));
  CHECK(cloth->vector("corner") == Vector3(1, 2.5, -3));
  CHECK(cloth->integers("ids") == std::vector<long>{4, 5});
  const auto holds = root->tables("hold");
  REQUIRE(holds.size() == 2);
  CHECK(holds[1]->number("top") == 0.5);
  CHECK(cloth->number_or("absent", 0.75) == 0.75);
}

TEST_CASE("an empty text, and a mark of its encoding alone, have no keys") {
  for (const std::string nothing : {"", "\xEF\xBB\xBF"}) {
    const auto root = parse_keys(nothing, "some.toml");
    CHECK(!root->has("title"));
    CHECK_NOTHROW(root->reject_unused());
  }
}

TEST_CASE("a key that nobody asked for is refused with its line and what is known") {
  const auto root = parse_keys(text, "some.toml");
  root->has("title");
  root->tables("hold")[0]->has("top");
  root->table("cloth")->number("width");
  CHECK_THROWS_WITH(root->reject_unused(), Contains("some.toml:4") && Contains("columns") &&
                                               Contains("[cloth]") &&
                                               Contains("known here: width"));
}

TEST_CASE("wrong types and missing keys are refused with file, line and what is wanted") {
  const auto root = parse_keys(text, "some.toml");
  const auto cloth = root->table("cloth");
  CHECK_THROWS_WITH(cloth->text("width"), Contains("some.toml:3") && Contains("text"));
  CHECK_THROWS_WITH(cloth->integer("width"), Contains("whole number"));
  CHECK_THROWS_WITH(cloth->vector("ids"), Contains("three numbers"));
  CHECK_THROWS_WITH(cloth->number("height"), Contains("some.toml:2") && Contains("height"));
  CHECK_THROWS_WITH(root->table("title"), Contains("a table"));
  CHECK_THROWS_WITH(parse_keys("a = nan", "n.toml")->number("a"),
                    Contains("n.toml:1") && Contains("finite"));
  CHECK_THROWS_WITH(parse_keys("a = [", "broken.toml"), Contains("broken.toml:1"));
}

TEST_CASE("overrides change, add, and reach into lists") {
  const auto root = parse_keys(text, "some.toml");
  set_key(*root, "cloth.width=3");
  set_key(*root, "time.step=automatic");
  set_key(*root, "hold.1.top=0.125");
  CHECK(root->table("cloth")->number("width") == 3);
  CHECK(root->table("time")->text("step") == "automatic");
  CHECK(root->tables("hold")[1]->number("top") == 0.125);
  CHECK(root->table("cloth")->where("width") == "--set cloth.width=3");
  CHECK_THROWS_WITH(set_key(*root, "cloth.width"), Contains("table.key=value"));
  CHECK_THROWS_WITH(set_key(*root, "title.more=1"), Contains("not a table"));
  CHECK_THROWS_WITH(set_key(*root, "hold.7.top=1"), Contains("no hold.7"));
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
