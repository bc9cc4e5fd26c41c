// A scene of several pieces with everything that the solver declares: what is true of each of its
// parts alone is true of it among the others, and wherever, whenever and in which order it is.

#include "verification/subjects/suite/contact/obstacle_scenes.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr long count = 15;
const Vector3 gravity(-4, 2.5, -8.1);  // m/s^2

/// A limp sheet that moves and bends somewhat.
PortableScene restless(const char* name, int cells, const Vector3& at) {
  PortableScene scene = shifted(limp_sheet(cells, 0.03), at);
  scene.name = name;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    scene.v.col(i) = 0.2 * Vector3(std::sin(1.3 * double(i)), std::cos(2.1 * double(i)), 0.5);
  return scene;
}

/// Of the scene's mass, 0.7 to 1.3 times each.
void give_own_masses(PortableScene& scene) {
  scene.own_masses = true;
  for (Eigen::Index i = 0; i < scene.mass.size(); ++i)
    scene.mass[i] *= 1 + 0.3 * std::sin(1.9 * double(i) + 0.3);
}

bool accepts(Trial& trial, const PortableScene& scene) {
  try {
    trial.prepare(scene);
    return true;
  } catch (const NotOffered&) {
    return false;
  }
}

/// What all pieces have in common.
PortableMaterial material_for(Trial& trial, PortableScene scene) {
  PortableMaterial& material = scene.material;
  if (trial.declaration().offers("damping")) material.stretch_damping = 1e-3 * material.young;
  PortableScene bent = scene;
  bent.name = "sheet that may bend";
  bent.material.bending_rigidity = drawn("rigidity of pieces", 0.8e-4, 1.2e-4);
  if (trial.declaration().offers("damping")) bent.material.bending_damping = 2e-5;
  return accepts(trial, bent) ? bent.material : material;
}

/// The scene after a motion p -> turn p + shift that leaves boxes along the axes.
PortableScene moved(PortableScene scene, const Eigen::Matrix3d& turn, const Vector3& shift) {
  const auto to = [&](const Vector3& p) -> Vector3 { return turn * p + shift; };
  scene.mesh.rest = (turn * scene.mesh.rest).colwise() + shift;
  scene.x = (turn * scene.x).colwise() + shift;
  scene.v = turn * scene.v, scene.gravity = turn * scene.gravity;
  for (PortableBox& box : scene.boxes)
    box.centre = to(box.centre), box.half_extents = (turn * box.half_extents).cwiseAbs();
  for (PortableSphere& ball : scene.spheres) ball.centre = to(ball.centre);
  for (PortableCapsule& capsule : scene.capsules)
    capsule.a = to(capsule.a), capsule.b = to(capsule.b);
  return scene;
}

/// Free, held, and two on obstacles of each kind that differ in place alone; no layers, whose
/// contacts have an order.
std::vector<PortableScene> pieces_for(Trial& trial) {
  const Declaration& declared = trial.declaration();
  std::vector<PortableScene> pieces{restless("free", 3, {-0.9, 0.2, 2})};
  if (declared.offers("held")) {
    pieces.push_back(restless("held", 4, {1.4, 0.5, 3}));
    pieces.back().held = {20, 3};
    for (const int i : pieces.back().held) pieces.back().v.col(i).setZero();
  }
  pieces.push_back(restless("beside the free one, 8 mm away", 3, {-0.802, 0.2, 2}));
  pieces.back().v.row(0).array() += 0.4;          // and leaves it
  pieces.back().mesh.rest = pieces[0].mesh.rest;  // two pieces that were cut in one place
  pieces.push_back(restless("free too", 2, {-0.4, -1.1, 3}));
  const double thickness = declared.offers("self_collision") ? 0.004 : 0;
  int which = 1;
  for (const ObstacleKind& kind : obstacle_kinds()) {
    if (kind.group == "contact" || !declared.offers(kind.capability)) continue;
    PortableScene scene = limp_sheet(2 + which % 2, 0.03);
    kind.add(scene, which, 0.1 + 0.1 * which);
    lay(scene, kind.sides(which)[0], 0);
    scene.name = "on a " + kind.name;
    pieces.push_back(scene);
    pieces.push_back(moved(scene, Eigen::Matrix3d::Identity(), {0.4, -9, 5}));
    pieces.back().name += " like the one before";
    ++which;
  }
  const PortableMaterial material = material_for(trial, pieces[0]);
  for (PortableScene& piece : pieces) {
    piece.gravity = gravity, piece.material = material, piece.thickness = thickness;
    piece.dt = 0.002;
    if (declared.offers("masses") && !declared.has_consistent_mass) give_own_masses(piece);
    for (size_t k = 0; k < piece.mesh.hinges.size() && material.bending_rigidity > 0; ++k)
      piece.rest_angles.push_back(0.3 * std::sin(1.7 * double(k)));
  }
  return pieces;
}

