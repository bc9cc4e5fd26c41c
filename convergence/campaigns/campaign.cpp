#include "convergence/campaigns/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "convergence/campaigns/sample.h"

namespace foldproof {

namespace {

/// A text that would be read as something else after --set, or in a list, needs quotes.
bool needs_quotes(const std::string& text) {
  return text.empty() || text == "true" || text == "false" || text == "inf" || text == "nan" ||
         std::string("+-0123456789[{\"'").find(text[0]) != std::string::npos;
}

/// A basic string of TOML: line breaks and other control characters by their numbers.
std::string in_quotes(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c >= 0 && c < ' ') {
      quoted += fmt::format("\\u{:04x}", int(c));
      continue;
    }
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

std::string toml_of(const KeyValue& value) {
  if (const auto* text = std::get_if<std::string>(&value.data)) return in_quotes(*text);
  if (const auto* list = std::get_if<std::vector<KeyValue>>(&value.data)) {
    std::vector<std::string> parts;
    for (const KeyValue& entry : *list) parts.push_back(toml_of(entry));
    return fmt::format("[{}]", fmt::join(parts, ", "));
  }
  if (const auto* table = std::get_if<std::shared_ptr<KeyTable>>(&value.data)) {
    std::vector<std::string> parts;
    for (const auto& [key, entry] : (*table)->entries)
      parts.push_back(in_quotes(key) + " = " + toml_of(entry));
    return fmt::format("{{ {} }}", fmt::join(parts, ", "));
  }
  return text_of(value);
}

/// The surroundings of a block: its file, its command, its limit.
struct Reading {
  std::string folder;  // of the campaign's file
  std::string run;     // the command
  size_t most_jobs;

  /// Whether a parameter is read as TOML, after --set; else it is a word of the command line.
  bool is_key_of_case(const std::string& parameter) const {
    if (run == "simulate") return parameter != "case";
    return parameter.find('.') != std::string::npos && !parameter.starts_with("settings.");
  }

