// [[quantity]] of a case on random places: every row against its definition; and its messages.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "reference/bodies/level_set_provider.h"
#include "verification/cases/expectations.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/cases/small_sheet.h"

using namespace foldproof;

namespace {

const std::string sheet = small_sheet + R"(grading = 2.5
[bending]
stiffness = 0.01
[gravity]
acceleration = [1.2, -9.5, 2.3]
[time]
end = 0.05
frames_per_second = 100
)";

Case trial(const std::string& quantities) {
  const ScratchFolder folder;
  return read_case(folder.write("trial.toml", sheet + quantities));
}

Approx exactly(double value) { return Approx(value).epsilon(1e-10).margin(1e-13); }

PerParticle3 random_places(double reach, unsigned seed) {
  std::mt19937 bits(seed);
  std::uniform_real_distribution<double> within(-reach, reach);
  PerParticle3 x(3, 12);
  for (double& number : x.reshaped()) number = within(bits);
  return x;
}

/// Places, speeds and masses of a trial, and the direction against its weight.
struct Crumpled {
  Case of = trial("");
  BuiltScene built = build(of.scene, computing_provider());
  PerParticle3 x = of.scene.x + random_places(0.07, 5), v = random_places(2, 9);
  const PerParticle& mass = built.system.mass;
  Vector3 up = -Vector3(1.2, -9.5, 2.3).normalized();

  State state() const { return {0.05, x, v}; }
  double measured(const std::string& quantity) const {
    const Case one = trial("[[quantity]]\n" + quantity);
    Measurer measurer(one.scene, built, one.quantities);
    measurer.record(state());
    return measurer.values({state(), 1, {}, {}}).at(0);
  }
  double of_what(const std::string& what) const { return measured("what = \"" + what + "\""); }
  Vector3 mean(const std::vector<int>& particles) const {
    Vector3 sum = Vector3::Zero();
    double weight = 0;
    for (const int i : particles) sum += mass[i] * x.col(i), weight += mass[i];
    return sum / weight;
  }
};

const std::vector<int> everything = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};

std::string refusal(const std::string& quantities) {
  try {
    trial(quantities);
  } catch (const InputError& error) {
    const std::string message = error.what();
    return message.substr(message.find("trial.toml"));
  }
  return "";
}

}  // namespace

TEST_CASE("measurements: heights and positions are means by mass, along the right direction") {
  const Crumpled cloth;
  const std::vector<int> some = {8, 1, 5};
  const std::string of = "\nof = { particles = [8, 1, 5] }";
  CHECK(cloth.of_what("height") == exactly(cloth.up.dot(cloth.mean(everything))));
  CHECK(cloth.measured("what = \"height\"" + of) == exactly(cloth.up.dot(cloth.mean(some))));
  CHECK(cloth.measured("what = \"position\"" + of) == exactly(cloth.up.dot(cloth.mean(some))));
  CHECK(cloth.measured("what = \"position\"\nalong = [2, -3, 6]" + of) ==
        exactly(Vector3(2, -3, 6).dot(cloth.mean(some)) / 7));
  double lowest = 1e9, highest = -1e9, fastest = 0, squares = 0, weight = 0;
  for (const int i : some) {
    lowest = std::min(lowest, cloth.up.dot(cloth.x.col(i)));
    highest = std::max(highest, cloth.up.dot(cloth.x.col(i)));
    fastest = std::max(fastest, cloth.v.col(i).norm());
    squares += cloth.mass[i] * (cloth.x.col(i) - cloth.of.scene.x.col(i)).squaredNorm();
    weight += cloth.mass[i];
  }
  CHECK(cloth.measured("what = \"lowest\"" + of) == exactly(lowest));
  CHECK(cloth.measured("what = \"highest\"" + of) == exactly(highest));
  CHECK(cloth.measured("what = \"speed\"" + of) == exactly(fastest));
  CHECK(cloth.measured("what = \"displacement\"" + of) == exactly(std::sqrt(squares / weight)));
}

TEST_CASE("measurements: up is y without a weight, or with one of zero") {
  Crumpled cloth;
  for (const bool is_zero : {false, true}) {
    Case one = trial("[[quantity]]\nwhat = \"height\"\n[[quantity]]\nwhat = \"position\"\n");
    one.scene.gravity.reset();
    if (is_zero) one.scene.gravity = Vector3::Zero();
    Measurer measurer(one.scene, cloth.built, one.quantities);
    measurer.record(cloth.state());
    for (const double value : measurer.values({cloth.state(), 1, {}, {}}))
      CHECK(value == exactly(cloth.mean(everything).y()));
  }
}

