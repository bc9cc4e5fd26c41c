// What is built of what a case file says.
#include "verification/checks/scene_checks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/mesh/shapes.h"
#include "reference/scene/scene.h"
#include "verification/checks/moving_scenes.h"

namespace foldproof {

namespace {

constexpr double degree = std::numbers::pi / 180;

const std::string small_sheet = R"(
[cloth]
shape = "sheet"
pattern = "alternating"
width = 0.6
height = 0.43
columns = 4
rows = 3
density = 0.23
)";

const std::string short_time = R"(
[time]
end = 0.3
frames_per_second = 40
integrator = "A"
step = 0.003
)";

/// The sheet, some tables, the time.
Scene read_case(const std::string& tables, const std::vector<std::string>& overrides = {}) {
  return read_scene_text(small_sheet + tables + short_time, "trial.toml", overrides);
}

PerParticle3 plain_positions() {
  Sheet sheet;
  sheet.pattern = SheetPattern::alternating;
  sheet.width = 0.6;
  sheet.height = 0.43;
  sheet.columns = 4;
  sheet.rows = 3;
  return make_sheet(sheet).rest;
}

/// Differences between what was read and what was written, each in its own words.
class Differences {
 public:
  void see(const std::string& what, double difference) {
    names_.push_back(what);
    values_.push_back(std::abs(difference));
    worst_.see(std::abs(difference));
  }

  Finding finding(double bound, const std::string& why) const {
    return {{names_.empty() ? NAN : worst_.value(), bound, 0, "SI", why}, {{"what", "1", names_}, {"difference", "SI", values_}}, ""};
  }

 private:
  std::vector<std::string> names_;
  std::vector<double> values_;
  Worst worst_;
};

/// The positions after 20 steps of a case.
PerParticle3 end_of(const Scene& scene) {
  const System system = build_system(scene);
  State s = start_state(scene);
  Work work;
  for (int n = 0; n < 20; ++n) s = integrator_named(scene.integrator).step(system, {&s, 1}, 0.003, work);
  return s.x;
}

Finding absent_finding(const Subject&) {
  Differences differences;
  const Scene nothing = read_case(""), falls = read_case("[gravity]\n");
  const Scene zeros = read_case("[gravity]\n[stretch]\nstiffness = 0\n[bending]\nstiffness = 0\n");
  const auto forces = [](const Scene& scene) { return double(build_system(scene).forces.size()); };
  differences.see("forces of a case without any", forces(nothing));
  differences.see("forces of a case with gravity, less 1", forces(falls) - 1);
  differences.see("that force is gravity", std::holds_alternative<Gravity>(build_system(falls).forces[0]) ? 0 : 1);
  differences.see("forces of a case with three, less 3", forces(zeros) - 3);
  differences.see("filters and led particles", double(build_system(zeros).filters.size() + build_system(zeros).led.size()));
  differences.see("parts named, less 2", double(built_parts(falls, build_system(falls)).size()) - 2);
  differences.see("positions with gravity alone and with zero stiffnesses", largest_difference(end_of(falls), end_of(zeros)));
  differences.see("positions without force and at rest", largest_difference(end_of(nothing), plain_positions()));
  differences.see("default gravity", (*falls.gravity - Vector3(0, -9.80665, 0)).norm());
  return differences.finding(0, "what is absent is not built; a stiffness of zero adds zeros, which change no digit");
}

