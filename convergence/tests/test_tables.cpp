// Parts of tables: columns and groups keep their numbers, units and uncertainties.
#include <catch2/catch.hpp>
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

TEST_CASE("group_of keeps the rows with the text, without its column") {
  const Table group = group_of(runs(), "scheme", "A");
  REQUIRE(group.columns().size() == 2);
  CHECK(group.numbers("step") == std::vector<double>{0.3, 0.15});
  CHECK(group.numbers("error") == std::vector<double>{4.5, 1.5});
  CHECK(group.column("error").uncertainty == 0.5);
  CHECK(group_of(runs(), "scheme", "B").rows() == 0);
}

TEST_CASE("stacked keeps the larger uncertainty of a later table") {
  Table coarse{{"error", "m"}};
  coarse.row(oracles::Estimate{7.0, 2.5});
  const Table fine = with_columns(runs(), {"error"});
  const Table all = stacked({"mesh", ""}, {{"fine", fine}, {"coarse", coarse}});
  CHECK(all.column("error").uncertainty == 2.5);
  CHECK(all.texts("mesh") == std::vector<std::string>{"fine", "fine", "fine", "coarse"});
  CHECK(all.numbers("error") == std::vector<double>{4.5, 3, 1.5, 7});
  CHECK_THROWS_AS(stacked({"mesh", ""}, {{"a", runs()}, {"b", fine}}), std::logic_error);
}

TEST_CASE("largest_deviation is relative, of either sign, and keeps NaN") {
  Table table{{"measured", "m"}, {"derived", "m"}};
  CHECK(largest_deviation(table, "measured", "derived") == 0);
  table.row(3.0, 4.0);
  table.row(4.5, 4.0);
  CHECK(largest_deviation(table, "measured", "derived") == 0.25);
  CHECK(largest_ratio(table, "measured", "derived") == 1.125);
  CHECK(last_exponent(with_columns(table, {"derived", "measured"}), "measured", "derived") == 0);
  table.row(nan, 4.0);
  table.row(12.0, 4.0);
  CHECK(std::isnan(largest_deviation(table, "measured", "derived")));
  CHECK(std::isnan(largest_ratio(table, "measured", "derived")));
}

}  // namespace foldproof