TEST_CASE("measurements: a small weight and a short direction count by their direction") {
  Crumpled cloth;
  Case one = trial(
      "[[quantity]]\nwhat = \"height\"\n[[quantity]]\nwhat = \"position\"\n"
      "along = [0.2, -0.3, 0.6]\n");
  one.scene.gravity = Vector3(0.6, 0.2, -0.3);
  Measurer measurer(one.scene, cloth.built, one.quantities);
  measurer.record(cloth.state());
  const std::vector<double> values = measurer.values({cloth.state(), 1, {}, {}});
  CHECK(values.at(0) == exactly(-Vector3(0.6, 0.2, -0.3).dot(cloth.mean(everything)) / 0.7));
  CHECK(values.at(1) == exactly(Vector3(0.2, -0.3, 0.6).dot(cloth.mean(everything)) / 0.7));
}

TEST_CASE("measurements: distances, angles and the mean curvature of a crumpled sheet") {
  const Crumpled cloth;
  const auto p = [&](int i) { return Vector3(cloth.x.col(i)); };
  CHECK(cloth.measured("what = \"distance\"\nof = { particles = [9, 2] }") ==
        exactly((p(9) - p(2)).norm()));
  const double a = (p(9) - p(2)).norm(), b = (p(6) - p(2)).norm(), c = (p(9) - p(6)).norm();
  CHECK(cloth.measured("what = \"angle\"\nof = { particles = [9, 2, 6] }") ==
        exactly(std::acos((a * a + b * b - c * c) / (2 * a * b)) * 180 / pi));
  double turned = 0, area = 0;
  for (const Hinge& hinge : cloth.of.scene.mesh.hinges) {
    const auto& h = hinge.particles;
    const Vector3 n1 = (p(h[0]) - p(h[2])).cross(p(h[0]) - p(h[3])),
                  n2 = (p(h[1]) - p(h[3])).cross(p(h[1]) - p(h[2]));
    turned += std::atan2(n1.cross(n2).norm(), n1.dot(n2)) * (p(h[3]) - p(h[2])).norm();
  }
  for (const Triangle& t : cloth.of.scene.mesh.triangles)
    area += (p(t[0]) - p(t[2])).cross(p(t[1]) - p(t[2])).norm() / 2;
  CHECK(cloth.of_what("mean_curvature") == exactly(turned / (2 * area)));
}

TEST_CASE("measurements: energies and momenta of a crumpled sheet") {
  const Crumpled cloth;
  double kinetic = 0, weight = 0;
  Vector3 momentum = Vector3::Zero(), spin = Vector3::Zero();
  for (const int i : everything) {
    const Vector3 x = cloth.x.col(i), v = cloth.v.col(i);
    kinetic += cloth.mass[i] * v.squaredNorm() / 2;
    weight -= cloth.mass[i] * x.dot(Vector3(1.2, -9.5, 2.3));
    momentum += cloth.mass[i] * v, spin += cloth.mass[i] * x.cross(v);
  }
  const Energies e = energies(cloth.built.system, cloth.state());
  CHECK(e.stretch > 1e-3);
  CHECK(e.bending > 1e-5);
  CHECK(cloth.of_what("kinetic_energy") == exactly(kinetic));
  CHECK(cloth.of_what("gravitational_energy") == exactly(weight));
  CHECK(cloth.of_what("elastic_energy") == exactly(e.stretch + e.bending));
  CHECK(cloth.of_what("energy") == exactly(kinetic + weight + e.stretch + e.bending));
  CHECK(cloth.of_what("momentum") == exactly(momentum.norm()));
  CHECK(cloth.of_what("angular_momentum") == exactly(spin.norm()));
  CHECK(cloth.of_what("contact_points") == 0);
  CHECK(cloth.of_what("depth") == 0);  // without an object
}

TEST_CASE("measurements: each row has its unit and as many particles as it needs") {
  std::vector<std::string> rows;
  for (const Measurable& row : measurable())
    rows.push_back(std::string(row.what) + " " + row.unit + " " + std::to_string(row.particles));
  CHECK(rows == std::vector<std::string>{
                    "height m 0", "lowest m 0", "highest m 0", "position m 0", "displacement m 0",
                    "distance m 2", "angle degrees 3", "mean_curvature 1/m -1", "speed m/s 0",
                    "kinetic_energy J -1", "elastic_energy J -1", "gravitational_energy J -1",
                    "energy J -1", "momentum kg m/s -1", "angular_momentum kg m^2/s -1",
                    "contact_points 1 -1", "depth m -1"});
  CHECK(unit_of({"", "reaches_turning_rate"}) == "degrees/s");
  CHECK(unit_of({"", "nothing_known"}) == "1");
}

