// Columns of golden values: names, units, ranges of the inputs, and each output in the
// column of its name.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <sstream>

#include "verification/oracles/definitions.h"
#include "verification/oracles/depth_maps.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/forecast.h"
#include "verification/oracles/golden.h"
#include "verification/oracles/sticking.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

/// One line a column: name, unit, "in" or "out".
std::vector<std::string> described(const GoldenTable& table) {
  std::vector<std::string> lines;
  for (const GoldenColumn& column : table.columns)
    lines.push_back(column.name + " [" + column.unit + "] " + (column.is_input ? "in" : "out"));
  return lines;
}

/// From lines "NAME [UNIT] in|out"; a name that ends with * stands for its three coordinates, one
/// with # for four corners.
std::vector<std::string> expected_columns(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  const auto add_vector = [&lines](const std::string& name, const std::string& rest) {
    for (const char axis : {'x', 'y', 'z'}) lines.push_back(name + "_" + axis + rest);
  };
  for (std::string line; std::getline(stream, line, ';');) {
    const std::size_t space = line.find(' ');
    const std::string name = line.substr(0, space - 1), rest = line.substr(space);
    if (line[space - 1] == '*')
      add_vector(name, rest);
    else if (line[space - 1] == '#')
      for (const char corner : {'1', '2', '3', '4'}) add_vector(name + corner, rest);
    else
      lines.push_back(line);
  }
  return lines;
}

/// The values of all rows, by name.
struct Columns {
  GoldenTable table;

  Columns(const std::string& name, int rows) : table(golden_values(name, rows, 11)) {}

  std::size_t place(const std::string& name) const {
    for (std::size_t k = 0; k < table.columns.size(); ++k)
      if (table.columns[k].name == name) return k;
    throw InputError("no column " + name);
  }
  double at(std::size_t row, const std::string& name) const { return table.rows[row][place(name)]; }
  Vector3 vector(std::size_t row, const std::string& name) const {
    return {at(row, name + "_x"), at(row, name + "_y"), at(row, name + "_z")};
  }
  std::array<Vector3, 4> corners(std::size_t row, const std::string& name) const {
    return {vector(row, name + "1"), vector(row, name + "2"), vector(row, name + "3"),
            vector(row, name + "4")};
  }
};

/// Do the numbers fill the range, without leaving it?
bool fill(const std::vector<double>& values, double low, double high) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double margin = 0.04 * (high - low);
  return *least >= low && *least <= low + margin && *most <= high && *most >= high - margin;
}

/// One number a row.
template <class Value>
std::vector<double> each(const Columns& columns, const Value& value) {
  std::vector<double> values;
  for (std::size_t row = 0; row < columns.table.rows.size(); ++row) values.push_back(value(row));
  return values;
}

bool fills(const Columns& columns, const std::string& name, double low, double high) {
  return fill(each(columns, [&](std::size_t row) { return columns.at(row, name); }), low, high);
}

bool vectors_fill(const Columns& columns, const std::string& name, double size) {
  return fills(columns, name + "_x", -size, size) && fills(columns, name + "_y", -size, size) &&
         fills(columns, name + "_z", -size, size);
}

}  // namespace

TEST_CASE("golden tables have the columns that the formulas need, in order") {
  CHECK(golden_names() == std::vector<std::string>{"bending", "springs", "integrator", "forecast",
                                                   "friction", "projection", "sticking"});
  const std::vector<std::pair<std::string, std::string>> tables{
      {"bending",
       "x# [m] in;v# [m/s] in;ke [J] in;kd [N s] in;theta0 [rad] in;rest# [m] in;theta [rad] "
       "out;u# [1/m] out;elastic_rest_weighted# [N] out;elastic_current_weighted# [N] out;damping# "
       "[N] out;energy_rest_weighted [J] out"},
      {"springs",
       "xa* [m] in;xb* [m] in;va* [m/s] in;vb* [m/s] in;Y [N/m] in;kd [N s/m] in;A [m^2] in;L0 [m] "
       "in;elastic_a* [N] out;damping_a* [N] out;energy [J] out"},
      {"integrator",
       "k [1/s^2] in;c [1/s] in;x [m] in;v [m/s] in;h [s] in;x_A [m] out;v_A [m/s] out;x_B [m] "
       "out;v_B [m/s] out;x_C [m] out;v_C [m/s] out;x_exact [m] out;v_exact [m/s] out"},
      {"forecast",
       "phi [m] in;N* [1] in;v_object* [m/s] in;v* [m/s] in;tau [s] in;phi_new [m] out;v_new* "
       "[m/s] out"},
      {"friction",
       "phi [m] in;N* [1] in;v_object* [m/s] in;v* [m/s] in;tau [s] in;mu [1] in;phi_new [m] "
       "out;v_new* [m/s] out"},
      {"projection",
       "eps [m] in;tau [m] in;deepest [m] in;phi [m] in;phi_plain [m] out;phi_power [m] "
       "out;phi_blend [m] out"},
      {"sticking",
       "x* [m] in;a* [m] in;b* [m] in;c* [m] in;weight_b [1] in;weight_c [1] in;height [m] in;k0 "
       "[N/m] in;far [m] in;target* [m] out;k [N/m] out;energy [J] out;force* [N] out;force_a* [N] "
       "out;force_b* [N] out;force_c* [N] out"}};
  for (const auto& [name, columns] : tables) {
    const GoldenTable table = golden_values(name, 4, 3);
    CHECK(table.name == name);
    CHECK(described(table) == expected_columns(columns));
    CHECK(table.rows.size() == 4);
    for (const std::vector<double>& row : table.rows) CHECK(row.size() == table.columns.size());
    CHECK(golden_values(name, 1, 3).rows.size() == 1);
  }
}

