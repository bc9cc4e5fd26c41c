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
const std::string sheet = small_sheet + R"([gravity]
acceleration = [0, -9.5, 0]
[time]
end = 0.05
frames_per_second = 100
[[object]]
shape = "half_space"
turn = { axis = [0, 1, 0], angle = 90 }
move = [-0.05, 0, 0]
)";

Case trial(const std::string& quantities) {
  const ScratchFolder folder;
  return read_case(folder.write("trial.toml", sheet + quantities));
}

/// `what` at the end, if all frames have these positions and velocities.
double measured(const std::string& quantity, const std::function<void(State&)>& place,
                long contacts = 0) {
  const Case one = trial("[[quantity]]\n" + quantity);
  const BuiltScene built = build(one.scene, computing_provider());
  Measurer measurer(one.scene, built, one.quantities);
  State state = built.start;
  place(state);
  state.time = one.scene.schedule.end;
  Diagnostics row;
  row.work.object_contacts = contacts;
  measurer.record(row);
  measurer.record(state);
  return measurer.values({state, 1, {}, {}}).at(0);
}

double of_what(const std::string& what, const std::function<void(State&)>& place) {
  return measured("what = \"" + what + "\"", place);
}

void translate(State& s) { s.x.colwise() += Vector3(0.11, 0.23, 0.37); }

/// `what` of runs whose mean height is that of each frame.
double over_frames(const std::string& more, const std::vector<std::pair<double, double>>& frames) {
  const Case one = trial("[[quantity]]\nwhat = \"height\"\n" + more);
  const BuiltScene built = build(one.scene, computing_provider());
  Measurer measurer(one.scene, built, one.quantities);
  for (const auto& [time, h] : frames) {
    State s = built.start;
    s.time = time;
    s.x.row(1).array() += h - height / 2;
    measurer.record(s);
  }
  return measurer.values({built.start, 1, {}, {}}).at(0);
}

