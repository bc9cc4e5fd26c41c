// Points that are inside two objects, and points that depend on several particles.
#include "reference/filters/object_collision.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/contact_scenes.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

/// d(psi)/dt = (v - v_a).N_a - (v - v_b).N_b for the difference psi of the two depths [m/s].
double rate(const KnownPoint& a, const KnownPoint& b, const Vector3& v) {
  return (v - a.velocity).dot(a.normal) - (v - b.velocity).dot(b.normal);
}

Finding equal_depth_finding(const Subject& subject) {
  const Pinch pinch = known_pinch();
  const PerParticle3 after = corrected_by_objects(subject, pinch.scene, pinch.span, pinch.state);
  Table measured = roundings_of("depth and speed times step");
  Worst worst;
  for (Eigen::Index i = 0; i < after.cols(); ++i) {
    const Vector3 p = pinch.state.x.col(i);
    const KnownPoint a = pinch.first(p, pinch.span), b = pinch.second(p, pinch.span);
    const double psi = a.phi - b.phi + pinch.tau * rate(a, b, after.col(i));
    const double across = (a.normal - b.normal).norm();
    worst.observe(std::abs(psi) / (epsilon * (1 + pinch.tau * Vector3(after.col(i)).norm()) /
                                   std::min(1.0, across)));
  }
  measured.row("two balls, " + std::to_string(after.cols()) + " particles inside both",
               worst.value());
  return judge_worst(measured, 40,
                     "as many roundings as a forecast against one object takes, twice");
}

/// A velocity along the surface between two objects, without what leads deeper into both.
Vector3 without_sinking(const KnownPoint& a, const KnownPoint& b, const Vector3& v) {
  const Vector3 out = (a.normal + b.normal).normalized();
  return (a.normal + b.normal).norm() > 0.1 ? Vector3(v + std::max(0.0, -v.dot(out)) * out) : v;
}

/// The velocity along the surface between both objects is shortened, not turned, by at most the sum
/// of both Coulomb limits, and then loses what leads deeper into both.
Finding pinch_friction_finding(const Subject& subject) {
  const Pinch pinch = known_pinch();
  const PerParticle3 after = corrected_by_objects(subject, pinch.scene, pinch.span, pinch.state);
  Table measured = roundings_of("speed");
  Worst worst;
  double stuck = 0, slid = 0;
  for (Eigen::Index i = 0; i < after.cols(); ++i) {
    const Vector3 p = pinch.state.x.col(i), v = pinch.state.v.col(i), v_after = after.col(i);
    const KnownPoint a = pinch.first(p, pinch.span), b = pinch.second(p, pinch.span);
    const Vector3 n = (a.normal - b.normal).normalized(), mean = (a.velocity + b.velocity) / 2;
    const auto tangent = [&](const Vector3& u) { return Vector3(u - u.dot(n) * n); };
    const Vector3 sliding = tangent(v - mean), still = tangent(v_after - mean);
    const auto push = [&](const KnownPoint& k) {
      return std::max(0.0, -(k.phi / pinch.tau + (v - k.velocity).dot(k.normal)));
    };
    const double most = pinch.friction_first * push(a) + pinch.friction_second * push(b);
    const double wanted = std::max(0.0, sliding.norm() - most);
    (wanted > 0 ? slid : stuck) += 1;
    worst.observe((still - without_sinking(a, b, wanted * sliding.normalized())).norm() /
                  (epsilon * (1 / pinch.tau + v.norm() + mean.norm())));
  }
  measured.row("two balls", stuck > 20 && slid > 20 ? worst.value() : nan);
  return judge_worst(
      measured, 200,
      "roundings of positions near 1 m over the step, magnified by at most 1/|N_a - N_b| where the "
      "normals of the two balls differ little",
      std::to_string(int(stuck)) + " particles stick, " + std::to_string(int(slid)) + " slide");
}

/// A floor and a wall that meet in a corner, particles near it outside both.
Scene corner() {
  Scene scene = loose_particles(20);
  const Eigen::Quaterniond wall = oracles::rotation_between(Vector3::UnitZ(), Vector3(1, 0.2, 0.1));
  scene.objects.push_back(object_at("floor", HalfSpace{}, {}));
  scene.objects.push_back(object_at("wall", HalfSpace{}, {wall, Vector3::Zero()}));
  return scene;
}

