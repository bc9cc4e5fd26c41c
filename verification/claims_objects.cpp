// Claims of BMF03 section 5: cloth against objects.
#include <utility>

#include "verification/claims.h"

namespace foldproof {

namespace {

std::vector<Claim> what_marching_gives() {
  return {{"C1",
           "5.1",
           "Fast marching from small positive values outside and small negative ones inside gives a signed "
           "distance.",
           {{"level-set-resolution.crude-start.distance", Role::supports},
            {"level-set-resolution.crude-start.contour", Role::supports},
            {"level-set.marching-solves-its-equation", Role::supports},
            {"level-set.marching-keeps-sides", Role::supports},
            {"level-set-resolution.crude-start.normals-stay-wrong", Role::limits}},
           Standing::conditional,
           "Only to a part of a cell: the surface is off by up to "
           "{level-set-resolution.crude-start.contour}, and normals "
           "next to it by {level-set-resolution.crude-start.normals-stay-wrong|error|last} in the mean, on "
           "whatever grid. "
           "Exact values next to the surface cure both.",
           "Marching itself solves its equation to {level-set.marching-solves-its-equation}. From such a "
           "start the mean error "
           "about a ball falls from {level-set-resolution.crude-start.distance|error|first} to "
           "{level-set-resolution.crude-start.distance|error|last} as the spacing is quartered, while the "
           "mean angle between "
           "the grid's normals and the ball's stays at "
           "{level-set-resolution.crude-start.normals-stay-wrong|error|smallest} to "
           "{level-set-resolution.crude-start.normals-stay-wrong|error|largest}. With exact values next to "
           "the surface the "
           "largest angle falls to {level-set-resolution.exact-start.normals|error|last}, and second-order "
           "marching errs by "
           "{level-set-resolution.second-order.ball|error|last} in the mean."}};
}

std::vector<Claim> what_projection_keeps() {
  return {
      {"C11",
       "5.3",
       "Plain projection of cloth that is inside an object smooths its folds out; a map that rises with the "
       "signed "
       "distance keeps which of two points is the deeper, and so the folds.",
       {{"wrinkles-kept.plain-flattens", Role::supports},
        {"wrinkles-kept.blend-keeps-a-share", Role::supports},
        {"wrinkles-kept.wavelength-blend", Role::supports},
        {"projection.map-keeps-order", Role::supports},
        {"projection.order-of-depths-is-kept", Role::supports},
        {"wrinkles-kept.power-crushes-the-deep", Role::limits},
        {"projection.twice-compresses-more", Role::limits}},
       Standing::conditional,
       "How high the folds stay is the choice of map and of tau over the deepest penetration: order alone "
       "promises "
       "nothing. A smooth power law with tau a fifth of that depth leaves "
       "{wrinkles-kept.power-crushes-the-deep|share left by the power law|largest} of the deeper half.",
       "Of wrinkles that were inside, plain projection leaves a deviation of {wrinkles-kept.plain-flattens}. "
       "The map "
       "that is straight below and blended at tau leaves between "
       "{wrinkles-kept.blend-keeps-a-share|share of it that is left|smallest} and "
       "{wrinkles-kept.blend-keeps-a-share|share of it that is left|largest} of it for tau from a sixteenth "
       "to four "
       "times the deepest penetration, the power law between "
       "{wrinkles-kept.wavelength-power|share of it that is left|smallest} and "
       "{wrinkles-kept.wavelength-power|share of it that is left|largest}, at the same wavelength. Done "
       "twice, a map "
       "compresses again."},
      {"C12",
       "5.3",
       "Projecting into [eps, tau] with a small eps leaves no triangle of the cloth that meets the object.",
       {{"projection.no-triangle-is-left-inside", Role::supports},
        {"projection.no-triangle-is-left-in-a-mesh", Role::supports},
        {"eps-needed.ball-bound", Role::supports},
        {"eps-needed.large-ball-bound", Role::supports},
        {"eps-needed.box-bound", Role::supports},
        {"projection.no-eps-leaves-triangles-inside", Role::limits},
        {"eps-needed.ball-order", Role::limits},
        {"eps-needed.box-order", Role::limits}},
       Standing::conditional,
       "eps must be at least L^2/(6 R) for edges of length L on an object of radius R, and in proportion to "
       "L where "
       "the object has an edge; L/sqrt(3) suffices for any object.",
       "Decided in whole numbers, without a distance field. The eps that is needed on a ball is "
       "{eps-needed.ball-bound} of L^2/(6 R) at most, along the edge of a box {eps-needed.box-bound} of "
       "L/sqrt(3), "
       "at every scale. With eps = 0 every sheet that was tried keeps triangles inside."}};
}

std::vector<Claim> where_projection_applies() {
  return {
      {"C13",
       "5.3",
       "Points pinched between two objects must not be projected.",
       {{"projection.pinched-points-would-tear", Role::supports},
        {"projection.pinched-points-are-left-alone", Role::supports}},
       Standing::confirmed,
       "",
       "Cloth between two balls that overlap, rippled by millimetres, is stretched up to "
       "{projection.pinched-points-would-tear|stretch when projected|largest} times when each point leaves "
       "the ball "
       "in which it is deepest; left alone it keeps every bit."},
      {"C17",
       "5.3",
       "The projection serves the cloth as it is drawn, subdivided, as well.",
       {{"projection.serves-the-subdivided-cloth", Role::supports},
        {"projection.subdividing-afterwards-spoils-it", Role::supports},
        {"subdivision.loop-is-affine", Role::supports}},
       Standing::confirmed,
       "",
       "Subdivided first, by midpoints or by Loop's rule, and projected then, no triangle is left inside, "
       "with an eps "
       "that shrinks from {projection.serves-the-subdivided-cloth|eps|largest} to "
       "{projection.serves-the-subdivided-cloth|eps|smallest} as edges are halved. In the other order up to "
       "{projection.subdividing-afterwards-spoils-it|triangles left inside|largest} triangles cut in."}};
}

}  // namespace

/// In the order of their ids; each part of the section has a function of its own.
std::vector<Claim> object_claims() {
  std::vector<Claim> claims = what_marching_gives();
  for (Claim& claim : what_projection_keeps()) claims.push_back(std::move(claim));
  for (Claim& claim : where_projection_applies()) claims.push_back(std::move(claim));
  return claims;
}

}  // namespace foldproof
