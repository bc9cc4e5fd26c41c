// Overrides of keys on the command line, and the characters that a file of keys may hold.
#include <catch2/catch.hpp>

#include "reference/scene/key_file.h"

using namespace foldproof;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

constexpr const char* text = R"(title = "a case"
ids = [4, 5]
[cloth]
width = 1.5
[[hold]]
top = 0.25
[[hold]]
top = 0.5
[[hold.part]]
x = 1
[[hold.part]]
x = 2
[[only]]
y = 3
)";

std::shared_ptr<KeyTable> with(const std::string& assignment) {
  auto root = parse_keys(text, "some.toml");
  set_key(*root, assignment);
  return root;
}

/// A list of so many numbers, a dot in each.
std::string dotted(int numbers) {
  std::string list = "[0.5";
  for (int k = 1; k < numbers; ++k) list += ", 0.5";
  return list + "]";
}

const std::string outside = ": a character outside ASCII; put texts into quotes";

}  // namespace

TEST_CASE("an override reaches each table and each entry of a list", "[scene]") {
  CHECK(with("title=7")->integer("title") == 7);
  CHECK(with("cloth.width=2.5")->table("cloth")->number("width") == 2.5);
  CHECK(with("hold.0.top=0.75")->tables("hold")[0]->number("top") == 0.75);
  CHECK(with("hold.1.part.1.x=9")->tables("hold")[1]->tables("part")[1]->integer("x") == 9);
  CHECK(with("hold.1.part.1.x=9")->tables("hold")[1]->tables("part")[0]->integer("x") == 1);
  CHECK(with("only.y=8")->tables("only")[0]->integer("y") == 8);
  CHECK(with("only.0.y=8")->tables("only")[0]->integer("y") == 8);
  CHECK(with("only.1=8")->tables("only")[0]->integer("1") == 8);
  CHECK(with("cloth.3=8")->table("cloth")->integer("3") == 8);
  CHECK(with("a..b=4")->table("a")->table("")->integer("b") == 4);
  CHECK(with("a.b.c.d=4")->table("a")->table("b")->table("c")->integer("d") == 4);
}

TEST_CASE("the value of an override is what TOML says, or else a text", "[scene]") {
  CHECK(with("v=true")->flag_or("v", false));
  CHECK(with("v=1.5")->number("v") == 1.5);
  CHECK(with("v='a=b'")->text("v") == "a=b");
  CHECK(with("v=a=b")->text("v") == "a=b");
  CHECK(with("v=")->text("v").empty());
  CHECK(with("v=[1, 2")->text("v") == "[1, 2");
  CHECK(with("v=1 \xC3\xA9")->text("v") == "1 \xC3\xA9");
  CHECK(with("v=[[1, 2, 3]]")->vectors("v") == std::vector<Vector3>{{1, 2, 3}});
  CHECK(with("v=" + dotted(201))->text("v") == dotted(201));
}

TEST_CASE("all that an override makes has its place, and the name of its step", "[scene]") {
  const std::string assignment = "p.q={ r = [5, { s = 6 }] }", where = "--set " + assignment;
  const auto root = with(assignment);
  const auto p = root->table("p"), q = p->table("q");
  CHECK(root->where("p") == where);
  CHECK(p->where() == where);
  CHECK(p->where("q") == where);
  CHECK(q->where() == where);
  CHECK(q->where("r") == where);
  const auto& list = std::get<std::vector<KeyValue>>(q->entries.at("r").data);
  REQUIRE(list.size() == 2);
  CHECK(list[0].where == where);
  CHECK(list[1].where == where);
  CHECK_THROWS_WITH(p->number("x"), where + ": [p] needs the key 'x'");
  CHECK(is_override(where));
  CHECK_FALSE(is_override("some.toml:3"));
  CHECK_FALSE(is_override("a--set b"));
}

TEST_CASE("an override that leads nowhere is refused with what is wrong", "[scene]") {
  const auto refusal = [](const std::string& assignment) {
    try {
      with(assignment);
    } catch (const InputError& error) {
      const std::string said = error.what(), begin = "--set " + assignment + ": ";
      return said.starts_with(begin) ? said.substr(begin.size()) : "elsewhere: " + said;
    }
    return std::string("none");
  };
  CHECK(refusal("cloth.width") == "write table.key=value");
  CHECK(refusal("=5") == "write table.key=value");
  CHECK(refusal("") == "write table.key=value");
  CHECK(refusal("title.x=5") == "'title' is not a table");
  CHECK(refusal("ids.x=5") == "'ids' is not a table");
  CHECK(refusal("hold.x=5") == "'hold' is not a table");
  CHECK(refusal("hold.1=5") == "'hold' is not a table");
  CHECK(refusal("hold.2.x=5") == "there is no hold.2");
  CHECK(refusal("hold.123456789.x=5") == "there is no hold.123456789");
  CHECK(refusal("hold.1234567890.x=5") == "'hold' is not a table");
  CHECK(refusal("hold.1a.x=5") == "'hold' is not a table");
  CHECK(refusal("nothing.0.x=5") == "there is no nothing.0");
  CHECK(refusal("title.0.x=5") == "there is no title.0");
  CHECK(refusal("ids.1.x=5") == "ids.1 is not a table");
  CHECK(refusal("ids.2.x=5") == "there is no ids.2");
  std::string key = "a";
  for (int parts = 1; parts < 32; ++parts) key += ".a";
  CHECK(refusal(key + "=5") == "none");
  CHECK(refusal(key + ".a=5") == "a key in more than 32 tables");
}

