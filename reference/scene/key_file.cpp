#include "reference/scene/key_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>

#include "reference/mesh/text_file.h"

namespace foldproof {

namespace {

constexpr int most_nested = 32;  // nested tables and lists
constexpr int most_dots = 200;   // per line

std::string place(const std::string& file, const toml::source_region& source) {
  return source.begin.line == 0 || file.starts_with("--")
             ? file
             : file + ":" + std::to_string(source.begin.line);
}

/// The value being converted: its full name, its file, and its nesting depth.
struct Place {
  std::string name;
  const std::string& file;
  int depth = 0;
};

std::shared_ptr<KeyTable> convert(const toml::table& table, const Place& at);

KeyValue convert(const toml::node& node, const Place& at) {
  const std::string &name = at.name, where = place(at.file, node.source());
  if (at.depth > most_nested)
    throw InputError(where + ": tables and lists in more than " + std::to_string(most_nested) +
                     " others");
  if (const auto* value = node.as_boolean()) return {value->get(), where};
  if (const auto* value = node.as_integer()) return {long(value->get()), where};
  if (const auto* value = node.as_floating_point()) return {value->get(), where};
  if (const auto* value = node.as_string()) return {value->get(), where};
  if (const auto* value = node.as_table()) return {convert(*value, at), where};
  if (const auto* list = node.as_array()) {
    std::vector<KeyValue> values;
    for (const toml::node& entry : *list)
      values.push_back(convert(entry, {name, at.file, at.depth + 1}));
    return {values, where};
  }
  throw InputError(where + ": '" + name + "' is a date or time, which no key takes");
}

std::shared_ptr<KeyTable> convert(const toml::table& table, const Place& at) {
  const auto& [name, file, depth] = at;
  auto result = std::make_shared<KeyTable>(name, place(file, table.source()));
  for (const auto& [key, node] : table) {
    const std::string full = name.empty() ? std::string(key) : name + "." + std::string(key);
    KeyValue value = convert(node, {full, file, depth + 1});
    value.where =
        file.starts_with("--") ? file : file + ":" + std::to_string(key.source().begin.line);
    result->entries.emplace(std::string(key), std::move(value));
  }
  return result;
}

std::optional<double> as_number(const KeyValue& value) {
  if (const auto* integer = std::get_if<long>(&value.data)) return double(*integer);
  const auto* number = std::get_if<double>(&value.data);
  return number && std::isfinite(*number) ? std::optional(*number) : std::nullopt;
}

bool as_vector(const KeyValue& value, Vector3& result) {
  const auto* list = std::get_if<std::vector<KeyValue>>(&value.data);
  if (!list || list->size() != 3) return false;
  for (int k = 0; k < 3; ++k) {
    const std::optional<double> number = as_number((*list)[size_t(k)]);
    if (!number) return false;
    result[k] = *number;
  }
  return true;
}

}  // namespace

bool KeyTable::has(const std::string& key) const {
  requested_.insert(key);
  return entries.contains(key);
}

const KeyValue& KeyTable::require_key(const std::string& key) const {
  if (!has(key))
    throw InputError(where_ + ": " + (name_.empty() ? "the file" : "[" + name_ + "]") +
                     " needs the key '" + key + "'");
  return entries.at(key);
}

void KeyTable::wrong_type(const std::string& key, const std::string& wanted) const {
  throw InputError(where(key) + ": '" + key + "'" + (name_.empty() ? "" : " in [" + name_ + "]") +
                   " must be " + wanted);
}

std::string KeyTable::where(const std::string& key) const {
  const auto entry = entries.find(key);
  return entry == entries.end() ? where_ : entry->second.where;
}

double KeyTable::number(const std::string& key) const {
  const std::optional<double> number = as_number(require_key(key));
  if (!number) wrong_type(key, "a finite number");
  return *number;
}

double KeyTable::number_or(const std::string& key, double fallback) const {
  return has(key) ? number(key) : fallback;
}

long KeyTable::integer(const std::string& key) const {
  const auto* value = std::get_if<long>(&require_key(key).data);
  if (!value) wrong_type(key, "a whole number");
  return *value;
}

long KeyTable::integer_or(const std::string& key, long fallback) const {
  return has(key) ? integer(key) : fallback;
}

bool KeyTable::flag_or(const std::string& key, bool fallback) const {
  if (!has(key)) return fallback;
  const auto* value = std::get_if<bool>(&require_key(key).data);
  if (!value) wrong_type(key, "true or false");
  return *value;
}

std::string KeyTable::text(const std::string& key) const {
  const auto* value = std::get_if<std::string>(&require_key(key).data);
  if (!value) wrong_type(key, "a text in quotes");
  return *value;
}

std::string KeyTable::text_or(const std::string& key, const std::string& fallback) const {
  return has(key) ? text(key) : fallback;
}

bool KeyTable::is_text(const std::string& key) const {
  return has(key) && std::holds_alternative<std::string>(entries.at(key).data);
}

bool KeyTable::is_list(const std::string& key) const {
  return has(key) && std::holds_alternative<std::vector<KeyValue>>(entries.at(key).data);
}

Vector3 KeyTable::vector(const std::string& key) const {
  Vector3 result;
  if (!as_vector(require_key(key), result)) wrong_type(key, "three numbers [x, y, z]");
  return result;
}

Vector3 KeyTable::vector_or(const std::string& key, const Vector3& fallback) const {
  return has(key) ? vector(key) : fallback;
}

std::vector<long> KeyTable::integers(const std::string& key) const {
  const auto* list = std::get_if<std::vector<KeyValue>>(&require_key(key).data);
  if (!list) wrong_type(key, "a list of whole numbers");
  std::vector<long> result;
  for (const KeyValue& entry : *list) {
    const auto* value = std::get_if<long>(&entry.data);
    if (!value) wrong_type(key, "a list of whole numbers");
    result.push_back(*value);
  }
  return result;
}

std::vector<std::string> KeyTable::texts(const std::string& key) const {
  const auto* list = std::get_if<std::vector<KeyValue>>(&require_key(key).data);
  if (!list) wrong_type(key, "a list of texts");
  std::vector<std::string> result;
  for (const KeyValue& entry : *list) {
    const auto* value = std::get_if<std::string>(&entry.data);
    if (!value) wrong_type(key, "a list of texts");
    result.push_back(*value);
  }
  return result;
}

std::vector<Vector3> KeyTable::vectors(const std::string& key) const {
  const auto* list = std::get_if<std::vector<KeyValue>>(&require_key(key).data);
  if (!list) wrong_type(key, "a list of points [[x, y, z], ...]");
  std::vector<Vector3> result(list->size());
  for (size_t k = 0; k < list->size(); ++k)
    if (!as_vector((*list)[k], result[k])) wrong_type(key, "a list of points [[x, y, z], ...]");
  return result;
}

std::shared_ptr<KeyTable> KeyTable::table(const std::string& key) const {
  if (!has(key)) return nullptr;
  const auto* value = std::get_if<std::shared_ptr<KeyTable>>(&entries.at(key).data);
  if (!value) wrong_type(key, "a table");
  return *value;
}

std::vector<std::shared_ptr<KeyTable>> KeyTable::tables(const std::string& key) const {
  std::vector<std::shared_ptr<KeyTable>> result;
  if (!has(key)) return result;
  const auto* list = std::get_if<std::vector<KeyValue>>(&entries.at(key).data);
  if (!list) wrong_type(key, "a list of tables, [[" + key + "]]");
  for (const KeyValue& entry : *list) {
    const auto* value = std::get_if<std::shared_ptr<KeyTable>>(&entry.data);
    if (!value) wrong_type(key, "a list of tables, [[" + key + "]]");
    result.push_back(*value);
  }
  return result;
}

void KeyTable::leave(const std::string& key) const {
  requested_.insert(key);
  left_.insert(key);
}

void KeyTable::reject_unused() const {
  std::string known;
  for (const std::string& key : requested_) known += (known.empty() ? "" : ", ") + key;
  for (const auto& [key, value] : entries) {
    if (!requested_.contains(key))
      throw InputError(value.where + ": unknown key '" + key + "' in " +
                       (name_.empty() ? "the file" : "[" + name_ + "]") + "; known here: " + known);
    if (left_.contains(key)) continue;
    if (const auto* below = std::get_if<std::shared_ptr<KeyTable>>(&value.data))
      (*below)->reject_unused();
    if (const auto* list = std::get_if<std::vector<KeyValue>>(&value.data))
      for (const KeyValue& entry : *list)
        if (const auto* below = std::get_if<std::shared_ptr<KeyTable>>(&entry.data))
          (*below)->reject_unused();
  }
}

namespace {

/// The position after the quoted text that begins at `at`; if the quotes do not close, the end of
/// the line or file.
size_t behind_quotes(std::string_view text, size_t at) {
  const std::string one(1, text[at]), three(3, text[at]);
  const bool has_escapes = text[at] == '"', is_long = text.substr(at).starts_with(three);
  const std::string& end = is_long ? three : one;
  at += end.size();
  while (at < text.size() && !text.substr(at).starts_with(end)) {
    if (text[at] == '\n' && !is_long) return at;
    at += has_escapes && text[at] == '\\' ? 2 : 1;
  }
  return std::min(at + end.size(), text.size());
}

struct Unbearable {
  int line;
  std::string why;
};

/// Finds input that would break the parser, outside comments and quoted strings. Each dot of a key
/// nests a table, and the parser's stack with it, so the dots of a line are limited, of any
/// meaning. Where toml++ 3.3 expects blanks, and in keys, non-ASCII letters lead it to unreachable
/// code.
std::optional<Unbearable> unbearable(std::string_view text) {
  int line = 1, dots = 0;
  // the mark that some editors put before UTF-8
  size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  while (at < text.size()) {
    const size_t start = at;
    const char c = text[at];
    const bool may_begin = start == 0 || std::string_view(" \t\r\n=,.[{").find(text[start - 1]) !=
                                             std::string_view::npos;
    if ((c == '"' || c == '\'') && may_begin) at = behind_quotes(text, at);
    if (c == '#') at = std::min(text.find('\n', at), text.size());
    if (at == start) ++at;
    if (static_cast<unsigned char>(c) > 127)
      return Unbearable{line, "a character outside ASCII; put texts into quotes"};
    if (c == '.' && ++dots > most_dots)
      return Unbearable{line, "more than " + std::to_string(most_dots) + " dots; break the line"};
    if (c == '\n') dots = 0;
    line += int(std::count(text.begin() + long(start), text.begin() + long(at), '\n'));
  }
  return {};
}

/// First parses without non-ASCII letters: valid files have them only in comments and strings,
/// which the parser accepts, but not while it composes an error message.
toml::table parse_toml(const std::string& text, const std::string& file) {
  std::string plain = text;
  const auto mark = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  std::replace_if(
      plain.begin() + mark, plain.end(), [](char c) { return static_cast<unsigned char>(c) > 127; },
      'x');
  if (plain != text) static_cast<void>(toml::parse(plain, file));
  return toml::parse(text, file);
}

}  // namespace

std::shared_ptr<KeyTable> parse_keys(const std::string& text, const std::string& file) {
  if (const auto found = unbearable(text))
    throw InputError(file + ":" + std::to_string(found->line) + ": " + found->why);
  try {
    return convert(parse_toml(text, file), Place{"", file});
  } catch (const toml::parse_error& error) {
    throw InputError(place(file, error.source()) + ": " + std::string(error.description()));
  }
}

namespace {

/// A value as in TOML; else a number as people type it (".5", "2."); else text.
KeyValue parsed_value(const std::string& text, const std::string& where) {
  if (unbearable(text)) return {text, where};
  try {
    return convert(*parse_toml("value = " + text, where).get("value"), Place{"value", where});
  } catch (const toml::parse_error&) {
    const char* const end = text.data() + text.size();
    double number = 0;
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    if (error == std::errc() && stop == end && std::isfinite(number)) return {number, where};
    return {text, where};
  }
}

KeyTable& table_below(KeyTable& table, const std::string& step, const std::string& assignment) {
  const std::string where = "--set " + assignment;
  auto [entry, is_new] =
      table.entries.try_emplace(step, KeyValue{std::make_shared<KeyTable>(step, where), where});
  KeyValue* value = &entry->second;
  if (auto* list = std::get_if<std::vector<KeyValue>>(&value->data); list && list->size() == 1)
    value = &list->front();  // a list with one entry needs no number
  auto* below = std::get_if<std::shared_ptr<KeyTable>>(&value->data);
  if (!below) throw InputError(where + ": '" + step + "' is not a table");
  return **below;
}

KeyTable& list_entry(KeyTable& table, const std::string& step, const std::string& number,
                     const std::string& assignment) {
  const auto entry = table.entries.find(step);
  auto* list = entry == table.entries.end()
                   ? nullptr
                   : std::get_if<std::vector<KeyValue>>(&entry->second.data);
  const size_t index = std::stoul(number);
  if (!list || index >= list->size())
    throw InputError("--set " + assignment + ": there is no " + step + "." + number);
  auto* below = std::get_if<std::shared_ptr<KeyTable>>(&(*list)[index].data);
  if (!below)
    throw InputError("--set " + assignment + ": " + step + "." + number + " is not a table");
  return **below;
}

bool is_number(const std::string& text) {
  return !text.empty() && text.size() < 10 &&
         text.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

bool is_override(const std::string& where) { return where.starts_with("--set "); }

void set_key(KeyTable& root, const std::string& assignment) {
  const size_t equals = assignment.find('=');
  std::vector<std::string> path;
  std::istringstream steps(assignment.substr(0, equals));
  for (std::string step; std::getline(steps, step, '.');) path.push_back(step);
  if (equals == std::string::npos || path.empty())
    throw InputError("--set " + assignment + ": write table.key=value");
  if (path.size() > size_t(most_nested))
    throw InputError("--set " + assignment + ": a key in more than " + std::to_string(most_nested) +
                     " tables");

  KeyTable* table = &root;
  for (size_t k = 0; k + 1 < path.size(); ++k) {
    const bool picks = k + 2 < path.size() && is_number(path[k + 1]);
    table = picks ? &list_entry(*table, path[k], path[k + 1], assignment)
                  : &table_below(*table, path[k], assignment);
    if (picks) ++k;
  }
  const auto written = table->entries.find(path.back());
  if (written != table->entries.end() && !is_override(written->second.where))
    table->replaced.insert(*written);
  if (equals + 1 == assignment.size()) {
    if (written == table->entries.end())
      throw InputError("--set " + assignment + ": there is no key '" + path.back() + "' to unset");
    table->entries.erase(written);
    return;
  }
  table->entries.insert_or_assign(
      path.back(), parsed_value(assignment.substr(equals + 1), "--set " + assignment));
}

std::string read_text(const std::string& path) {
  const std::string text = plain_text(read_text_file(path, case_text_limits), path);
  if (text.empty()) throw InputError(path + ": cannot be read, or is empty");
  return text;
}

}  // namespace foldproof