TEST_CASE("measurements: a message names the place, the key and what is known") {
  const std::string q = "[[quantity]]\nwhat = ";
  std::string known;
  for (const Measurable& row : measurable()) known += std::string(row.what) + ", ";
  CHECK(refusal(q + "\"hieght\"") ==
        "trial.toml:19: unknown quantity 'hieght'; known: " + known + "and the keys of [expect]");
  CHECK(refusal(q + "\"height\"\nof = \"none\"") ==
        "trial.toml:20: 'of' must be \"all\", { particles = [...] } or { box = [[x, y, z], [x, y, "
        "z]] }");
  CHECK(refusal(q + "\"height\"\nof = { box = [[5, 5, 5], [6, 6, 6]] }") ==
        "trial.toml:20: 'of' names no particle of the cloth's start");
  CHECK(refusal(q + "\"height\"\nwhen = 0.0501") ==
        "trial.toml:20: 'when' is a time outside the run [s]");
  CHECK(refusal(q + "\"height\"\nwhen = -1e-9") ==
        "trial.toml:20: 'when' is a time outside the run [s]");
  CHECK(refusal(q + "\"height\"\nwhen = 0.05") == "");
  CHECK(refusal(q + "\"height\"\nwhen = 0") == "");
  CHECK_THAT(refusal(q + "\"height\"\nof = { box = [[0, 0, 0]] }"),
             Catch::Matchers::Contains("'box' must be two points"));
  CHECK(refusal(q + "\"is_reproducible\"") ==
        "trial.toml:19: 'is_reproducible' repeats steps, so it is not a number of one run; use "
        "[expect]");
  for (const char* key : {"of = \"all\"", "when = \"end\""}) {
    const std::string name = std::string(key).substr(0, std::string(key).find(' '));
    CHECK(refusal(q + "\"stays_flat\"\n" + key) ==
          "trial.toml:20: 'stays_flat' is measured as [expect] does; leave out '" + name + "'");
  }
  CHECK(refusal(q + "\"sticks\"") ==
        "trial.toml:19: 'sticks' makes no sense here: the case has no [[sticky]]");
  CHECK(refusal(q + "\"takes_steps\"") == "");  // which is never meaningless
  CHECK(refusal(q + "\"energy\"\nof = \"all\"") ==
        "trial.toml:20: 'energy' is measured on the whole cloth; leave out 'of'");
  CHECK(refusal(q + "\"angle\"\nof = { particles = [1, 2] }") ==
        "trial.toml:19: 'angle' needs of = { particles = [...] } with 3 numbers");
  CHECK(refusal(q + "\"distance\"\nof = { particles = [1, 2, 3] }") ==
        "trial.toml:19: 'distance' needs of = { particles = [...] } with 2 numbers");
  CHECK(refusal(q + "\"position\"\nalong = [0, 0, 0]") ==
        "trial.toml:20: 'along' is a direction and must not be zero");
  CHECK(refusal(q + "\"height\"\n" + q + "\"speed\"\n" + q + "\"height\"") ==
        "trial.toml:23: two quantities are called 'height'; give one of them another 'name'");
  CHECK(refusal(q + "\"height\"\nname = \"b\"\n" + q + "\"speed\"\n" + q +
                "\"lowest\"\nname = \"speed\"") ==
        "trial.toml:24: two quantities are called 'speed'; give one of them another 'name'");
}

TEST_CASE("measurements: a region takes the copies of a split vertex with it, and a whole box") {
  Scene scene = trial("").scene;
  const ParticleRegion box{{}, {{scene.x.col(5), scene.x.col(10)}}};  // corners are in it
  CHECK(particles_in(box, scene) == std::vector<int>{5, 6, 9, 10});
  const Case named = trial(
      "[[quantity]]\nname = \"mine\"\nwhat = \"height\"\nof = \"all\"\n"
      "when = \"minimum\"\n[[quantity]]\nwhat = \"speed\"\nwhen = 0.031\n"
      "of = { box = [[0, 0, 0], [1, 0, 0]] }\n[[quantity]]\nwhat = \"lowest\"\n"
      "of = { particles = [7, 4] }\n");
  REQUIRE(named.quantities.size() == 3);
  CHECK(named.quantities[0].name == "mine");
  CHECK(named.quantities[0].what == "height");
  CHECK(named.quantities[0].when == Instant::minimum);
  CHECK(particles_in(named.quantities[0].of, scene) == everything);
  CHECK(named.quantities[1].name == "speed");
  CHECK(named.quantities[1].when == Instant::at_time);
  CHECK(named.quantities[1].time == 0.031);
  CHECK(particles_in(named.quantities[1].of, scene) == std::vector<int>{0, 1, 2, 3});
  CHECK(named.quantities[2].when == Instant::end);
  CHECK(particles_in(named.quantities[2].of, scene) == std::vector<int>{7, 4});
}

