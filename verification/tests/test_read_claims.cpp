// The reader of claims: what it returns, and what it refuses with the place of it.
#include <catch2/catch.hpp>

#include "reference/types.h"
#include "verification/claims/read_claims.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

/// A paper, and its claim in lines 7 to 23.
const std::string paper_and_claim = R"([paper]
key = "ABC99"
title = "Sums"
authors = ["A. Adder", "B. Bee"]
year = 1999

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
  REQUIRE(text.find(part) != std::string::npos);
  return text.replace(text.find(part), part.size(), other);
}

std::vector<Claim> read(const std::string& text) {
  const ScratchFolder folder;
  folder.write("abc99.toml", text);
  return read_claims(folder.file("."));
}

/// The claims with one part replaced are refused at this line, with these words.
void rejected(const std::string& part, const std::string& other, int line,
              const std::string& words) {
  INFO(part << " -> " << other);
  CHECK_THROWS_WITH(read(with(paper_and_claim, part, other)),
                    Contains("abc99.toml:" + std::to_string(line) + ": ") && Contains(words));
}

const std::string condition = "condition = \"below {sums.overflow|bound}\"\n",
                  paragraph = "paragraph = 3\n", begins = "begins = \"Sums of all kinds\"\n";

}  // namespace

TEST_CASE("a claim is read with its paper, its joined lines and its deciders in their order") {
  const Claim only = read(paper_and_claim).at(0);
  CHECK(std::vector<std::string>{only.paper, only.id, only.section, only.cited.begins,
                                 only.cited.printed, only.cited.restored, only.statement,
                                 only.condition, only.why} ==
        std::vector<std::string>{"ABC99", "ABC-1", "2.4", "Sums of all kinds", "a - b", "a + b",
                                 "Sums add up.", "below {sums.overflow|bound}",
                                 "They add up to {sums.add-up}."});
  CHECK(only.cited.paragraph == 3);
  REQUIRE(only.decided_by.size() == 2);
  CHECK(only.decided_by[0].finding == "sums.add-up");
  CHECK(only.decided_by[0].role == Role::supports);
  CHECK(only.decided_by[1].finding == "sums.overflow");
  CHECK(only.decided_by[1].role == Role::limits);
  CHECK(only.recorded == Ruling::conditional);
  const std::string contradicted = with(paper_and_claim, "\"limits\"", "\"contradicts\"");
  CHECK(read(contradicted)[0].decided_by[1].role == Role::contradicts);
  const std::string alone = R"("sums.add-up")";
  const std::string as_name =
      with(paper_and_claim, "{role = \"supports\", finding = " + alone + "}", alone);
  CHECK(read(as_name)[0].decided_by[0].role == Role::supports);
  for (const Ruling ruling : {Ruling::confirmed, Ruling::refuted, Ruling::undecided})
    CHECK(read(with(with(paper_and_claim, condition, ""), "confirmed under a condition",
                    std::string(name_of(ruling))))[0]
              .recorded == ruling);
}

TEST_CASE("an unknown key of a claim, of a decider or of a paper is refused") {
  rejected("section =", "chapter = \"2\"\nsection =", 9, "unknown key 'chapter'");
  rejected("{role =", "{weight = 3, role =", 18, "unknown key 'weight'");
  rejected("year", "pages = 9\nyear", 5, "unknown key 'pages'");
  rejected("[paper]", "words = 3\n[paper]", 1, "unknown key 'words'");
}

TEST_CASE("a claim without its place in the paper, or with half a formula, is refused") {
  rejected(paragraph, "", 10, "'paragraph' and 'begins' belong together");
  rejected("paragraph = 3", "paragraph = 0", 10, "counted from 1");
  rejected(begins, "", 10, "'paragraph' and 'begins' belong together");
  rejected("restored = \"a + b\"\n", "", 12, "belong together");
  rejected("a + b", "a - b", 13, "'restored' is what is printed");
}

TEST_CASE("a claim may leave its paragraph out, and say what is missing in place of its findings") {
  std::string text = with(paper_and_claim, paragraph + begins, "");
  CHECK(read(text)[0].cited.paragraph == 0);
  text = with(with(text, condition, ""), "confirmed under a condition", "undecided");
  const size_t from = text.find("decided_by");
  const std::string deciders = text.substr(from, text.find("recorded =") - from);
  const Claim open = read(with(text, deciders, "missing = \"a sum\"\n"))[0];
  CHECK(open.missing == "a sum");
  CHECK(open.decided_by.empty());
  CHECK_THROWS_WITH(read(with(text, deciders, deciders + "missing = \"a sum\"\n")),
                    Contains("not both"));
  rejected("recorded =", "missing = \"a sum\"\nrecorded =", 21, "'undecided' is not recorded");
}

TEST_CASE("what a claim or a paper lacks, or says with an unknown or an empty word, is refused") {
  rejected("\"limits\"", "\"limit\"", 19, "'limit'; known: supports, limits, contradicts");
  rejected("confirmed under a condition", "conditional", 21, "unknown recorded 'conditional'");
  rejected("id = \"ABC-1\"\n", "", 7, "needs the key 'id'");
  rejected("ABC-1", "ABC/1", 8, "the id 'ABC/1'");
  rejected("Sums of all kinds", " ", 11, "'begins' is empty");
  rejected("Sums add \\\nup.", "", 14, "'statement' is empty");
  rejected("\"sums.add-up\"", "\"\"", 18, "'finding' is empty");
  rejected("They add up to {sums.add-up}.", "", 23, "'why' is empty");
  rejected("{sums.add-up}.", "{sums.add-up.", 23, "the brace is not closed");
  rejected("|bound}", "|bound", 22, "the brace is not closed");
  rejected("ABC99", "", 2, "'key' is empty");
  rejected("\"A. Adder\", \"B. Bee\"", "", 4, "'authors' is empty");
  rejected("year = 1999\n", "", 1, "needs the key 'year'");
}

TEST_CASE("a condition is given if and only if the recorded ruling is conditional") {
  rejected(condition, "", 21, "needs the key 'condition'");
  rejected("confirmed under a condition", "confirmed", 22, "is not recorded");
}

TEST_CASE("a claim that nothing decides, or that names a finding twice, is refused") {
  rejected(
      "  {role = \"supports\", finding = \"sums.add-up\"},\n"
      "  {role = \"limits\", finding = \"sums.overflow\"},\n",
      "", 17, "no finding decides this claim");
  rejected("\"sums.overflow\"}", "\"sums.add-up\"}", 19, "'sums.add-up' is named twice");
}

TEST_CASE("files are read in the order of their names, and an id that is taken is refused") {
  const ScratchFolder folder;
  folder.write("b.toml", paper_and_claim);
  folder.write("a.toml", with(with(paper_and_claim, "ABC99", "A01"), "ABC-1", "A1"));
  CHECK(read_claims(folder.file(".")).at(0).paper == "A01");
  folder.write("a.toml", paper_and_claim);
  CHECK_THROWS_WITH(read_claims(folder.file(".")),
                    Contains("b.toml:8: the id 'ABC-1' is taken at ") && Contains("a.toml:8"));
  CHECK_THROWS_WITH(read_claims(folder.file("none")), Contains("none: there are no claims"));
}