TEST_CASE("golden numbers are the upper 53 bits of the Mersenne twister's") {
  std::mt19937_64 bits(11);
  const auto share = [&bits] { return double(bits() >> 11) / 9007199254740992.0; };
  const GoldenTable table = golden_values("projection", 3, 11);
  for (const std::vector<double>& row : table.rows) {
    const double tau = 0.002 + 0.018 * share(), eps = tau * (0.01 + 0.49 * share()),
                 deepest = tau * (0.5 + 5.5 * share());
    CHECK(row[1] == Approx(tau).epsilon(1e-14));
    CHECK(row[0] == Approx(eps).epsilon(1e-14));
    CHECK(row[2] == Approx(deepest).epsilon(1e-14));
    CHECK(row[3] == Approx(-deepest + (tau + deepest) * share()).margin(1e-16));
  }
}

TEST_CASE("golden directions are those of vectors in a ball without its middle") {
  std::mt19937_64 bits(11);
  const auto within = [&bits](double low, double high) {
    return low + (high - low) * (double(bits() >> 11) / 9007199254740992.0);
  };
  const Columns columns("forecast", 2500);
  for (std::size_t row = 0; row < 2500; ++row) {
    within(-0.01, 0.02);
    Vector3 v = Vector3::Zero();
    while (v.norm() <= 0.1 || v.norm() >= 1)
      for (double& component : v) component = within(-1, 1);
    REQUIRE((columns.vector(row, "N") - v.normalized()).norm() < 1e-15);
    for (int rest = 0; rest < 7; ++rest) within(0, 1);
  }
}

TEST_CASE("golden contacts cover their ranges, and hold the formula's answers") {
  for (const std::string name : {"forecast", "friction"}) {
    const Columns columns(name, 400);
    CHECK(fills(columns, "phi", -0.01, 0.02));
    CHECK(vectors_fill(columns, "v_object", 1));
    CHECK(vectors_fill(columns, "v", 2));
    CHECK(fills(columns, "tau", 0.001, 0.02));
    if (name == "friction") CHECK(fills(columns, "mu", 0, 1.5));
    for (std::size_t row = 0; row < 400; ++row) {
      CHECK(std::abs(columns.vector(row, "N").norm() - 1) < 4e-16);
      const ForecastAnswer answer =
          forecast_answer({columns.at(row, "phi"), columns.vector(row, "N"),
                           columns.vector(row, "v_object"), columns.vector(row, "v"),
                           columns.at(row, "tau"), name == "friction" ? columns.at(row, "mu") : 0});
      CHECK(columns.at(row, "phi_new") == answer.phi_new);
      CHECK(columns.vector(row, "v_new") == answer.v);
    }
  }
}

TEST_CASE("golden depths cover their ranges, and hold the maps' answers") {
  const Columns columns("projection", 400);
  CHECK(fills(columns, "tau", 0.002, 0.02));
  const auto over_tau = [&](const std::string& name) {
    return each(columns,
                [&](std::size_t row) { return columns.at(row, name) / columns.at(row, "tau"); });
  };
  CHECK(fill(over_tau("eps"), 0.01, 0.5));
  CHECK(fill(over_tau("deepest"), 0.5, 6));
  CHECK(fill(each(columns,
                  [&](std::size_t row) {
                    const double deepest = columns.at(row, "deepest");
                    return (columns.at(row, "phi") + deepest) / (columns.at(row, "tau") + deepest);
                  }),
             0, 1));
  for (std::size_t row = 0; row < 400; ++row) {
    const Band band{columns.at(row, "eps"), columns.at(row, "tau"), columns.at(row, "deepest")};
    const double phi = columns.at(row, "phi");
    CHECK(columns.at(row, "phi_plain") == std::max(phi, band.nearest));
    CHECK(columns.at(row, "phi_power") == power_map(band, phi).value);
    CHECK(columns.at(row, "phi_blend") == blend_map(band, phi).value);
  }
}

