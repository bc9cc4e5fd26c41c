// Claims of BMF03 section 5: cloth against objects.
#include <algorithm>
#include <string>
#include <utility>

#include "verification/claims/claims.h"

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
           "{level-set-resolution.crude-start.contour}, and normals next to it by "
           "{level-set-resolution.crude-start.normals-stay-wrong|error|last} in the mean, on whatever grid. "
           "Exact values next to the surface cure both",
           "Marching itself solves its equation to {level-set.marching-solves-its-equation}. From such a "
           "start the mean error about a ball falls from "
           "{level-set-resolution.crude-start.distance|error|first} to "
           "{level-set-resolution.crude-start.distance|error|last} as the spacing is quartered, while the "
           "mean angle between the grid's normals and the ball's stays at "
           "{level-set-resolution.crude-start.normals-stay-wrong|error|smallest} to "
           "{level-set-resolution.crude-start.normals-stay-wrong|error|largest}. With exact values next to "
           "the surface the largest angle falls to {level-set-resolution.exact-start.normals|error|last}, "
           "and second-order marching errs by {level-set-resolution.second-order.ball|error|last} in the "
           "mean."}};
}

std::vector<Claim> where_contact_is_found() {
  return {
      {"C5",
       "5.2",
       "Looking at the cloth's particles is enough, since cloth is densely sampled.",
       {{"pointwise-contact.edges-cut-in-by-the-square", Role::supports},
        {"pointwise-contact.edges-stay-within-the-chord", Role::supports},
        {"pointwise-contact.a-pin-comes-through", Role::limits}},
       Standing::conditional,
       "Where the object's features are larger than the cloth's edges: a pin thinner than an edge comes "
       "through",
       "On a ball, what lies between particles cuts in by the square of the edge: midpoints by "
       "{pointwise-contact.edges-cut-in-by-the-square|depth of midpoints|first} to "
       "{pointwise-contact.edges-cut-in-by-the-square|depth of midpoints|last} for edges of "
       "{pointwise-contact.edges-cut-in-by-the-square|edge|first} to "
       "{pointwise-contact.edges-cut-in-by-the-square|edge|last}. Midpoints and centres as points of their "
       "own help coarse cloth: see pointwise-contact."},
      {"C6",
       "5.2",
       "The forecast is that the point lies exactly on the object's surface after the forecast time.",
       {{"contact.forecast-ends-on-the-surface", Role::supports},
        {"forecast-time.lands-on-a-plane", Role::supports},
        {"forecast-time.order-on-a-resting-ball", Role::limits},
        {"forecast-time.order-on-a-turning-ball", Role::limits}},
       Standing::conditional,
       "As a forecast it is exact; as a place only on planes. On curved and on turning objects the point is "
       "off by the square of the step",
       "phi + tau (v_p - v).N is zero to rounding. After the step a point that slides on a ball is off by "
       "{forecast-time.order-on-a-resting-ball|miss|first} for a step of "
       "{forecast-time.order-on-a-resting-ball|step|first} and "
       "{forecast-time.order-on-a-resting-ball|miss|last} for one of "
       "{forecast-time.order-on-a-resting-ball|step|last}."},
      {"C7",
       "5.2",
       "Forecasting is more stable and smoother than pushing points out of objects.",
       {{"resting-contact.quieter-than-push-out", Role::supports},
        {"resting-contact.projection-is-as-quiet", Role::limits}},
       Standing::conditional,
       "Against velocities that take points out once they are inside. Points that are put on the surface, "
       "and lose their velocity into it, rest as quietly",
       "Cloth at rest on a ball shakes by {resting-contact.quieter-than-push-out|shaking at rest|forecast} "
       "under forecasting, by {resting-contact.quieter-than-push-out|shaking at rest|push_out} if points are "
       "pushed out, which also lets them in by {resting-contact.quieter-than-push-out|largest "
       "depth|push_out}, and by {resting-contact.projection-is-as-quiet|shaking at rest|projection} under "
       "projection."},
      {"C8",
       "5.2",
       "Forecasting is not the same as using the object at the next step.",
       {{"forecast-time.is-not-the-next-step", Role::supports},
        {"forecast-time.decay-is-as-derived", Role::supports}},
       Standing::confirmed,
       "",
       "The forecast time is free: a distance to a plane shrinks by the factor of one less the step over the "
       "forecast time, so that cloth comes down softly. With a forecast time of five steps a point is at "
       "{forecast-time.is-not-the-next-step|height after a step|forecast} where the object at the next step "
       "would have stopped it. With the step itself, and on a resting plane, the two agree."}};
}

