// Keys of a TOML file, each with the place it was read; an unused key is an error.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "reference/types.h"

namespace foldproof {

class KeyTable;

struct KeyValue {
  std::variant<bool, long, double, std::string, std::vector<KeyValue>, std::shared_ptr<KeyTable>>
      data;
  std::string where;  // "file:line", or "--set KEY=VALUE"
};

/// One table of keys. Every reader throws InputError "file:line: ..." for a missing key, a wrong
/// type or a number that is not finite.
class KeyTable {
 public:
  KeyTable(std::string name, std::string where)
      : name_(std::move(name)), where_(std::move(where)) {}

  bool has(const std::string& key) const;  // this marks the key as known
  double number(const std::string& key) const;
  double number_or(const std::string& key, double fallback) const;
  long integer(const std::string& key) const;
  long integer_or(const std::string& key, long fallback) const;
  bool flag_or(const std::string& key, bool fallback) const;
  std::string text(const std::string& key) const;
  std::string text_or(const std::string& key, const std::string& fallback) const;
  bool is_text(const std::string& key) const;
  bool is_list(const std::string& key) const;
  Vector3 vector(const std::string& key) const;
  Vector3 vector_or(const std::string& key, const Vector3& fallback) const;
  std::vector<long> integers(const std::string& key) const;
  std::vector<std::string> texts(const std::string& key) const;
  std::vector<Vector3> vectors(const std::string& key) const;

  /// The table under the key; nullptr if there is none.
  std::shared_ptr<KeyTable> table(const std::string& key) const;
  /// The tables of [[key]]; empty if there is none.
  std::vector<std::shared_ptr<KeyTable>> tables(const std::string& key) const;

  /// Leaves the key to another reader: it counts as known, and reject_unused does not search it.
  void leave(const std::string& key) const;

  /// "file:line" of the key, or of the table if it lacks the key.
  std::string where(const std::string& key) const;
  const std::string& where() const { return where_; }

  /// Throws InputError for the first unused key, here or below, and lists the known ones.
  void reject_unused() const;

  std::map<std::string, KeyValue> entries;
  std::map<std::string, KeyValue> replaced;  // values from the file for keys that set_key replaced

 private:
  const KeyValue& require_key(const std::string& key) const;
  [[noreturn]] void wrong_type(const std::string& key, const std::string& wanted) const;

  std::string name_, where_;
  mutable std::set<std::string> requested_, left_;
};

/// Parses TOML text; `file` names it in messages. Throws InputError "file:line: ..." for a syntax
/// error, for tables and lists nested more than 32 deep, and, outside of quotes and comments, for a
/// line with more than 200 dots, and for a character outside ASCII.
std::shared_ptr<KeyTable> parse_keys(const std::string& text, const std::string& file);

/// Whether a value's place is an override on the command line, not a line of a file.
bool is_override(const std::string& where);

/// Overrides "a.b.c=value" (value as in TOML, or a number as in ".5", or else text; a number in the
/// path picks an entry of a list, and a single entry needs none). Missing tables are created.
/// "a.b.c=" unsets the key. Throws InputError for an override without '=', a path through a value,
/// or no key to unset.
void set_key(KeyTable& root, const std::string& assignment);

/// The whole file. Throws InputError if it cannot be read, is empty, or is longer than
/// case_text_limits (mesh/text_file.h).
std::string read_text(const std::string& path);

}  // namespace foldproof
