// [[quantity]] of a case: each row of measurable() on a sheet that is placed by hand, with the
// answer of a line of arithmetic; regions, instants, and refusals.
#include <catch2/catch.hpp>
#include <cmath>

#include "verification/cases/expectations.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/cases/small_sheet.h"

namespace foldproof {

using Catch::Matchers::Contains;

namespace {

constexpr double width = 0.3, height = 0.2, area = width * height;  // m, m^2
constexpr double density = 0.2, mass = density * area;              // kg/m^2, kg
constexpr double g = 9.5;                                           // m/s^2

/// Particles 0 .. 11, four in a row along x, rows along y; the object's inside is x < -0.05.
const std::string sheet = small_sheet + R"([[object]]
shape = "half_space"
turn = { axis = [0, 1, 0], angle = 90 }
move = [-0.05, 0, 0]
)";

Case trial(const std::string& quantities) {
  const ScratchFolder folder;
  return read_case(folder.write("trial.toml", sheet + quantities));
}

/// Frames that the case's quantities are taken of, each with the contacts of the step before.
std::vector<double> values_of(const Case& of, const std::vector<State>& frames,
                              const std::vector<long>& contacts = {}) {
  const BuiltScene built = build(of.scene, computing_provider());
  Measurer measurer(of.scene, built, of.quantities);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    Diagnostics row;
    row.linear_momentum = row.angular_momentum = Vector3::Zero();
    row.work.object_contacts = contacts.empty() ? 0 : contacts[k];
    measurer.record(row);
    measurer.record(frames[k]);
  }
  return measurer.values({built.start, 29, {}, {}});
}

/// `what` at the end, if the only frame has these positions and velocities.
double measured(const std::string& quantity, const std::function<void(State&)>& place,
                const Vector3& gravity = Vector3(0, -g, 0)) {
  Case one = trial("[[quantity]]\n" + quantity);
  one.scene.gravity = gravity;
  State state = start_state(one.scene);
  place(state);
  state.time = one.scene.schedule.end;
  return values_of(one, {state}, {7}).at(0);
}

double of_what(const std::string& what, const std::function<void(State&)>& place) {
  return measured("what = \"" + what + "\"", place);
}

void translate(State& s) { s.x.colwise() += Vector3(0.11, 0.23, 0.37); }

/// The height, over frames whose mean heights are these.
double over_frames(const std::string& more, const std::vector<std::pair<double, double>>& frames) {
  const Case one = trial("[[quantity]]\nwhat = \"height\"\n" + more);
  std::vector<State> states;
  for (const auto& [time, h] : frames) {
    states.push_back({time, one.scene.x, one.scene.v});
    states.back().x.row(1).array() += h - height / 2;
  }
  return values_of(one, states).at(0);
}

}  // namespace

TEST_CASE("heights are measured against gravity and weighted with masses") {
  CHECK(of_what("height", translate) == Approx(height / 2 + 0.23));
  CHECK(of_what("lowest", translate) == Approx(0.23));
  CHECK(of_what("highest", translate) == Approx(height + 0.23));
  CHECK(of_what("position", translate) == Approx(height / 2 + 0.23));
  CHECK(measured("what = \"position\"\nalong = [-0.2, 0, 0]", translate) ==
        Approx(-(width / 2 + 0.11)));
  CHECK(of_what("displacement", translate) == Approx(Vector3(0.11, 0.23, 0.37).norm()));
  // the middle row has half of the mass: only weights make it count as much as both others
  const auto lift_middle = [](State& s) { s.x.row(1).segment(4, 4).array() += 0.4; };
  CHECK(of_what("height", lift_middle) == Approx(height / 2 + 0.2));
  CHECK(of_what("displacement", lift_middle) == Approx(0.4 / std::sqrt(2)));
  for (const char* what : {"what = \"height\"", "what = \"position\""}) {
    CHECK(measured(what, translate, Vector3::Zero()) == Approx(height / 2 + 0.23));  // along y
    CHECK(measured(what, translate, Vector3(0, 0, 0.1)) == Approx(-0.37));
  }
}

TEST_CASE("distances and angles are between particles by number") {
  CHECK(measured("what = \"distance\"\nof = { particles = [4, 9] }", translate) ==
        Approx(std::hypot(0.1, 0.1)));
  // at 4 = (0, 0.1): to 1 = (0.1, 0) and to 9 = (0.1, 0.2)
  CHECK(measured("what = \"angle\"\nof = { particles = [1, 4, 9] }", translate) == Approx(90));
  CHECK(measured("what = \"angle\"\nof = { particles = [9, 0, 3] }", translate) ==
        Approx(std::atan2(0.2, 0.1) * 180 / pi));
}

TEST_CASE("the mean curvature of a rolled sheet is that of its cylinder") {
  CHECK(of_what("mean_curvature", translate) == Approx(0).margin(1e-12));
  // columns become chords of a circle: two lines of 0.2 m turn by 2 asin(c/2R) each
  const double radius = 0.17, turn = 2 * std::asin(0.1 / (2 * radius));
  const auto roll = [&](State& s) {
    for (Eigen::Index i = 0; i < s.x.cols(); ++i) {
      const double angle = turn * std::round(s.x(0, i) / 0.1);
      s.x(0, i) = radius * std::sin(angle);
      s.x(2, i) = radius * std::cos(angle);
    }
  };
  CHECK(of_what("mean_curvature", roll) == Approx(2 * turn * height / (2 * area)));
}

