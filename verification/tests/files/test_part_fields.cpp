// Kept results, field by field: what the bytes say, and what is read from bytes made by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>

#include "verification/files/part_file.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

namespace {

using Json = nlohmann::json;

const PartOf of_job{"a-job", "digest", "full", 77};
const RunOrigin origin{"a commit", "dirty", "a date", 5};

/// Every field differs from all others and from its default.
RunRecord part_specimen() {
  RunRecord part;
  Record record;
  record.name = "r.name";
  record.kind = "r.kind";
  record.study = "r.study";
  record.claim = "r.claim";
  record.source = "r.source";
  Table evidence{{"words", "e.unit"}, {"numbers", "e.m"}};
  evidence.name = "e.name";
  evidence.title = "e.title";
  struct Estimate {
    double value, uncertainty;
  };
  evidence.row("one", Estimate{1.5, 0.125});
  evidence.row("two", Estimate{-2.5, 0.25});
  record.finding = {{3.5, 4.5, 5.5, "v.unit", "v.why"}, evidence, "f.note"};
  record.outcome = Outcome::fails;
  record.better = "r.better";
  record.seconds = 6.5;
  Record holds;
  holds.outcome = Outcome::holds;
  part.records = {record, holds, Record{}};
  Curve curve{"c.label", {7.5, 8.5}, {9.5, 10.5}, 11.5, {12.5}};
  curve.slope = 13.5;
  curve.marks = {Mark::unfinished, Mark::diverged};
  Curve other{"o.label", {1.25}, {2.25}, 3.25, {}};
  other.slope = -0.75;
  StudyRecord study;
  study.name = "s.name";
  study.claim = "s.claim";
  study.source = "s.source";
  study.about = "s.about";
  study.seconds = 14.5;
  study.figures = {{"g.name",
                    "g.title",
                    {"g.x", "g.xu", Scale::log},
                    {"g.y", "g.yu", Scale::linear},
                    15.5,
                    "g.caption",
                    {curve, other}}};
  study.maps = {{"m.name",
                 "m.title",
                 {"m.x", "m.xu", Scale::linear},
                 {"m.y", "m.yu", Scale::log},
                 {16.5, 17.5},
                 {18.5},
                 {19.5, 20.5},
                 "m.quantity",
                 "m.unit",
                 Scale::log,
                 "m.caption",
                 {other}}};
  study.tables = {evidence, Table("t.name", "t.title", Table{{"n", "1"}}.with_row(21.5))};
  part.studies = {study};
  part.cases = {{"k.name", "k.file", "k.title", "k.about", 22.5, "k.stopped"}};
  return part;
}

Json curve_json() {
  return {{"label", "c.label"},    {"x", {7.5, 8.5}}, {"y", {9.5, 10.5}}, {"floor", 11.5},
          {"pair_orders", {12.5}}, {"slope", 13.5},   {"marks", {1, 2}}};
}

Json evidence_json() {
  return {{"name", "e.name"},
          {"title", "e.title"},
          {"columns",
           {{{"name", "words"},
             {"unit", "e.unit"},
             {"off", 0.0},
             {"values", {"one", "two"}},
             {"is_text", true}},
            {{"name", "numbers"},
             {"unit", "e.m"},
             {"off", 0.25},
             {"values", {1.5, -2.5}},
             {"is_text", false}}}}};
}

Json axis_json(const std::string& name, bool is_log) {
  return {{"label", name}, {"unit", name + "u"}, {"is_log", is_log}};
}

Json read_cbor(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return Json::from_cbor(std::vector<std::uint8_t>{std::istreambuf_iterator<char>(file), {}});
}

void write_cbor(const std::string& path, const Json& json, const std::string& tail = "") {
  const std::vector<std::uint8_t> bytes = Json::to_cbor(json);
  std::ofstream(path, std::ios::binary) << std::string(bytes.begin(), bytes.end()) << tail;
}

}  // namespace

