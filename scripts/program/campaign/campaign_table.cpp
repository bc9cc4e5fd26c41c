#include "scripts/program/campaign/campaign_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "scripts/program/campaign/work.h"
#include "scripts/program/json_text.h"
#include "verification/files/hdf5_file.h"

namespace foldproof {

namespace {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string setting(const std::vector<Assignment>& set, const std::string& key) {
  const auto found = std::ranges::find(set, key, &Assignment::key);
  return found == set.end() ? "" : found->value;
}

/// The value that the wanted share of jobs keeps to: the smallest bound that they would meet.
double quantile_of(std::vector<double> values, double share, bool is_at_most) {
  std::ranges::sort(values);
  if (!is_at_most) std::ranges::reverse(values);
  const size_t needed = size_t(std::ceil(share * double(values.size()) * (1 - 1e-12)));
  return values[std::max(size_t(1), needed) - 1];
}

/// The numbers of a parameter; none if a value is no number.
std::vector<double> numbers_of(const CampaignTable& table, const std::string& name) {
  const size_t parameter =
      size_t(std::ranges::find(table.parameters, name) - table.parameters.begin());
  std::vector<double> numbers;
  for (const auto& row : table.settings) {
    const std::string& text = row[parameter];
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    numbers.push_back(number);
  }
  return numbers;
}

template <class T>
std::vector<T> column_of(const std::vector<std::vector<T>>& rows, size_t k) {
  std::vector<T> column;
  for (const auto& row : rows) column.push_back(row[k]);
  return column;
}

/// The values of a quantity, a row a job; NaN where no job has it.
std::vector<double> quantity_of(const CampaignTable& table, const std::string& name) {
  const auto found = std::ranges::find(table.quantities, name);
  if (found == table.quantities.end()) return std::vector<double>(table.keys.size(), nan);
  return column_of(table.values, size_t(found - table.quantities.begin()));
}

}  // namespace

CampaignTable campaign_table(OpenCampaign& of) {
  CampaignTable table;
  table.parameters = of.varied;
  table.units = of.index.units();
  const std::map<std::string, int> starts = of.index.open_starts();
  std::vector<std::map<std::string, double>> values;
  std::set<std::string> names;
  const SqliteTransaction reading = of.index.reading();
  for (size_t i = 0; i < of.campaign.root.jobs; ++i) {
    const std::vector<Assignment> set = job_assignments(of.campaign, i);
    const std::string key = of.keys.key_of(set);
    const std::optional<JobResult> result = of.index.find(key);
    table.keys.push_back(key);
    std::vector<std::string> row;
    for (const std::string& parameter : table.parameters) row.push_back(setting(set, parameter));
    table.settings.push_back(row);
    const auto started = starts.find(key);
    const bool has_crashed = started != starts.end() && started->second >= most_starts;
    table.ends.push_back(result ? name_of(result->end) : has_crashed ? "crashed" : "missing");
    table.reasons.push_back(result ? result->reason : "");
    table.seconds.push_back(result ? result->seconds : nan);
    values.push_back(result ? result->values : std::map<std::string, double>());
    for (const auto& [name, value] : values.back()) names.insert(name);
  }
  table.quantities.assign(names.begin(), names.end());
  for (const auto& of_job : values) {
    std::vector<double> row;
    for (const std::string& name : table.quantities)
      row.push_back(of_job.contains(name) ? of_job.at(name) : nan);
    table.values.push_back(row);
  }
  return table;
}

std::vector<Sensitivity> sensitivities_of(const Campaign& campaign, const CampaignTable& table) {
  std::vector<Sensitivity> all;
  std::set<std::string> quantities;
  for (const CampaignFigure& figure : campaign.figures) quantities.insert(figure.quantity);
  for (const std::string& quantity : quantities) {
    if (std::ranges::count(table.quantities, quantity) == 0) continue;
    std::vector<double> y = quantity_of(table, quantity);
    for (size_t i = 0; i < y.size(); ++i)
      if (table.ends[i] != name_of(JobEnd::holds) && table.ends[i] != name_of(JobEnd::fails))
        y[i] = nan;
    for (const std::string& parameter : sampled_parameters(campaign)) {
      const auto x = numbers_of(table, parameter);
      if (!x.empty()) all.push_back({quantity, parameter, first_order_index(x, y)});
    }
  }
  return all;
}

std::string text_of(const std::vector<Sensitivity>& sensitivities) {
  std::string text;
  for (const auto& [quantity, parameter, of] : sensitivities)
    text += std::isnan(of.index)
                ? fmt::format("{}: {} samples do not say what comes from {}\n", quantity,
                              of.samples, parameter)
                : fmt::format("{}: {:.3f} +- {:.3f} of its variance by {} alone ({} samples)\n",
                              quantity, of.index, of.error, parameter, of.samples);
  return text;
}

std::string csv_of(const CampaignTable& table) {
  std::string text = "key,outcome,reason";
  for (const std::string& name : table.parameters) text += "," + csv_field(name);
  for (const std::string& name : table.quantities) {
    const auto unit = table.units.find(name);
    text += "," + csv_field(unit == table.units.end() ? name : name + " [" + unit->second + "]");
  }
  text += "\n";
  for (size_t i = 0; i < table.keys.size(); ++i) {
    text += table.keys[i] + "," + table.ends[i] + "," + csv_field(table.reasons[i]);
    for (const std::string& value : table.settings[i]) text += "," + csv_field(value);
    for (const double value : table.values[i])
      text += "," + (std::isnan(value) ? "" : fmt::format("{:.17g}", value));
    text += "\n";
  }
  return text;
}

void write_hdf5_table(const std::string& path, const CampaignTable& table) {
  write_hdf5(path, [&](const Hdf5& file) {
    file.attribute("parameters", table.parameters);
    file.attribute("quantities", table.quantities);
    file.dataset("outcome", table.ends);
    file.dataset("reason", table.reasons);
    file.dataset("key", table.keys);
    file.dataset("seconds", table.seconds);
    const Hdf5 parameters = file.group("parameter"), quantities = file.group("quantity");
    for (size_t k = 0; k < table.parameters.size(); ++k)
      parameters.dataset(table.parameters[k], column_of(table.settings, k));
    for (size_t k = 0; k < table.quantities.size(); ++k)
      quantities.dataset(table.quantities[k], column_of(table.values, k));
  });
}

std::vector<Record> judge_campaign(const Campaign& campaign, const CampaignTable& table) {
  std::vector<Record> records;
  const size_t waiting = size_t(std::ranges::count(table.ends, "missing"));
  for (const CampaignExpectation& e : campaign.expectations) {
    const double worst = (e.is_at_most ? 1 : -1) * std::numeric_limits<double>::infinity();
    std::vector<double> values = quantity_of(table, e.quantity);
    for (double& value : values) value = std::isnan(value) ? worst : value;
    const auto kept = std::ranges::count_if(
        values, [&](double value) { return e.is_at_most ? value <= e.bound : value >= e.bound; });
    const double needed = e.share * double(values.size()) * (1 - 1e-12);
    Record record;
    record.name = "campaign." + campaign.name + "." + e.quantity;
    record.kind = "case";
    record.claim = fmt::format("{:g} % of the runs have a {} of at {} {:g}.", 100 * e.share,
                               e.quantity, e.is_at_most ? "most" : "least", e.bound);
    const auto unit = table.units.find(e.quantity);
    record.finding = {{quantile_of(values, e.share, e.is_at_most), e.bound, 0,
                       unit == table.units.end() ? "1" : unit->second, e.why},
                      {},
                      fmt::format("{} of {} runs keep it, {} wait", kept, values.size(), waiting)};
    record.outcome = double(kept) >= needed                     ? Outcome::holds
                     : double(kept) + double(waiting) >= needed ? Outcome::inconclusive
                                                                : Outcome::fails;
    records.push_back(record);
  }
  return records;
}

std::string json_of_table(const Campaign& campaign, const CampaignTable& table,
                          const std::vector<Record>& verdicts) {
  using nlohmann::json;
  json figures = json::array(), findings = json::array(), sensitivities = json::array();
  for (const CampaignFigure& f : campaign.figures)
    figures.push_back({{"quantity", f.quantity},
                       {"title", f.title},
                       {"over", f.over},
                       {"logarithmic", f.is_logarithmic}});
  for (const Record& record : verdicts)
    findings.push_back({{"name", record.name},
                        {"claim", record.claim},
                        {"outcome", outcome_text(record)},
                        {"measured", record.finding.verdict.measured},
                        {"bound", record.finding.verdict.bound},
                        {"unit", record.finding.verdict.unit},
                        {"why", record.finding.verdict.why_bound},
                        {"note", record.finding.note}});
  for (const auto& [quantity, parameter, of] : sensitivities_of(campaign, table))
    sensitivities.push_back({{"quantity", quantity},
                             {"parameter", parameter},
                             {"index", of.index},
                             {"error", of.error},
                             {"samples", of.samples},
                             {"bins", of.bins}});
  return json_text({{"name", campaign.name},
                    {"title", campaign.title},
                    {"about", campaign.about},
                    {"run", campaign.run},
                    {"figures", figures},
                    {"findings", findings},
                    {"sensitivities", sensitivities},
                    {"names", campaign.names},
                    {"parameters", table.parameters},
                    {"quantities", table.quantities},
                    {"units", table.units},
                    {"outcomes", table.ends},
                    {"reasons", table.reasons},
                    {"settings", table.settings},
                    {"values", table.values},
                    {"seconds", table.seconds}});
}

}  // namespace foldproof