std::vector<Claim> what_contact_does() {
  return {{"C9",
           "5.2",
           "The friction formula handles static and kinetic friction.",
           {{"contact.friction-is-coulombs", Role::supports},
            {"contact.impulse-stays-in-the-cone", Role::supports},
            {"contact.sliding-is-never-reversed", Role::supports},
            {"contact.a-slope-holds-or-lets-go.C", Role::supports},
            {"contact.a-moving-slope-holds-or-lets-go.C", Role::supports},
            {"contact.a-belt-takes-along.C", Role::supports},
            {"contact.a-turntable-carries-without-drift.C", Role::supports},
            {"contact.a-drum-holds-by-the-capstan-law", Role::supports}},
           Standing::confirmed,
           "",
           "On slopes at rest and moving, a block holds where the tangent of the slope is below the "
           "friction, a thousandth below it included, and else slides as derived, to "
           "{contact.a-slope-holds-or-lets-go.C} in a second; on a turntable it stays in its place to "
           "{contact.a-turntable-carries-without-drift.C} in "
           "{contact.a-turntable-carries-without-drift.C|radius|largest} from the axis. A strip that slides "
           "round a drum keeps the capstan's law to {contact.a-drum-holds-by-the-capstan-law}. For this the "
           "velocity that moves the cloth must be corrected too, and the object's velocity be that of the "
           "chord."}};
}

std::vector<Claim> what_projection_keeps() {
  return {
      {"C11",
       "5.3",
       "Plain projection of cloth that is inside an object smooths its folds out; a map that rises with the "
       "signed distance keeps which of two points is the deeper, and so the folds.",
       {{"wrinkles-kept.plain-flattens", Role::supports},
        {"wrinkles-kept.blend-keeps-a-share", Role::supports},
        {"wrinkles-kept.wavelength-blend", Role::supports},
        {"projection.map-keeps-order", Role::supports},
        {"projection.order-of-depths-is-kept", Role::supports},
        {"wrinkles-kept.power-crushes-the-deep", Role::limits},
        {"projection.twice-compresses-more", Role::limits}},
       Standing::conditional,
       "How high the folds stay is the choice of map and of tau over the deepest penetration: order alone "
       "promises nothing. A smooth power law with tau a fifth of that depth leaves "
       "{wrinkles-kept.power-crushes-the-deep|share left by the power law|largest} of the deeper half",
       "Of wrinkles that were inside, plain projection leaves a deviation of {wrinkles-kept.plain-flattens}. "
       "The map that is straight below and blended at tau leaves between "
       "{wrinkles-kept.blend-keeps-a-share|share of it that is left|smallest} and "
       "{wrinkles-kept.blend-keeps-a-share|share of it that is left|largest} of it for tau from a sixteenth "
       "to four times the deepest penetration, the power law between {wrinkles-kept.wavelength-power|share "
       "of it that is left|smallest} and {wrinkles-kept.wavelength-power|share of it that is left|largest}, "
       "at the same wavelength. Done twice, a map compresses again."},
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
       "L where the object has an edge; L/sqrt(3) suffices for any object",
       "Decided in whole numbers, without a distance field. The eps that is needed on a ball is "
       "{eps-needed.ball-bound} of L^2/(6 R) at most, along the edge of a box {eps-needed.box-bound} of "
       "L/sqrt(3), at every scale. With eps = 0 every sheet that was tried keeps triangles inside."}};
}

std::vector<Claim> what_freedom_gives() {
  return {
      {"C10",
       "5.3",
       "That the response leaves some points inside of objects lets more folds and wrinkles develop.",
       {{"folds-inside.more-where-both-sides-are-free", Role::supports},
        {"folds-inside.no-more-over-a-ball", Role::limits}},
       Standing::conditional,
       "Where cloth is inside to begin with and the forecast time lets it stay there: cloth that falls on a "
       "ball from outside is never inside, and folds as much whatever the forecast time",
       "A tube that is pushed together on a drum has "
       "{folds-inside.more-where-both-sides-are-free|crests a turn|last} crests a turn, after the "
       "projection, "
       "if its valleys may stay inside, and {folds-inside.more-where-both-sides-are-free|crests a "
       "turn|first} "
       "if it is brought to the surface within a step. Over a ball the mean fold changes by "
       "{folds-inside.no-more-over-a-ball} of itself."}};
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
       "the ball in which it is deepest; left alone it keeps every bit."}};
}

