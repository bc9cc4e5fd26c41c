#include "verification/cases/frame_dynamics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "verification/cases/face_bound.h"

namespace foldproof {

namespace {

// Of accelerations, speeds and energies: empirical, the balance of cases without contact [1].
constexpr double share = 0.01;

Vector3 mean_by_mass(const PerParticle3& values, const PerParticle& mass) {
  return values * mass / mass.sum();
}

// ---- free fall

bool has_weight(const Scene& scene) { return scene.gravity && scene.gravity->norm() > 0; }

/// Frames before the first in which the cloth is near an object.
std::size_t count_free_frames(const FrameMotion& motion) {
  if (motion.built.objects.empty()) return motion.frames.size();
  const double near = largest_enclosing_radius(motion.of.scene);
  std::size_t count = 0;
  while (count < motion.frames.size() && clearance_in(motion, motion.frames[count]) > near) ++count;
  return count;
}

/// Why the centre of mass is not known to fall freely; "" if it is.
std::string why_not_in_free_fall(const FrameMotion& motion, std::size_t free_frames) {
  const Scene& scene = motion.of.scene;
  if (!has_weight(scene)) return "gravity: the case has none";
  if (!scene.prescribed.empty()) return "free cloth: the case's [[hold]] carries it";
  if (!scene.sticky.empty()) return "free cloth: bonds may carry it";
  if (free_frames < 3)
    return fmt::format("three frames before the cloth is near an object: there are {}",
                       free_frames);
  return "";
}

/// The centre of mass on a parabola: through three frames.
struct Parabola {
  Vector3 velocity, acceleration;  // at the first of them [m/s], [m/s^2]
  double to_middle, to_last;       // s
};

Parabola parabola_through(const TimedMesh& first, const TimedMesh& middle, const TimedMesh& last,
                          const PerParticle& mass) {
  const double a = middle.time - first.time, b = last.time - middle.time;
  const Vector3 early = mean_by_mass(middle.x - first.x, mass) / a;
  const Vector3 late = mean_by_mass(last.x - middle.x, mass) / b;
  const Vector3 acceleration = 2 * (late - early) / (a + b);
  return {early - acceleration * a / 2, acceleration, a, a + b};
}

/// What the file's rounding and the scheme may change of a parabola.
struct Allowed {
  double acceleration, across, along;  // m/s^2; m/s, across and along gravity
};

// A centre that only its weight moves, by a scheme with a uniform step h up to a frame:
//   order 1      x(t) = v t + g t^2/2 +- g h t/2: g is exact, v off by up to g h/2 along gravity;
//   order >= 2   exact, but for a multistep method that starts with a backward Euler step: BDF2
//                is then shifted by d = 3/4 g h^2, so g by 2 d/(tm T), v by d (1/tm + 1/T).
// A coordinate rounded by e moves a centre by up to e = sqrt(3) rounding, each difference by 2 e.
Allowed allowed_of(const Parabola& p, double g, double h, double rounding) {
  const double e = 2 * std::sqrt(3.0) * rounding, tm = p.to_middle, T = p.to_last;
  const double start_up = 0.75 * g * h * h;
  const double of_acceleration = 2 * e * (1 / tm + 1 / (T - tm)) / T;
  const double across = share * g * T + e / tm + of_acceleration * tm / 2;
  return {share * g + 2 * start_up / (tm * T) + of_acceleration, across,
          across + std::max(g * h / 2, start_up * (1 / tm + 1 / T))};
}

// ---- energy

bool are_equally_spaced(double a, double b) { return std::abs(a - b) < 0.01 * (a + b); }

/// The cloth between frames k - 1 and k + 1: its mean velocity, and by Simpson's rule
/// its mean place.
State mean_state(std::span<const TimedMesh> frames, std::size_t k) {
  const TimedMesh &a = frames[k - 1], &b = frames[k], &c = frames[k + 1];
  return {b.time, (a.x + 4 * b.x + c.x) / 6, (c.x - a.x) / (c.time - a.time)};
}

/// By which rounding of the file may change the kinetic and potential energy of a mean state [J].
double motion_rounding(const FrameMotion& motion, const State& mean, double span) {
  const PerParticle& mass = motion.built.system.mass;
  const double e = std::sqrt(3.0) * motion.rounding(), speed = 2 * e / span;
  const double g = has_weight(motion.of.scene) ? motion.of.scene.gravity->norm() : 0;
  const PerParticle speeds = mean.v.colwise().norm().transpose();
  return speed * mass.dot(speeds) + mass.sum() * (speed * speed / 2 + g * e);
}

/// A first-order scheme with a step h starts up to g h/2 too fast along gravity (above) [J].
double first_order_start(const FrameMotion& motion, double h) {
  const Scene& scene = motion.of.scene;
  if (!has_weight(scene)) return 0;
  const PerParticle& mass = motion.built.system.mass;
  const double g = scene.gravity->norm();
  const double along = std::abs(mean_by_mass(scene.v, mass).dot(*scene.gravity) / g);
  return mass.sum() * (along * g * h / 2 + g * g * h * h / 8);
}

// ---- the reference's first frames

/// The centre of the particles that the case leaves free [m].
struct FreeCentre {
  PerParticle mass;  // 0: prescribed [kg]