std::string refusal(const std::string& quantities) {
  try {
    trial(quantities);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("heights are measured against gravity and weighted with masses") {
  CHECK(of_what("height", translate) == Approx(height / 2 + 0.23));
  CHECK(of_what("lowest", translate) == Approx(0.23));
  CHECK(of_what("highest", translate) == Approx(height + 0.23));
  CHECK(of_what("position", translate) == Approx(height / 2 + 0.23));
  CHECK(measured("what = \"position\"\nalong = [-2, 0, 0]", translate) ==
        Approx(-(width / 2 + 0.11)));
  // the middle row has half of the mass: only weights make it count as much as both others
  const auto lift_middle = [](State& s) { s.x.row(1).segment(4, 4).array() += 0.4; };
  CHECK(of_what("height", lift_middle) == Approx(height / 2 + 0.2));
}

TEST_CASE("displacement is the root mean square over masses of the way from the start") {
  CHECK(of_what("displacement", translate) == Approx(Vector3(0.11, 0.23, 0.37).norm()));
  const auto lift_middle = [](State& s) { s.x.row(2).segment(4, 4).array() += 0.4; };
  CHECK(of_what("displacement", lift_middle) == Approx(0.4 / std::sqrt(2)));
}

TEST_CASE("distances and angles are between particles by number") {
  const std::string particles = "\nof = { particles = [1, 4, 9] }";
  CHECK(measured("what = \"distance\"\nof = { particles = [4, 9] }", translate) ==
        Approx(std::hypot(0.1, 0.1)));
  // at 4 = (0, 0.1): to 1 = (0.1, 0) and to 9 = (0.1, 0.2)
  CHECK(measured("what = \"angle\"" + particles, translate) == Approx(90));
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

TEST_CASE("energies and momenta are those of a moving stretched sheet") {
  const Vector3 v(0.7, -1.1, 0.4);
  const auto move = [&](State& s) {
    translate(s);
    s.v.colwise() = v;
  };
  const Vector3 centre(width / 2 + 0.11, height / 2 + 0.23, 0.37);
  CHECK(of_what("kinetic_energy", move) == Approx(mass * v.squaredNorm() / 2));
  CHECK(of_what("gravitational_energy", move) == Approx(mass * g * centre.y()));
  CHECK(of_what("momentum", move) == Approx(mass * v.norm()));
  // of a rigid translation: that of its centre
  CHECK(of_what("angular_momentum", move) == Approx(mass * centre.cross(v).norm()));
  // sum over edges of Y A_e/2 strain^2, each triangle being that of three edges
  const double elastic = 1.5 * 40 * area * 0.05 * 0.05;
  const auto stretch = [](State& s) { s.x *= 1.05; };
  CHECK(of_what("elastic_energy", stretch) == Approx(elastic));
  const auto all = [&](State& s) {
    stretch(s);
    s.v.colwise() = v;
  };
  CHECK(of_what("energy", all) ==
        Approx(elastic + mass * v.squaredNorm() / 2 + mass * g * 1.05 * height / 2));
}

TEST_CASE("the speed is that of the fastest particle of the region") {
  const auto move = [](State& s) {
    s.v.col(3) = Vector3(0.3, -0.4, 0);
    s.v.col(7) = Vector3(0, 0, 0.2);
  };
  CHECK(of_what("speed", move) == Approx(0.5));
  CHECK(measured("what = \"speed\"\nof = { particles = [6, 7] }", move) == Approx(0.2));
  const auto lost = [](State& s) { s.v(0, 5) = nan; };
  CHECK(std::isnan(of_what("speed", lost)));
}

TEST_CASE("contact points are those of the step before, depths those inside objects") {
  CHECK(measured("what = \"contact_points\"", translate, 7) == 7);
  const auto sink = [](State& s) { s.x.row(0).array() -= 0.05 + 0.02; };
  CHECK(of_what("depth", sink) == Approx(0.02));
  CHECK(of_what("depth", translate) == 0);
}

TEST_CASE("all rows of the table are known by name and unit") {
  for (const Measurable& row : measurable()) {
    INFO(row.what);
    const std::string of = row.particles == 2   ? "\nof = { particles = [1, 2] }"
                           : row.particles == 3 ? "\nof = { particles = [1, 2, 7] }"
                                                : "";
    const Case one = trial("[[quantity]]\nwhat = \"" + std::string(row.what) + "\"" + of);
    CHECK(one.quantities.at(0).name == row.what);
    CHECK(unit_of(one.quantities[0]) == row.unit);
    CHECK(std::isfinite(measured("what = \"" + std::string(row.what) + "\"" + of, translate)));
  }
}

TEST_CASE("a region is a list, a box of the start, or the whole cloth") {
  const Scene scene = trial("").scene;
  CHECK(particles_in({}, scene).size() == 12);
  CHECK(particles_in({{7, 2}, {}}, scene) == std::vector<int>{7, 2});
  const ParticleRegion box{{}, {{Vector3(0.05, 0.05, -1), Vector3(0.25, 1, 1)}}};
  CHECK(particles_in(box, scene) == std::vector<int>{5, 6, 9, 10});
  const auto lift = [](State& s) { s.x(1, 5) += 5; };  // who is in the box does not change
  CHECK(measured("what = \"lowest\"\nof = { box = [[0.05, 0.05, -1], [0.25, 1, 1]] }", lift) ==
        Approx(0.1));
  CHECK(measured("what = \"highest\"\nof = { box = [[0.05, 0.05, -1], [0.25, 1, 1]] }", lift) ==
        Approx(5.1));
}

TEST_CASE("a quantity is asked at the end, at a time, or for an extreme over the frames") {
  const std::vector<std::pair<double, double>> frames = {{0, 3},    {0.01, 7}, {0.02, 2},
                                                         {0.03, 4}, {0.04, 5}, {0.05, 6}};
  CHECK(over_frames("", frames) == Approx(6));
  CHECK(over_frames("when = \"end\"", frames) == Approx(6));
  CHECK(over_frames("when = \"maximum\"", frames) == Approx(7));
  CHECK(over_frames("when = \"minimum\"", frames) == Approx(2));
  CHECK(over_frames("when = 0.023", frames) == Approx(2));
  CHECK(over_frames("when = 0.027", frames) == Approx(4));
  CHECK(over_frames("when = 0", frames) == Approx(3));
  CHECK(over_frames("when = 0.025", frames) == Approx(2));  // the earlier of two as near
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

TEST_CASE("quantities of [expect] are measured as there: the largest over all frames") {
  const auto sink = [](State& s) { s.x.row(0).array() -= 0.05 + 0.02; };
  CHECK(of_what("stays_outside", sink) == Approx(0.02));
  CHECK(of_what("takes_steps", translate) == 1);
  CHECK(unit_of({"", "stays_outside"}) == "m");
}

TEST_CASE("what is measured without being asked depends on the scene") {
  const Case one = trial("");
  std::vector<std::string> names;
  for (const Measurement& m : usual_measurements(one.scene, {"stays_outside", "takes_steps"}))
    names.push_back(m.name);
  CHECK(names == std::vector<std::string>{"kinetic_energy", "elastic_energy", "height", "lowest",
                                          "stays_outside"});
  Scene weightless = one.scene;
  weightless.gravity.reset();
  CHECK(usual_measurements(weightless, {}).size() == 2);
}

TEST_CASE("a quantity that cannot be is refused with its place") {
  const std::string q = "[[quantity]]\nwhat = ";
  CHECK_THAT(refusal(q + "\"hieght\""), Contains("trial.toml:20") && Contains("'hieght'") &&
                                            Contains("known: height, lowest"));
  CHECK_THAT(refusal(q + "\"distance\""), Contains("needs of = { particles = [...] } with 2"));
  CHECK_THAT(refusal(q + "\"angle\"\nof = { particles = [1, 2] }"), Contains("with 3 numbers"));
  CHECK_THAT(refusal(q + "\"height\"\nof = { particles = [12] }"), Contains("trial.toml:21"));
  CHECK_THAT(refusal(q + "\"height\"\nof = { box = [[5, 5, 5], [6, 6, 6]] }"),
             Contains("names no particle"));
  CHECK_THAT(refusal(q + "\"height\"\nof = \"none\""), Contains("must be \"all\""));
  CHECK_THAT(refusal(q + "\"height\"\nwhen = \"ende\""), Contains("known: end, maximum, minimum"));
  CHECK_THAT(refusal(q + "\"height\"\nwhen = 0.06"), Contains("outside the run"));
  CHECK_THAT(refusal(q + "\"height\"\nalong = [1, 0, 0]"), Contains("along"));
  CHECK_THAT(refusal(q + "\"position\"\nalong = [0, 0, 0]"), Contains("must not be zero"));
  CHECK_THAT(refusal(q + "\"energy\"\nof = { particles = [1] }"), Contains("whole cloth"));
  CHECK_THAT(refusal(q + "\"stays_outside\"\nwhen = \"end\""), Contains("leave out 'when'"));
  CHECK_THAT(refusal(q + "\"stays_outside\"\nof = \"all\""), Contains("leave out 'of'"));
  CHECK_THAT(refusal(q + "\"is_reproducible\""), Contains("repeats steps"));
  CHECK_THAT(refusal(q + "\"sticks\""), Contains("makes no sense here"));
  CHECK_THAT(refusal("[[quantity]]\nname = \"x\""), Contains("what"));
  CHECK_THAT(refusal(q + "\"height\"\n" + q + "\"height\""),
             Contains("two quantities are called 'height'"));
  CHECK(refusal(q + "\"height\"\nname = \"a\"\n" + q + "\"height\"").empty());
}

}  // namespace foldproof
