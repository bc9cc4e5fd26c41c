// Keys of a file, and overrides of them.
#include <catch2/catch.hpp>

#include "reference/scene/key_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;

using Catch::Matchers::Contains;

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

}  // namespace

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

TEST_CASE("an override takes a number without the digits that TOML requires", "[scene]") {
  const auto width = [](const std::string& typed) {
    return with("cloth.width=" + typed)->table("cloth")->number("width");
  };
  CHECK(width(".25") == 0.25);
  CHECK(width("-.5e-3") == -0.5e-3);
  CHECK(width("3.") == 3);
  CHECK(with("title=1.2.3")->text("title") == "1.2.3");
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
