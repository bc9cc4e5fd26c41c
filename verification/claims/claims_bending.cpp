// Claims of BMF03 section 4: the bending element.
#include <algorithm>

#include "verification/claims/claims.h"

namespace foldproof {

namespace {

std::vector<Claim> the_mode() {
  return {{"B1",
           "4",
           "Of the twelve motions of two triangles exactly one bends: it is orthogonal to the eleven others, "
           "which are the rigid motions and those in the planes of the triangles.",
           {{"bending.mode-is-orthogonal-to-the-eleven-others", Role::supports},
            {"bending.mode-is-the-only-one", Role::supports}},
           Standing::confirmed,
           "",
           "On hinges of all angles and shapes u is orthogonal to each of the eleven, to "
           "{bare: bending.mode-is-orthogonal-to-the-eleven-others} roundings of its size, magnified by how "
           "thin the hinge is. The eleven are independent (their smallest "
           "singular value is at least {bending.mode-is-the-only-one|smallest over largest singular "
           "value|smallest} of the largest), and the one direction that they leave is that of u."},
          {"B2",
           "4",
           "Because u is orthogonal to rigid motions, the forces keep linear and angular momentum.",
           {{"bending.forces-sum-to-zero", Role::supports},
            {"bending.torques-sum-to-zero", Role::supports},
            {"bending.damping-forces-keep-momentum", Role::supports},
            {"bending.damping-leaves-rigid-motion-alone", Role::supports}},
           Standing::confirmed,
           "",
           "On crumpled sheets of every pattern and on single hinges, elastic forces sum to zero to "
           "{bare: bending.forces-sum-to-zero} roundings of the sum of their sizes, their torques to "
           "{bare: bending.torques-sum-to-zero} of theirs; damping forces do the same, to "
           "{bare: bending.damping-forces-keep-momentum}. What a scheme makes of forces that keep "
           "momentum is another matter: see T20."}};
}

std::vector<Claim> its_directions() {
  return {
      {"B3",
       "4",
       "Every bending model of two triangles that does not use exactly these directions breaks a "
       "conservation law or acts in the planes of the triangles.",
       {{"bending.mode-is-the-only-one", Role::supports},
        {"bending.force-stays-out-of-plane", Role::supports},
        {"bending.spring-across-the-hinge-acts-in-plane", Role::supports},
        {"bending.constant-length-gradients-act-in-plane", Role::supports},
        {"bending.quadratic-bending-acts-in-plane", Role::supports}},
       Standing::confirmed,
       "",
       "The eleven motions of rigid bodies and in the planes leave one direction only, so any other force "
       "does work on one of them. The usual alternatives keep momentum (of their size, torques sum to "
       "{largest of: bending.spring-across-the-hinge-acts-in-plane|net torque|largest, "
       "bending.constant-length-gradients-act-in-plane|net torque|largest, "
       "bending.quadratic-bending-acts-in-plane|net torque|largest} at most) and act in plane. Of a force's "
       "size, a spring between the far corners puts up to {bending.spring-across-the-hinge-acts-in-plane|in "
       "plane|largest} into an in-plane motion, gradients that take the lengths of normals and edge as "
       "constant up to {bending.constant-length-gradients-act-in-plane|in plane|largest}, quadratic bending "
       "up to {bending.quadratic-bending-acts-in-plane|in plane|largest}; the paper's element "
       "{bending.quadratic-bending-acts-in-plane|in plane, the paper's element|largest}."},
      {"B4",
       "4",
       "u1 and u2 fall off with the distance of their corner from the edge; u3 and u4 follow with "
       "barycentric weights.",
       {{"bending.mode-weights-are-barycentric", Role::supports}},
       Standing::confirmed,
       "",
       "Forces times heights balance, and the forces on the edge's ends are the barycentric shares of those "
       "on the far corners, to {bare: bending.mode-weights-are-barycentric} roundings of a force, magnified "
       "by how thin the hinge is, with heights whose ratio goes from "
       "{bending.mode-weights-are-barycentric|height of x1 over height of x2|smallest} to "
       "{bending.mode-weights-are-barycentric|height of x1 over height of x2|largest}."},
      {"B10",
       "4",
       "The angle changes at the rate d(theta)/dt = sum of u_i.v_i.",
       {{"bending.mode-is-minus-gradient-of-theta", Role::contradicts}},
       Standing::refuted,
       "",
       "With u and theta as printed, u is minus the gradient of theta, to {bare: "
       "bending.mode-is-minus-gradient-of-theta} roundings of its size, magnified by how thin the hinge is, "
       "against exact differentiation: the rate is minus that sum. The first motion tried turns the angle by "
       "{bending.mode-is-minus-gradient-of-theta|d(theta)/dt of a random motion|1}, where u.v is "
       "{bending.mode-is-minus-gradient-of-theta|u.v of the same motion|1}. The forces as printed have the "
       "right sign; only this line has not. The damping force, written with d(theta)/dt, dissipates only "
       "while that stands for u.v; with the true rate it would feed energy."}};
}

std::vector<Claim> the_elastic_force() {
  return {
      {"B5",
       "4",
       "sin(theta/2) rises smoothly and monotonically from one fold through the flat state to the other.",
       {{"bending.sine-rises-monotonically", Role::supports},
        {"bending.sine-is-accurate-near-flat-and-near-folded", Role::supports},
        {"bending.sharp-folds-stay-finite", Role::supports}},
       Standing::confirmed,
       "",
       "Swept from fold to fold it never falls; near flat and near folded it agrees with fifty digits to "
       "{bare: bending.sine-is-accurate-near-flat-and-near-folded} roundings of one, magnified by how thin "
       "the hinge is, in the form that we compute (the printed root of a difference would lose half the "
       "digits near flat)."},
      {"B6",
       "4",
       "The factor |E|^2/(|N1| + |N2|) makes the look independent of the mesh, so that ke is a property "
       "of the material.",
       {{"bending-rigidity.does-not-depend-on-size", Role::supports},
        {"bending-rigidity.depends-on-direction", Role::limits},
        {"bending-rigidity.depends-on-pattern", Role::limits}},
       Standing::conditional,
       "The pattern of the triangles and its direction stay as they are",
       "A pattern refined keeps its flexural rigidity D: the error of its cylinders has second order, to "
       "{bending-rigidity.does-not-depend-on-size}. Another pattern has another D: curved along x, the "
       "patterns tried differ by {bending-rigidity.depends-on-pattern|greatest difference of D/ke|first} ke. "
       "Squares split along one diagonal differ by {bending-rigidity.depends-on-direction|greatest "
       "difference of D/ke|first} ke between their own directions, and refinement does not remove that. What "
       "the sentence is used for, that cloth looks the same on a finer mesh, is kept; that it does so on any "
       "mesh is not."},
      {"B7",
       "4",
       "Other functions of the angle keep all of this, as long as they scale all four forces alike.",
       {{"bending.other-laws-keep-momentum", Role::supports},
        {"bending.force-is-minus-gradient-of-energy", Role::supports}},
       Standing::confirmed,
       "",
       "With other laws in the sine's place, forces and torques sum to zero to {bare: "
       "bending.other-laws-keep-momentum} roundings of the sum of their sizes, and their work is what an "
       "energy loses, to {bare: bending.force-is-minus-gradient-of-energy} roundings of energy and work."}};
}

std::vector<Claim> rest_angles_and_limits() {
  return {
      {"B8",
       "4",
       "Rest angles other than zero keep a sculpted shape and restore it.",
       {{"bending.rest-angles-at-rest-give-no-force", Role::supports},
        {"bending.force-is-minus-gradient-of-energy", Role::supports},
        {"bending.damping-dissipates", Role::supports},
        {"bending.unfolded-pleats-return", Role::supports},
        {"shape-return.comes-back", Role::supports},
        {"shape-return.needs-its-rest-angles", Role::supports}},
       Standing::confirmed,
       "",
       "At its rest shape a curved surface feels no bending, to "
       "{bare: bending.rest-angles-at-rest-give-no-force} roundings of what a bent hinge feels. "
       "A sheet with the rest angles of pleats that was held flat folds back: of the unfolding, "
       "{bending.unfolded-pleats-return|left of the unfolding|first} is left after "
       "{bending.unfolded-pleats-return|time|first}, {bending.unfolded-pleats-return|left of the "
       "unfolding|last} after {bending.unfolded-pleats-return|time|last}; without rest angles it stays "
       "flat. A closed shell with bumps, pulled out of shape by about a tenth of its size, comes back: "
       "{shape-return.comes-back} is left."},
      {"B11",
       "4",
       "The model behaves well in the stiff limit (Figure 4) and in the soft one (Figure 3).",
       {{"case.stiff_statue.runs-to-its-end", Role::supports},
        {"case.stiff_statue.keeps-its-angles", Role::supports},
        {"case.stiff_statue.energy-is-accounted-for", Role::supports},
        {"case.stiff_bending.runs-to-its-end", Role::supports},
        {"case.stiff_bending.energy-is-accounted-for", Role::supports},
        {"case.stiff_bending.keeps-its-angles", Role::supports},
        {"case.soft_bending.runs-to-its-end", Role::supports},
        {"case.soft_bending.energy-is-accounted-for", Role::supports}},
       Standing::confirmed,
       "",
       "A statue's shell with stiff bending hangs by its head to the end of the run. It stretches and swings "
       "back, but no hinge leaves its rest angle by more than {case.stiff_statue.keeps-its-angles}; of the "
       "energy that is exchanged, {case.stiff_statue.energy-is-accounted-for} is not accounted for. Sheets "
       "whose bending is stiff beside their stretching, and ones that it hardly resists at all, run to their "
       "end too, with {largest of: case.stiff_bending.energy-is-accounted-for, "
       "case.soft_bending.energy-is-accounted-for} at most unaccounted for. The scenes of "
       "the two figures, in full size, are the cases water_bottle and balloon: the full tier judges what "
       "they look like."}};
}

std::vector<Claim> the_damping_force() {
  return {
      {"B9",
       "4",
       "The damping force resists the change of the angle only, and its matrix is symmetric and negative "
       "semi-definite.",
       {{"bending.damping-leaves-in-plane-motion-alone", Role::supports},
        {"bending.damping-leaves-rigid-motion-alone", Role::supports},
        {"bending.damping-is-symmetric", Role::supports},
        {"bending.damping-is-negative-semidefinite", Role::supports},
        {"bending.damping-dissipates", Role::supports}},
       Standing::confirmed,
       "",
       "Motions in the planes of the triangles feel nothing beyond {bare: "
       "bending.damping-leaves-in-plane-motion-alone} roundings of what the single motions add up to, rigid "
       "ones nothing beyond {bare: bending.damping-leaves-rigid-motion-alone}, both magnified by how thin a "
       "hinge is; the matrix is symmetric to {bare: bending.damping-is-symmetric} roundings of its largest "
       "entry, and its largest eigenvalue is {bare: bending.damping-is-negative-semidefinite} roundings of "
       "all its rows times the size of its least one."},
      {"B12",
       "4",
       "With its factor |E|, kd is a property of the material under refinement, perhaps anisotropic.",
       {{"bending-scaling.edge", Role::contradicts},
        {"bending-scaling.edge-squared-over-area", Role::limits}},
       Standing::refuted,
       "",
       "A sheet rolled at a given rate dissipates in proportion to the width of a cell: the order of the "
       "last pair of meshes is {bending-scaling.edge|order of the pair|last}, where a property of the "
       "material has zero. From the coarsest mesh to the finest the dissipation falls from "
       "{bending-scaling.edge|dissipation per area and squared rate|first} to "
       "{bending-scaling.edge|dissipation per area and squared rate|last}. The elastic force's factor "
       "|E|^2/(|N1| + |N2|) in its place leaves {bending-scaling.edge-squared-over-area|order of the "
       "pair|last}."},
      {"B13",
       "4",
       "A damping that is a nonlinear function of the angle's rate keeps the symmetry of its Jacobian.",
       {{"bending.nonlinear-damping-stays-symmetric", Role::supports}},
       Standing::confirmed,
       "",
       "A law that grows with the cube of the rate, multiplying all four forces alike, has a Jacobian that "
       "is symmetric to {bare: bending.nonlinear-damping-stays-symmetric} roundings of what its differences "
       "are taken of, magnified by how thin the hinge is, on hinges of all angles; one that acts on each "
       "corner's share by itself misses symmetry by {bending.nonlinear-damping-stays-symmetric|corner by "
       "corner|smallest} of its size at least."}};
}

/// B1, B2, ... in the order of their numbers.
bool is_before(const Claim& a, const Claim& b) {
  return std::stoi(a.id.substr(1)) < std::stoi(b.id.substr(1));
}

}  // namespace

std::vector<Claim> bending_claims() {
  std::vector<Claim> claims;
  for (const auto& part :
       {the_mode(), its_directions(), the_elastic_force(), rest_angles_and_limits(), the_damping_force()})
    claims.insert(claims.end(), part.begin(), part.end());
  std::sort(claims.begin(), claims.end(), is_before);
  return claims;
}

}  // namespace foldproof
