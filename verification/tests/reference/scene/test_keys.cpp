// Keys of a file, and overrides of them.
#include <catch2/catch.hpp>

#include "reference/scene/key_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

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

std::shared_ptr<KeyTable> parsed(const std::string& keys) { return parse_keys(keys, "some.toml"); }

}  // namespace

TEST_CASE("each value, table and entry of a list has its line, and is read as it stands",
          "[scene]") {
  const auto root = parsed(text);
  const auto a = root->table("a"), c = a->table("c");
  const auto e = root->tables("e");
  REQUIRE(e.size() == 2);
  const auto& lists = std::get<std::vector<KeyValue>>(c->entries.at("list").data);
  const std::vector<std::pair<std::string, int>> places = {
      {root->where("top"), 1}, {root->where("a"), 2}, {a->where(), 2},     {a->where("none"), 2},
      {a->where("b"), 3},      {a->where("c"), 4},    {c->where(), 4},     {c->where("d"), 5},
      {c->where("list"), 7},   {lists[0].where, 8},   {lists[1].where, 9}, {e[0]->where(), 11},
      {e[1]->where(), 13},     {e[1]->where("g"), 14}};
  for (const auto& [place, line] : places) CHECK(place == "some.toml:" + std::to_string(line));
  CHECK(root->where("none") == root->where());

  CHECK(c->number_or("d", 5) == -2);  // a whole number is one
  CHECK(c->integer_or("absent", 5) == 5);
  CHECK(c->flag_or("absent", true));
  CHECK(e[0]->text_or("f", "y") == "x");
  CHECK(e[1]->texts("g") == std::vector<std::string>{"u", "v", "w"});
  CHECK(c->vectors("list") == std::vector<Vector3>{{1, 2.5, 3}, {4, 5.5, 6}});
  CHECK(parsed("i = [7, -8, 9]")->integers("i") == std::vector<long>{7, -8, 9});
  CHECK(e[1]->is_list("g"));
  CHECK_FALSE(e[0]->is_list("f"));
  CHECK_FALSE(e[1]->is_text("g"));
  CHECK(parsed("")->vector_or("v", {7, 8, 9}) == Vector3(7, 8, 9));
}

TEST_CASE("a missing key, or a value of another type, the last of a list too, is refused",
          "[scene]") {
  const auto root = parsed(text);
  CHECK_THROWS_WITH(root->number("x"), root->where() + ": the file needs the key 'x'");
  CHECK_THROWS_WITH(root->tables("e")[1]->vector("x"), "some.toml:13: [e] needs the key 'x'");
  CHECK_THROWS_WITH(root->table("a")->text("b"),
                    "some.toml:3: 'b' in [a] must be a text in quotes");
  const auto list = [](const std::string& value) { return parsed("k = " + value); };
  CHECK_THROWS_WITH(list("[1, 2.5]")->integers("k"), Contains("a list of whole numbers"));
  CHECK_THROWS_WITH(list("['a', 2]")->texts("k"), Contains("a list of texts"));
  CHECK_THROWS_WITH(list("[[1, 2, 3], 4]")->vectors("k"), Contains("a list of points"));
  CHECK_THROWS_WITH(list("[{}, 4]")->tables("k"), Contains("a list of tables, [[k]]"));
  CHECK_THROWS_WITH(list("1.5")->flag_or("k", true), Contains("true or false"));
  for (const char* value : {"[1, 2]", "[1, 2, 3, 4]", "['a', 2, 3]", "[1, 2, inf]", "[]"})
    CHECK_THROWS_WITH(list(value)->vector("k"), Contains("three numbers [x, y, z]"));
  for (const char* value : {"-inf", "nan", "'1'", "true"})
    CHECK_THROWS_WITH(list(value)->number("k"), Contains("a finite number"));
}

TEST_CASE("an unused key is refused with the known ones, below tables and in lists too",
          "[scene]") {
  const auto root = parsed(text);
  CHECK_THROWS_WITH(root->reject_unused(),
                    "some.toml:2: unknown key 'a' in the file; known here: ");
  root->has("top");
  root->leave("e");  // to another reader
  root->table("a")->has("b");
  const auto c = root->table("a")->table("c");
  c->has("yes");
  c->has("list");
  CHECK_THROWS_WITH(root->reject_unused(),
                    "some.toml:5: unknown key 'd' in [a.c]; known here: list, yes");
  c->has("d");
  CHECK_NOTHROW(root->reject_unused());
  const auto lists = parsed("k = [5, { m = 3 }, { n = 4 }]\n");
  lists->has("k");
  const auto& entries = std::get<std::vector<KeyValue>>(lists->entries.at("k").data);
  std::get<std::shared_ptr<KeyTable>>(entries[1].data)->has("m");
  CHECK_THROWS_WITH(lists->reject_unused(), "some.toml:1: unknown key 'n' in [k]; known here: ");
}

TEST_CASE("an empty text, and a mark of its encoding alone, have no keys") {
  for (const std::string nothing : {"", "\xEF\xBB\xBF"}) CHECK(parsed(nothing)->entries.empty());
}

TEST_CASE("quotes begin a text after a sign or a blank, not inside a word") {
  CHECK(parsed("a=\"\xC3\xA9\"\n")->text("a") == "\xC3\xA9");
  CHECK_THROWS_WITH(parsed("a = b\"\xC3\xA9\"\n"), Contains("outside ASCII"));
}

