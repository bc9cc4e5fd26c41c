#include "verification/files/part_file.h"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "verification/files/atomic_file.h"

namespace foldproof {

using Json = nlohmann::json;

// The keys of an object are the names of its fields.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Axis, label, unit, scale)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Curve, label, x, y, floor, pair_orders, slope, marks)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Figure, name, title, x, y, slope, caption, curves)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Map, name, title, x, y, x_values, y_values, values, quantity,
                                   unit, scale, caption, curves)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Verdict, measured, bound, uncertainty, unit, why_bound)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CaseRecord, name, file, title, about, seconds, stopped)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunOrigin, commit, tree, date)

inline void to_json(Json& json, const Column& column) {
  json = {{"name", column.name}, {"unit", column.unit}, {"uncertainty", column.uncertainty}};
  std::visit([&](const auto& values) { json["values"] = values; }, column.values);
  json["is_text"] = std::holds_alternative<std::vector<std::string>>(column.values);
}

inline void from_json(const Json& json, Column& column) {
  json.at("name").get_to(column.name);
  json.at("unit").get_to(column.unit);
  json.at("uncertainty").get_to(column.uncertainty);
  if (json.at("is_text"))
    column.values = json.at("values").get<std::vector<std::string>>();
  else
    column.values = json.at("values").get<std::vector<double>>();
}

inline void to_json(Json& json, const Table& table) {
  json = {{"name", table.name}, {"title", table.title}, {"columns", table.columns()}};
}

inline void from_json(const Json& json, Table& table) {
  json.at("name").get_to(table.name);
  json.at("title").get_to(table.title);
  for (const Json& column : json.at("columns")) table.add(column.get<Column>());
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Finding, verdict, evidence, note, headline, failure)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StudyRecord, name, claim, source, about, seconds, figures, maps,
                                   tables)

inline void to_json(Json& json, const Record& record) {
  json = {{"name", record.name},     {"kind", record.kind},      {"study", record.study},
          {"claim", record.claim},   {"source", record.source},  {"finding", record.finding},
          {"better", record.better}, {"seconds", record.seconds}};
  json["outcome"] = record.outcome ? int(*record.outcome) : -1;
}

inline void from_json(const Json& json, Record& record) {
  for (const auto& [key, text] : {std::pair("name", &record.name),
                                  {"kind", &record.kind},
                                  {"study", &record.study},
                                  {"claim", &record.claim},
                                  {"source", &record.source},
                                  {"better", &record.better}})
    json.at(key).get_to(*text);
  json.at("finding").get_to(record.finding);
  json.at("seconds").get_to(record.seconds);
  if (const int outcome = json.at("outcome"); outcome >= 0) record.outcome = Outcome(outcome);
}

namespace {

constexpr int part_layout = 1;  // raised when what is written here changes

Json as_json(const PartOf& of) {
  return {{"layout", part_layout},
          {"job", of.job},
          {"program", of.program},
          {"tier", of.tier},
          {"seed", of.seed}};
}

RunRecord read_all(const Json& json) {
  RunRecord part;
  part.origins = {json.at("origin").get<RunOrigin>()};
  part.origins[0].jobs = 1;
  json.at("records").get_to(part.records);
  json.at("studies").get_to(part.studies);
  json.at("cases").get_to(part.cases);
  return part;
}

}  // namespace

void write_part(const std::string& path, const PartOf& of, const RunOrigin& origin,
                const RunRecord& part) {
  const Json json = {{"of", as_json(of)},
                     {"origin", origin},
                     {"records", part.records},
                     {"studies", part.studies},
                     {"cases", part.cases}};
  const std::vector<std::uint8_t> bytes = Json::to_cbor(json);
  write_text(path, std::string(bytes.begin(), bytes.end()));
}

std::optional<RunRecord> read_part(const std::string& path, const PartOf& of) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  const Json json = Json::from_cbor(bytes, true, false);
  if (json.is_discarded() || !json.is_object() || json.value("of", Json()) != as_json(of))
    return std::nullopt;
  try {
    return read_all(json);
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace foldproof