  std::string text(const std::string& parameter, const KeyValue& value) const {
    const auto* word = std::get_if<std::string>(&value.data);
    return word && !is_key_of_case(parameter) ? *word : text_of(value);
  }
};

/// The names in all TOML files of a folder, in the order of the files' names: of the tables
/// [fault.NAME], say, or the `name` in each [[fault]].
std::vector<std::string> names_in_files(const KeyTable& asked, const std::string& folder) {
  namespace fs = std::filesystem;
  const std::string below = folder + "/" + asked.text("folder"), every = asked.text("every");
  std::error_code none;
  std::set<std::string> files;
  for (const auto& entry : fs::directory_iterator(below, none))
    if (entry.path().extension() == ".toml") files.insert(entry.path().string());
  if (none) throw InputError(asked.where("folder") + ": there is no folder " + below);
  std::vector<std::string> names;
  for (const std::string& file : files) {
    const auto root = parse_keys(read_text(file), file);
    if (!root->is_list(every) && root->has(every))
      for (const auto& [name, table] : root->table(every)->entries) names.push_back(name);
    else
      for (const auto& table : root->tables(every))
        names.push_back(text_of(table->entries.at("name")));
  }
  return names;
}

void require_few(double jobs, const KeyTable& keys, size_t most_jobs) {
  if (!(jobs <= double(most_jobs)))
    throw InputError(
        fmt::format("{}: {:.3g} jobs; a campaign has at most {}", keys.where(), jobs, most_jobs));
}

/// The values of one parameter: a list, { from, to, count, spacing } or { folder, every }.
std::vector<std::string> values_of(const KeyTable& table, const std::string& key,
                                   const Reading& reading) {
  std::vector<std::string> values;
  const KeyValue& entry = table.entries.at(key);
  if (const auto* list = std::get_if<std::vector<KeyValue>>(&entry.data)) {
    table.leave(key);  // a value may be a table, which the case will read
    for (const KeyValue& value : *list) values.push_back(reading.text(key, value));
  } else if (std::holds_alternative<std::shared_ptr<KeyTable>>(entry.data)) {
    const auto range = table.table(key);
    if (range->has("every")) return names_in_files(*range, reading.folder);
    const long count = range->integer("count");
    if (count < 2) throw InputError(range->where("count") + ": 'count' must be at least 2");
    require_few(double(count), *range, reading.most_jobs);
    for (long k = 0; k < count; ++k)
      values.push_back(fmt::format("{}", spread_over(*range, double(k) / double(count - 1))));
  } else {
    throw InputError(entry.where + ": '" + key +
                     "' needs a list of values, or { from, to, count }; one value goes to [set]");
  }
  if (values.empty()) throw InputError(entry.where + ": '" + key + "' has no values");
  return values;
}

std::vector<Assignment> fixed_in(const KeyTable& block, const Reading& reading) {
  std::vector<Assignment> fixed;
  if (block.has("case")) fixed.push_back({"case", block.text("case")});
  if (const auto set = block.table("set"))
    for (const auto& [key, value] : set->entries) {
      static_cast<void>(set->has(key));
      set->leave(key);
      fixed.push_back({key, reading.text(key, value)});
    }
  return fixed;
}

CampaignAxis zipped(const KeyTable& table, const Reading& reading) {
  CampaignAxis axis;
  for (const auto& [key, value] : table.entries) {
    static_cast<void>(table.has(key));
    const std::vector<std::string> values = values_of(table, key, reading);
    if (axis.keys.empty()) axis.rows.resize(values.size());
    if (values.size() != axis.rows.size())
      throw InputError(fmt::format(
          "{}: '{}' has {} values, and '{}' has {}; lists of a [[zip]] need as many as each other",
          value.where, key, values.size(), axis.keys[0], axis.rows.size()));
    for (size_t r = 0; r < values.size(); ++r) axis.rows[r].push_back(values[r]);
    axis.keys.push_back(key);
  }
  if (axis.keys.empty()) throw InputError(table.where() + ": [[zip]] has no parameter");
  return axis;
}

CampaignBlock read_block(const KeyTable& keys, const Reading& reading) {
  CampaignBlock block;
  block.fixed = fixed_in(keys, reading);
  double combinations = 1, parts = 0;
  const auto add_axis = [&](const CampaignAxis& axis) {
    block.axes.push_back(axis);
    combinations *= double(axis.rows.size());
    require_few(combinations, keys, reading.most_jobs);
  };
  if (const auto grid = keys.table("grid"))
    for (const auto& [key, value] : grid->entries) {
      static_cast<void>(grid->has(key));
      CampaignAxis axis{{key}, {}, false};
      for (const std::string& text : values_of(*grid, key, reading)) axis.rows.push_back({text});
      add_axis(axis);
    }
  for (const auto& table : keys.tables("zip")) add_axis(zipped(*table, reading));
  if (const auto table = keys.table("sample")) {
    require_few(double(table->integer("count")), *table, reading.most_jobs);
    add_axis(latin_hypercube(*table));
  }
  for (const auto& part : keys.tables("part")) {
    block.parts.push_back(read_block(*part, reading));
    parts += double(block.parts.back().jobs);
    require_few(combinations * parts, keys, reading.most_jobs);
  }
  block.jobs = size_t(combinations * (block.parts.empty() ? 1 : parts));
  return block;
}

JobLimits read_limits(const KeyTable& keys) {
  JobLimits limits;
  const auto table = keys.table("limits");
  if (!table) return limits;
  limits.seconds = table->number_or("seconds", limits.seconds);
  limits.memory = 1e6 * table->number_or("megabytes", limits.memory / 1e6);
  if (!(limits.seconds > 0)) throw InputError(table->where("seconds") + ": 'seconds' must be > 0");
  if (!(limits.memory >= 1e8))
    throw InputError(table->where("megabytes") + ": 'megabytes' must be at least 100");
  return limits;
}

std::vector<CampaignExpectation> read_expectations(const KeyTable& keys) {
  std::vector<CampaignExpectation> all;
  const auto table = keys.table("expect");
  if (!table) return all;
  for (const auto& [name, value] : table->entries) {
    const auto entry = table->table(name);
    CampaignExpectation one;
    one.quantity = name;
    one.is_at_most = entry->has("at_most");
    if (one.is_at_most == entry->has("at_least"))
      throw InputError(value.where + ": give at_most or at_least");
    one.bound = entry->number(one.is_at_most ? "at_most" : "at_least");
    one.share = entry->number_or("share", 1);
    if (!(one.share > 0 && one.share <= 1))
      throw InputError(entry->where("share") + ": 'share' must be above 0 and at most 1");
    one.why = entry->text("why");
    all.push_back(one);
  }
  return all;
}

std::vector<CampaignFigure> read_figures(const KeyTable& keys) {
  std::vector<CampaignFigure> all;
  for (const auto& table : keys.tables("figure")) {
    CampaignFigure figure{table->text("quantity"), table->text_or("title", ""),
                          table->texts("over"), table->flag_or("logarithmic", false)};
    if (figure.over.empty() || figure.over.size() > 3)
      throw InputError(table->where("over") + ": 'over' names one, two or three parameters");
    all.push_back(figure);
  }
  return all;
}

std::string quantities_of(const KeyTable& keys) {
  if (!keys.has("quantity")) return "";
  keys.leave("quantity");
  return "quantity = " + toml_of(keys.entries.at("quantity"));
}

void add_assignments(const CampaignBlock& block, size_t i, std::map<std::string, std::string>& to) {
  for (const Assignment& a : block.fixed) to[a.key] = a.value;
  for (const CampaignAxis& axis : block.axes) {
    const auto& row = axis.rows[i % axis.rows.size()];
    for (size_t k = 0; k < row.size(); ++k) to[axis.keys[k]] = row[k];
    i /= axis.rows.size();
  }
  for (const CampaignBlock& part : block.parts) {
    if (i < part.jobs) return add_assignments(part, i, to);
    i -= part.jobs;
  }
}

void add_parameters(const CampaignBlock& block, bool is_one_of_several,
                    std::set<std::string>& varied, std::set<std::string>& sampled) {
  if (is_one_of_several)
    for (const Assignment& a : block.fixed) varied.insert(a.key);
  for (const CampaignAxis& axis : block.axes)
    for (const std::string& key : axis.keys) {
      varied.insert(key);
      if (axis.is_sample) sampled.insert(key);
    }
  for (const CampaignBlock& part : block.parts)
    add_parameters(part, is_one_of_several || block.parts.size() > 1, varied, sampled);
}

std::map<std::string, std::string> read_names(const KeyTable& keys) {
  std::map<std::string, std::string> names;
  if (const auto table = keys.table("names"))
    for (const auto& [key, value] : table->entries) names[key] = table->text(key);
  return names;
}

std::string campaign_name(const std::string& path) {
  std::string name = std::filesystem::path(path).filename().string();
  for (const std::string& end : {std::string(".toml"), std::string(".campaign")})
    if (name.ends_with(end)) name.resize(name.size() - end.size());
  return name;
}

}  // namespace

std::string text_of(const KeyValue& value) {
  if (const auto* flag = std::get_if<bool>(&value.data)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<long>(&value.data)) return fmt::format("{}", *whole);
  if (const auto* number = std::get_if<double>(&value.data)) return fmt::format("{}", *number);
  if (const auto* text = std::get_if<std::string>(&value.data))
    return needs_quotes(*text) ? in_quotes(*text) : *text;
  return toml_of(value);
}

std::string name_of(Keep keep) {
  return keep == Keep::none ? "none" : keep == Keep::failures ? "failures" : "all";
}

Keep keep_named(const std::string& name) {
  for (const Keep keep : {Keep::none, Keep::failures, Keep::all})
    if (name == name_of(keep)) return keep;
  throw InputError("'" + name + "': keep none, failures or all");
}

Campaign read_campaign_text(const std::string& text, const std::string& path, size_t most_jobs) {
  const auto keys = parse_keys(text, path);
  Campaign campaign;
  campaign.file = path;
  campaign.name = campaign_name(path);
  campaign.title = keys->text_or("title", campaign.name);
  campaign.about = keys->text_or("about", "");
  campaign.run = keys->text_or("run", "simulate");
  try {
    campaign.keep = keep_named(keys->text_or("keep", "none"));
  } catch (const InputError& error) {
    throw InputError(keys->where("keep") + ": " + error.what());
  }
  const std::string folder = std::filesystem::absolute(path).parent_path().string();
  campaign.root = read_block(*keys, {folder, campaign.run, most_jobs});
  campaign.limits = read_limits(*keys);
  campaign.expectations = read_expectations(*keys);
  campaign.figures = read_figures(*keys);
  campaign.names = read_names(*keys);
  campaign.quantities = quantities_of(*keys);
  keys->reject_unused();
  return campaign;
}

Campaign read_campaign(const std::string& path) {
  return read_campaign_text(read_text(path), path);
}

std::vector<Assignment> job_assignments(const Campaign& campaign, size_t i) {
  std::map<std::string, std::string> values;
  add_assignments(campaign.root, i, values);
  std::vector<Assignment> sorted;
  for (const auto& [key, value] : values) sorted.push_back({key, value});
  return sorted;
}

std::vector<std::string> varied_parameters(const Campaign& campaign) {
  std::set<std::string> varied, sampled;
  add_parameters(campaign.root, false, varied, sampled);
  return {varied.begin(), varied.end()};
}

std::vector<std::string> sampled_parameters(const Campaign& campaign) {
  std::set<std::string> varied, sampled;
  add_parameters(campaign.root, false, varied, sampled);
  return {sampled.begin(), sampled.end()};
}

}  // namespace foldproof