TEST_CASE("energies, momenta, speeds, contacts and depths are those of the frame") {
  const Vector3 v(0.7, -1.1, 0.4);
  const auto move = [&](State& s) { translate(s), s.v.colwise() = v; };
  const Vector3 centre(width / 2 + 0.11, height / 2 + 0.23, 0.37);
  CHECK(of_what("kinetic_energy", move) == Approx(mass * v.squaredNorm() / 2));
  CHECK(of_what("gravitational_energy", move) == Approx(mass * g * centre.y()));
  CHECK(of_what("momentum", move) == Approx(mass * v.norm()));
  // of a rigid translation: that of its centre
  CHECK(of_what("angular_momentum", move) == Approx(mass * centre.cross(v).norm()));
  // sum over edges of Y A_e/2 strain^2, each triangle being that of three edges
  const double elastic = 1.5 * 40 * area * 0.05 * 0.05;
  const auto all = [&](State& s) { s.x *= 1.05, s.v.colwise() = v; };
  CHECK(of_what("elastic_energy", all) == Approx(elastic));
  CHECK(of_what("energy", all) ==
        Approx(elastic + mass * v.squaredNorm() / 2 + mass * g * 1.05 * height / 2));
  const auto some = [](State& s) { s.v(0, 3) = 0.5, s.v(2, 7) = -0.2; };
  CHECK(of_what("speed", some) == Approx(0.5));
  CHECK(measured("what = \"speed\"\nof = { particles = [6, 7] }", some) == Approx(0.2));
  CHECK(std::isnan(of_what("speed", [](State& s) { s.v(0, 5) = nan; })));
  CHECK(of_what("contact_points", translate) == 7);
  CHECK(of_what("depth", [](State& s) { s.x.row(0).array() -= 0.07; }) == Approx(0.02));
  CHECK(of_what("depth", translate) == 0);
}

TEST_CASE("a region is a list, a box of the start, or the whole cloth") {
  const Scene scene = trial("").scene;
  CHECK(particles_in({}, scene).size() == 12);
  CHECK(particles_in({{7, 2}, {}}, scene) == std::vector<int>{7, 2});
  const ParticleRegion box{{}, {{scene.x.col(5), scene.x.col(10)}}};  // corners are in it
  CHECK(particles_in(box, scene) == std::vector<int>{5, 6, 9, 10});
  const std::string of = "\nof = { box = [[0.05, 0.05, -1], [0.25, 1, 1]] }";
  const auto lift = [](State& s) { s.x(1, 5) += 5; };  // the same particles stay in the box
  CHECK(measured("what = \"lowest\"" + of, lift) == Approx(0.1));
  CHECK(measured("what = \"highest\"" + of, lift) == Approx(5.1));
  CHECK(measured("what = \"highest\"\nof = { particles = [7, 4] }", lift) == Approx(0.1));
  CHECK(measured("what = \"highest\"\nof = \"all\"", lift) == Approx(5.1));
}

TEST_CASE("a quantity is asked at the end, at a time, or for an extreme over the frames") {
  const std::vector<std::pair<double, double>> frames = {{0, 3},    {0.01, 7}, {0.02, 2},
                                                         {0.03, 4}, {0.04, 5}, {0.05, 6}};
  const std::vector<std::pair<std::string, double>> rows = {
      {"", 6},
      {"when = \"end\"", 6},
      {"when = \"maximum\"", 7},
      {"when = \"minimum\"", 2},
      {"when = 0.023", 2},
      {"when = 0.027", 4},
      {"when = 0", 3},
      {"when = 0.025", 2}};  // the earlier of two as near
  for (const auto& [when, value] : rows) CHECK(over_frames(when, frames) == Approx(value));
  // a time is met to half a frame, an end to a billionth
  const auto is_met = [](const std::string& when, double time) {
    return !std::isnan(over_frames(when, {{time, 1}}));
  };
  CHECK(is_met("", 0.05 + 0.9e-11));
  CHECK(!is_met("", 0.05 - 1.1e-11));
  for (const double time : {0.015, 0.025}) CHECK(is_met("when = 0.02", time));
  for (const double time : {0.0149999, 0.0250001}) CHECK(!is_met("when = 0.02", time));
}

TEST_CASE("a run that stopped has no end, and what it had before") {
  const std::vector<std::pair<double, double>> frames = {{0, 3}, {0.01, 7}, {0.02, 2}};
  CHECK(std::isnan(over_frames("", frames)));
  CHECK(std::isnan(over_frames("when = 0.04", frames)));
  CHECK(over_frames("when = 0.01", frames) == Approx(7));
  CHECK(over_frames("when = \"maximum\"", frames) == Approx(7));
  CHECK(std::isnan(over_frames("when = \"maximum\"", {{0, 3}, {0.01, nan}, {0.02, 5}})));
  CHECK(std::isnan(over_frames("when = \"minimum\"", {{0, 3}, {0.01, nan}, {0.02, 5}})));
}

}  // namespace foldproof
