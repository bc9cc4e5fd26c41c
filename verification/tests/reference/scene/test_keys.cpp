// Tables of keys: values, their places, and each refusal word for word.
#include <catch2/catch.hpp>

#include "reference/scene/key_file.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;

namespace {

constexpr const char* text = R"(top = 7
[a]
b = 1.5
[a.c]
d = -2
yes = true
list = [
  [1, 2.5, 3],
  [4, 5.5, 6]
]
[[e]]
f = "x"
[[e]]
g = ["u", "v", "w"]
)";

std::string nested(int lists, const std::string& inside) {
  return std::string(size_t(lists), '[') + inside + std::string(size_t(lists), ']');
}

}  // namespace

TEST_CASE("each value, table and entry of a list knows its line", "[scene]") {
  const auto root = parse_keys(text, "some.toml");
  CHECK(root->where("top") == "some.toml:1");
  CHECK(root->where("a") == "some.toml:2");
  CHECK(root->where("none") == root->where());
  const auto a = root->table("a"), c = a->table("c");
  CHECK(a->where() == "some.toml:2");
  CHECK(a->where("b") == "some.toml:3");
  CHECK(a->where("none") == "some.toml:2");
  CHECK(a->where("c") == "some.toml:4");
  CHECK(c->where() == "some.toml:4");
  CHECK(c->where("d") == "some.toml:5");
  CHECK(c->where("list") == "some.toml:7");
  const auto& lists = std::get<std::vector<KeyValue>>(c->entries.at("list").data);
  REQUIRE(lists.size() == 2);
  CHECK(lists[0].where == "some.toml:8");
  CHECK(lists[1].where == "some.toml:9");
  const auto e = root->tables("e");
  REQUIRE(e.size() == 2);
  CHECK(e[0]->where() == "some.toml:11");
  CHECK(e[1]->where() == "some.toml:13");
  CHECK(e[1]->where("g") == "some.toml:14");
}

TEST_CASE("values are read as they stand, whole numbers as numbers too", "[scene]") {
  const auto root = parse_keys(text, "some.toml");
  const auto c = root->table("a")->table("c");
  CHECK(c->integer("d") == -2);
  CHECK(c->number("d") == -2);
  CHECK(c->number_or("d", 5) == -2);
  CHECK(c->integer_or("d", 5) == -2);
  CHECK(c->integer_or("absent", 5) == 5);
  CHECK(c->number_or("absent", 5.5) == 5.5);
  CHECK(c->flag_or("yes", false));
  CHECK(c->flag_or("absent", true));
  CHECK_FALSE(c->flag_or("absent", false));
  CHECK(c->vectors("list") == std::vector<Vector3>{{1, 2.5, 3}, {4, 5.5, 6}});
  const auto e = root->tables("e");
  CHECK(e[0]->text("f") == "x");
  CHECK(e[0]->text_or("f", "y") == "x");
  CHECK(e[0]->text_or("absent", "y") == "y");
  CHECK(e[1]->texts("g") == std::vector<std::string>{"u", "v", "w"});
  CHECK(e[1]->is_list("g"));
  CHECK_FALSE(e[1]->is_list("absent"));
  CHECK_FALSE(e[0]->is_list("f"));
  CHECK(e[0]->is_text("f"));
  CHECK_FALSE(e[0]->is_text("absent"));
  CHECK_FALSE(e[1]->is_text("g"));
  CHECK(root->table("absent") == nullptr);
  CHECK(root->tables("absent").empty());
  CHECK(root->has("top"));
  CHECK_FALSE(root->has("bottom"));
  const auto more = parse_keys("v = [1, -2.5, 3]\ni = [7, -8, 9]\nf = false\n", "some.toml");
  CHECK(more->vector("v") == Vector3(1, -2.5, 3));
  CHECK(more->vector_or("v", {7, 8, 9}) == Vector3(1, -2.5, 3));
  CHECK(more->vector_or("absent", {7, 8, 9}) == Vector3(7, 8, 9));
  CHECK(more->integers("i") == std::vector<long>{7, -8, 9});
  CHECK_FALSE(more->flag_or("f", true));
}