Finding numbers_finding(const Subject&) {
  const Scene scene = read_scene_text(
      "title = \"Trial\"\nabout = \"Words\"\n" + small_sheet +
          "[gravity]\nacceleration = [0.3, -0.7, 1.1]\n[stretch]\nstiffness = 37.5\ndamping = 0.011\nrest_length_scale = 0.97\n"
          "[bending]\nstiffness = 3.1e-4\ndamping = 2.3e-5\nweighting = \"current\"\ndamping_factor = \"edge_squared_over_area\"\n"
          "law = \"cubic\"\n[time]\nend = 0.31\nframes_per_second = 40\nintegrator = \"B\"\nsafety = 0.43\nstrain_per_step = 0.07\n"
          "max_steps = 53\n[solver]\ntolerance = 3e-7\nmax_iterations = 17\nrelative_to = \"initial_residual\"\n",
      "folder/trial.toml");
  Differences differences;
  const auto is = [&](const std::string& what, bool right) { differences.see(what, right ? 0 : 1); };
  is("name, title, about", scene.name == "trial" && scene.title == "Trial" && scene.about == "Words");
  is("density", scene.density == 0.23);
  is("gravity", *scene.gravity == Vector3(0.3, -0.7, 1.1));
  is("stretch", scene.stretch->stiffness == 37.5 && scene.stretch->damping == 0.011 && scene.stretch->rest_length_scale == 0.97);
  is("bending", scene.bending->stiffness == 3.1e-4 && scene.bending->damping == 2.3e-5);
  is("weighting", scene.bending->weighting == Weighting::current);
  is("damping factor", scene.bending->damping_factor == DampingFactor::edge_squared_over_area);
  is("law", scene.bending->law == "cubic");
  is("time", scene.schedule.end == 0.31 && scene.schedule.frame_interval == 1.0 / 40 && scene.schedule.max_steps == 53);
  is("automatic step", scene.schedule.step.fixed == 0 && scene.schedule.step.safety == 0.43 && scene.schedule.step.strain_per_step == 0.07);
  is("fixed step", read_case("").schedule.step.fixed == 0.003);
  is("integrator", scene.integrator == "B" && read_case("").integrator == "A");
  is("solver", scene.solver.tolerance == 3e-7 && scene.solver.max_iterations == 17);
  is("scale of the residual", scene.solver.scale == ResidualScale::initial_residual && read_case("").solver.scale == ResidualScale::momentum);
  is("solver of the system", build_system(scene).solver.tolerance == 3e-7);
  is("defaults of bending", read_case("[bending]\nstiffness = 1e-4\n").bending->weighting == Weighting::rest &&
                                read_case("[bending]\nstiffness = 1e-4\n").bending->law == "sine");
  return differences.finding(0, "a number is read as it is written");
}

Finding overrides_finding(const Subject&) {
  const std::string tables = "[stretch]\nstiffness = 37.5\n[[hold]]\nparticles = [0]\n[[hold]]\nparticles = [3]\n";
  const auto with = [&](std::vector<std::string> overrides) { return read_case(tables, overrides); };
  Differences differences;
  const auto is = [&](const std::string& what, bool right) { differences.see(what, right ? 0 : 1); };
  const auto refused = [&](const std::string& assignment, const std::string& mention) {
    try {
      with({assignment});
    } catch (const InputError& error) {
      return std::string(error.what()).find(mention) != std::string::npos;
    }
    return false;
  };
  is("a number", with({"stretch.stiffness=53.25"}).stretch->stiffness == 53.25);
  is("the last one counts", with({"stretch.stiffness=53.25", "stretch.stiffness=7"}).stretch->stiffness == 7);
  is("a text without quotes", with({"time.integrator=C"}).integrator == "C");
  is("a missing table is made", *with({"gravity.acceleration=[1, 2, 4]"}).gravity == Vector3(1, 2, 4));
  const Scene picked = with({"hold.1.particles=[5, 7]"});
  is("an entry of a list", picked.led.size() == 3 && picked.led[0].particle == 0 && picked.led[1].particle == 5 && picked.led[2].particle == 7);
  is("it is written into the case's text", with({"stretch.stiffness=53.25"}).text.find("--set stretch.stiffness=53.25") != std::string::npos);
  is("an unknown key is refused", refused("stretch.stifness=53", "--set: unknown key 'stifness'"));
  is("a wrong value is refused", refused("stretch.stiffness=-3", "--set"));
  is("a missing '=' is refused", refused("stretch.stiffness", "table.key=value"));
  is("a path through a value is refused", refused("stretch.stiffness.x=3", "'stiffness' is not a table"));
  is("an entry that is not there is refused", refused("hold.2.particles=[5]", "no hold.2"));
  return differences.finding(0, "an override acts as if it stood in the file, or is refused");
}

std::vector<int> held_by(const std::string& table) {
  std::vector<int> particles;
  for (const PrescribedParticle& p : read_case("[[hold]]\n" + table).led) particles.push_back(p.particle);
  return particles;
}

