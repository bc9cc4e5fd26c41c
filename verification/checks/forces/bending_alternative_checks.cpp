// Other models of bending: the laws of the paper's element that they violate, where they agree with
// it, and the buckling springs of Choi and Ko.
#include "verification/specimens/differences.h"
#include "verification/specimens/bending_alternatives.h"
#include "verification/specimens/buckling_column.h"
#include "verification/specimens/check.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

/// Violation of each law by four forces, relative to their size [1].
struct Defects {
  double force;   // |sum F_i| over sum |F_i|
  double torque;  // |sum x_i x F_i| about the centre over sum |x_i||F_i|
  // largest work on a motion of length 1 in the planes, over |F| as a vector of twelve
  double in_plane;
};

/// Motions that bend nothing and turn nothing: x1 and x2 in the planes of their triangles, and a
/// stretch of the edge.
std::vector<PerParticle3> in_plane_motions(const Corners& x) {
  const Vector3 edge = x[3] - x[2], none = Vector3::Zero();
  std::vector<PerParticle3> motions;
  const auto add = [&](const Corners& v) {
    PerParticle3 motion(3, 4);
    motion << v[0], v[1], v[2], v[3];
    motions.push_back(motion / motion.norm());
  };
  add({x[0] - x[2], none, none, none});
  add({edge, none, none, none});
  add({none, x[1] - x[2], none, none});
  add({none, edge, none, none});
  add({none, none, -edge, edge});
  return motions;
}

Defects defects_of(const Corners& x, const std::array<Vector3, 4>& force) {
  PerParticle3 f(3, 4), corners(3, 4);
  f << force[0], force[1], force[2], force[3];
  corners << x[0], x[1], x[2], x[3];
  Worst work;
  for (const PerParticle3& motion : in_plane_motions(x))
    work.observe(std::abs(motion.cwiseProduct(f).sum()) / f.norm());
  return {epsilon * net_force(f), epsilon * net_torque(corners, f), work.value()};
}

/// A folded hinge of the reference, and the paper's forces on it from the subject.
struct FoldedHinge {
  std::string name;
  Corners x, rest;
  Defects of_the_paper;
};

/// Random hinges at angles of either sign from .2 to 2.9 rad where |cos theta| > .1. Flat hinges
/// have no force in any model. At right angles the shortcut puts sin theta cos theta into the
/// edge's stretch, which happens to be right.
std::vector<FoldedHinge> folded_hinges(const Subject& subject) {
  constexpr int tries = 48;
  Random random(613);
  std::vector<FoldedHinge> list;
  for (unsigned k = 0; k < tries; ++k) {
    const double angle = random.uniform(-2.9, 2.9);
    if (!(std::abs(angle) > 0.2 && std::abs(std::cos(angle)) > 0.1)) continue;
    Specimen hinge = random_hinge(301 + k, angle);
    const Hinge& element = hinge.scene.mesh.hinges[0];
    const Corners x = corners_of(element, hinge.state.x);
    hinge.scene.bending = bending_variants()[0];
    const PerParticle3 f = Probe(subject, hinge.scene).elastic(hinge.state);
    const Corners force = corners_of(element, f), rest = corners_of(element, hinge.scene.mesh.rest);
    list.push_back({hinge.name, x, rest, defects_of(x, force)});
  }
  return list;
}

Finding acts_in_plane(const Subject& subject, const BendingAlternative& model) {
  Worst ratio;
  Table found(
      "hinge; in plane [1]; in plane, the paper's element [1]; net force [1]; net torque [1]");
  for (const FoldedHinge& hinge : folded_hinges(subject)) {
    const Defects defects = defects_of(hinge.x, model.force(hinge.x, hinge.rest));
    const double paper = hinge.of_the_paper.in_plane;
    found.row(hinge.name, defects.in_plane, paper, defects.force, defects.torque);
    ratio.observe(paper / defects.in_plane);
  }
  return {{found.rows() == 0 ? NAN : ratio.value(), 1e-6, 0, "1",
           "a millionth: a model's in-plane force is then not rounding, on any of the hinges"},
          found,
          "in plane: the largest work on an in-plane motion over the product of lengths, 1 if the "
          "force were that motion; measured is the paper's over the model's, at worst"};
}

/// The paper's element under the same measures, and a shortcut that is exact.
Finding paper_keeps_all(const Subject& subject) {
  Table measured = roundings_of("the forces, thinness");
  measured.add({"in plane, normals alone taken as constant", "epsilon thinness"});
  for (const FoldedHinge& hinge : folded_hinges(subject)) {
    Worst worst;
    for (double defect :
         {hinge.of_the_paper.force, hinge.of_the_paper.torque, hinge.of_the_paper.in_plane})
      worst.observe(defect / (epsilon * aspect_ratio(hinge.x)));
    const auto shortcut = shortcut_gradient(hinge.x, EdgeLength::differentiated);
    measured.row(hinge.name, worst.value(),
                 defects_of(hinge.x, shortcut).in_plane / (epsilon * aspect_ratio(hinge.x)));
  }
  return judge_worst(
      measured, "measured", 32,
      "sums of four forces and products with twelve numbers take fewer than 32 roundings, "
      "magnified by thinness",
      "Treating only the normals' lengths as constant loses nothing: in d(theta) = cos d(sin) - "
      "sin d(cos) their changes cancel. The edge's length must not be treated so.");
}