TEST_CASE("a missing key is refused with its table, which the file itself is too", "[scene]") {
  const auto root = parse_keys(text, "some.toml");
  CHECK_THROWS_WITH(root->number("x"), root->where() + ": the file needs the key 'x'");
  CHECK_THROWS_WITH(root->table("a")->text("x"), "some.toml:2: [a] needs the key 'x'");
  CHECK_THROWS_WITH(root->table("a")->table("c")->integer("x"),
                    "some.toml:4: [a.c] needs the key 'x'");
  CHECK_THROWS_WITH(root->tables("e")[1]->vector("x"), "some.toml:13: [e] needs the key 'x'");
  CHECK_THROWS_WITH(root->texts("x"), root->where() + ": the file needs the key 'x'");
  CHECK_THROWS_WITH(root->integers("x"), root->where() + ": the file needs the key 'x'");
  CHECK_THROWS_WITH(root->vectors("x"), root->where() + ": the file needs the key 'x'");
}

TEST_CASE("a value of another type is refused with what it must be", "[scene]") {
  const auto root = parse_keys(text, "some.toml");
  const auto a = root->table("a");
  CHECK_THROWS_WITH(root->text("top"), "some.toml:1: 'top' must be a text in quotes");
  CHECK_THROWS_WITH(a->text("b"), "some.toml:3: 'b' in [a] must be a text in quotes");
  CHECK_THROWS_WITH(a->text_or("b", ""), "some.toml:3: 'b' in [a] must be a text in quotes");
  CHECK_THROWS_WITH(a->integer("b"), "some.toml:3: 'b' in [a] must be a whole number");
  CHECK_THROWS_WITH(a->integer_or("b", 3), "some.toml:3: 'b' in [a] must be a whole number");
  CHECK_THROWS_WITH(a->flag_or("b", true), "some.toml:3: 'b' in [a] must be true or false");
  CHECK_THROWS_WITH(a->vector("b"), "some.toml:3: 'b' in [a] must be three numbers [x, y, z]");
  CHECK_THROWS_WITH(a->table("b"), "some.toml:3: 'b' in [a] must be a table");
  CHECK_THROWS_WITH(a->tables("b"), "some.toml:3: 'b' in [a] must be a list of tables, [[b]]");
  CHECK_THROWS_WITH(a->integers("b"), "some.toml:3: 'b' in [a] must be a list of whole numbers");
  CHECK_THROWS_WITH(a->texts("b"), "some.toml:3: 'b' in [a] must be a list of texts");
  CHECK_THROWS_WITH(a->vectors("b"),
                    "some.toml:3: 'b' in [a] must be a list of points [[x, y, z], ...]");
  CHECK_THROWS_WITH(a->table("c")->number("yes"),
                    "some.toml:6: 'yes' in [a.c] must be a finite number");
}

TEST_CASE("an entry of another type is refused, the last one of a list too", "[scene]") {
  const auto list = [](const std::string& value) {
    return parse_keys("k = " + value, "some.toml");
  };
  CHECK_THROWS_WITH(list("[1, 2.5]")->integers("k"),
                    "some.toml:1: 'k' must be a list of whole numbers");
  CHECK_THROWS_WITH(list("['a', 2]")->texts("k"), "some.toml:1: 'k' must be a list of texts");
  CHECK_THROWS_WITH(list("[[1, 2, 3], 4]")->vectors("k"),
                    "some.toml:1: 'k' must be a list of points [[x, y, z], ...]");
  CHECK_THROWS_WITH(list("[{}, 4]")->tables("k"),
                    "some.toml:1: 'k' must be a list of tables, [[k]]");
  for (const char* value : {"[1, 2]", "[1, 2, 3, 4]", "['a', 2, 3]", "[1, 2, inf]", "[nan, 2, 3]",
                            "[1, true, 3]", "[]"}) {
    INFO(value);
    CHECK_THROWS_WITH(list(value)->vector("k"), "some.toml:1: 'k' must be three numbers [x, y, z]");
  }
  for (const char* value : {"inf", "-inf", "nan", "'1'", "true", "[1]"}) {
    INFO(value);
    CHECK_THROWS_WITH(list(value)->number("k"), "some.toml:1: 'k' must be a finite number");
  }
  CHECK(list("[]")->integers("k").empty());
  CHECK(list("[]")->vectors("k").empty());
}

