// Placement of the cloth by a case file, its initial velocity and its held particles.
#include "reference/mesh/shapes.h"
#include "reference/scene/scene.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/trial_cases.h"

namespace foldproof {

namespace {

constexpr double degree = pi / 180;

std::vector<int> particles_held_by(const std::string& table) {
  std::vector<int> particles;
  for (const PrescribedParticle& p : trial_scene("[[hold]]\n" + table).prescribed)
    particles.push_back(p.particle);
  return particles;
}

Finding hold_finding() {
  const PerParticle3 rest = plain_positions();
  std::vector<int> left, top;
  for (int i = 0; i < rest.cols(); ++i) {
    if (rest(0, i) <= 0.16) left.push_back(i);
    if (rest(1, i) >= 0.43 - 0.35 * 0.43) top.push_back(i);
  }
  Differences differences;
  const auto is = [&](const std::string& what, bool right) { differences.is(what, right); };
  is("particles", particles_held_by("particles = [7, 2]") == std::vector<int>{7, 2});
  is("box", left.size() == 8 &&
                particles_held_by("box = [[-0.01, -0.01, -0.01], [0.16, 1.0, 0.01]]") == left);
  is("top", top.size() == 10 && particles_held_by("top = 0.35") == top);
  const Scene scene = trial_scene(
      "[[hold]]\nparticles = [7]\nvelocity = [0.1, 0.2, 0.4]\namplitude = [0.3, 0.5, "
      "0.7]\nfrequency = 1.7\nphase = 33\n"
      "center = [0.6, 0.9, 1.1]\nangular_velocity = [10, -20, 35]\n");
  const Motion timed_motion =
      trial_scene("[[hold]]\nparticles = [7]\nfrom = 0.13\nuntil = 0.29\n").prescribed.at(0).motion;
  is("from, until", timed_motion.from == 0.13 && timed_motion.until == 0.29);
  const PrescribedParticle& p = scene.prescribed.at(0);
  is("start", p.start == Vector3(rest.col(7)));
  is("velocity, amplitude, center", p.motion.velocity == Vector3(0.1, 0.2, 0.4) &&
                                        p.motion.amplitude == Vector3(0.3, 0.5, 0.7) &&
                                        p.motion.center == Vector3(0.6, 0.9, 1.1));
  is("frequency", p.motion.frequency == 1.7);
  is("acts all the time", p.motion.from == 0 && std::isinf(p.motion.until));
  differences.is_near("phase in degrees", p.motion.phase - 33 * degree, 33 * degree);
  differences.is_near("angular velocity in degrees",
                      (p.motion.angular_velocity - degree * Vector3(10, -20, 35)).norm(),
                      degree * Vector3(10, -20, 35).norm());
  const Vector3 arm = Vector3(rest.col(7)) - Vector3(0.6, 0.9, 1.1),
                spin = degree * Vector3(10, -20, 35);
  differences.is_near("start position on the path",
                      (start_state(scene).x.col(7) - rest.col(7)).norm(),
                      arm.norm() + Vector3(0.6, 0.9, 1.1).norm());
  const Vector3 speed = spin.cross(arm) + Vector3(0.1, 0.2, 0.4) +
                        2 * pi * 1.7 * std::cos(33 * degree) * Vector3(0.3, 0.5, 0.7);
  differences.is_near("start velocity on the path", (start_state(scene).v.col(7) - speed).norm(),
                      spin.norm() * arm.norm() + speed.norm());
  return differences.judged(32,
                            "angles are converted to radians, positions and velocities computed, "
                            "with a few roundings of each term");
}

Finding start_finding() {
  const Scene scene =
      trial_scene("[start]\nstretch = 1.07\nvelocity = [0.3, -0.5, 0.9]\nspin = [40, -70, 110]\n");
  const PerParticle3 rest = plain_positions();
  const Vector3 center = rest.rowwise().mean(), spin = degree * Vector3(40, -70, 110);
  Worst x, v, size, speed;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    const Vector3 arm = 1.07 * (rest.col(i) - center);
    size.observe(arm.norm() + center.norm());
    speed.observe(spin.norm() * arm.norm() + Vector3(0.3, -0.5, 0.9).norm());
    x.observe((scene.x.col(i) - center - arm).norm());
    v.observe((scene.v.col(i) - Vector3(0.3, -0.5, 0.9) - spin.cross(arm)).norm());
  }
  const PerParticle3 shaken = trial_scene("[start]\nnoise = 0.004\nseed = 5\n").x - rest;
  Differences differences;
  differences.is_near("positions", x.value(), size.value());
  differences.is_near("velocities", v.value(), speed.value());
  differences.is_near("rest shape", largest_difference(scene.mesh.rest, rest), size.value());
  differences.is("noise is within its size and fills it",
                 shaken.cwiseAbs().maxCoeff() <= 0.004 && shaken.cwiseAbs().maxCoeff() > 0.0036);
  differences.is("noise has both signs", shaken.minCoeff() < -0.0036 && shaken.maxCoeff() > 0.0036);
  differences.is_near(
      "the seed fixes the noise",
      largest_difference(shaken, trial_scene("[start]\nnoise = 0.004\nseed = 5\n").x - rest),
      0.004);
  differences.is("another seed gives other noise",
                 largest_difference(
                     shaken, trial_scene("[start]\nnoise = 0.004\nseed = 6\n").x - rest) > 1e-3);
  return differences.judged(
      32, "a few roundings of each of the terms that lengths and velocities are summed from");
}

Finding placed_finding() {
  const std::string
      line = "density = 0.23\n",
      placed = "fit = 1.3\nturn = { axis = [1, -2, 3], angle = 37 }\nmove = [0.3, -0.2, 0.7]\n";
  std::string cloth = small_sheet;
  cloth.replace(cloth.find(line), line.size(), line + placed);
  const Scene scene = read_scene_text(cloth + short_time, "trial.toml");
  const PerParticle3 rest = plain_positions();
  const Vector3 axis = Vector3(1, -2, 3).normalized(), move(0.3, -0.2, 0.7);
  Worst worst;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {  // by Rodrigues' formula
    const Vector3 x = 1.3 / 0.6 * rest.col(i), along = axis.dot(x) * axis;
    const Vector3 turned =
        along + std::cos(37 * degree) * (x - along) + std::sin(37 * degree) * axis.cross(x);
    worst.observe((scene.x.col(i) - turned - move).norm());
  }
  Differences differences;
  differences.is_near("start", worst.value(), 1.3 + move.norm());
  differences.is_near("rest shape is the placed one", largest_difference(scene.x, scene.mesh.rest),
                      1.3 + move.norm());
  return differences.judged(32,
                            "scaled, turned and moved with some twenty roundings of the cloth's "
                            "length and of the way moved");
}

Finding rest_angle_finding() {
  const std::string cylinder =
      "[cloth]\nshape = \"cylinder\"\nradius = 0.31\nheight = 0.5\naround = 9\nalong = 4\ndensity "
      "= 0.2\n";
  const auto angles = [&](const std::string& source) {
    return read_scene_text(cylinder + "[bending]\nstiffness = 1e-4\n" + source + short_time,
                           "trial.toml")
        .rest_angles;
  };
  const auto extremes = [](const std::vector<double>& list) {
    return std::minmax_element(list.begin(), list.end());
  };
  const auto given = angles("rest_angle = -27.5\n"), flat = angles("rest_angle = \"flat\"\n"),
             shape = angles("rest_angle = \"rest_shape\"\n"), none = angles("");
  Differences differences;
  differences.is_near("a number, in degrees, least", *extremes(given).first + 27.5 * degree,
                      27.5 * degree);
  differences.is_near("a number, in degrees, greatest", *extremes(given).second + 27.5 * degree,
                      27.5 * degree);
  differences.is_near("flat", std::max(-*extremes(flat).first, *extremes(flat).second));
  // a cylinder of nine sides is folded by 40 degrees along its length and flat elsewhere
  differences.is("rest shape, least", std::abs(*extremes(shape).first) < 1e-9 ||
                                          std::abs(*extremes(shape).second) < 1e-9);
  differences.is_near(
      "rest shape, sharpest",
      std::max(std::abs(*extremes(shape).first), std::abs(*extremes(shape).second)) - 40 * degree);
  differences.is("the default is the rest shape", shape == none);
  differences.is("one angle a hinge", given.size() == shape.size() && flat.size() == shape.size());
  return differences.judged(
      64, "an angle is found from coordinates with some thirty roundings of 1 rad");
}

}  // namespace

std::vector<Check> scene_place_checks() {
  const std::string source = "good practice";
  return {
      {"scene.held-particles-are-as-written",
       "The reference holds or moves the particles that a case names, as the case says.", source,
       hold_finding},
      {"scene.start-state-is-as-written",
       "The reference starts with the stretch, spin, velocity and noise that a case says.", source,
       start_finding},
      {"scene.cloth-is-placed-as-written",
       "The reference scales, turns and moves the cloth as a case says.", source, placed_finding},
      {"scene.rest-angles-come-from-the-named-source",
       "Rest angles of the reference come from a number, from flatness or from the rest shape, as "
       "a case says.",
       source, rest_angle_finding},
  };
}

}  // namespace foldproof
