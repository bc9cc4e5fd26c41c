// Golden values: ranges of the inputs, each output in the column of its name, and the
// reference, which knows nothing of how they were made.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/filters/object_response.h"
#include "reference/post/depth_map.h"
#include "verification/oracles/definitions.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/golden.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

/// One row, by the names of its columns.
struct GoldenRow {
  const GoldenTable& table;
  const std::vector<double>& values;

  double operator[](const std::string& name) const {
    for (std::size_t k = 0; k < table.columns.size(); ++k)
      if (table.columns[k].name == name) return values[k];
    throw InputError("no column " + name);
  }
  Vector3 vector(const std::string& name) const {
    return {(*this)[name + "_x"], (*this)[name + "_y"], (*this)[name + "_z"]};
  }
  std::array<Vector3, 4> corners(const std::string& name) const {
    return {vector(name + "1"), vector(name + "2"), vector(name + "3"), vector(name + "4")};
  }
};

template <class Judge>
void for_each_row(const std::string& name, int rows, const Judge& judge) {
  const GoldenTable table = golden_values(name, rows, 7);
  REQUIRE(table.rows.size() == std::size_t(rows));
  for (const std::vector<double>& values : table.rows) {
    REQUIRE(values.size() == table.columns.size());
    judge(GoldenRow{table, values});
  }
}

}  // namespace

TEST_CASE("golden springs and hinges hold the formulas' answers") {
  for_each_row("springs", 20, [](const GoldenRow& row) {
    const SpringInput spring{{row.vector("xa"), row.vector("xb")},
                             {row.vector("va"), row.vector("vb")},
                             {row["Y"], row["kd"], row["A"], row["L0"]}};
    CHECK(row.vector("elastic_a") == spring_elastic_50(spring).value[0]);
    CHECK(row.vector("damping_a") == spring_damping_50(spring).value[0]);
    CHECK(row["energy"] == spring_energy_50(spring).value);
  });
  for_each_row("bending", 20, [](const GoldenRow& row) {
    HingeInput hinge{row.corners("x"), row.corners("v"), row.corners("rest"),
                     row["ke"],        row["kd"],        row["theta0"]};
    CHECK(row["theta"] == hinge_angle_50(hinge.x).value);
    CHECK(row.corners("u") == bending_mode_50(hinge.x).value);
    CHECK(row.corners("elastic_rest_weighted") == bending_elastic_50(hinge).value);
    CHECK(row.corners("damping") == bending_damping_50(hinge).value);
    CHECK(row["energy_rest_weighted"] == bending_energy_50(hinge).value);
    hinge.elastic_geometry = Geometry::current;
    CHECK(row.corners("elastic_current_weighted") == bending_elastic_50(hinge).value);
  });
}

TEST_CASE("golden contacts are those of the reference's forecast") {
  for (const std::string name : {"forecast", "friction"}) {
    int answered = 0, stuck = 0;
    for_each_row(name, 200, [&](const GoldenRow& row) {
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
  for_each_row("projection", 200, [](const GoldenRow& row) {
    const DepthBand band{row["eps"], row["tau"], row["deepest"]};
    for (const DepthMap& map : depth_maps())
      CHECK(std::abs(map.at(band, row["phi"]) - row["phi_" + std::string(map.name)]) <
            1e-14 * band.reach);
  });
}

TEST_CASE("golden forces add up to nothing, and so do their torques") {
  for_each_row("bending", 200, [](const GoldenRow& row) {
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
  for_each_row("sticking", 200, [](const GoldenRow& row) {
    Vector3 sum = row.vector("force");
    double size = sum.norm();
    for (const std::string corner : {"a", "b", "c"}) {
      sum += row.vector("force_" + corner);
      size += row.vector("force_" + corner).norm();
    }
    CHECK(sum.norm() <= 1e-14 * size);
    const Vector3 pull = row["k"] * (row.vector("target") - row.vector("x"));
    CHECK((row.vector("force") - pull).norm() <= 1e-15 * row["k"]);  // targets lie within .4 m
  });
}

TEST_CASE("golden values are the same for the same seed, and refuse what they do not know") {
  for (const std::string& name : golden_names()) {
    const GoldenTable one = golden_values(name, 3, 1), longer = golden_values(name, 5, 1),
                      other = golden_values(name, 3, 2);
    for (size_t k = 0; k < 3; ++k) CHECK(one.rows[k] == longer.rows[k]);
    CHECK(one.rows[0] != other.rows[0]);
  }
  CHECK_THROWS_WITH(golden_values("bend", 1, 1), Catch::Contains("'bend'; known: bending, spr"));
  CHECK_THROWS_AS(golden_values("bending", 0, 1), InputError);
}