TEST_CASE("an unused key is refused with the known ones, below tables and in lists too",
          "[scene]") {
  const auto root = parse_keys(text, "some.toml");
  CHECK_THROWS_WITH(root->reject_unused(),
                    "some.toml:2: unknown key 'a' in the file; known here: ");
  root->has("unwritten");
  root->has("top");
  root->leave("e");
  const auto a = root->table("a");
  a->has("b");
  const auto c = a->table("c");
  c->has("yes");
  c->has("list");
  CHECK_THROWS_WITH(root->reject_unused(),
                    "some.toml:5: unknown key 'd' in [a.c]; known here: list, yes");
  c->has("d");
  CHECK_NOTHROW(root->reject_unused());  // [[e]] is left to another reader
  CHECK_THROWS_WITH(parse_keys(text, "other.toml")->tables("e")[1]->reject_unused(),
                    "other.toml:14: unknown key 'g' in [e]; known here: ");

  const auto lists = parse_keys("k = [5, { m = 3 }, { n = 4 }]\n", "some.toml");
  lists->has("k");
  const auto& entries = std::get<std::vector<KeyValue>>(lists->entries.at("k").data);
  std::get<std::shared_ptr<KeyTable>>(entries[1].data)->has("m");
  CHECK_THROWS_WITH(lists->reject_unused(), "some.toml:1: unknown key 'n' in [k]; known here: ");
  std::get<std::shared_ptr<KeyTable>>(entries[2].data)->has("n");
  CHECK_NOTHROW(lists->reject_unused());
}

TEST_CASE("a key that is left is known, though nobody asks for it", "[scene]") {
  const auto behind = parse_keys("b = 1\nd = 2\n", "some.toml");
  behind->leave("b");
  CHECK_THROWS_WITH(behind->reject_unused(),
                    "some.toml:2: unknown key 'd' in the file; known here: b");
  const auto root = parse_keys("a = 1\n[b]\nc = 2\n", "some.toml");
  root->leave("b");
  CHECK_THROWS_WITH(root->reject_unused(),
                    "some.toml:1: unknown key 'a' in the file; known here: b");
}

TEST_CASE("32 lists and tables in each other are read, 33 are refused", "[scene]") {
  const std::string refusal = ": tables and lists in more than 32 others";
  CHECK_NOTHROW(parse_keys("a = " + nested(32, ""), "some.toml"));
  CHECK_THROWS_WITH(parse_keys("a = " + nested(33, ""), "some.toml"), "some.toml:1" + refusal);
  CHECK_NOTHROW(parse_keys("a = " + nested(31, "5"), "some.toml"));
  CHECK_THROWS_WITH(parse_keys("a = " + nested(32, "5"), "some.toml"), "some.toml:1" + refusal);

  std::string key = "a";
  for (int parts = 1; parts < 32; ++parts) key += ".a";
  CHECK_NOTHROW(parse_keys(key + " = 1", "some.toml"));
  CHECK_THROWS_WITH(parse_keys(key + ".a = 1", "some.toml"), "some.toml:1" + refusal);

  // each list with a table in it is two
  std::string mixed = "1";
  for (int pairs = 0; pairs < 15; ++pairs) mixed = "[{ b = " + mixed + " }]";
  CHECK_NOTHROW(parse_keys("a = " + nested(1, mixed), "some.toml"));
  CHECK_THROWS_WITH(parse_keys("a = " + nested(2, mixed), "some.toml"), "some.toml:1" + refusal);

  // a value of --set stands by itself
  const auto root = parse_keys("", "some.toml");
  CHECK_NOTHROW(set_key(*root, "a=" + nested(33, "")));
  CHECK_THROWS_WITH(set_key(*root, "a=" + nested(34, "")), "--set a=" + nested(34, "") + refusal);
}

TEST_CASE("dates and times are refused", "[scene]") {
  CHECK_THROWS_WITH(parse_keys("[t]\nday = 1979-05-27", "some.toml"),
                    "some.toml:2: 't.day' is a date or time, which no key takes");
  CHECK_THROWS_WITH(set_key(*parse_keys("", "some.toml"), "a=1979-05-27"),
                    "--set a=1979-05-27: 'value' is a date or time, which no key takes");
}

TEST_CASE("a text is read whole, and a file without any is refused", "[scene]") {
  const ScratchFolder folder;
  CHECK(read_text(folder.write("some.toml", "a = 1\n\nb = 2")) == "a = 1\n\nb = 2");
  const std::string empty = folder.write("empty.toml", "");
  CHECK_THROWS_WITH(read_text(empty), empty + ": cannot be read, or is empty");
}