TEST_CASE("measurements: of several quantities each has its own instants and regions") {
  Crumpled cloth;
  const Case one = trial(
      "[[quantity]]\nname = \"a\"\nwhat = \"highest\"\nwhen = \"maximum\"\nof = { particles = [2] "
      "}\n[[quantity]]\nname = \"b\"\nwhat = \"highest\"\nwhen = \"minimum\"\nof = { particles = "
      "[7] }\n[[quantity]]\nname = \"c\"\nwhat = \"highest\"\nwhen = 0.02\n[[quantity]]\nwhat = "
      "\"takes_steps\"\n[[quantity]]\nwhat = \"keeps_its_place\"\n[[quantity]]\nwhat = "
      "\"contact_points\"\nwhen = \"maximum\"\n[[quantity]]\nwhat = \"makes_contact\"\n"
      "[[object]]\nshape = \"half_space\"\nmove = [0, 0, -9]\n");
  const BuiltScene built = build(one.scene, computing_provider());
  Measurer measurer(one.scene, built, one.quantities);
  const std::vector<double> lifts = {0.3, -0.5, 0.9, 0.2, -0.1, 0.4};
  for (std::size_t k = 0; k < lifts.size(); ++k) {
    Diagnostics row;
    row.linear_momentum = row.angular_momentum = Vector3::Zero();
    row.work.object_contacts = k == 2 ? 11 : long(k);
    measurer.record(row);
    State s{0.01 * double(k), one.scene.x, PerParticle3::Zero(3, 12)};
    s.x.colwise() += lifts[k] * cloth.up;
    measurer.record(s);
  }
  const std::vector<double> values = measurer.values({cloth.state(), 29, {}, {}});
  const auto height = [&](int i) { return cloth.up.dot(one.scene.x.col(i)); };
  CHECK(values.at(0) == exactly(height(2) + 0.9));
  CHECK(values.at(1) == exactly(height(7) - 0.5));
  CHECK(values.at(2) == exactly((cloth.up.transpose() * one.scene.x).maxCoeff() + 0.9));
  CHECK(values.at(3) == 29);
  CHECK(values.at(4) == exactly(0.9));
  CHECK(values.at(5) == 11);
  CHECK(values.at(6) == 11);
}

TEST_CASE("measurements: a time is met to half a frame, an end to a rounding of it") {
  const auto seen = [](const std::string& when, double time) {
    const Case one = trial("[[quantity]]\nwhat = \"height\"\n" + when);
    const BuiltScene built = build(one.scene, computing_provider());
    Measurer measurer(one.scene, built, one.quantities);
    measurer.record(State{time, one.scene.x, one.scene.v});
    return !std::isnan(measurer.values({built.start, 1, {}, {}}).at(0));
  };
  CHECK(seen("", 0.05 + 0.9e-11));  // a billionth of a frame
  CHECK(!seen("", 0.05 - 1.1e-11));
  CHECK(seen("when = 0.02", 0.025));
  CHECK(seen("when = 0.02", 0.015));
  CHECK(!seen("when = 0.02", 0.0250001));
  CHECK(!seen("when = 0.02", 0.0149999));
}

TEST_CASE("measurements: what is measured without being asked leaves out what is no quantity") {
  const Scene scene = trial("").scene;
  std::vector<std::string> names;
  for (const Measurement& m :
       usual_measurements(scene, {"runs_to_its_end", "stays_flat", "is_reproducible", "takes_steps",
                                  "solves_converge", "keeps_its_place"})) {
    CHECK(m.name == m.what);
    names.push_back(m.what);
  }
  CHECK(names == std::vector<std::string>{"kinetic_energy", "elastic_energy", "height", "lowest",
                                          "stays_flat", "keeps_its_place"});
}
