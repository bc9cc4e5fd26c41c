// The reader of claims: what it returns, and what it refuses with the place of it.
#include <catch2/catch.hpp>
#include <fstream>

#include "reference/types.h"
#include "verification/claims/read_claims.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

constexpr const char* paper = R"([paper]
key = "ABC99"
title = "Sums"
authors = ["A. Adder", "B. Bee"]
year = 1999
)";

// lines 6 to 23 behind the paper
constexpr const char* claim = R"(
[[claim]]
id = "ABC-1"
section = "2.4"
paragraph = 3
begins = "Sums of all kinds"
printed = "a - b"
restored = "a + b"
statement = """
Sums add \
up."""
decided_by = [
  {role = "supports", finding = "sums.add-up"},
  {role = "limits", finding = "sums.overflow"},
]
recorded = "confirmed under a condition"
condition = "below {sums.overflow|bound}"
why = "They add up to {sums.add-up}."
)";

/// The text with one part, which must occur, replaced by another.
std::string with(std::string text, const std::string& part, const std::string& other) {
  const size_t at = text.find(part);
  REQUIRE(at != std::string::npos);
  return text.replace(at, part.size(), other);
}

std::vector<Claim> read(const std::string& text) {
  const ScratchFolder folder;
  std::ofstream(folder.file("abc99.toml")) << text;
  return read_claims(folder.file("."));
}

/// The claims with one part of the claim replaced are refused at this line, with these words.
void rejected(const std::string& part, const std::string& other, int line,
              const std::string& words) {
  INFO(part << " -> " << other);
  CHECK_THROWS_AS(read(paper + with(claim, part, other)), InputError);
  CHECK_THROWS_WITH(read(paper + with(claim, part, other)),
                    Contains("abc99.toml:" + std::to_string(line) + ": ") && Contains(words));
}

}  // namespace

TEST_CASE("a claim is read with its paper, its joined lines and its deciders in their order") {
  const std::vector<Claim> claims = read(std::string(paper) + claim);
  REQUIRE(claims.size() == 1);
  const Claim& only = claims[0];
  CHECK(only.paper == "ABC99");
  CHECK(only.id == "ABC-1");
  CHECK(only.section == "2.4");
  CHECK(only.cited.paragraph == 3);
  CHECK(only.cited.begins == "Sums of all kinds");
  CHECK(only.cited.printed == "a - b");
  CHECK(only.cited.restored == "a + b");
  CHECK(only.statement == "Sums add up.");
  REQUIRE(only.decided_by.size() == 2);
  CHECK(only.decided_by[0].finding == "sums.add-up");
  CHECK(only.decided_by[0].role == Role::supports);
  CHECK(only.decided_by[1].finding == "sums.overflow");
  CHECK(only.decided_by[1].role == Role::limits);
  CHECK(only.recorded == Ruling::conditional);
  CHECK(only.condition == "below {sums.overflow|bound}");
  CHECK(only.why == "They add up to {sums.add-up}.");
}

TEST_CASE("every role and every ruling is read by its name") {
  const std::string contradicted = with(claim, "\"limits\"", "\"contradicts\"");
  CHECK(read(paper + contradicted)[0].decided_by[1].role == Role::contradicts);
  const std::string plain = with(claim, "condition = \"below {sums.overflow|bound}\"\n", "");
  for (const Ruling ruling : {Ruling::confirmed, Ruling::refuted, Ruling::undecided}) {
    const std::string name(name_of(ruling));
    CHECK(read(paper + with(plain, "confirmed under a condition", name))[0].recorded == ruling);
  }
}

TEST_CASE("papers come in the order of their files' names, claims in that of their file") {
  const ScratchFolder folder;
  const auto id = [](const std::string& other) { return with(claim, "ABC-1", other); };
  std::ofstream(folder.file("b.toml")) << paper << id("B2") << id("B1");
  std::ofstream(folder.file("a.toml")) << with(paper, "ABC99", "A01") << id("A1");
  std::ofstream(folder.file("notes.md")) << "no claims";
  std::string ids;
  for (const Claim& one : read_claims(folder.file("."))) ids += one.paper + " " + one.id + ", ";
  CHECK(ids == "A01 A1, ABC99 B2, ABC99 B1, ");
}

TEST_CASE("an unknown key of a claim, of a decider or of a paper is refused") {
  rejected("section =", "chapter = \"2\"\nsection =", 9, "unknown key 'chapter'");
  rejected("{role =", "{weight = 3, role =", 18, "unknown key 'weight'");
  CHECK_THROWS_WITH(read(with(paper, "year", "pages = 9\nyear") + claim),
                    Contains("abc99.toml:5: unknown key 'pages'"));
  CHECK_THROWS_WITH(read("words = 3\n" + std::string(paper) + claim),
                    Contains("abc99.toml:1: unknown key 'words'"));
}

TEST_CASE("a claim without its place in the paper, or with half a formula, is refused") {
  rejected("paragraph = 3\n", "", 10, "'paragraph' and 'begins' belong together");
  rejected("paragraph = 3", "paragraph = 0", 10, "counted from 1");
  rejected("begins = \"Sums of all kinds\"\n", "", 10, "'paragraph' and 'begins' belong together");
  rejected("begins = \"Sums of all kinds\"", "begins = \" \"", 11, "'begins' is empty");
  rejected("restored = \"a + b\"\n", "", 12, "belong together");
  rejected("a + b", "a - b", 13, "'restored' is what is printed");
}