Finding each_object_finding(const Subject& subject) {
  const Scene scene = corner();
  const double h = 0.01;
  const Span span{0, h, h};
  Random random(31);
  const Vector3 floor(0, 0, 1), wall = Vector3(1, 0.2, 0.1).normalized();
  State state{0, scene.x, random.vectors(scene.x.cols(), 20)};
  for (Eigen::Index i = 0; i < state.x.cols(); ++i)
    state.x.col(i) = random.uniform(0, 0.2) * wall + random.uniform(0.02, 0.2) * floor +
                     Vector3(0, random.uniform(-1, 1), 0);
  const PerParticle3 after = corrected_by_objects(subject, scene, span, state);
  Worst deepest;
  double corrected_twice = 0;
  for (Eigen::Index i = 0; i < after.cols(); ++i) {
    const Vector3 p = state.x.col(i), end = p + h * after.col(i), free = p + h * state.v.col(i);
    deepest.observe(-std::min(end.dot(floor), end.dot(wall)));
    corrected_twice += free.dot(floor) < 0 && free.dot(wall) < 0;
  }
  return {{corrected_twice > 10 ? deepest.value() : nan, 100 * epsilon, 0, "m",
           "the second push leads out of the first object too, since the normals enclose less than "
           "a right angle: what remains is rounding of positions within 1 m and steps of 0.2 m"},
          Table{{"particles that would enter both", "1"}}.with_row(corrected_twice)};
}

/// The half-spaces z >= 0 of a floor and of one turned about y, particles without
/// friction between them.
Scene wedge(double degrees, const Eigen::Quaterniond& frame) {
  Scene scene = loose_particles(5);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(degrees * pi / 180, Vector3::UnitY()));
  const Vector3 edge = frame * Vector3::UnitY();
  scene.objects.push_back(object_at("floor", HalfSpace{}, {frame, 0.37 * edge}));
  scene.objects.push_back(object_at("other", HalfSpace{}, {frame * turn, -0.53 * edge}));
  return scene;
}

/// Particles outside both half-spaces that would enter both. Normals more than 120 degrees apart:
/// held equally deep in both. Otherwise: on both surfaces.
Finding closing_finding(const Subject& subject) {
  const double h = 0.01;
  Random random(37);
  Table measured = roundings_of("place and way");
  for (const double degrees : {95., 118., 122., 150.}) {
    const Scene scene = wedge(degrees, Eigen::Quaterniond::Identity());
    const double angle = degrees * pi / 180;
    const Vector3 a = Vector3::UnitZ(), b(std::sin(angle), 0, std::cos(angle));
    const Eigen::Matrix2d gram{{1, a.dot(b)}, {a.dot(b), 1}};
    State state = resting_state(scene.x);
    for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
      const Eigen::Vector2d inwards =
          gram.inverse() * -Eigen::Vector2d(random.uniform(10, 20), random.uniform(10, 20));
      state.x.col(i) =
          random.uniform(0.01, 0.05) * (a + b).normalized() + Vector3(0, random.uniform(-1, 1), 0);
      state.v.col(i) = inwards[0] * a + inwards[1] * b + Vector3(0, random.uniform(-1, 1), 0);
    }
    const PerParticle3 after = corrected_by_objects(subject, scene, {0, h, h}, state);
    Worst worst;
    for (Eigen::Index i = 0; i < after.cols(); ++i) {
      const Vector3 end = state.x.col(i) + h * after.col(i);
      const double apart = std::abs(end.dot(a) - end.dot(b));
      const double farthest = std::max(std::abs(end.dot(a)), std::abs(end.dot(b)));
      const double size = Vector3(state.x.col(i)).norm() + h * Vector3(state.v.col(i)).norm();
      const double held = farthest > 1e-3 ? apart : nan;  // not led to both, either
      worst.observe((degrees > 120 ? held : farthest) / (epsilon * size));
    }
    measured.row(std::to_string(int(degrees)) + " degrees", worst.value());
  }
  return judge_worst(measured, 40,
                     "as many roundings as a forecast against one object takes, twice");
}

/// Particles within rounding of the edge where two walls meet, driven into both for a hundred
/// steps: depth in either, at most.
double depth_in_corner(const Subject& subject, double degrees) {
  const double h = 0.01, angle = degrees * pi / 180;
  const Eigen::Quaterniond frame(Eigen::AngleAxisd(0.7, Vector3(0.2, 0.9, -0.3).normalized()));
  const Scene scene = wedge(degrees, frame);
  const Vector3 a = frame * Vector3::UnitZ(),
                b = frame * Vector3(std::sin(angle), 0, std::cos(angle));
  const Vector3 out = (a + b).normalized(), aside = (a - b).normalized();
  State state = resting_state(scene.x);
  Random random(41);
  for (Eigen::Index i = 0; i < state.x.cols(); ++i)
    state.x.col(i) = random.uniform(-1, 1) * (frame * Vector3::UnitY()) +
                     epsilon * (random.uniform(-1, 1) * out + random.uniform(-1, 1) * aside);
  Worst deepest;
  for (int step = 0; step < 100; ++step) {
    for (Eigen::Index i = 0; i < state.x.cols(); ++i)
      state.v.col(i) = -random.uniform(1, 3) * out + random.uniform(-0.2, 0.2) * aside;
    state.v = corrected_by_objects(subject, scene, {0, h, h}, state);
    state.x += h * state.v;
    deepest.observe(
        -std::min((a.transpose() * state.x).minCoeff(), (b.transpose() * state.x).minCoeff()));
  }
  return deepest.value();
}