std::vector<Claim> what_is_drawn() {
  return {
      {"C17",
       "5.3",
       "The projection serves the cloth as it is drawn, subdivided, as well.",
       {{"projection.serves-the-subdivided-cloth", Role::supports},
        {"projection.subdividing-afterwards-spoils-it", Role::supports},
        {"subdivision.loop-is-affine", Role::supports}},
       Standing::confirmed,
       "",
       "Subdivided first, by midpoints or by Loop's rule, and projected then, no triangle is left inside, "
       "with an eps that shrinks from {projection.serves-the-subdivided-cloth|eps|largest} to "
       "{projection.serves-the-subdivided-cloth|eps|smallest} as edges are halved. In the other order up to "
       "{projection.subdividing-afterwards-spoils-it|triangles left inside|largest} triangles cut in."}};
}

std::vector<Claim> what_is_pinched() {
  return {{"C14",
           "5.1",
           "Cloth that is pinched between two bodies stays on the surface between them.",
           {{"contact.pinched-points-end-equally-deep", Role::supports},
            {"contact.pinched-points-slide-by-coulomb", Role::supports},
            {"case.pinch.pinches", Role::supports},
            {"case.pinch.stays-between", Role::supports},
            {"case.pinch.slower-than", Role::supports},
            {"case.armpit.pinches", Role::supports},
            {"case.armpit.slower-than", Role::supports}},
           Standing::confirmed,
           "",
           "Where two balls close on cloth until they overlap, pinched particles stay within "
           "{case.pinch.stays-between} of where they are equally deep in both, and nothing is faster than "
           "{case.pinch.slower-than}. The paper asks for the place; the formula is ours: the difference of "
           "the two depths is forecast to be zero. Held so, points that are about to enter both objects "
           "count as pinched, not only those that are inside both."}};
}

std::vector<Claim> what_comes_last() {
  return {{"C16",
           "5",
           "Cloth that avoids objects and cloth that avoids itself go together: objects correct the "
           "velocities first, "
           "self-collision works on the result.",
           {{"case.fast.crosses-itself", Role::supports},
            {"case.fast.stays-outside", Role::limits},
            {"self-collision.a-step-is-free-of-crossings", Role::supports}},
           Standing::conditional,
           "What comes last has the last word: the cloth does not pass through itself, but its layers may "
           "push it into an "
           "object, by {case.fast.stays-outside} where three sheets strike a ball at 20 m/s",
           "Three sheets, 6 mm apart, wrap round a ball that they strike at 20 m/s. No frame crosses itself, "
           "decided without "
           "rounding by a judge that shares no code with the method; the deepest particle is "
           "{case.fast.stays-outside} inside "
           "the ball; nothing in the method bounds that but the sheets' thrust."}};
}

}  // namespace

/// In the order of their ids; each part of the section has a function of its own.
std::vector<Claim> object_claims() {
  std::vector<Claim> claims = what_marching_gives();
  for (Claim& claim : where_contact_is_found()) claims.push_back(std::move(claim));
  for (Claim& claim : what_contact_does()) claims.push_back(std::move(claim));
  for (Claim& claim : what_projection_keeps()) claims.push_back(std::move(claim));
  for (Claim& claim : what_freedom_gives()) claims.push_back(std::move(claim));
  for (Claim& claim : where_projection_applies()) claims.push_back(std::move(claim));
  for (Claim& claim : what_is_pinched()) claims.push_back(std::move(claim));
  for (Claim& claim : what_comes_last()) claims.push_back(std::move(claim));
  for (Claim& claim : what_is_drawn()) claims.push_back(std::move(claim));
  for (Claim& claim : level_set_claims()) claims.push_back(std::move(claim));
  std::sort(claims.begin(), claims.end(), [](const Claim& a, const Claim& b) {
    return std::stoi(a.id.substr(1)) < std::stoi(b.id.substr(1));
  });
  return claims;
}

}  // namespace foldproof