template <typename Obstacle>
void append(std::vector<Obstacle>& all, const std::vector<Obstacle>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

PortableScene whole_of(const std::vector<PortableScene>& pieces) {
  PortableScene all = together("pieces, held, free and on obstacles", pieces);
  all.boxes.clear(), all.spheres.clear(), all.capsules.clear();
  for (const PortableScene& one : pieces)
    append(all.boxes, one.boxes), append(all.spheres, one.spheres),
        append(all.capsules, one.capsules);
  return all;
}

/// A row for each piece: how far its places are from those that are expected.
Finding judged(const std::vector<PortableScene>& pieces, const PerParticle3& x,
               const PerParticle3& expected, const char* why) {
  const double fall = gravity.norm() * std::pow(double(count) * pieces[0].dt, 2) / 2;  // m
  Table measured = table_of("piece | way [m] | difference [of a free fall]");
  Eigen::Index first = 0;
  for (const PortableScene& one : pieces) {
    const auto part = [&](const PerParticle3& of) -> PerParticle3 {
      return of.middleCols(first, one.x.cols());
    };
    measured.row(one.name, largest(part(expected) - one.x),
                 largest(part(x) - part(expected)) / fall);
    first += one.x.cols();
  }
  return judge_worst(measured, 0.03, why);
}

Finding pieces_move_as_alone(Trial& trial) {
  const std::vector<PortableScene> pieces = pieces_for(trial);
  const PerParticle3 x = trial.after(whole_of(pieces), count).x;
  PerParticle3 alone = x;
  Eigen::Index first = 0;
  for (PortableScene one : pieces) {
    one.name = "piece alone, " + one.name;
    alone.middleCols(first, one.x.cols()) = trial.after(one, count).x;
    first += one.x.cols();
  }
  return judged(pieces, x, alone,
                "what does not touch a piece does nothing to it; a solver that chooses its own "
                "steps may choose others for the whole scene");
}

/// A step in each call.
Finding calls_may_be_divided(Trial& trial) {
  const std::vector<PortableScene> pieces = pieces_for(trial);
  const PortableScene scene = whole_of(pieces);
  const PerParticle3 expected = trial.after(scene, count).x;
  return judged(pieces, trial.motion(scene, multiples(1, count)).back().x, expected,
                "the same steps; what is iterated may start elsewhere");
}

/// The same scene before and after one with as many particles, of which all else is different.
Finding scenes_leave_nothing(Trial& trial) {
  const std::vector<PortableScene> pieces = pieces_for(trial);
  const PortableScene scene = whole_of(pieces);
  PortableScene other = scene;
  other.name = "other pieces, as many";
  other.gravity = Vector3(3, -5, 2);
  other.material.young *= 0.6, other.material.density *= 1.5, other.mass *= 1.5;
  other.material.bending_rigidity *= 0.4, other.material.stretch_damping *= 0.3;
  for (double& angle : other.rest_angles) angle *= -1;
  for (int& i : other.held) i = (i + 7) % int(scene.x.cols());
  for (const int i : other.held) other.v.col(i).setZero();
  for (PortableBox& box : other.boxes) box.centre.z() -= 0.05, box.friction = 0.9;
  for (PortableSphere& ball : other.spheres) ball.radius *= 0.95;
  for (PortableCapsule& capsule : other.capsules) capsule.radius *= 0.95;
  trial.restart();
  const PerParticle3 expected = trial.after(scene, count).x;
  trial.after(other, count);
  return judged(pieces, trial.after(scene, count).x, expected, "a scene is all that it is given");
}

/// x becomes y, y becomes z, z becomes x, once and twice.
Finding turned_moves_alike(Trial& trial) {
  const std::vector<PortableScene> pieces = pieces_for(trial);
  const PortableScene scene = whole_of(pieces);
  const PerParticle3 expected = trial.after(scene, count).x;
  Eigen::Matrix3d exchange;
  exchange << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  PerParticle3 x = expected;
  for (const Eigen::Matrix3d& turn : {exchange, Eigen::Matrix3d(exchange * exchange)}) {
    const Vector3 shift(1.3, -0.7, 0.4);
    const PerParticle3 there = trial.after(moved(scene, turn, shift), count).x;
    const PerParticle3 back = turn.transpose() * (there.colwise() - shift);
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      if ((back.col(i) - expected.col(i)).norm() > (x.col(i) - expected.col(i)).norm())
        x.col(i) = back.col(i);
  }
  return judged(pieces, x, expected, "space has no preferred place or axis");
}

/// Obstacles, held particles and pieces from the last to the first.
Finding lists_have_no_order(Trial& trial) {
  const std::vector<PortableScene> pieces = pieces_for(trial);
  const PerParticle3 expected = trial.after(whole_of(pieces), count).x;
  std::vector<PortableScene> reversed(pieces.rbegin(), pieces.rend());
  for (PortableScene& one : reversed) std::reverse(one.held.begin(), one.held.end());
  reversed[0].material = pieces[0].material;
  PortableScene scene = whole_of(reversed);
  scene.name = "the same pieces, from the last to the first";
  const PerParticle3 there = trial.after(scene, count).x;
  PerParticle3 x = expected;
  Eigen::Index first = 0;
  for (const PortableScene& one : pieces) {
    const Eigen::Index size = one.x.cols();
    x.middleCols(first, size) = there.middleCols(there.cols() - first - size, size);
    first += size;
  }
  return judged(pieces, x, expected, "order is not physical where pieces do not touch");
}

}  // namespace

std::vector<Law> mixed_laws() {
  const std::string headline = "piece | difference";
  return {
      {"mixed.pieces-move-as-they-do-alone",
       "Pieces that do not touch, free, held or on obstacles, move as each does alone.",
       "locality of forces", pieces_move_as_alone, "", headline},
      {"mixed.calls-may-be-divided",
       "Pieces of all kinds move alike by one call of many steps, and by many of one.",
       "protocol: 'advance'", calls_may_be_divided, "L1", headline},
      {"mixed.scenes-leave-nothing",
       "A scene of all kinds moves alike before and after another of its size.", "determinism",
       scenes_leave_nothing, "", headline},
      {"mixed.turned-scene-moves-alike",
       "A scene of all kinds that is placed elsewhere, its axes exchanged, moves alike.",
       "isotropy of space", turned_moves_alike, "", headline},
      {"mixed.lists-have-no-order",
       "Pieces, held particles and obstacles move alike in whichever order they are listed.",
       "numbering is not physical", lists_have_no_order, "", headline},
  };
}

}  // namespace foldproof
