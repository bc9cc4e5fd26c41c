// Studies in an HDF5 file, read back through the library itself.
#include <catch2/catch.hpp>
#include <cmath>

#include "verification/files/hdf5_file.h"
#include "verification/files/studies_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/hdf5_listing.h"

namespace foldproof {

namespace {

Listing listing_of(const std::vector<StudyRecord>& studies) {
  const ScratchFolder folder;
  {
    Hdf5 file = Hdf5::create_file(folder.file("a.h5"));
    write_studies(file, studies);
    file.close();
  }
  return hdf5_listing(folder.file("a.h5"));
}

/// A curve with all that it may have, and one with what it must have.
Curve full_curve() {
  return {"marked",
          {0.5, 0.25, 0.125},
          {7, 9, std::nan("")},
          1e-12,
          {1.75, 2.5},
          3.5,
          {Mark::unfinished, Mark::measured, Mark::diverged}};
}
const Curve bare_curve{"bare", {1.5, 2.5}, {-4, 6.5}, std::nan(""), {}};

Figure full_figure() {
  return {"convergence", "A title",      {"step", "s", Scale::log}, {"error", "m", Scale::linear},
          4.5,           "as expected.", {full_curve(), bare_curve}};
}
const Figure bare_figure{
    "empty", "Nothing", {"a", "1", Scale::linear}, {"b", "N", Scale::log}, std::nan(""), "", {}};

/// A map of 3 x 2 points.
Map full_map() {
  return {"stability",
          "Where it is stable",
          {"damping", "kg/s", Scale::linear},
          {"step", "ms", Scale::log},
          {0.25, 0.5, 0.75},
          {10, 20},
          {1.5, 2.5, 3.5, 4.5, 5.5, 6.5},
          "growth",
          "1/s",
          Scale::log,
          "of one mode.",
          {bare_curve}};
}

Table small_table(const std::string& name, const std::string& title, double value) {
  return Table(name, title, Table{{"case", ""}, {"length", "m"}}.with_row("c", value));
}

const Listing full_curve_entries{{"", ""},
                                 {"@order", "0"},
                                 {"@label", "marked"},
                                 {"@floor", "1e-12"},
                                 {"@slope", "3.5"},
                                 {"x", "[3] 0.5 | 0.25 | 0.125"},
                                 {"y", "[3] 7 | 9 | nan"},
                                 {"pair_orders", "[2] 1.75 | 2.5"},
                                 {"marks", "[3] unfinished | measured | diverged"}};

Listing bare_curve_entries(int order) {
  return {{"", ""},
          {"@order", std::to_string(order)},
          {"@label", "bare"},
          {"@floor", "nan"},
          {"x", "[2] 1.5 | 2.5"},
          {"y", "[2] -4 | 6.5"}};
}

const Listing figure_entries{{"", ""},
                             {"@order", "0"},
                             {"@title", "A title"},
                             {"@x_label", "step"},
                             {"@x_unit", "s"},
                             {"@x_scale", "log"},
                             {"@y_label", "error"},
                             {"@y_unit", "m"},
                             {"@y_scale", "linear"},
                             {"@slope", "4.5"},
                             {"@caption", "as expected."},
                             {"curves/", ""}};

const Listing bare_figure_entries{{"", ""},          {"@order", "1"},  {"@title", "Nothing"},
                                  {"@x_label", "a"}, {"@x_unit", "1"}, {"@x_scale", "linear"},
                                  {"@y_label", "b"}, {"@y_unit", "N"}, {"@y_scale", "log"},
                                  {"@slope", "nan"}, {"@caption", ""}, {"curves/", ""}};

/// The rows of values are those of the y axis.
Listing map_entries(int order) {
  return {{"", ""},
          {"@order", std::to_string(order)},
          {"@title", "Where it is stable"},
          {"@x_label", "damping"},
          {"@x_unit", "kg/s"},
          {"@x_scale", "linear"},
          {"@y_label", "step"},
          {"@y_unit", "ms"},
          {"@y_scale", "log"},
          {"@quantity", "growth"},
          {"@unit", "1/s"},
          {"@scale", "log"},
          {"@caption", "of one mode."},
          {"x", "[3] 0.25 | 0.5 | 0.75"},
          {"x@unit", "kg/s"},
          {"y", "[2] 10 | 20"},
          {"y@unit", "ms"},
          {"values", "[2 x 3] 1.5 | 2.5 | 3.5 | 4.5 | 5.5 | 6.5"},
          {"values@unit", "1/s"},
          {"curves/", ""}};
}

Listing table_entries(int order, const std::string& title, const std::string& value) {
  return {{"", ""},
          {"@order", std::to_string(order)},
          {"@title", title},
          {"case", "[1] c"},
          {"case@order", "0"},
          {"case@unit", ""},
          {"length", "[1] " + value},
          {"length@order", "1"},
          {"length@unit", "m"}};
}

Listing study_entries(int order, const std::string& claim, const std::string& source,
                      const std::string& about, const std::string& seconds) {
  return {{"", ""},          {"@order", std::to_string(order)},
          {"@claim", claim}, {"@source", source},
          {"@about", about}, {"@seconds", seconds},
          {"figures/", ""},  {"maps/", ""},
          {"tables/", ""}};
}

void add_below(const std::string& group, const Listing& part, Listing& all) {
  for (const auto& [name, value] : part) all[group + name] = value;
}

/// What the only map of the only study says when it is written.
void write_map_of(const Map& map) { listing_of({{"study", "", "", "", 0, {}, {map}, {}}}); }

}  // namespace

TEST_CASE("studies file: figures, maps and tables are written with all that they have") {
  Map second_map = full_map();
  second_map.name = "second";
  second_map.curves.clear();
  StudyRecord full{"steps",
                   "they converge",
                   "BMF03 section 4",
                   "how steps converge",
                   8.5,
                   {full_figure(), bare_figure},
                   {full_map(), second_map},
                   {small_table("first", "One", 0.75), small_table("last", "Two", -3.25)}};
  const StudyRecord bare{"bare", "a claim", "a source", "about", 2.25, {}, {}, {}};
  Listing expected{{"/", ""}, {"/studies/", ""}};
  const std::string s = "/studies/steps/";
  add_below(s, study_entries(0, "they converge", "BMF03 section 4", "how steps converge", "8.5"),
            expected);
  add_below("/studies/bare/", study_entries(1, "a claim", "a source", "about", "2.25"), expected);
  add_below(s + "figures/convergence/", figure_entries, expected);
  add_below(s + "figures/convergence/curves/curve-00/", full_curve_entries, expected);
  add_below(s + "figures/convergence/curves/curve-01/", bare_curve_entries(1), expected);
  add_below(s + "figures/empty/", bare_figure_entries, expected);
  add_below(s + "maps/stability/", map_entries(0), expected);
  add_below(s + "maps/stability/curves/curve-00/", bare_curve_entries(0), expected);
  add_below(s + "maps/second/", map_entries(1), expected);
  add_below(s + "tables/first/", table_entries(0, "One", "0.75"), expected);
  add_below(s + "tables/last/", table_entries(1, "Two", "-3.25"), expected);
  CHECK(difference_of(listing_of({full, bare}), expected) == "");
}

TEST_CASE("studies file: a map needs one value for each of its points") {
  Map map = full_map();
  CHECK_NOTHROW(write_map_of(map));
  const char* const message = " values for 3 x 2 points; give one for each, row by row";
  map.values.push_back(7.5);
  CHECK_THROWS_WITH(write_map_of(map), std::string("map 'stability': 7") + message);
  map.values.resize(5);
  CHECK_THROWS_WITH(write_map_of(map), std::string("map 'stability': 5") + message);
  CHECK_THROWS_AS(write_map_of(map), std::logic_error);
}

TEST_CASE("studies file: a curve has a mark for each point, or none") {
  Figure figure = full_figure();
  const auto write = [&] { listing_of({{"study", "", "", "", 0, {figure}, {}, {}}}); };
  figure.curves[0].marks.pop_back();
  CHECK_THROWS_WITH(write(), "curve 'marked': 2 marks for 3 points; give one for each, or none");
  CHECK_THROWS_AS(write(), std::logic_error);
  figure.curves[0].marks.clear();
  CHECK_NOTHROW(write());
}

}  // namespace foldproof