Finding corner_finding(const Subject& subject) {
  Table measured{{"normals apart", "degrees"}, {"largest depth", "m"}};
  for (const double degrees : {0., 25., 70., 90., 118., 124., 152., 168.})
    measured.row(degrees, depth_in_corner(subject, degrees));
  return judge_worst(measured, 200 * epsilon,
                     "a rounding of steps of 30 mm in each of a hundred steps, along 1 m");
}

/// Midpoints and centres get exactly the velocity of the response, by impulses that decrease with
/// the mass.
Finding shares_finding() {
  const Contact contact = known_contacts().front();
  System system = build_system(contact.scene);
  PerParticle inverse_mass = system.inverse_mass;
  Random random(5);
  for (Eigen::Index i = 0; i < inverse_mass.size(); ++i)
    inverse_mass[i] = i % 7 == 3 ? 0 : random.uniform(0.2, 3);
  Table measured = roundings_of("share");
  Worst mean, ratio, held;
  for (const CollisionPoint& point :
       collision_points(contact.scene.mesh, inverse_mass, PointKind::faces)) {
    double sum = 0;
    for (int k = 0; k < point.count; ++k) {
      sum += point.shares[k] / point.count;
      const double w = inverse_mass[point.particles[size_t(k)]],
                   w0 = inverse_mass[point.particles[0]];
      ratio.observe(std::abs(point.shares[k] * w0 - point.shares[0] * w) / epsilon);
      if (w == 0) held.observe(std::abs(point.shares[k]) / epsilon);
    }
    mean.observe(std::abs(sum - 1) / epsilon);
  }
  measured.row("the point takes the whole change", mean.value());
  measured.row("shares are as the inverse masses", ratio.value());
  measured.row("prescribed particles take none", held.value());
  return judge_worst(measured, 40,
                     "three divisions and sums of numbers near 1, shares up to 15 apart");
}

/// A sheet of loose particles falls onto a spike that none of them touches, with the points of this
/// kind kept out: depth of the spike in the means of these groups of particles.
template <class Groups>
Finding spike_finding(const Subject& subject, const Groups& groups, const Vector3& place,
                      PointKind needed) {
  constexpr double radius = 0.02, below = 0.015, h = 0.01;  // m, m, s
  const Vector3 middle = place - below * Vector3::UnitZ();
  Scene scene = loose_particles(5);
  scene.objects.push_back(
      object_at("spike", Sphere{radius}, {Eigen::Quaterniond::Identity(), middle}));
  State state{0, scene.x, PerParticle3::Zero(3, scene.x.cols())};
  state.v.row(2).setConstant(-1);
  Table depths{{"points", ""}, {"depth of a mean", "m"}};
  for (const auto& [name, kind] : {std::pair{"particles", PointKind::particles},
                                   {"edges", PointKind::edges},
                                   {"faces", PointKind::faces}}) {
    if (kind != PointKind::particles && kind != needed) continue;
    scene.collision.points = kind;
    const PerParticle3 x = state.x + h * corrected_by_objects(subject, scene, {0, h, h}, state);
    Worst deepest;
    for (const auto& group : groups) {
      Vector3 mean = Vector3::Zero();
      for (const int i : group) mean += x.col(i) / double(std::size(group));
      deepest.observe(radius - (mean - middle).norm());
    }
    depths.row(name, deepest.value());
  }
  const std::vector<double>& depth = depths.numbers("depth of a mean");
  return {{depth[0] > 1e-3 ? depth[1] : nan, 20 * epsilon, 0, "m",
           "the point comes down on the spike's top and is held there, up to rounding"},
          depths,
          "not a number if the particles alone keep the spike out"};
}

Finding centres_finding(const Subject& subject) {
  return spike_finding(subject, loose_particles(5).mesh.triangles, {1. / 6, 1. / 12, 0},
                       PointKind::faces);
}

Finding midpoints_finding(const Subject& subject) {
  std::vector<std::array<int, 2>> ends;
  for (const Edge& edge : loose_particles(5).mesh.edges) ends.push_back({edge.a, edge.b});
  return spike_finding(subject, ends, {1. / 8, 0, 0}, PointKind::edges);
}

