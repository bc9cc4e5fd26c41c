// Invariance of the result under changes of units, of the frame of reference, and of the start
// time.
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/moving_sheets.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

/// Old units over new ones: a quantity in metres is multiplied by length, and so on.
struct Units {
  double length, mass, time;  // 1
};

Motion convert(const Motion& motion, const Units& u) {
  Motion result = motion;
  result.velocity *= u.length / u.time;
  result.amplitude *= u.length;
  result.frequency /= u.time;
  result.center *= u.length;
  result.angular_velocity /= u.time;
  return result;
}

/// The same scene in other units.
Scene convert(Scene scene, const Units& u) {
  scene.mesh.rest *= u.length;
  scene.x *= u.length;
  scene.v *= u.length / u.time;
  scene.density *= u.mass / (u.length * u.length);
  *scene.gravity *= u.length / (u.time * u.time);
  scene.stretch->stiffness *= u.mass / (u.time * u.time);
  scene.stretch->damping *= u.mass / u.time;
  scene.bending->stiffness *= u.mass * u.length * u.length / (u.time * u.time);
  scene.bending->damping *= u.mass * u.length / u.time;
  for (PrescribedParticle& p : scene.prescribed)
    p = {p.particle, u.length * p.start, convert(p.motion, u)};
  return scene;
}

/// Solved to rounding: in other units, a solve to a tolerance may take one more iteration.
Scene solved_sheet() {
  Scene scene = partly_prescribed_sheet();
  scene.solver.tolerance = 1e-14;
  return scene;
}

/// The state after 20 steps in other units, converted back.
State run_in(const Units& u, const Subject& subject, const std::string& integrator, double h,
             int steps) {
  Stepper stepper(subject, convert(solved_sheet(), u), integrator);
  State s = stepper.run(stepper.start(), h * u.time, steps);
  s.x /= u.length;
  s.v /= u.length / u.time;
  return s;
}

/// Difference between the ends of two runs, in epsilon of the extent and of the extent over the
/// time [epsilon].
double distance(const State& a, const State& b, double size, double duration) {
  Worst worst;
  worst.observe(largest_difference(a.x, b.x) / (epsilon * size));
  worst.observe(largest_difference(a.v, b.v) * duration / (epsilon * size));
  return worst.value();
}

Finding powers_finding(const Subject& subject, const std::string& integrator) {
  const State plain = run_in({1, 1, 1}, subject, integrator, 1.3e-3, 20);
  Table differing("length [1]; mass [1]; time [1]; numbers that differ [1]");
  // even powers of mass and time, so that square roots are scaled by powers of two as well
  for (const Units& u : {Units{8, 64, 1}, Units{1, 0.0625, 16}, Units{0.5, 256, 0.25}}) {
    const State other = run_in(u, subject, integrator, 1.3e-3, 20);
    differing.row(
        u.length, u.mass, u.time,
        count_differing_entries(other.x, plain.x) + count_differing_entries(other.v, plain.v));
  }
  return {{differing.worst("numbers that differ"), 0, 0, "numbers that differ",
           "a power of two changes no digit of any number on the way"},
          differing};
}

Finding units_finding(const Subject& subject, const std::string& integrator) {
  const double h = 1.3e-3;
  const int steps = 20;
  Stepper stepper(subject, solved_sheet(), integrator);
  const State start = stepper.start();
  const double grown = growth(stepper, start, h, steps), size = extent(start.x);
  const State plain = run_in({1, 1, 1}, subject, integrator, h, steps);
  Worst worst;
  for (const Units& u : {Units{39.37, 1000, 1}, Units{0.3, 2.2046, 3600}, Units{1e3, 0.07, 0.011}})
    worst.observe(distance(run_in(u, subject, integrator, h, steps), plain, size, steps * h));
  const double bound = 64 * steps * grown;
  return {{worst.value(), bound, 0, "epsilon of the extent",
           "20 steps of 64 roundings, those of the converted constants included, each amplified at "
           "most as a disturbance at the start; solves end at 1e-14 of the velocity, 45 epsilon, "
           "two a step in C: the amplification, ten and more, covers them"},
          Table{{"growth", "1"}}.with_row(grown),
          smallest_defect(bound, "extent")};
}

Finding twice_finding(const Subject& subject) {
  double differing = 0;
  Table counts{{"integrator", "1"}, {"numbers that differ", "1"}};
  std::vector<State> firsts;
  for (const Integrator& integrator : paper_schemes())
    firsts.push_back(run_in({1, 1, 1}, subject, std::string(integrator.name), 1.3e-3, 23));
  for (const Integrator& integrator : paper_schemes()) {
    const State& first = firsts[counts.rows()];
    const State second = run_in({1, 1, 1}, subject, std::string(integrator.name), 1.3e-3, 23);
    const double here =
        count_differing_entries(first.x, second.x) + count_differing_entries(first.v, second.v);
    counts.row(integrator.name, here);
    differing += here;
    if (!first.x.allFinite()) differing = NAN;
  }
  return {{differing, 0, 0, "numbers that differ", "a run is a function of its input"},
          counts,
          "each second run is made after the first runs of all methods"};
}

Finding frame_finding(const Subject& subject, const std::string& integrator) {
  const double h = 1.1e-3;
  const int steps = 12;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.9, Vector3(0.4, -0.8, 0.3).normalized()).toRotationMatrix();
  const Vector3 shift(0.43, -0.29, 0.61), boost(1.7, -0.9, 2.3);
  Scene scene = free_sheet();
  scene.solver.tolerance = 1e-14;
  Stepper stepper(subject, scene, integrator);
  const State start = stepper.start();
  const State plain = stepper.run(start, h, steps);
  State moved = start;
  moved.x = (turn * start.x).colwise() + shift;
  moved.v = (turn * start.v).colwise() + boost;
  const double size = extent(moved.x) + extent(start.x) + boost.norm() * steps * h;
  moved = stepper.run(moved, h, steps);
  State expected = plain;
  expected.x = (turn * plain.x).colwise() + (shift + steps * h * boost);
  expected.v = (turn * plain.v).colwise() + boost;
  const double grown = growth(stepper, start, h, steps), bound = 64 * steps * grown;
  return {{distance(moved, expected, size, steps * h), bound, 0, "epsilon of the extent",
           "12 steps of 64 roundings, each amplified at most as a disturbance at the start; solves "
           "end at 1e-14 of the velocity, 45 epsilon"},
          Table{{"growth", "1"}}.with_row(grown),
          smallest_defect(bound, "extent")};
}

}  // namespace

std::vector<Check> symmetry_checks() {
  std::vector<Check> list;
  add_for_each_scheme(
      list, {{"dynamics.scaling-laws-hold", "units changed by powers of two give the same bits.",
              "dimensional analysis", powers_finding},
             {"dynamics.units-do-not-matter",
              "a change of units by any factor gives the same motion to rounding.",
              "dimensional analysis", units_finding}});
  list.push_back({"dynamics.runs-are-bitwise-reproducible",
                  "Two runs from the same start end with the same bits.", "reproducibility",
                  twice_finding});
  add_for_each_scheme(list, {{"dynamics.translation-rotation-invariance-holds",
                              "a rotated, shifted and uniformly moving start gives the rotated, "
                              "shifted and moved result.",
                              "Galilean invariance", frame_finding}});
  return list;
}

}  // namespace foldproof