// ---- where other models agree with the paper's

constexpr double angle_range[] = {0.01, 0.03, 0.1, 0.3, 1};  // rad

/// F is ke c sin(theta/2) u here and ke c (theta/2) u there, for k_b = ke/24:
///   1 - sin(a)/a <= a^2/6 with a = theta/2, so that they differ by at most theta^2/24.
Finding discrete_shells_is_close(const Subject& subject) {
  Table found("hinge; angle [rad]; forces differ [1]; over the square of the angle [1/rad^2]");
  unsigned seed = 811;
  for (const double size : angle_range)
    for (const double angle : {size, -size}) {
      Specimen hinge = random_hinge(seed++, angle);
      const Hinge& element = hinge.scene.mesh.hinges[0];
      hinge.scene.rest_angles = {0};
      hinge.scene.bending = bending_variants()[0];
      const Corners x = corners_of(element, hinge.state.x),
                    rest = corners_of(element, hinge.scene.mesh.rest);
      const Corners force = corners_of(element, Probe(subject, hinge.scene).elastic(hinge.state));
      const auto other = discrete_shells_force(x, rest, 0);
      const double stiffness = hinge.scene.bending->stiffness / 24;
      double difference = 0, scale = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        difference += (stiffness * other[k] - force[k]).squaredNorm();
        scale += (stiffness * other[k]).squaredNorm();
      }
      const double relative = std::sqrt(difference / scale);
      found.row(hinge.name, angle, relative, relative / (angle * angle));
    }
  return judge_worst(found, "over the square of the angle", (1 + 1e-6) / 24,
                     "1 - sin(a)/a is at most a^2/6, a the half of the angle; a millionth of it "
                     "for the roundings at the least angle",
                     "k_b = ke/24");
}

/// Energies of isometric folds from flat, for k = ke/12 and with c = |E|^2/(2 A), A of
/// both triangles:
///   quadratic      ke c sin(theta/2)^2             = ke c (theta^2/4) (1 - theta^2/12 + ...)
///   the paper's    4 ke c sin(theta/4)^2           = ke c (theta^2/4) (1 - theta^2/48 + ...)
/// Their ratio cos(theta/4)^2 is 1 - theta^2/16 at least.
Finding quadratic_is_close(const Subject& subject) {
  Table found("hinge; angle [rad]; energies differ [1]; over the square of the angle [1/rad^2]");
  Random random(907);
  for (const double size : angle_range)
    for (const double angle : {size, -size}) {
      const double edge = random.uniform(0.05, 0.2), height = random.uniform(0.03, 0.2),
                   other_height = random.uniform(0.03, 0.2), foot = random.uniform(-0.1, 0.2),
                   other_foot = random.uniform(-0.1, 0.2);
      const auto folded = [&](double by) {
        return Corners{
            Vector3(foot, height, 0),
            Vector3(other_foot, -other_height * std::cos(by), -other_height * std::sin(by)),
            Vector3(0, 0, 0), Vector3(edge, 0, 0)};
      };
      const Corners rest = folded(0), x = folded(angle);
      Scene scene = hinge_scene(rest, 0);
      scene.bending = bending_variants()[0];
      const double paper = Probe(subject, scene).energy(state_of(x));
      const double quadratic = scene.bending->stiffness / 12 * quadratic_bending_energy(x, rest);
      const double relative = std::abs(quadratic / paper - 1);
      found.row("hinge " + std::to_string(found.rows() + 1), angle, relative,
                relative / (angle * angle));
    }
  return judge_worst(found, "over the square of the angle", (1 + 1e-6) / 16,
                     "the ratio of the energies is cos(theta/4)^2, which is 1 - theta^2/16 at "
                     "least; a millionth of it for the roundings at the least angle",
                     "k = ke/12");
}

constexpr const char* source = "Choi, Ko 2002, as later papers describe it";

Finding force_is_the_energys() {
  Table found("distance over length [1]; force [N]; error [1]");
  const BucklingSpring spring = BucklingColumn{}.spring;
  for (const double part : {.3, .62, .9, .97, .999}) {
    const double d = part * spring.length, change = 1e-5 * spring.length;
    const double slope = (8 * (spring.energy(d + change) - spring.energy(d - change)) -
                          (spring.energy(d + 2 * change) - spring.energy(d - 2 * change))) /
                         (12 * change);
    found.row(part, spring.force(d), std::abs(slope / spring.force(d) - 1));
  }
  return judge_worst(found, "error", 1e-7,
                     "differences in double precision over a hundred-thousandth of the length");
}

