#include "verification/claims/read_claims.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <initializer_list>
#include <map>

#include "reference/scene/key_file.h"

namespace foldproof {

namespace {

std::string written_text(const KeyTable& keys, const std::string& key) {
  const std::string text = keys.text(key);
  if (text.find_first_not_of(" \n") == std::string::npos)
    throw InputError(keys.where(key) + ": '" + key + "' is empty");
  return text;
}

/// A text with placeholders, see `fill_placeholders`.
std::string text_with_numbers(const KeyTable& keys, const std::string& key) {
  const std::string text = written_text(keys, key);
  try {
    findings_in_text(text);
  } catch (const std::runtime_error& error) {
    throw InputError(keys.where(key) + ": " + error.what());
  }
  return text;
}

/// The word whose name the key holds.
template <class Word>
Word word_of(const KeyTable& keys, const std::string& key, std::initializer_list<Word> words) {
  const std::string wanted = keys.text(key);
  std::string known;
  for (const Word word : words) {
    if (wanted == name_of(word)) return word;
    known += (known.empty() ? "" : ", ") + std::string(name_of(word));
  }
  throw InputError(keys.where(key) + ": unknown " + key + " '" + wanted + "'; known: " + known);
}

/// Part of the name of a finding, claim.ID, and of a group in run.h5.
std::string id_of(const KeyTable& row) {
  const std::string id = written_text(row, "id");
  const auto is_allowed = [](unsigned char c) { return std::isalnum(c) || c == '-'; };
  if (!std::ranges::all_of(id, is_allowed))
    throw InputError(row.where("id") + ": the id '" + id +
                     "' may have letters, digits and '-' only");
  return id;
}

struct Paper {
  std::string key;    // by which claims are cited
  std::string title;  // with its year
};

/// Checks [paper].
Paper paper_of(const KeyTable& root) {
  const auto paper = root.table("paper");
  if (!paper) throw InputError(root.where() + ": there is no [paper]");
  const std::string title = written_text(*paper, "title");
  if (paper->texts("authors").empty())
    throw InputError(paper->where("authors") + ": 'authors' is empty");
  const int year = paper->integer("year");
  return {written_text(*paper, "key"), title + " (" + std::to_string(year) + ")"};
}

/// The tables of `decided_by`; a name alone is that of a finding that supports the claim.
std::vector<std::shared_ptr<KeyTable>> rows_of_deciders(const KeyTable& row) {
  if (!row.is_list("decided_by")) return row.tables("decided_by");
  std::vector<std::shared_ptr<KeyTable>> rows;
  for (const KeyValue& value : std::get<std::vector<KeyValue>>(row.entries.at("decided_by").data))
    if (const auto* table = std::get_if<std::shared_ptr<KeyTable>>(&value.data)) {
      rows.push_back(*table);
    } else {
      rows.push_back(std::make_shared<KeyTable>("decided_by", value.where));
      rows.back()->entries = {{"finding", value}, {"role", {"supports", value.where}}};
    }
  return rows;
}

std::vector<Decider> deciders_of(const KeyTable& row) {
  std::vector<Decider> deciders;
  if (row.has("missing") && !row.has("decided_by")) return deciders;
  for (const auto& entry : rows_of_deciders(row)) {
    const std::string tier = entry->has("tier") ? entry->text("tier") : "every";
    if (tier != "every" && tier != "full")
      throw InputError(entry->where("tier") + ": unknown tier '" + tier + "'; known: every, full");
    const Role role = word_of(*entry, "role", {Role::supports, Role::limits, Role::contradicts});
    for (const std::string& finding : choices_of(written_text(*entry, "finding"))) {
      if (std::ranges::find(deciders, finding, &Decider::finding) != deciders.end())
        throw InputError(entry->where("finding") + ": the finding '" + finding +
                         "' is named twice");
      deciders.push_back({finding, role, tier == "full"});
    }
  }
  if (deciders.empty())
    throw InputError(row.where("decided_by") + ": no finding decides this claim");
  return deciders;
}

/// Empty for a claim that findings decide.
std::string missing_for(const KeyTable& row, Ruling recorded) {
  if (!row.has("missing")) return "";
  if (recorded != Ruling::undecided)
    throw InputError(row.where("missing") + ": something is missing, but '" +
                     std::string(name_of(Ruling::undecided)) + "' is not recorded");
  if (row.has("decided_by"))
    throw InputError(row.where("missing") +
                     ": a claim has findings that decide it or says what is missing, not both");
  return written_text(row, "missing");
}

/// Empty for a claim that is not recorded as conditional.
std::string condition_of(const KeyTable& row, Ruling recorded) {
  const std::string conditional(name_of(Ruling::conditional));
  if (recorded == Ruling::conditional) {
    if (!row.has("condition"))
      throw InputError(row.where("recorded") + ": '" + conditional + "' needs the key 'condition'");
    return text_with_numbers(row, "condition");
  }
  if (row.has("condition"))
    throw InputError(row.where("condition") + ": a condition is given, but '" + conditional +
                     "' is not recorded");
  return "";
}

Citation citation_of(const KeyTable& row) {
  Citation cited;
  if (row.has("paragraph") != row.has("begins"))
    throw InputError(row.where(row.has("begins") ? "begins" : "paragraph") +
                     ": 'paragraph' and 'begins' belong together; only one is given");
  if (row.has("begins")) {
    cited.paragraph = row.integer("paragraph");
    if (cited.paragraph < 1)
      throw InputError(row.where("paragraph") + ": 'paragraph' is counted from 1");
    cited.begins = written_text(row, "begins");
  }
  if (row.has("printed") != row.has("restored"))
    throw InputError(row.where(row.has("printed") ? "printed" : "restored") +
                     ": 'printed' and 'restored' belong together; only one is given");
  if (row.has("printed")) {
    cited.printed = written_text(row, "printed");
    cited.restored = written_text(row, "restored");
    if (cited.printed == cited.restored)
      throw InputError(row.where("restored") + ": 'restored' is what is printed; leave both out");
  }
  return cited;
}

Claim claim_of(const KeyTable& row, const Paper& paper) {
  Claim claim{paper.key,
              id_of(row),
              written_text(row, "section"),
              written_text(row, "statement"),
              deciders_of(row),
              word_of(row, "recorded",
                      {Ruling::confirmed, Ruling::conditional, Ruling::refuted, Ruling::undecided}),
              "",
              text_with_numbers(row, "why")};
  claim.condition = condition_of(row, claim.recorded);
  claim.cited = citation_of(row);
  claim.missing = missing_for(row, claim.recorded);
  claim.paper_title = paper.title;
  return claim;
}

}  // namespace

std::vector<std::string> choices_of(const std::string& name) {
  const size_t from = name.find('{'), to = name.find('}', from);
  if (to == std::string::npos) return {name};
  std::vector<std::string> names;
  for (size_t at = from + 1; at <= to; at = std::min(name.find(',', at), to) + 1)
    for (const std::string& rest : choices_of(name.substr(to + 1)))
      names.push_back(name.substr(0, from) + name.substr(at, name.find_first_of(",}", at) - at) +
                      rest);
  return names;
}

std::vector<Claim> read_claims(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  if (paths.empty()) throw InputError(folder + ": there are no claims, PAPER.toml");
  std::sort(paths.begin(), paths.end());

  std::vector<Claim> claims;
  std::map<std::string, std::string> places;  // of each id
  for (const std::filesystem::path& path : paths) {
    const auto root = parse_keys(read_text(path.string()), path.string());
    const Paper paper = paper_of(*root);
    const auto rows = root->tables("claim");
    if (rows.empty()) throw InputError(path.string() + ": there is no [[claim]]");
    for (const auto& row : rows) {
      claims.push_back(claim_of(*row, paper));
      const auto [first, is_new] = places.try_emplace(claims.back().id, row->where("id"));
      if (!is_new)
        throw InputError(row->where("id") + ": the id '" + claims.back().id + "' is taken at " +
                         first->second);
    }
    root->reject_unused();
  }
  return claims;
}

}  // namespace foldproof
