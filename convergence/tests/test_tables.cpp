// Parts of tables: columns and groups keep their numbers, units and uncertainties.
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "convergence/tables.h"
#include "verification/oracles/estimate.h"

namespace foldproof {

namespace {

Table runs() {
  Table table{{"scheme", ""}, {"step", "s"}, {"error", "m"}};
  table.row("A", 0.3, oracles::Estimate{4.5, 0.25});
  table.row("C", 0.3, oracles::Estimate{3.0, 0.5});
  table.row("A", 0.15, oracles::Estimate{1.5, 0.125});
  return table;
}

}  // namespace

TEST_CASE("with_columns keeps units, numbers and uncertainties, in the order asked for") {
  const Table part = with_columns(runs(), {"error", "scheme"});
  REQUIRE(part.columns().size() == 2);
  CHECK(part.columns()[0].name == "error");
  CHECK(part.columns()[0].unit == "m");
  CHECK(part.columns()[0].uncertainty == 0.5);
  CHECK(part.numbers("error") == std::vector<double>{4.5, 3.0, 1.5});
  CHECK(part.texts("scheme") == std::vector<std::string>{"A", "C", "A"});
  CHECK_THROWS_AS(with_columns(runs(), {"velocity"}), std::logic_error);
}

TEST_CASE("group_of keeps the rows with the text, without its column") {
  const Table group = group_of(runs(), "scheme", "A");
  REQUIRE(group.columns().size() == 2);
  CHECK(group.numbers("step") == std::vector<double>{0.3, 0.15});
  CHECK(group.numbers("error") == std::vector<double>{4.5, 1.5});
  CHECK(group.column("error").uncertainty == 0.5);
  CHECK(group_of(runs(), "scheme", "B").rows() == 0);
  CHECK_THROWS_AS(group_of(runs(), "step", "A"), std::logic_error);
}

TEST_CASE("stacked puts tables below each other and names their rows") {
  const Table all = stacked({"sheet", "1"}, {{"damped", runs()}, {"free", runs()}});
  REQUIRE(all.columns().size() == 4);
  CHECK(all.columns()[0].unit == "1");
  CHECK(all.texts("sheet") ==
        std::vector<std::string>{"damped", "damped", "damped", "free", "free", "free"});
  CHECK(all.numbers("step") == std::vector<double>{0.3, 0.3, 0.15, 0.3, 0.3, 0.15});
  CHECK(all.column("error").uncertainty == 0.5);
  const Table other = with_columns(runs(), {"scheme", "step"});
  CHECK_THROWS_AS(stacked({"sheet", "1"}, {{"damped", runs()}, {"free", other}}), std::logic_error);
}

TEST_CASE("stacked keeps the larger uncertainty of a later table") {
  Table coarse{{"error", "m"}};
  coarse.row(oracles::Estimate{7.0, 2.5});
  const Table fine = with_columns(runs(), {"error"});
  CHECK(stacked({"mesh", ""}, {{"fine", fine}, {"coarse", coarse}}).column("error").uncertainty ==
        2.5);
}

TEST_CASE("largest_deviation is relative, of either sign, and keeps NaN") {
  Table table{{"measured", "m"}, {"derived", "m"}};
  CHECK(largest_deviation(table, "measured", "derived") == 0);
  table.row(3.0, 4.0);
  table.row(4.5, 4.0);
  CHECK(largest_deviation(table, "measured", "derived") == 0.25);
  table.row(nan, 4.0);
  table.row(12.0, 4.0);
  CHECK(std::isnan(largest_deviation(table, "measured", "derived")));
}

TEST_CASE("largest_ratio divides row by row and keeps NaN") {
  Table table{{"a", "m"}, {"b", "m"}};
  table.row(3.0, 4.0);
  table.row(1.0, 8.0);
  CHECK(largest_ratio(table, "a", "b") == 0.75);
  CHECK(largest_ratio(table, "b", "a") == 8);
  table.row(0.0, 0.0);
  CHECK(std::isnan(largest_ratio(table, "a", "b")));
}

TEST_CASE("last_exponent is the slope between the last two rows") {
  Table table{{"a", "m"}, {"b", "m"}};
  table.row(1.0, 5.0);
  CHECK_THROWS_AS(last_exponent(table, "a", "b"), std::logic_error);
  table.row(2.0, 12.0);
  table.row(6.0, 4.0);
  CHECK(std::abs(last_exponent(table, "a", "b") + 1) < 1e-15);
}

}  // namespace foldproof