Finding hold_finding(const Subject&) {
  const PerParticle3 rest = plain_positions();
  std::vector<int> left, top;
  for (int i = 0; i < rest.cols(); ++i) {
    if (rest(0, i) <= 0.16) left.push_back(i);
    if (rest(1, i) >= 0.43 - 0.35 * 0.43) top.push_back(i);
  }
  Differences differences;
  const auto is = [&](const std::string& what, bool right) { differences.see(what, right ? 0 : 1); };
  is("particles", held_by("particles = [7, 2]") == std::vector<int>{7, 2});
  is("box", left.size() == 8 && held_by("box = [[-0.01, -0.01, -0.01], [0.16, 1.0, 0.01]]") == left);
  is("top", top.size() == 10 && held_by("top = 0.35") == top);
  const Scene scene = read_case(
      "[[hold]]\nparticles = [7]\nvelocity = [0.1, 0.2, 0.4]\namplitude = [0.3, 0.5, 0.7]\nfrequency = 1.7\nphase = 33\n"
      "center = [0.6, 0.9, 1.1]\nangular_velocity = [10, -20, 35]\n");
  const PrescribedParticle& p = scene.led.at(0);
  is("start", p.start == Vector3(rest.col(7)));
  is("velocity, amplitude, center", p.motion.velocity == Vector3(0.1, 0.2, 0.4) && p.motion.amplitude == Vector3(0.3, 0.5, 0.7) &&
                                       p.motion.center == Vector3(0.6, 0.9, 1.1));
  is("frequency", p.motion.frequency == 1.7);
  differences.see("phase in degrees [rad]", p.motion.phase - 33 * degree);
  differences.see("angular velocity in degrees [rad/s]", (p.motion.angular_velocity - degree * Vector3(10, -20, 35)).norm());
  differences.see("start position on the path", (start_state(scene).x.col(7) - rest.col(7)).norm());
  const Vector3 arm = Vector3(rest.col(7)) - Vector3(0.6, 0.9, 1.1), spin = degree * Vector3(10, -20, 35);
  const Vector3 speed = spin.cross(arm) + Vector3(0.1, 0.2, 0.4) + 2 * std::numbers::pi * 1.7 * std::cos(33 * degree) * Vector3(0.3, 0.5, 0.7);
  differences.see("start velocity on the path", (start_state(scene).v.col(7) - speed).norm());
  return differences.finding(32 * epsilon, "angles are converted to radians, and velocities of up to 10 m/s computed, with a few roundings");
}

Finding start_finding(const Subject&) {
  const Scene scene = read_case("[start]\nstretch = 1.07\nvelocity = [0.3, -0.5, 0.9]\nspin = [40, -70, 110]\n");
  const PerParticle3 rest = plain_positions();
  const Vector3 center = rest.rowwise().mean(), spin = degree * Vector3(40, -70, 110);
  Worst x, v, noise, least;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    const Vector3 arm = 1.07 * (rest.col(i) - center);
    x.see((scene.x.col(i) - center - arm).norm());
    v.see((scene.v.col(i) - Vector3(0.3, -0.5, 0.9) - spin.cross(arm)).norm());
  }
  const PerParticle3 shaken = read_case("[start]\nnoise = 0.004\nseed = 5\n").x - rest;
  Differences differences;
  differences.see("positions", x.value());
  differences.see("velocities", v.value());
  differences.see("rest shape", largest_difference(scene.mesh.rest, rest));
  differences.see("noise is within its size and fills it", shaken.cwiseAbs().maxCoeff() <= 0.004 && shaken.cwiseAbs().maxCoeff() > 0.0036 ? 0 : 1);
  differences.see("noise has both signs", shaken.minCoeff() < -0.0036 && shaken.maxCoeff() > 0.0036 ? 0 : 1);
  differences.see("the seed fixes the noise", largest_difference(shaken, read_case("[start]\nnoise = 0.004\nseed = 5\n").x - rest));
  differences.see("another seed gives other noise", largest_difference(shaken, read_case("[start]\nnoise = 0.004\nseed = 6\n").x - rest) > 1e-3 ? 0 : 1);
  return differences.finding(32 * epsilon, "a few roundings of lengths below 1 m and velocities of about 2 m/s");
}

