// Golden values against the reference, which knows nothing of how they were made: the column order,
// the signs, the laws.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/filters/object_response.h"
#include "reference/forces/sticking.h"
#include "reference/post/depth_map.h"
#include "verification/oracles/golden.h"

using namespace foldproof;

namespace {

/// One row, by the names of its columns.
struct Row {
  const GoldenTable& table;
  const std::vector<double>& values;

  double operator[](const std::string& name) const {
    for (size_t k = 0; k < table.columns.size(); ++k)
      if (table.columns[k].name == name) return values[k];
    throw InputError("no column " + name);
  }
  Vector3 vector(const std::string& name) const {
    return {(*this)[name + "_x"], (*this)[name + "_y"], (*this)[name + "_z"]};
  }
};

template <class Judge>
void for_each_row(const std::string& name, const Judge& judge) {
  const GoldenTable table = golden_values(name, 200, 7);
  REQUIRE(table.rows.size() == 200);
  for (const std::vector<double>& values : table.rows) {
    REQUIRE(values.size() == table.columns.size());
    for (const double value : values) REQUIRE(std::isfinite(value));
    judge(Row{table, values});
  }
}

}  // namespace

TEST_CASE("golden contacts are those of the reference's forecast") {
  for (const std::string name : {"forecast", "friction"}) {
    int answered = 0, stuck = 0;
    for_each_row(name, [&](const Row& row) {
      ObjectPoint at{row["phi"], row.vector("N"), row.vector("v_object")};
      at.friction = name == "friction" ? row["mu"] : 0;
      const Vector3 v = forecast_velocity(at, row.vector("v"), row["tau"]);
      CHECK((v - row.vector("v_new")).norm() < 1e-13 * (1 + row.vector("v_new").norm()));
      answered += v != row.vector("v");
      stuck += (v - at.velocity - (v - at.velocity).dot(at.normal) * at.normal).norm() < 1e-12;
    });
    CHECK(answered > 50);
    CHECK(answered < 150);
    CHECK((stuck > 10) == (name == "friction"));
  }
}

TEST_CASE("golden depths are those of the reference's maps") {
  for_each_row("projection", [](const Row& row) {
    const DepthBand band{row["eps"], row["tau"], row["deepest"]};
    for (const DepthMap& map : depth_maps())
      CHECK(std::abs(map.at(band, row["phi"]) - row["phi_" + std::string(map.name)]) <
            1e-14 * band.reach);
  });
}

TEST_CASE("golden forces add up to nothing, and so do their torques") {
  for_each_row("bending", [](const Row& row) {
    for (const std::string force :
         {"elastic_rest_weighted", "elastic_current_weighted", "damping"}) {
      Vector3 sum = Vector3::Zero(), torque = Vector3::Zero();
      double size = 0;
      for (const std::string k : {"1", "2", "3", "4"}) {
        sum += row.vector(force + k);
        torque += (row.vector("x" + k) - row.vector("x1")).cross(row.vector(force + k));
        size += row.vector(force + k).norm();
      }
      CHECK(sum.norm() <= 1e-15 * size);
      CHECK(torque.norm() <= 1e-15 * size);
    }
  });
  for_each_row("sticking", [](const Row& row) {
    const Vector3 sum =
        row.vector("force") + row.vector("force_a") + row.vector("force_b") + row.vector("force_c");
    CHECK(sum.norm() <= 1e-14 * (row.vector("force").norm() + row.vector("force_a").norm() +
                                 row.vector("force_b").norm() + row.vector("force_c").norm()));
    const Vector3 pull = row["k"] * (row.vector("target") - row.vector("x"));
    CHECK((row.vector("force") - pull).norm() <= 1e-15 * row["k"]);  // targets lie within .4 m
  });
}

TEST_CASE(
    "golden springs pull along themselves, golden steps are near the truth where they are short") {
  for_each_row("springs", [](const Row& row) {
    const Vector3 d = row.vector("xb") - row.vector("xa");
    const double strain = d.norm() / row["L0"] - 1;
    const double stiffness = row["Y"] * row["A"] / row["L0"];
    CHECK(std::abs(row.vector("elastic_a").dot(d.normalized()) - stiffness * strain) <=
          1e-14 * stiffness);
    CHECK(std::abs(row["energy"] - stiffness * row["L0"] / 2 * strain * strain) <=
          1e-14 * stiffness * row["L0"] * std::abs(strain));
    CHECK(row.vector("damping_a").dot(row.vector("va") - row.vector("vb")) <= 0);
  });
  int short_ones = 0;
  for_each_row("integrator", [&](const Row& row) {
    const double omega = std::sqrt(row["k"]), h = row["h"];
    if (omega * h > 0.3 || row["c"] * h > 0.3) return;
    ++short_ones;
    const double size = std::hypot(row["x"], row["v"] / omega);
    for (const std::string scheme : {"A", "B", "C"}) {
      CHECK(std::abs(row["x_" + scheme] - row["x_exact"]) < 0.03 * size);
      CHECK(std::abs(row["v_" + scheme] - row["v_exact"]) < 0.03 * size * omega);
    }
  });
  CHECK(short_ones > 5);
}

TEST_CASE("golden values are the same for the same seed, and refuse what they do not know") {
  for (const std::string& name : golden_names()) {
    const GoldenTable one = golden_values(name, 3, 1), longer = golden_values(name, 5, 1),
                      other = golden_values(name, 3, 2);
    for (size_t k = 0; k < 3; ++k) CHECK(one.rows[k] == longer.rows[k]);
    CHECK(one.rows[0] != other.rows[0]);
  }
  CHECK_THROWS_WITH(golden_values("bend", 1, 1), Catch::Contains("bending, springs"));
  CHECK_THROWS_AS(golden_values("bending", 0, 1), InputError);
}