TEST_CASE("kept results: each field has its key in the bytes") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("part");
  write_part(path, of_job, origin, part_specimen());
  const Json json = read_cbor(path);
  CHECK(
      json.at("of") ==
      Json{{"layout", 1}, {"job", "a-job"}, {"program", "digest"}, {"tier", "full"}, {"seed", 77}});
  CHECK(json.at("origin") == Json{{"commit", "a commit"}, {"tree", "dirty"}, {"date", "a date"}});
  REQUIRE(json.at("records").size() == 3);
  CHECK(json.at("records")[0] == Json{{"name", "r.name"},
                                      {"kind", "r.kind"},
                                      {"study", "r.study"},
                                      {"claim", "r.claim"},
                                      {"source", "r.source"},
                                      {"verdict",
                                       {{"measured", 3.5},
                                        {"bound", 4.5},
                                        {"uncertainty", 5.5},
                                        {"unit", "v.unit"},
                                        {"why_bound", "v.why"}}},
                                      {"evidence", evidence_json()},
                                      {"note", "f.note"},
                                      {"outcome", 1},
                                      {"better", "r.better"},
                                      {"seconds", 6.5}});
  CHECK(json.at("records")[1].at("outcome") == 0);
  CHECK(json.at("records")[2].at("outcome") == -1);
  const Json& study = json.at("studies").at(0);
  for (const char* key : {"name", "claim", "source", "about"})
    CHECK(study.at(key) == std::string("s.") + key);
  CHECK(study.at("seconds") == 14.5);
  REQUIRE(study.at("figures").size() == 1);
  const Json& figure = study.at("figures")[0];
  for (const char* key : {"name", "title", "caption"})
    CHECK(figure.at(key) == std::string("g.") + key);
  CHECK(figure.at("x") == axis_json("g.x", true));
  CHECK(figure.at("y") == axis_json("g.y", false));
  CHECK(figure.at("slope") == 15.5);
  REQUIRE(figure.at("curves").size() == 2);
  CHECK(figure.at("curves")[0] == curve_json());
  CHECK(figure.at("curves")[1].at("label") == "o.label");
  REQUIRE(study.at("maps").size() == 1);
  const Json& map = study.at("maps")[0];
  for (const char* key : {"name", "title", "quantity", "unit", "caption"})
    CHECK(map.at(key) == std::string("m.") + key);
  CHECK(map.at("x") == axis_json("m.x", false));
  CHECK(map.at("y") == axis_json("m.y", true));
  CHECK(map.at("x_values") == Json{16.5, 17.5});
  CHECK(map.at("y_values") == Json::array({18.5}));
  CHECK(map.at("values") == Json{19.5, 20.5});
  CHECK(map.at("is_log") == true);
  CHECK(map.at("curves").size() == 1);
  REQUIRE(study.at("tables").size() == 2);
  CHECK(study.at("tables")[0] == evidence_json());
  CHECK(study.at("tables")[1].at("title") == "t.title");
  CHECK(json.at("cases") == Json::array({Json{{"name", "k.name"},
                                              {"file", "k.file"},
                                              {"title", "k.title"},
                                              {"about", "k.about"},
                                              {"seconds", 22.5},
                                              {"stopped", "k.stopped"}}}));
}

TEST_CASE("kept results: each field comes back where it was") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("part");
  write_part(path, of_job, origin, part_specimen());
  const auto part = read_part(path, of_job);
  REQUIRE(part);
  REQUIRE(part->origins.size() == 1);
  CHECK(part->origins[0].commit == "a commit");
  CHECK(part->origins[0].tree == "dirty");
  CHECK(part->origins[0].date == "a date");
  CHECK(part->origins[0].jobs == 1);
  REQUIRE(part->records.size() == 3);
  const Record& record = part->records[0];
  CHECK(record.outcome == Outcome::fails);
  CHECK(part->records[1].outcome == Outcome::holds);
  CHECK_FALSE(part->records[2].outcome);
  CHECK(record.finding.evidence.name == "e.name");
  CHECK(record.finding.evidence.title == "e.title");
  const std::vector<Column>& columns = record.finding.evidence.columns();
  REQUIRE(columns.size() == 2);
  CHECK(columns[0].uncertainty == 0);
  CHECK(columns[1].uncertainty == 0.25);
  const StudyRecord& study = part->studies.at(0);
  CHECK(study.figures.at(0).x.scale == Scale::log);
  CHECK(study.figures.at(0).y.scale == Scale::linear);
  CHECK(study.figures.at(0).slope == 15.5);
  const Curve& curve = study.figures.at(0).curves.at(0);
  CHECK(curve.floor == 11.5);
  CHECK(curve.slope == 13.5);
  CHECK(curve.pair_orders == std::vector<double>{12.5});
  CHECK(curve.marks == std::vector<Mark>{Mark::unfinished, Mark::diverged});
  CHECK(study.maps.at(0).x_values == std::vector<double>{16.5, 17.5});
  CHECK(study.maps.at(0).y_values == std::vector<double>{18.5});
  CHECK(study.maps.at(0).scale == Scale::log);
  write_part(scratch.file("again"), of_job, origin, *part);
  CHECK(read_cbor(scratch.file("again")) == read_cbor(path));
}

TEST_CASE("kept results: bytes that are no part of this job are none, of whatever kind they are") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("part");
  write_part(path, of_job, origin, part_specimen());
  const Json whole = read_cbor(path);
  const auto is_part = [&](const Json& json, const std::string& tail = "") {
    write_cbor(path, json, tail);
    return read_part(path, of_job).has_value();
  };
  CHECK(is_part(whole));
  CHECK_FALSE(is_part(whole, "x"));
  CHECK_FALSE(is_part(Json::array({1, 2})));
  CHECK_FALSE(is_part(Json("a text")));
  CHECK_FALSE(is_part(Json::object()));
  for (const char* key : {"of", "origin", "records", "studies", "cases"}) {
    Json less = whole, odd = whole;
    less.erase(key);
    odd[key] = 7;
    CHECK_FALSE(is_part(less));
    CHECK_FALSE(is_part(odd));
  }
  Json newer = whole;
  newer["of"]["layout"] = 2;
  CHECK_FALSE(is_part(newer));
}

}  // namespace foldproof