TEST_CASE("a claim may leave its paragraph out, and say what is missing in place of its findings") {
  std::string text = with(claim, "paragraph = 3\nbegins = \"Sums of all kinds\"\n", "");
  CHECK(read(paper + text)[0].cited.paragraph == 0);
  text = with(text, "condition = \"below {sums.overflow|bound}\"\n", "");
  text = with(text, "confirmed under a condition", "undecided");
  const std::string deciders =
      text.substr(text.find("decided_by"), text.find("recorded =") - text.find("decided_by"));
  const Claim open = read(paper + with(text, deciders, "missing = \"a sum\"\n"))[0];
  CHECK(open.missing == "a sum");
  CHECK(open.decided_by.empty());
  CHECK_THROWS_WITH(read(paper + with(text, deciders, deciders + "missing = \"a sum\"\n")),
                    Contains("not both"));
  rejected("recorded =", "missing = \"a sum\"\nrecorded =", 21, "'undecided' is not recorded");
}

TEST_CASE("an unknown role and an unknown ruling are refused, with those that are known") {
  rejected("\"limits\"", "\"limit\"", 19,
           "unknown role 'limit'; known: supports, limits, contradicts");
  rejected("confirmed under a condition", "conditional", 21,
           "unknown recorded 'conditional'; known: confirmed, confirmed under a condition, "
           "refuted, undecided");
}

TEST_CASE("a text of a claim that is missing or empty is refused") {
  rejected("id = \"ABC-1\"\n", "", 7, "needs the key 'id'");
  rejected("\"ABC-1\"", "\"\"", 8, "'id' is empty");
  rejected("\"2.4\"", "\" \"", 9, "'section' is empty");
  rejected("Sums add \\\nup.", "", 14, "'statement' is empty");
  rejected("\"sums.add-up\"", "\"\"", 18, "'finding' is empty");
  rejected("\"below {sums.overflow|bound}\"", "\"\"", 22, "'condition' is empty");
  rejected("\"They add up to {sums.add-up}.\"", "\"\"", 23, "'why' is empty");
}

TEST_CASE("a paper without its key, title, authors or year is refused") {
  CHECK_THROWS_WITH(read(claim), Contains("abc99.toml") && Contains("there is no [paper]"));
  CHECK_THROWS_WITH(read(paper), Contains("abc99.toml: there is no [[claim]]"));
  CHECK_THROWS_WITH(read(with(paper, "\"ABC99\"", "\"\"") + claim),
                    Contains("abc99.toml:2: 'key' is empty"));
  CHECK_THROWS_WITH(read(with(paper, "\"Sums\"", "\"\"") + claim),
                    Contains("abc99.toml:3: 'title' is empty"));
  CHECK_THROWS_WITH(read(with(paper, "\"A. Adder\", \"B. Bee\"", "") + claim),
                    Contains("abc99.toml:4: 'authors' is empty"));
  CHECK_THROWS_WITH(read(with(paper, "year = 1999\n", "") + claim),
                    Contains("abc99.toml:1: ") && Contains("needs the key 'year'"));
}

TEST_CASE("a condition is given if and only if the recorded ruling is conditional") {
  rejected("condition = \"below {sums.overflow|bound}\"\n", "", 21, "needs the key 'condition'");
  rejected("confirmed under a condition", "confirmed", 22, "is not recorded");
}

TEST_CASE("a claim that nothing decides, or that names a finding twice, is refused") {
  const std::string deciders =
      with(claim, "  {role = \"supports\", finding = \"sums.add-up\"},\n", "");
  CHECK_THROWS_WITH(
      read(paper + with(deciders, "  {role = \"limits\", finding = \"sums.overflow\"},\n", "")),
      Contains("abc99.toml:17: no finding decides this claim"));
  rejected("\"sums.overflow\"}", "\"sums.add-up\"}", 19,
           "the finding 'sums.add-up' is named twice");
}

TEST_CASE(
    "an id that is taken, in the same file or in another, and one that is no name are refused") {
  CHECK_THROWS_WITH(
      read(std::string(paper) + claim + claim),
      Contains("abc99.toml:26: the id 'ABC-1' is taken at ") && Contains("abc99.toml:8"));
  const ScratchFolder folder;
  for (const char* file : {"a.toml", "b.toml"}) std::ofstream(folder.file(file)) << paper << claim;
  CHECK_THROWS_WITH(read_claims(folder.file(".")),
                    Contains("b.toml:8: the id 'ABC-1' is taken at ") && Contains("a.toml:8"));
  rejected("ABC-1", "ABC/1", 8, "the id 'ABC/1'");
}

TEST_CASE("a placeholder whose brace is not closed is refused when claims are read") {
  rejected("{sums.add-up}.", "{sums.add-up.", 23, "the brace is not closed");
  rejected("|bound}", "|bound", 22, "the brace is not closed");
}

TEST_CASE("a folder without claims is refused by its name") {
  const ScratchFolder folder;
  CHECK_THROWS_WITH(read_claims(folder.file("none")), Contains("none: there are no claims"));
}