TEST_CASE("golden springs cover their ranges, and hold the laws' answers") {
  const Columns columns("springs", 400);
  for (const std::string end : {"a", "b"}) {
    CHECK(vectors_fill(columns, "x" + end, 0.05));
    CHECK(vectors_fill(columns, "v" + end, 1));
  }
  CHECK(fills(columns, "Y", 1, 1000));
  CHECK(fills(columns, "kd", 0.001, 1));
  CHECK(fills(columns, "A", 1e-5, 1e-3));
  CHECK(fills(columns, "L0", 0.01, 0.1));
  for (std::size_t row = 0; row < 400; ++row) {
    const SpringInput spring{
        {columns.vector(row, "xa"), columns.vector(row, "xb")},
        {columns.vector(row, "va"), columns.vector(row, "vb")},
        {columns.at(row, "Y"), columns.at(row, "kd"), columns.at(row, "A"), columns.at(row, "L0")}};
    CHECK(columns.vector(row, "elastic_a") == spring_elastic_50(spring).value[0]);
    CHECK(columns.vector(row, "damping_a") == spring_damping_50(spring).value[0]);
    CHECK(columns.at(row, "energy") == spring_energy_50(spring).value);
  }
}

TEST_CASE("golden oscillators cover their ranges, and hold the schemes' answers") {
  const Columns columns("integrator", 400);
  const auto omega = [&](std::size_t row) { return std::sqrt(columns.at(row, "k")); };
  CHECK(fill(each(columns, [&](std::size_t row) { return std::log10(omega(row)); }), -1, 3));
  CHECK(
      fill(each(columns,
                [&](std::size_t row) { return std::log10(columns.at(row, "c") / omega(row) / 2); }),
           -3, 2));
  CHECK(fills(columns, "x", -1, 1));
  CHECK(fill(each(columns, [&](std::size_t row) { return columns.at(row, "v") / omega(row); }), -1,
             1));
  CHECK(fill(each(columns, [&](std::size_t row) { return columns.at(row, "h") * omega(row); }),
             0.01, 1.9));
  for (std::size_t row = 0; row < 400; ++row) {
    const Oscillator oscillator{columns.at(row, "k"), columns.at(row, "c"), columns.at(row, "x"),
                                columns.at(row, "v")};
    const double h = columns.at(row, "h");
    for (const auto& [name, scheme] : {std::pair<std::string, Scheme>{"A", Scheme::mixed},
                                       {"B", Scheme::central_newmark},
                                       {"C", Scheme::variable_step_newmark}}) {
      const OscillatorEstimate after = stepped_oscillator(scheme, oscillator, h);
      CHECK(columns.at(row, "x_" + name) == after.x.value);
      CHECK(columns.at(row, "v_" + name) == after.v.value);
    }
    const OscillatorEstimate truth = oscillator_at(oscillator, h);
    CHECK(columns.at(row, "x_exact") == truth.x.value);
    CHECK(columns.at(row, "v_exact") == truth.v.value);
  }
}