/// A triangle of different masses; only its centre is kept out of the ball that it falls onto.
struct ComingDown {
  ObjectCollision filter;
  State state;
};

ComingDown coming_down() {
  const SceneObject ball = object_at("ball", Sphere{0.21},
                                     {Eigen::Quaterniond::Identity(), Vector3(0.02, -0.03, -0.22)});
  CollisionPoint centre;
  centre.particles = {2, 0, 1};
  centre.count = 3;
  centre.shares = Vector3(0.6, 1.5, 0.9);
  ComingDown made{
      {{ball.object}, {centre}},
      resting_state(PerParticle3{{0.3, -0.2, -0.1}, {0.1, 0.3, -0.4}, {0.01, 0, -0.01}})};
  made.state.v = PerParticle3{{0.7, -0.4, 0.2}, {0.3, 0.9, -0.6}, {-3.1, -2.6, -3.7}};
  return made;
}

Finding change_finding() {
  Table measured = roundings_of("1 m/s");
  const ComingDown down = coming_down();
  const CollisionPoint& centre = down.filter.points[0];
  PerParticle3 v = down.state.v;
  Work work;
  down.filter.correct({0, 0.01, 0.01}, down.state, v, work);
  const PerParticle3 change = v - down.state.v;
  const Vector3 of_centre = centre.mean(change);
  for (int k = 0; k < 3; ++k) {
    const Vector3 of_corner = change.col(centre.particles[size_t(k)]);
    measured.row("corner " + std::to_string(k + 1),
                 (of_corner - centre.shares[k] * of_centre).norm() / epsilon);
  }
  measured.row("the ball is met", of_centre.norm() > 0.1 ? 0 : nan);
  return judge_worst(measured, 32, "velocities of a few m/s, a mean of three and a product");
}

Finding counts_finding() {
  Table measured{{"case", ""}, {"questions and contacts that are counted wrongly", "1"}};
  const ComingDown down = coming_down();
  const auto miscounted = [&](const Span& span, const PerParticle3& start, long contacts) {
    PerParticle3 v = start;
    Work work;
    down.filter.correct(span, down.state, v, work);
    return std::abs(double(work.object_queries - 1)) +
           std::abs(double(work.object_contacts - contacts));
  };
  measured.row("a move into the ball", miscounted({0, 0.01, 0.01}, down.state.v, 1));
  measured.row("a velocity at the end of a step", miscounted({0.01, 0.01, 0.01}, down.state.v, 0));
  measured.row("a move away", miscounted({0, 0.01, 0.01}, -down.state.v, 0));
  return judge_worst(measured, 0, "one point, asked once; a contact is a move that was changed");
}

}  // namespace

std::vector<Check> pinch_checks() {
  return {
      {"contact.pinched-points-end-equally-deep",
       "A point inside two objects is forecast to be equally deep in both: on the surface between "
       "them.",
       "BMF03 section 5.1", equal_depth_finding},
      {"contact.pinched-points-obey-coulomb",
       "Along the surface between them, friction reduces the point's velocity relative to the "
       "objects' mean by at most what both objects' pushes allow.",
       "BMF03 section 5.1", pinch_friction_finding},
      {"contact.closing-objects-hold-a-point-between-them",
       "A point that would enter two objects is held between them if their normals are more than "
       "120 degrees apart, and otherwise led to both surfaces.",
       "BMF03 section 5.2", closing_finding},
      {"contact.cloth-does-not-sink-into-a-corner",
       "A point driven into the corner of two walls for a hundred steps stays on their edge, "
       "whatever their angle.",
       "BMF03 section 5.2", corner_finding},
      {"contact.objects-beyond-the-nearest-count",
       "A point that is near one object and about to enter another is held out of both.",
       "BMF03 section 5.2", each_object_finding},
      {"contact.midpoints-and-centres-share-minimal-impulses",
       "Midpoints and centres pass the change of their velocity on to their particles by the least "
       "impulses.",
       "mechanics", shares_finding},
      {"contact.centres-pass-on-only-their-own-change",
       "Particles keep their velocities except for their shares of the change that the centre "
       "needs.",
       "mechanics", change_finding},
      {"contact.contacts-are-counted",
       "A point is tested once, and its contact counts if its move was changed.",
       "our own: cases are judged by it", counts_finding},
      {"contact.triangle-centres-stay-outside",
       "With centres of triangles as points, a spike between the particles does not come through.",
       "BMF03 section 5.2", centres_finding},
      {"contact.edge-midpoints-stay-outside",
       "With midpoints of edges as points, a spike between the particles does not come through.",
       "BMF03 section 5.2", midpoints_finding},
  };
}

}  // namespace foldproof
