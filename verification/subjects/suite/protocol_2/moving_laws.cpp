// What moves by itself: held particles on a path, and obstacles that carry the cloth.
#include <cmath>

#include <Eigen/Geometry>

#include "verification/subjects/suite/protocol_2/carriers.h"

namespace foldproof {

namespace {

using namespace suite;

Vector3 drift() {
  return {drawn("drift x", 0.2, 0.4), drawn("drift y", -0.3, -0.1), drawn("drift z", 0.1, 0.3)};
}

/// The held ones go through these places, the first of them at time 0.
void lead(PortableScene& scene, const std::vector<double>& times,
          const std::vector<Vector3>& ways) {
  scene.moving_held.times = times;
  for (const Vector3& way : ways) {
    PerParticle3 at(3, Eigen::Index(scene.held.size()));
    for (size_t k = 0; k < scene.held.size(); ++k)
      at.col(Eigen::Index(k)) = scene.x.col(scene.held[k]) + (double(k) + 1) * way;
    scene.moving_held.x.push_back(at);
  }
  for (size_t k = 0; k < scene.held.size(); ++k)
    scene.v.col(scene.held[k]) = (double(k) + 1) * (ways[1] - ways[0]) / (times[1] - times[0]);
}

/// Two corners on bent paths whose bends fall into steps; after the last time they rest.
Finding held_follow_their_path(Trial& trial) {
  PortableScene scene = hanging_sheet();
  scene.name = "sheet with moving corners";
  const double bend = drawn("bend", 0.0231, 0.0239), end = drawn("end of path", 0.0441, 0.0449);
  const Vector3 first = 0.02 * drift(), last = 0.03 * Vector3(-drift().y(), drift().x(), 0.1);
  lead(scene, {0, bend, end}, {Vector3::Zero(), first, last});
  Table measured = table_of("time [s] | particle [1] | off its path [of the path]");
  const std::vector<long> at{7, 16, 28};
  const std::vector<Snapshot> states = trial.motion(scene, at);
  for (size_t f = 0; f < at.size(); ++f) {
    const double time = double(at[f]) * scene.dt;
    const Vector3 way = time < bend ? Vector3(time / bend * first)
                        : time < end
                            ? Vector3(first + (time - bend) / (end - bend) * (last - first))
                            : last;
    for (size_t k = 0; k < scene.held.size(); ++k) {
      const int i = scene.held[k];
      const Vector3 due = scene.x.col(i) + (double(k) + 1) * way;
      measured.row(time, i, (states[f].x.col(i) - due).norm() / first.norm());
    }
  }
  const double rounding =
      8 * trial.declaration().rounding() * largest(scene.x) * double(at.back()) / first.norm();
  return judge_worst(measured, narrow(1e-9 + rounding, trial.declaration()),
                     "the place at each stated time is given; a rounding of positions a step");
}

/// All of it moves as its held corners do: nothing is strained, so nothing changes.
Finding led_sheet_goes_along(Trial& trial) {
  PortableScene scene = sheet_at_rest();
  scene.name = "sheet led by its corners";
  scene.held = {0, 6};
  const Vector3 velocity = 4 * drift();
  scene.v.colwise() = velocity;
  if (trial.declaration().offers("damping"))
    scene.material.stretch_damping = scene.dt * scene.material.young / 2;
  constexpr long steps = 12;
  const double end = steps * scene.dt;
  scene.moving_held = {{0, end}, {}};
  for (const double time : scene.moving_held.times) {
    PerParticle3 at(3, 2);
    for (size_t k = 0; k < 2; ++k)
      at.col(Eigen::Index(k)) = scene.x.col(scene.held[k]) + time * velocity;
    scene.moving_held.x.push_back(at);
  }
  const Snapshot now = trial.after(scene, steps);
  const PerParticle3 due = scene.x.colwise() + end * velocity;
  Table measured = table_of("time [s] | way [m] | largest distance from it [of the way]");
  measured.row(end, end * velocity.norm(), largest(now.x - due) / (end * velocity.norm()));
  const double rounding =
      narrow_rounding(trial, scene, steps) * largest(due) / (end * velocity.norm());
  return judge_worst(measured, narrow(rounding, trial.declaration()),
                     "a sheet in its rest shape that moves evenly has no forces in it: rounding");
}

// ---- obstacles that move

/// A belt: the sheet gains mu g t until it goes as fast as what it lies on; a lift takes it along.
Finding carried_by_friction(Trial& trial) {
  Table measured = table_of(
      "obstacle | mu [1] | speed of the obstacle [m/s] | way [m] | by Coulomb's law [m] | "
      "difference [of the obstacle's way]");
  constexpr long steps = 100;
  for_each_carrier(trial, [&](const Carrier& carrier) {
    for (const double mu : {drawn("mu of a belt", 0.15, 0.25), drawn("mu that grips", 0.8, 1.2)}) {
      PortableScene scene = sheet_on_top("sheet on a belt");
      const double end = steps * scene.dt, heading = drawn("heading of a belt", 0.3, 1.2);
      const double speed = drawn("speed of a belt", 0.45, 0.6), lift = 0.3;
      const Vector3 along(std::cos(heading), std::sin(heading), 0);
      carrier.put(scene, mu, straight(speed * along + lift * Vector3::UnitZ(), 1.01 * end));
      scene.v.colwise() = lift * Vector3::UnitZ();
      const Vector3 way = (trial.after(scene, steps).x - scene.x).rowwise().mean();
      const double slips = std::min(end, speed / (mu * weight));
      const double due = mu * weight * slips * slips / 2 + speed * (end - slips);
      const Vector3 expected = due * along + lift * end * Vector3::UnitZ();
      measured.row(carrier.capability, mu, speed, way.norm(), expected.norm(),
                   (way - expected).norm() / (speed * end));
    }
  });
  return judge_worst(measured, 0.05,
                     "a first order method errs by 1 %, the step in which contact begins by "
                     "2 %, and friction that a bound scheme gives a step late by as much");
}

/// On a turntable that grips, it turns along with what is under it.
Finding turned_by_a_turntable(Trial& trial) {
  Table measured =
      table_of("obstacle | turn [rad] | largest distance from where it is due [of its way]");
  constexpr long steps = 100;
  for_each_carrier(trial, [&](const Carrier& carrier) {
    PortableScene scene = sheet_on_top("sheet on a turntable");
    const double end = steps * scene.dt, rate = drawn("rate of a turntable", 1.5, 2);
    scene.x.row(0).array() += 0.3;
    scene.mesh.rest = scene.x;
    const Eigen::AngleAxisd turn(rate * end, Vector3::UnitZ());
    carrier.put(scene, 2, {{{0, {}}, {end, {Eigen::Quaterniond(turn), Vector3::Zero()}}}});
    for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
      scene.v.col(i) = rate * Vector3::UnitZ().cross(Vector3(scene.x.col(i)));
    const PerParticle3 due = turn.toRotationMatrix() * scene.x;
    measured.row(carrier.capability, rate * end,
                 largest(trial.after(scene, steps).x - due) / largest(due - scene.x));
  });
  return judge_worst(measured, 0.05,
                     "a first order method leaves its circle by rate dt/2 of a turn, 1 %; friction "
                     "that lags a step, and the curvature of a ball of 20 m, 2 %");
}

/// Two boxes close on the upper edge of a sheet, lift it, and hold it.
PortableScene gripped_sheet(double closed, double lifted, double lift, double end) {
  PortableScene scene = small_sheet();
  scene.name = "sheet in a grip";
  scene.x.colwise() -= middle_of(scene.x);
  scene.x.row(2) = scene.x.row(1), scene.x.row(1).setZero();  // upright
  scene.mesh.rest = scene.x;
  scene.gravity = Vector3(0, 0, -weight);
  const double top = scene.x.row(2).maxCoeff(), pad = 0.02, open = 0.01, press = 0.001;  // m
  for (const double side : {-1.0, 1.0}) {
    const auto at = [&](double time, double in, double up) -> Keyframe {
      return {time, {Eigen::Quaterniond::Identity(), Vector3(0, side * (open - in), up)}};
    };
    scene.boxes.push_back({{0, side * pad, top},
                           {0.2, pad, 0.03},
                           0.7,
                           {{at(0, 0, 0), at(closed, open + press, 0),
                             at(lifted, open + press, lift), at(end, open + press, lift)}}});
  }
  return scene;
}

Finding grip_lifts_and_holds(Trial& trial) {
  constexpr double closed = 0.02, lifted = 0.2, end = 2;  // s
  const double lift = drawn("lift", 0.08, 0.12);
  const PortableScene scene = gripped_sheet(closed, lifted, lift, end);
  const double top = scene.x.row(2).maxCoeff();
  const auto slip = [&](const Snapshot& now) {
    double most = 0;
    for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
      if (scene.x(2, i) > top - 0.03)
        most = std::max(most, (now.x.col(i) - scene.x.col(i) - lift * Vector3::UnitZ()).norm());
    return most;
  };
  const long at_lift = std::lround(lifted / scene.dt), at_end = std::lround(end / scene.dt);
  const std::vector<Snapshot> states = trial.motion(scene, {at_lift, at_end});
  const double first = slip(states[0]), last = slip(states[1]);
  Table measured = table_of(
      "lift [m] | behind after it [m] | behind at the end [m] | creep [um/s] | behind [of the "
      "lift]");
  measured.row(lift, first, last, 1e6 * (last - first) / (end - lifted), last / lift);
  return judge_worst(measured, 0.05,
                     "until the boxes touch it the sheet falls by g t^2/2 = 2 mm, 2 %; what is "
                     "held fast between two boxes then goes along");
}

}  // namespace

std::vector<Law> moving_laws() {
  return {
      {"moving.held-particles-follow-their-path",
       "Held particles are where they are said to be, while they move and after.", "protocol",
       held_follow_their_path, "held moving_held"},
      {"moving.led-sheet-goes-along",
       "A sheet that moves as its held particles do stays in its shape.", "Galilean invariance",
       led_sheet_goes_along, "held moving_held"},
      {"moving.friction-carries-the-sheet",
       "On an obstacle that moves, a sheet gains speed by friction until it goes along.", "Coulomb",
       carried_by_friction, "moving_obstacles", "mu | way | by Coulomb's law"},
      {"moving.turntable-turns-the-sheet",
       "A sheet on an obstacle that turns, and grips, turns along.", "Coulomb",
       turned_by_a_turntable, "moving_obstacles"},
      {"moving.grip-lifts-and-holds",
       "A sheet between two boxes that close on it and lift it goes along, and does not creep out.",
       "Coulomb", grip_lifts_and_holds, "boxes moving_obstacles", "behind at the end | creep"},
  };
}

}  // namespace foldproof