TEST_CASE("the value from the file is kept, not that of an earlier override", "[scene]") {
  const auto root = parse_keys(text, "some.toml");
  set_key(*root, "title=one");
  set_key(*root, "title=two");
  set_key(*root, "new=3");
  set_key(*root, "new=4");
  CHECK(root->text("title") == "two");
  CHECK(root->integer("new") == 4);
  REQUIRE(root->replaced.size() == 1);
  CHECK(std::get<std::string>(root->replaced.at("title").data) == "a case");
  CHECK(root->replaced.at("title").where == "some.toml:1");
}

TEST_CASE("a line may have 200 dots, outside of quotes and comments", "[scene]") {
  const std::string many(300, '.');
  CHECK_NOTHROW(parse_keys("a = " + dotted(200), "some.toml"));
  CHECK_THROWS_WITH(parse_keys("a = " + dotted(201), "some.toml"),
                    "some.toml:1: more than 200 dots; break the line");
  CHECK_NOTHROW(parse_keys("a = 1\nb = " + dotted(200) + "\nc = " + dotted(200), "some.toml"));
  CHECK_THROWS_WITH(parse_keys("a = 1\nb = " + dotted(201), "some.toml"),
                    "some.toml:2: more than 200 dots; break the line");
  CHECK_NOTHROW(parse_keys(
      "a = '" + many + "'\n# " + many + "\nb = \"" + many + "\"\nc = '''\n" + many + "'''\n",
      "some.toml"));
}

TEST_CASE("quotes end where TOML says", "[scene]") {
  const auto refused = [](const std::string& keys, int line) {
    CHECK_THROWS_WITH(parse_keys(keys, "some.toml"), "some.toml:" + std::to_string(line) + outside);
  };
  const std::string e = "\xC3\xA9";
  CHECK(parse_keys("\"" + e + "\" = 1", "some.toml")->integer(e) == 1);
  CHECK(parse_keys("a = \"\\\"" + e + "\"", "some.toml")->text("a") == "\"" + e);
  CHECK(parse_keys("a = '" + e + "\\'", "some.toml")->text("a") == e + "\\");
  CHECK(parse_keys("a = \"\"\"" + e + "\"\n\"" + e + "\"\"\"\"", "some.toml")->text("a") ==
        e + "\"\n\"" + e + "\"");
  CHECK(parse_keys("a.'" + e + "' = {'" + e + "' = ['" + e + "','" + e + "',\t'" + e + "',\n'" + e +
                       "']}\n['" + e + "']",
                   "some.toml")
            ->table("a")
            ->table(e)
            ->texts(e)
            .size() == 4);
  refused("a = \"\\\\\" " + e, 1);   // an escaped backslash, no escaped quote
  refused("a = 'b\\' " + e, 1);      // no escape in a literal
  refused("a = 'b\n" + e + "'", 2);  // ends with its line
  refused("a = \"b\n" + e + "\"", 2);
  refused("a = '''b\nc'''\n" + e, 3);
  refused("a = '''b''''" + e + "'", 1);  // its own quote before its end, and none begins behind it
  refused("a = ''\n" + e, 2);
  refused("a = ''''''\n\n" + e, 3);
  refused("a = 1 # don't\n" + e + "'", 2);
  refused("# \"\"\"\n\n# " + e + "\n" + e, 4);
  CHECK_NOTHROW(parse_keys("a = 1 # " + e, "some.toml"));
  CHECK_THROWS_WITH(parse_keys("a = 'b", "some.toml"), StartsWith("some.toml:1: "));
  CHECK_THROWS_WITH(parse_keys("a = \"b\\", "some.toml"), StartsWith("some.toml:1: "));
  CHECK_THROWS_WITH(parse_keys("a = '''b\n\n", "some.toml"), StartsWith("some.toml:"));
}

TEST_CASE("each letter outside ASCII stands in texts, and 127 is inside", "[scene]") {
  // U+00C0, U+0080 and U+10FFFF: bytes 0x80 and 0xBF among them
  for (const char* letter : {"\xC3\x80", "\xC2\x80", "\xF4\x8F\xBF\xBF"})
    CHECK(parse_keys("a = '" + std::string(letter) + "'", "some.toml")->text("a") == letter);
  CHECK_THROWS_WITH(parse_keys("a = 1\n\x80", "some.toml"), "some.toml:2" + outside);
  CHECK_THROWS_WITH(parse_keys("a = 1\n\x7F", "some.toml"), !Contains("outside ASCII"));
  CHECK_THROWS_WITH(parse_keys("# \x7F\na = [", "some.toml"), StartsWith("some.toml:1: "));
  CHECK_THROWS_WITH(parse_keys("\xEF\xBB\xBF\xC3\x80", "some.toml"), "some.toml:1" + outside);
  CHECK_THROWS_WITH(parse_keys("\xC3\x80", "some.toml"), "some.toml:1" + outside);
  CHECK(parse_keys("\xEF\xBB\xBF'a' = '\xC3\x80'", "some.toml")->text("a") == "\xC3\x80");
}
