// Two pieces of cloth that meet in one place: vertices and triangles, edges and edges.

#include "verification/oracles/exact_crossings.h"
#include "verification/subjects/suite/contact/obstacle_scenes.h"

namespace foldproof {

namespace {

using namespace suite;

/// Two pieces of cloth that meet in one place, the second one over the first. Ridges meet at an
/// edge whose ends are on no border.
struct Pair {
  const char* name;
  PerParticle3 under, over;
  std::vector<Triangle> triangles;  // of each
};

PerParticle3 points(std::initializer_list<Vector3> all) {
  PerParticle3 x(3, Eigen::Index(all.size()));
  Eigen::Index i = 0;
  for (const Vector3& p : all) x.col(i++) = p;
  return x;
}

std::vector<Pair> pairs() {
  const PerParticle3 large = points({{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0, 0.2, 0}}),
                     small = points({{-0.01, -0.01, 0}, {0.01, -0.01, 0.002}, {0, 0.02, 0.001}}),
                     one = points({{-0.1, 0, 0}, {0.1, 0, 0}, {0, 0.2, 0}}),
                     other = points({{0.01, -0.3, 0}, {0.01, 0.1, 0}, {-0.2, -0.1, 0.29}}),
                     ridge = points({{-0.1, 0, 0},
                                     {-0.03, 0, 0},
                                     {0.04, 0, 0},
                                     {0.1, 0, 0},
                                     {0, -0.1, -0.05},
                                     {0, 0.1, -0.05}}),
                     across = points({{0.013, -0.1, 0},
                                      {0.014, -0.04, 0},
                                      {0.016, 0.03, 0},
                                      {0.017, 0.1, 0},
                                      {0.1, 0, 0.05},
                                      {-0.09, 0, 0.05}});
  const std::vector<Triangle> alone{{0, 1, 2}},
      joined{{0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {1, 5, 0}, {2, 5, 1}, {3, 5, 2}};
  return {{"vertices over a triangle", large, small, alone},
          {"a triangle over vertices", small, large, alone},
          {"edges crosswise", one, other, alone},
          {"ridges crosswise", ridge, across, joined}};
}

/// How a pair meets.
struct Meeting {
  const char* name;
  double speed;      // m/s, of the piece over the other
  bool from_behind;  // both turned upside down: each meets the other's back
  bool is_first;     // in the mesh, the piece that is thrown
  bool is_held;      // the other one
  bool has_plane;    // far from both
};

constexpr double pair_gap = 0.011;  // m

PortableScene pair_that_meets(const Pair& pair, const Meeting& how) {
  const auto piece = [&](const PerParticle3& x) {
    PerParticle3 placed = x;
    if (how.from_behind) placed.row(2) *= -1;
    return resting("", make_triangle_mesh(placed, pair.triangles), {.young = 0.1});
  };
  const double up = how.from_behind ? -1 : 1;
  PortableScene under = piece(pair.under), over = shifted(piece(pair.over), {0, 0, up * pair_gap});
  over.v.row(2).setConstant(-up * how.speed);
  if (how.is_held)
    for (int i = 0; i < int(under.x.cols()); ++i) under.held.push_back(i);
  PortableScene scene =
      together(std::string(pair.name) + how.name,
               how.is_first ? std::vector{over, under} : std::vector{under, over});
  if (how.has_plane) scene.planes = {{{0, 0, -1}, Vector3::UnitZ(), 0.3}};
  scene.dt = 0.002;
  scene.thickness = 0.004;
  return scene;
}

/// Whether a triangle is on the wrong side of another's plane, whole: `up` is the right one.
bool is_through(const PerParticle3& plane, const PerParticle3& x, double up) {
  const Vector3 normal = Vector3(plane.col(1) - plane.col(0)).cross(plane.col(2) - plane.col(0));
  const double side = normal.z() > 0 ? up : -up;
  const Eigen::RowVectorXd out =
      side * normal.normalized().transpose() * (x.colwise() - plane.col(0));
  return out.maxCoeff() < -0.001;
}

/// Pieces that meet stop or are pushed away, from the front or from behind, in any mesh order.
Finding pairs_that_meet_stop(Trial& trial) {
  std::vector<Meeting> meetings{
      {"", 1, false, false, true, false},
      {", from behind and fast", drawn("a fast meeting", 2.2, 2.8), true, true, true, false},
      {", both free", 1.2, false, true, false, false},
      {", slowly", 0.015, true, false, true, false}};
  if (trial.declaration().offers("planes"))
    meetings.push_back({", beside a plane", 0.9, true, false, true, true});
  Table measured = table_of("pieces | time [s] | edges in triangles, or pieces through [1]");
  for (const Pair& pair : pairs())
    for (const Meeting& how : meetings) {
      const PortableScene scene = pair_that_meets(pair, how);
      const Eigen::Index half = scene.x.cols() / 2;
      // 0.01 to 0.03 m on their way
      const std::vector<long> steps = multiples(std::max(2L, std::lround(2 / how.speed)), 5);
      const std::vector<Snapshot> states = trial.motion(scene, steps);
      for (size_t k = 0; k < steps.size(); ++k) {
        const PerParticle3 &x = states[k].x, first = x.leftCols(half), last = x.rightCols(half),
                           &over = how.is_first ? first : last,
                           &under = how.is_first ? last : first;
        const double up = how.from_behind ? -1 : 1;
        const bool is_past = pair.under.col(2).y() == 0.2
                                 ? is_through(under, over, up)
                                 : pair.over.col(2).y() == 0.2 && is_through(over, under, -up);
        measured.row(
            scene.name, double(steps[k]) * scene.dt,
            double(oracles::exact_crossings(x, scene.mesh.triangles).size()) + (is_past ? 1 : 0));
      }
    }
  return judge_worst(measured, 0, "pairs that meet are counted without rounding");
}

/// Particles of unequal masses, where they can have them, share an impulse unequally.
Finding pairs_that_meet_keep_momentum(Trial& trial) {
  Table measured = table_of(
      "pieces | impulse [of what stops them] | momentum gained by both [of it] | spin gained by "
      "both [of it, times the lever] | kinetic energy [of the start] | largest of the momentum, of "
      "half of the spin, and of 0.4 of the energy gained [1]");
  for (const Pair& pair : pairs()) {
    PortableScene scene = pair_that_meets(pair, {", both free", 1.2, false, false, false, false});
    if (trial.declaration().offers("masses")) {
      scene.own_masses = true;
      for (Eigen::Index i = 0; i < scene.mass.size(); ++i)
        scene.mass[i] *= 1 + 0.4 * std::sin(2.1 * double(i) + 0.5);
    }
    const Eigen::Index half = scene.x.cols() / 2;
    const Snapshot end = trial.after(scene, 10);
    const double under = scene.mass.head(half).sum(), over = scene.mass.tail(half).sum(),
                 unit = 1.2 * under * over / (under + over),  // kg m/s
        lever = largest(scene.x.colwise() - middle_of(scene.x));
    const double hit = (end.v.leftCols(half) * scene.mass.head(half)).norm() / unit,
                 gained = (momentum_of(scene, end.v) - momentum_of(scene, scene.v)).norm() / unit,
                 turned = (spin_of(scene, end) - spin_of(scene, {scene.x, scene.v})).norm() / unit /
                          lever;
    if (!(hit > 0.05))
      throw FailedWithoutNumber(scene.name + ": the pieces do not meet", "pieces that meet");
    const double energy = kinetic_energy(scene, end.v) / kinetic_energy(scene, scene.v);
    measured.row(pair.name, hit, gained, turned, energy,
                 std::max({gained, turned / 2, (energy - 1) / 2.5}));
  }
  return judge_worst(measured, 0.02,
                     "opposite forces; on pieces that turn fast, their line is a first order "
                     "method's: off by the way of a step");
}

/// The piece that is hit turns about its one held particle, which has no moment about itself.
Finding what_is_held_is_turned_about(Trial& trial) {
  Table measured = table_of(
      "pieces | impulse [of what was thrown] | spin gained about what is held [of what was thrown, "
      "times the lever]");
  for (const Pair& pair : pairs())
    for (const int corner : {0, int(pair.under.cols()) - 1}) {
      PortableScene scene =
          pair_that_meets(pair, {", one particle held", 1.2, false, false, false, false});
      scene.held = {corner};
      const Eigen::Index half = scene.x.cols() / 2;
      const Vector3 about = scene.x.col(corner);
      const auto turning = [&](const Snapshot& now) {
        return torque_of(now.x.colwise() - about, now.v * scene.mass.asDiagonal());
      };
      const Snapshot end = trial.after(scene, 10);
      const double thrown = 1.2 * scene.mass.tail(half).sum(),  // kg m/s
          lever = largest(scene.x.colwise() - about);
      const PerParticle3 sped = end.v - scene.v;
      const double hit = (sped.rightCols(half) * scene.mass.tail(half)).norm() / thrown;
      if (!(hit > 0.03))
        throw FailedWithoutNumber(scene.name + ": the pieces do not meet", "pieces that meet");
      measured.row(pair.name, hit,
                   (turning(end) - turning({scene.x, scene.v})).norm() / thrown / lever);
    }
  return judge_worst(measured, 0.04,
                     "opposite forces in one line, and one that goes through what is held; on "
                     "pieces that turn fast, a first order method's line is off by a step's way");
}

}  // namespace

std::vector<Law> pair_laws() {
  return {
      {"self-collision.vertices-and-edges-stop",
       "A vertex that meets a triangle, and an edge that meets an edge, inside or on a border, "
       "stop or are pushed away: from the front, from behind, held, free, fast, in any order.",
       "impenetrability", pairs_that_meet_stop, "self_collision held"},
      {"self-collision.pairs-that-meet-keep-momentum",
       "Vertices, triangles and edges that meet, of unequal masses, keep their momentum and spin, "
       "and gain no energy.",
       "action and reaction", pairs_that_meet_keep_momentum, "self_collision",
       "pieces | impulse | momentum gained by both"},
      {"self-collision.what-is-hit-turns-about-what-is-held",
       "A piece that is hit while one of its particles is held turns about it, and the spin of "
       "both about it is kept.",
       "action and reaction", what_is_held_is_turned_about, "self_collision held",
       "pieces | impulse | spin gained about what is held"},
  };
}

}  // namespace foldproof