TEST_CASE("golden hinges cover their ranges, and hold the formulas' answers") {
  const Columns columns("bending", 200);
  for (const std::string which : {"x", "rest"}) {
    const auto corner = [&](std::size_t row, int k) {
      return Vector3(columns.corners(row, which)[std::size_t(k)] - columns.corners(row, which)[2]);
    };
    const auto values = [&](const auto& of) { return each(columns, of); };
    CHECK(fill(values([&](std::size_t row) { return corner(row, 3).y(); }), 0.01, 0.05));
    CHECK(fill(values([&](std::size_t row) {
                 return std::atan2(corner(row, 1).z(), -corner(row, 1).x());
               }),
               -2.9, 2.9));
    CHECK(fill(
        values([&](std::size_t row) { return std::hypot(corner(row, 1).x(), corner(row, 1).z()); }),
        0.005, 0.05));
    CHECK(fill(values([&](std::size_t row) { return corner(row, 1).y(); }), -0.01, 0.06));
    // the two triangles are drawn each for itself
    const auto alike = values([&](std::size_t row) {
      return std::abs(corner(row, 0).y() - corner(row, 1).y()) < 0.002 ||
             std::abs(corner(row, 0).x() - std::hypot(corner(row, 1).x(), corner(row, 1).z())) <
                 0.0015;
    });
    CHECK(std::count(alike.begin(), alike.end(), 1) < 40);
    // corner 1 is off its place by up to a millimetre
    CHECK(fill(values([&](std::size_t row) { return corner(row, 0).z(); }), -0.001, 0.001));
    for (std::size_t row = 0; row < 200; ++row) {
      const Vector3 place = corner(row, 0);
      CHECK((place.x() > 0.004 && place.x() < 0.051 && place.y() > -0.011 && place.y() < 0.061));
    }
    CHECK(vectors_fill(columns, which + "3", 0.3));
  }
  for (const std::string k : {"1", "2", "3", "4"}) CHECK(vectors_fill(columns, "v" + k, 1));
  CHECK(fill(each(columns, [&](std::size_t row) { return std::log10(columns.at(row, "ke")); }), -6,
             -1));
  CHECK(fill(
      each(columns, [&](std::size_t row) { return columns.at(row, "kd") / columns.at(row, "ke"); }),
      0.001, 0.1));
  CHECK(fills(columns, "theta0", -3, 3));
  for (std::size_t row = 0; row < 20; ++row) {
    HingeInput hinge;
    hinge.x = columns.corners(row, "x");
    hinge.v = columns.corners(row, "v");
    hinge.rest = columns.corners(row, "rest");
    hinge.ke = columns.at(row, "ke");
    hinge.kd = columns.at(row, "kd");
    hinge.theta0 = columns.at(row, "theta0");
    CHECK(columns.at(row, "theta") == hinge_angle_50(hinge.x).value);
    CHECK(columns.corners(row, "u") == bending_mode_50(hinge.x).value);
    CHECK(columns.corners(row, "elastic_rest_weighted") == bending_elastic_50(hinge).value);
    CHECK(columns.corners(row, "damping") == bending_damping_50(hinge).value);
    CHECK(columns.at(row, "energy_rest_weighted") == bending_energy_50(hinge).value);
    hinge.elastic_geometry = Geometry::current;
    CHECK(columns.corners(row, "elastic_current_weighted") == bending_elastic_50(hinge).value);
  }
}

TEST_CASE("golden bonds cover their ranges, and hold the formulas' answers") {
  const Columns columns("sticking", 300);
  CHECK(vectors_fill(columns, "a", 0.3));
  for (const std::string corner : {"b", "c"})
    for (int axis = 0; axis < 3; ++axis)
      CHECK(fill(each(columns,
                      [&](std::size_t row) {
                        return columns.vector(row, corner)[axis] - columns.vector(row, "a")[axis];
                      }),
                 -0.03 - 1e-15, 0.03 + 1e-15));
  for (const std::string weight : {"weight_b", "weight_c"}) CHECK(fills(columns, weight, 0, 0.5));
  CHECK(fills(columns, "height", 0, 0.01));
  CHECK(fills(columns, "k0", 1, 1000));
  CHECK(fills(columns, "far", 0.01, 0.05));
  CHECK(fill(each(columns,
                  [&](std::size_t row) {
                    return (columns.vector(row, "x") - columns.vector(row, "target")).norm() /
                           columns.at(row, "far");
                  }),
             0.01, 0.95));
  for (std::size_t row = 0; row < 30; ++row) {
    const StickingAnswer answer = sticking_answer(
        {columns.vector(row, "x"),
         {{columns.vector(row, "a"), columns.vector(row, "b"), columns.vector(row, "c")}},
         {{columns.at(row, "weight_b"), columns.at(row, "weight_c"), columns.at(row, "height")}},
         columns.at(row, "k0"),
         columns.at(row, "far")});
    CHECK(columns.vector(row, "target") == answer.target);
    CHECK(columns.at(row, "k") == answer.stiffness);
    CHECK(columns.at(row, "energy") == answer.energy);
    int first = 0;
    for (const std::string on : {"force", "force_a", "force_b", "force_c"}) {
      CHECK(columns.vector(row, on) == answer.force.segment<3>(first));
      first += 3;
    }
  }
}

TEST_CASE("an unknown golden table is named, with all that are known") {
  CHECK_THROWS_WITH(golden_values("bend", 1, 1),
                    "there are no golden values of 'bend'; known: bending, springs, integrator, "
                    "forecast, friction, projection, sticking");
  CHECK_THROWS_WITH(golden_values("springs", 0, 1), "golden values: count must be at least 1");
}
