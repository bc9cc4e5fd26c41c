#include "verification/files/part_file.h"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "verification/files/atomic_file.h"

namespace foldproof {

namespace {

using Json = nlohmann::json;

constexpr int part_layout = 1;  // raised when what is written here changes

Json to_json_of(const Column& column);
Json to_json_of(const Table& table);
Json to_json_of(const Curve& curve);
Json to_json_of(const Figure& figure);
Json to_json_of(const Map& map);
Json to_json_of(const Record& record);
Json to_json_of(const StudyRecord& study);
Json to_json_of(const CaseRecord& record);

template <class T>
Json list_of(const std::vector<T>& values) {
  Json list = Json::array();
  for (const T& value : values) list.push_back(to_json_of(value));
  return list;
}

Json to_json_of(const Column& column) {
  Json json = {{"name", column.name}, {"unit", column.unit}, {"off", column.uncertainty}};
  std::visit([&](const auto& values) { json["values"] = values; }, column.values);
  json["is_text"] = std::holds_alternative<std::vector<std::string>>(column.values);
  return json;
}

Column read_column(const Json& json) {
  Column column{json.at("name"), json.at("unit")};
  if (json.at("is_text"))
    column.values = json.at("values").get<std::vector<std::string>>();
  else
    column.values = json.at("values").get<std::vector<double>>();
  column.uncertainty = json.at("off");
  return column;
}

Json to_json_of(const Table& table) {
  return {{"name", table.name}, {"title", table.title}, {"columns", list_of(table.columns())}};
}

Table read_table(const Json& json) {
  Table table;
  table.name = json.at("name");
  table.title = json.at("title");
  for (const Json& column : json.at("columns")) table.add(read_column(column));
  return table;
}

Json to_json_of(const Axis& axis) {
  return {{"label", axis.label}, {"unit", axis.unit}, {"is_log", axis.scale == Scale::log}};
}

Scale read_scale(const Json& is_log) { return is_log.get<bool>() ? Scale::log : Scale::linear; }

Axis read_axis(const Json& json) {
  return {json.at("label"), json.at("unit"), read_scale(json.at("is_log"))};
}

Json to_json_of(const Curve& curve) {
  std::vector<int> marks;
  for (const Mark mark : curve.marks) marks.push_back(int(mark));
  return {{"label", curve.label}, {"x", curve.x},         {"y", curve.y},
          {"floor", curve.floor}, {"slope", curve.slope}, {"pair_orders", curve.pair_orders},
          {"marks", marks}};
}

Curve read_curve(const Json& json) {
  Curve curve{json.at("label"), json.at("x"), json.at("y"), json.at("floor"),
              json.at("pair_orders")};
  curve.slope = json.at("slope");
  for (const Json& mark : json.at("marks")) curve.marks.push_back(Mark(mark.get<int>()));
  return curve;
}

std::vector<Curve> read_curves(const Json& json) {
  std::vector<Curve> curves;
  for (const Json& curve : json) curves.push_back(read_curve(curve));
  return curves;
}

Json to_json_of(const Figure& figure) {
  return {{"name", figure.name},
          {"title", figure.title},
          {"x", to_json_of(figure.x)},
          {"y", to_json_of(figure.y)},
          {"slope", figure.slope},
          {"caption", figure.caption},
          {"curves", list_of(figure.curves)}};
}

Figure read_figure(const Json& json) {
  return {
      json.at("name"),  json.at("title"),   read_axis(json.at("x")),       read_axis(json.at("y")),
      json.at("slope"), json.at("caption"), read_curves(json.at("curves"))};
}

Json to_json_of(const Map& map) {
  return {{"name", map.name},         {"title", map.title},
          {"x", to_json_of(map.x)},   {"y", to_json_of(map.y)},
          {"x_values", map.x_values}, {"y_values", map.y_values},
          {"values", map.values},     {"quantity", map.quantity},
          {"unit", map.unit},         {"is_log", map.scale == Scale::log},
          {"caption", map.caption},   {"curves", list_of(map.curves)}};
}

Map read_map(const Json& json) {
  return {json.at("name"),         json.at("title"),
          read_axis(json.at("x")), read_axis(json.at("y")),
          json.at("x_values"),     json.at("y_values"),
          json.at("values"),       json.at("quantity"),
          json.at("unit"),         read_scale(json.at("is_log")),
          json.at("caption"),      read_curves(json.at("curves"))};
}

Json to_json_of(const Verdict& verdict) {
  return {{"measured", verdict.measured},
          {"bound", verdict.bound},
          {"uncertainty", verdict.uncertainty},
          {"unit", verdict.unit},
          {"why_bound", verdict.why_bound}};
}

Verdict read_verdict(const Json& json) {
  return {json.at("measured"), json.at("bound"), json.at("uncertainty"), json.at("unit"),
          json.at("why_bound")};
}

Json to_json_of(const Record& record) {
  return {{"name", record.name},
          {"kind", record.kind},
          {"study", record.study},
          {"claim", record.claim},
          {"source", record.source},
          {"verdict", to_json_of(record.finding.verdict)},
          {"evidence", to_json_of(record.finding.evidence)},
          {"note", record.finding.note},
          {"outcome", record.outcome ? int(*record.outcome) : -1},
          {"better", record.better},
          {"seconds", record.seconds}};
}

Record read_record(const Json& json) {
  Record record;
  record.name = json.at("name");
  record.kind = json.at("kind");
  record.study = json.at("study");
  record.claim = json.at("claim");
  record.source = json.at("source");
  record.finding = {read_verdict(json.at("verdict")), read_table(json.at("evidence")),
                    json.at("note")};
  if (const int outcome = json.at("outcome"); outcome >= 0) record.outcome = Outcome(outcome);
  record.better = json.at("better");
  record.seconds = json.at("seconds");
  return record;
}

Json to_json_of(const StudyRecord& study) {
  return {{"name", study.name},          {"claim", study.claim},
          {"source", study.source},      {"about", study.about},
          {"seconds", study.seconds},    {"figures", list_of(study.figures)},
          {"maps", list_of(study.maps)}, {"tables", list_of(study.tables)}};
}

StudyRecord read_study(const Json& json) {
  StudyRecord study;
  study.name = json.at("name");
  study.claim = json.at("claim");
  study.source = json.at("source");
  study.about = json.at("about");
  study.seconds = json.at("seconds");
  for (const Json& figure : json.at("figures")) study.figures.push_back(read_figure(figure));
  for (const Json& map : json.at("maps")) study.maps.push_back(read_map(map));
  for (const Json& table : json.at("tables")) study.tables.push_back(read_table(table));
  return study;
}

Json to_json_of(const CaseRecord& record) {
  return {{"name", record.name},   {"file", record.file},       {"title", record.title},
          {"about", record.about}, {"seconds", record.seconds}, {"stopped", record.stopped}};
}

CaseRecord read_case(const Json& json) {
  return {json.at("name"),  json.at("file"),    json.at("title"),
          json.at("about"), json.at("seconds"), json.at("stopped")};
}

Json to_json_of(const PartOf& of) {
  return {{"layout", part_layout},
          {"job", of.job},
          {"program", of.program},
          {"tier", of.tier},
          {"seed", of.seed}};
}

RunRecord read_all(const Json& json) {
  RunRecord part;
  const Json& origin = json.at("origin");
  part.origins = {{origin.at("commit"), origin.at("tree"), origin.at("date"), 1}};
  for (const Json& record : json.at("records")) part.records.push_back(read_record(record));
  for (const Json& study : json.at("studies")) part.studies.push_back(read_study(study));
  for (const Json& record : json.at("cases")) part.cases.push_back(read_case(record));
  return part;
}

}  // namespace

void write_part(const std::string& path, const PartOf& of, const RunOrigin& origin,
                const RunRecord& part) {
  const Json json = {
      {"of", to_json_of(of)},
      {"origin", {{"commit", origin.commit}, {"tree", origin.tree}, {"date", origin.date}}},
      {"records", list_of(part.records)},
      {"studies", list_of(part.studies)},
      {"cases", list_of(part.cases)}};
  const std::vector<std::uint8_t> bytes = Json::to_cbor(json);
  write_text(path, std::string(bytes.begin(), bytes.end()));
}

std::optional<RunRecord> read_part(const std::string& path, const PartOf& of) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  const Json json = Json::from_cbor(bytes, true, false);
  if (json.is_discarded() || !json.is_object() || json.value("of", Json()) != to_json_of(of))
    return std::nullopt;
  try {
    return read_all(json);
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace foldproof