Finding placed_finding(const Subject&) {
  const std::string line = "density = 0.23\n", placed = "fit = 1.3\nturn = { axis = [1, -2, 3], angle = 37 }\nmove = [0.3, -0.2, 0.7]\n";
  std::string cloth = small_sheet;
  cloth.replace(cloth.find(line), line.size(), line + placed);
  const Scene scene = read_scene_text(cloth + short_time, "trial.toml");
  const PerParticle3 rest = plain_positions();
  const Vector3 axis = Vector3(1, -2, 3).normalized(), move(0.3, -0.2, 0.7);
  Worst worst;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {  // by Rodrigues' formula
    const Vector3 x = 1.3 / 0.6 * rest.col(i), along = axis.dot(x) * axis;
    const Vector3 turned = along + std::cos(37 * degree) * (x - along) + std::sin(37 * degree) * axis.cross(x);
    worst.see((scene.x.col(i) - turned - move).norm());
  }
  Differences differences;
  differences.see("start", worst.value());
  differences.see("rest shape is the placed one", largest_difference(scene.x, scene.mesh.rest));
  return differences.finding(32 * epsilon, "scaled, turned and moved with some twenty roundings of lengths below 2 m");
}

Finding rest_angle_finding(const Subject&) {
  const std::string cylinder = "[cloth]\nshape = \"cylinder\"\nradius = 0.31\nheight = 0.5\naround = 9\nalong = 4\ndensity = 0.2\n";
  const auto angles = [&](const std::string& source) {
    return read_scene_text(cylinder + "[bending]\nstiffness = 1e-4\n" + source + short_time, "trial.toml").rest_angles;
  };
  const auto extremes = [](const std::vector<double>& list) { return std::minmax_element(list.begin(), list.end()); };
  const auto given = angles("rest_angle = -27.5\n"), flat = angles("rest_angle = \"flat\"\n"), shape = angles("rest_angle = \"rest_shape\"\n"), none = angles("");
  Differences differences;
  differences.see("a number, in degrees, least", *extremes(given).first + 27.5 * degree);
  differences.see("a number, in degrees, greatest", *extremes(given).second + 27.5 * degree);
  differences.see("flat", std::max(-*extremes(flat).first, *extremes(flat).second));
  // a cylinder of nine sides is folded by 40 degrees along its length and flat elsewhere
  differences.see("rest shape, least", std::abs(*extremes(shape).first) < 1e-9 || std::abs(*extremes(shape).second) < 1e-9 ? 0 : 1);
  differences.see("rest shape, sharpest [rad]", std::max(std::abs(*extremes(shape).first), std::abs(*extremes(shape).second)) - 40 * degree);
  differences.see("the default is the rest shape", shape == none ? 0 : 1);
  differences.see("one angle a hinge", double(given.size() + flat.size() + shape.size()) / 3 - double(shape.size()));
  return differences.finding(64 * epsilon, "an angle is found from coordinates with some thirty roundings");
}

}  // namespace

std::vector<Check> scene_meaning_checks() {
  const std::string source = "good practice";
  return {
      {"scene.absent-parts-build-nothing", "What a case of the reference does not name is not built.", source, absent_finding},
      {"scene.numbers-are-as-written", "A scene of the reference holds the numbers that its case file says.", source, numbers_finding},
      {"scene.overrides-act", "Overrides act on a case of the reference as if they stood in its file.", source, overrides_finding},
      {"scene.hold-is-as-written", "The reference holds and leads the particles that a case names, as it says.", source, hold_finding},
      {"scene.start-is-as-written", "The reference starts with the stretch, spin, velocity and noise that a case says.", source, start_finding},
      {"scene.cloth-is-placed-as-written", "The reference scales, turns and moves the cloth as a case says.", source, placed_finding},
      {"scene.rest-angle-sources", "Rest angles of the reference come from a number, from flatness or from the rest shape, as a case says.", source, rest_angle_finding},
  };
}

std::vector<Check> scene_checks() {
  std::vector<Check> all = scene_refusal_checks();
  for (const Check& check : scene_meaning_checks()) all.push_back(check);
  return all;
}

}  // namespace foldproof