/// The strain at which a straight column buckles, by bisection, as a load over Euler's.
Finding gives_way_at_once() {
  BucklingColumn column;
  double holds = 0, gives_way = 0.1;
  for (int turn = 0; turn < 60 && gives_way > 1e-12; ++turn) {
    const double strain = (holds + gives_way) / 2;
    (stiffness_across(column, strain) < 0 ? gives_way : holds) = strain;
  }
  // two springs cross every section; each bends with k_b, one starts at every particle: B = 2 k_b
  const double distance = column.spring.length * (1 - gives_way);
  const double load = -2 * column.spring.force(distance);
  const double length = column.spacing * (column.particles - 3);  // between the clamps' middles
  const double euler = std::pow(2 * pi / length, 2) * 2 * column.spring.bending;
  Table found("strain [1]; load [N]; Euler's load [N]; load over Euler's [1]");
  found.row(gives_way, load, euler, load / euler);
  return judge_worst(found, "load over Euler's", 1e-6,
                     "a millionth: no barrier, real or artificial",
                     "a straight column is stiff across only by tension");
}

struct Trial {
  ColumnMethod method;
  const char* words;
  double step;  // over the elastic limit
};

Table shortened_columns() {
  Table found(
      "method; step over the elastic limit [1]; energy at the end, of that at the stop [1]; "
      "largest energy, of that at the stop [1]; speed at the end [m/s]");
  const BucklingColumn column;
  for (const Trial& trial :
       {Trial{ColumnMethod::backward_euler, "backward Euler", 0.7},
        Trial{ColumnMethod::backward_euler, "backward Euler", 7},
        Trial{ColumnMethod::backward_euler, "backward Euler", 70},
        Trial{ColumnMethod::bdf2, "BDF2", 0.7}, Trial{ColumnMethod::bdf2, "BDF2", 7},
        Trial{ColumnMethod::bdf2, "BDF2", 70}}) {
    const double h = trial.step * column.elastic_limit();
    const int steps = std::clamp(int(0.15 / h), 300, 2500);
    const Shortening run = shorten(column, trial.method, h, steps);
    found.row(trial.words, trial.step, run.at_the_end / run.at_the_stop,
              run.largest_after / run.at_the_stop, run.speed);
  }
  return found;
}

Finding comes_to_rest() {
  return judge_worst(shortened_columns(), "energy at the end, of that at the stop", 1,
                     "nothing does work on a held column: an unstable method adds energy",
                     "one linear solve a step, no damping force");
}

Finding gains_on_the_way() {
  const Table found = shortened_columns();
  const double largest = found.worst("largest energy, of that at the stop");
  return {{1.5 / largest, 1, 0, "1", "half as much again is a gain that is seen"},
          found,
          "while the ends are still"};
}

}  // namespace

std::vector<Check> bending_alternative_checks() {
  std::vector<Check> checks = {
      {"bending.force-stays-out-of-plane",
       "On folded hinges the paper's forces sum to zero, have no torque "
       "and do no work in the planes of the triangles.",
       "BMF03 section 4", paper_keeps_all},
      {"bending.discrete-shells-is-the-papers-at-small-angles",
       "Discrete Shells with k_b = ke/24 has the paper's forces, up to the square of the angle.",
       "Grinspun, Hirani, Desbrun, Schroeder 2003", discrete_shells_is_close},
      {"bending.quadratic-is-the-papers-at-small-angles",
       "Folded without stretch, quadratic bending has the paper's energy, up to the "
       "square of the angle.",
       "Bergou, Wardetzky, Harmon, Zorin, Grinspun 2006", quadratic_is_close}};
  for (const BendingAlternative& model : bending_alternatives())
    checks.push_back({model.name,
                      model.words + " pulls in the planes of the triangles, a million times more "
                                    "than the paper's element.",
                      model.source,
                      [model](const Subject& subject) { return acts_in_plane(subject, model); }});
  checks.insert(
      checks.end(),
      {{"bending.buckling-spring-has-an-energy",
        "The force of the buckling spring is the derivative of its energy.", source,
        force_is_the_energys},
       {"bending.buckling-springs-give-way-at-once",
        "A straight column of buckling springs gives way under any load, however far below "
        "Euler's.",
        source, gives_way_at_once},
       {"bending.buckling-columns-lose-energy-undamped",
        "An undamped column of buckling springs, shortened and then held, ends with no more energy "
        "than it was left with, in steps from below the elastic limit to far beyond.",
        source, comes_to_rest},
       {"bending.buckling-columns-gain-energy-on-the-way",
        "In some such steps the energy of a held column of buckling springs rises on the way.",
        source, gains_on_the_way}});
  return checks;
}

}  // namespace foldproof