  explicit FreeCentre(const FrameMotion& motion) : mass(motion.built.system.mass) {
    for (const PrescribedParticle& p : motion.of.scene.prescribed) mass[p.particle] = 0;
    if (!(mass.sum() > 0)) throw NotOffered{"free particles"};
  }
  Vector3 of(const PerParticle3& x) const { return mean_by_mass(x, mass); }
};

/// Where the reference's centre is at each half interval of the frames, from its start on [m].
std::vector<Vector3> reference_centres(const FrameMotion& motion, const FreeCentre& centre,
                                       double half) {
  constexpr std::size_t fewest = 5, most = 10;  // frames
  const Scene& scene = motion.of.scene;
  const double size = (scene.x.rowwise().maxCoeff() - scene.x.rowwise().minCoeff()).norm();
  const std::size_t last = std::min(most, motion.frames.size() - 1);
  State now = motion.built.start;
  Schedule schedule = scene.schedule;
  schedule.frame_interval = half;
  std::vector<Vector3> centres{centre.of(now.x)};
  std::size_t wanted = 2 * last;
  for (std::size_t k = 1; k <= wanted + 1; ++k) {
    schedule.end = now.time + half;
    const RunResult run =
        simulate(motion.built.system, integrator_named(scene.integrator), now, schedule, {});
    if (run.stop) throw NotOffered{"a reference that runs: it stops, as " + run.stop->reason};
    now = run.last;
    centres.push_back(centre.of(now.x));
    const bool has_moved = (centres.back() - centres.front()).norm() >= share * size;
    if (k >= 2 * fewest && k % 2 == 0 && has_moved) wanted = std::min(wanted, k);
  }
  if (!((centres[wanted] - centres[0]).norm() >= share * size))
    throw NotOffered{
        fmt::format("a motion to compare: in {} frames the reference's centre moves by less than 1 "
                    "% of the cloth's size",
                    last)};
  return centres;
}

/// The interval of the first frames, the same for as many as are compared [s].
double first_interval(const FrameMotion& motion) {
  if (motion.frames.size() < 2) throw NotOffered{"a second frame"};
  const double h = motion.frames[1].time - motion.frames[0].time;
  for (std::size_t k = 1; k + 1 < std::min<std::size_t>(motion.frames.size(), 11); ++k)
    if (!are_equally_spaced(h, motion.frames[k + 1].time - motion.frames[k].time))
      throw NotOffered{"equally spaced frames"};
  return h;
}

}  // namespace

Finding centre_falls_freely(const FrameMotion& motion) {
  require_particles(motion);
  require_start(motion);
  const std::size_t count = count_free_frames(motion);
  if (const std::string why = why_not_in_free_fall(motion, count); !why.empty())
    throw NotOffered{why};
  const PerParticle& mass = motion.built.system.mass;
  const Vector3 gravity = *motion.of.scene.gravity, down = gravity.normalized();
  const Vector3 start = mean_by_mass(motion.of.scene.v, mass);
  const double h = motion.frames[1].time - motion.frames[0].time;
  Table measured(
      "last frame [s]; acceleration's error [g]; allowed of it [g]; start velocity's error along "
      "gravity [m/s]; start velocity's error across gravity [m/s]; largest error over allowed [1]");
  for (std::size_t k = 2; k < count; ++k) {
    const Parabola p =
        parabola_through(motion.frames[0], motion.frames[k / 2], motion.frames[k], mass);
    const Allowed allowed = allowed_of(p, gravity.norm(), h, motion.rounding());
    const double off = (p.acceleration - gravity).norm();
    const double along = std::abs((p.velocity - start).dot(down));
    const double across = ((p.velocity - start) - down * (p.velocity - start).dot(down)).norm();
    Worst worst;
    worst.observe(off / allowed.acceleration);
    worst.observe(along / allowed.along);
    worst.observe(across / allowed.across);
    measured.row(motion.frames[k].time, off / gravity.norm(), allowed.acceleration / gravity.norm(),
                 along, across, worst.value());
  }
  return judge_worst(
      measured, 1,
      "internal forces cannot move the centre: through the first, middle and last frame it has g "
      "and the case's velocity, to 1 %, the file's rounding and the start of a scheme with a step "
      "a frame, together in the column of what is allowed");
}

// Over two frame intervals, of mean M: M(kinetic) >= that of the mean velocity (Jensen), M(weight)
// by Simpson's rule, M(elastic) >= 0, and M(total) <= the start's, for nothing does work. In free
// fall both are exact. Where an impact turns the centre by dv, Simpson's rule adds at most m g h
// dv/36, but Jensen leaves out m p (1 - p) dv^2/2, p being the impact's share of the time: more,
// but for an impact slower than g h.
Finding motion_stays_in_budget(const FrameMotion& motion) {
  require_closed_budget(motion);
  const Energies start = energies(motion.built.system, start_state(motion.of.scene));
  Table measured(
      "time [s]; kinetic and weight less the start's total [J]; allowed excess [J]; measured over "
      "allowed [1]");
  double largest = 0;
  for (std::size_t k = 1; k + 1 < motion.frames.size(); ++k) {
    const double before = motion.frames[k].time - motion.frames[k - 1].time;
    const double after = motion.frames[k + 1].time - motion.frames[k].time;
    if (!are_equally_spaced(before, after)) continue;
    const State mean = mean_state(motion.frames, k);
    Energies now = energies(motion.built.system, mean);
    now.stretch = start.stretch, now.bending = start.bending;
    largest = std::max(largest, exchanged(now, start));
    const double excess = now.kinetic + now.gravity - start.total();
    const double allowed = share * largest + motion_rounding(motion, mean, before + after) +
                           first_order_start(motion, before);
    measured.row(mean.time, excess, allowed, excess <= 0 ? 0 : excess / allowed);
  }
  if (measured.rows() == 0) throw NotOffered{"three equally spaced frames"};
  return judge_worst(measured, 1,
                     "nothing does work on the cloth: the energy of the mean velocity and weight "
                     "over two frame intervals never exceeds the start's total; 1 % of the largest "
                     "exchange (empirical: the balance of cases without contact), rounding of the "
                     "file and a first-order start are allowed");
}

// A first-order scheme with a step up to a frame, h, is early or late by up to h/2: its centre is
// on the reference's path between t - h/2 and t + h/2.
Finding starts_as_the_reference(const FrameMotion& motion) {
  require_particles(motion);
  require_start(motion);
  if (why_not_in_free_fall(motion, count_free_frames(motion)).empty())
    throw NotOffered{"a centre that its weight alone does not explain: it falls freely"};
  constexpr double models = 0.1;  // empirical: what contact and the discretisation may change [1]
  const double h = first_interval(motion);
  const FreeCentre centre(motion);
  const std::vector<Vector3> reference = reference_centres(motion, centre, h / 2);
  Table measured(
      "time [s]; reference's displacement [m]; the frames' [m]; distance of both [m]; allowed "
      "difference [m]; measured over allowed [1]");
  for (std::size_t k = 1; 2 * k + 1 < reference.size(); ++k) {
    const Vector3 wanted = reference[2 * k] - reference[0];
    const Vector3 moved = centre.of(motion.frames[k].x) - centre.of(motion.frames[0].x);
    const double off_in_time = std::max((reference[2 * k + 1] - reference[2 * k]).norm(),
                                        (reference[2 * k - 1] - reference[2 * k]).norm());
    const double allowed =
        off_in_time + models * wanted.norm() + 2 * std::sqrt(3.0) * motion.rounding();
    const double off = (moved - wanted).norm();
    measured.row(motion.frames[k].time, wanted.norm(), moved.norm(), off, allowed, off / allowed);
  }
  return judge_worst(measured, 1,
                     "half a frame early or late, as a first-order scheme with a step a frame is; "
                     "10 % for contact and discretisation (empirical); rounding of the file");
}

}  // namespace foldproof