TEST_CASE("32 lists and tables in each other are read, 33 are refused", "[scene]") {
  // each list with a table in it is two
  std::string key = "a", mixed = "1";
  for (int parts = 1; parts < 32; ++parts) key += ".a";
  for (int pairs = 0; pairs < 15; ++pairs) mixed = "[{ b = " + mixed + " }]";
  CHECK_NOTHROW(parsed(key + " = 1"));
  CHECK_NOTHROW(parsed("a = [" + mixed + "]"));
  const std::string refusal = "some.toml:1: tables and lists in more than 32 others";
  check_refused(parsed, {{key + ".a = 1", refusal}, {"a = [[" + mixed + "]]", refusal}});
}

TEST_CASE("dates are refused, and files without any text", "[scene]") {
  check_refused(parsed, {{"[t]\nday = 1979-05-27", "some.toml:2: 't.day' is a date or time"}});
  CHECK_THROWS_WITH(set_key(*parsed(""), "a=1979-05-27"), Contains("'value' is a date or time"));
  const ScratchFolder folder;
  CHECK(read_text(folder.write("some.toml", "a = 1\n\nb = 2")) == "a = 1\n\nb = 2");
  check_refused(read_text, {{folder.write("empty.toml", ""), "cannot be read, or is empty"}});
}

namespace {

constexpr const char* case_text = R"(title = "a case"
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
  auto root = parse_keys(case_text, "some.toml");
  set_key(*root, assignment);
  return root;
}

std::shared_ptr<KeyTable> read_keys(const std::string& keys) {
  return parse_keys(keys, "some.toml");
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

TEST_CASE("an override that leads nowhere is refused with what is wrong", "[scene]") {
  const std::string form = "write table.key=value", hold = "'hold' is not a table";
  std::string key = "a";
  for (int parts = 1; parts < 32; ++parts) key += ".a";
  CHECK_NOTHROW(with(key + "=5"));
  check_refused(with, {{"cloth.width", "--set cloth.width: " + form},
                       {"=5", "--set =5: " + form},
                       {"", form},
                       {"title.x=5", "'title' is not a table"},
                       {"hold.x=5", hold},
                       {"hold.1=5", hold},
                       {"hold.1a.x=5", hold},
                       {"hold.1234567890.x=5", hold},
                       {"hold.123456789.x=5", "there is no hold.123456789"},
                       {"hold.2.x=5", "there is no hold.2"},
                       {"nothing.0.x=5", "there is no nothing.0"},
                       {"title.0.x=5", "there is no title.0"},
                       {"ids.1.x=5", "ids.1 is not a table"},
                       {"ids.2.x=5", "there is no ids.2"},
                       {key + ".a=5", "a key in more than 32 tables"}});
}

TEST_CASE("the value from the file is kept, not that of an earlier override", "[scene]") {
  const auto root = parse_keys(case_text, "some.toml");
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

TEST_CASE("a line may have 200 dots, and a value of an override is a text if it is no other",
          "[scene]") {
  CHECK_NOTHROW(read_keys("a = " + dotted(200) + "\nb = " + dotted(200)));
  CHECK_NOTHROW(read_keys("a = '" + std::string(300, '.') + "' # " + std::string(300, '.')));
  check_refused(read_keys, {{"a = 1\nb = " + dotted(201), "some.toml:2: more than 200 dots"}});
  for (const std::string& text : {std::string("a=b"), std::string("[1, 2"), dotted(201)})
    CHECK(with("v=" + text)->text("v") == text);
  CHECK(with("v='a=b'")->text("v") == "a=b");
}

TEST_CASE("quotes end where TOML says", "[scene]") {
  const std::string e = "\xC3\xA9", one = "some.toml:1" + outside, two = "some.toml:2" + outside;
  CHECK(read_keys("\"" + e + "\" = 1")->integer(e) == 1);
  for (const auto& [quoted, text] : std::vector<std::pair<std::string, std::string>>{
           {"\"\\\"" + e + "\"", "\"" + e},
           {"'" + e + "\\'", e + "\\"},
           {"\"\"\"" + e + "\"\n\"" + e + "\"\"\"\"", e + "\"\n\"" + e + "\""}})
    CHECK(read_keys("a = " + quoted)->text("a") == text);
  const std::string list = "['" + e + "','" + e + "',\t'" + e + "',\n'" + e + "']";
  const auto root = read_keys("a.'" + e + "' = {'" + e + "' = " + list + "}\n['" + e + "']");
  CHECK(root->table("a")->table(e)->texts(e).size() == 4);
  CHECK_NOTHROW(read_keys("a = 1 # " + e));
  check_refused(read_keys, {{"a = \"\\\\\" " + e, one},       // an escaped backslash, no quote
                            {"a = 'b\\' " + e, one},          // no escape in a literal
                            {"a = '''b''''" + e + "'", one},  // its own quote before its end
                            {"a = 'b\n" + e + "'", two},      // ends with its line
                            {"a = \"b\n" + e + "\"", two},
                            {"a = ''\n" + e, two},
                            {"a = 1 # don't\n" + e + "'", two},
                            {"a = '''b\nc'''\n" + e, "some.toml:3" + outside},
                            {"a = ''''''\n\n" + e, "some.toml:3" + outside},
                            {"# \"\"\"\n\n# " + e + "\n" + e, "some.toml:4" + outside},
                            {"a = 'b", "some.toml:1: "},
                            {"a = \"b\\", "some.toml:1: "}});
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

TEST_CASE("an override without a value unsets a key, which must be there", "[scene]") {
  const auto root = with("cloth.width=");
  CHECK(!root->table("cloth")->has("width"));
  CHECK(root->table("cloth")->replaced.contains("width"));
  CHECK(with("hold.0.top=")->tables("hold")[0]->entries.empty());
  CHECK(!with("only=")->has("only"));
  CHECK(with("title=''")->text("title").empty());
  check_refused(with, {{"cloth.widht=", "--set cloth.widht=: there is no key 'widht' to unset"}});
}
