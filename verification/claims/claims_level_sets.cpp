// Claims of BMF03 section 5.1 on how the objects' level sets are stored, updated and interpolated.
#include <utility>

#include "verification/claims/claims.h"

namespace foldproof {

namespace {

std::vector<Claim> storing_and_updating() {
  return {
      {"C2",
       "5.1",
       "A rigid body's level set is computed once; that of a deforming body need be updated only near the "
       "surface, which is cheap.",
       {{"octree.rides-with-its-body", Role::supports},
        {"level-sets-in-time.frame-asks-for-few-distances", Role::supports},
        {"deforming.far-nodes-are-not-searched", Role::supports},
        {"deforming.kept-nodes-err-as-bounded", Role::supports},
        {"level-sets-in-time.fast-bodies-keep-little", Role::limits}},
       Standing::conditional,
       "From frame to frame the body moves by little against its distance from the nodes; one that moves by "
       "its own size is looked for anew everywhere",
       "An octree of a body that turns and moves answers within {octree.rides-with-its-body} and asks for no "
       "distance after it was built. A frame of a deforming body asks for "
       "{level-sets-in-time.frame-asks-for-few-distances|distances for the first frame|largest} distances, "
       "{level-sets-in-time.frame-asks-for-few-distances} of the nodes of a grid as fine. Away from the "
       "surface nodes keep what was nearest in the frame before; their largest error is "
       "{deforming.kept-nodes-err-as-bounded}. Of a body that moves by more than its radius in a frame only "
       "{level-sets-in-time.fast-bodies-keep-little} of the nodes are kept."},
      {"C3",
       "5.1",
       "Level sets of a whole animation, computed beforehand, serve many cloth simulations at no further "
       "cost.",
       {{"level-set-cache.loaded-is-the-same", Role::supports},
        {"level-set-cache.loading-is-cheap", Role::limits},
        {"level-set-cache.unfit-files-are-refused", Role::supports}},
       Standing::conditional,
       "but for loading them, which may take a tenth of what computing them takes",
       "Loading takes {level-set-cache.loading-is-cheap} of the time of computing and gives every bit back. "
       "Files that are cut, damaged, foreign or stale are refused."}};
}

std::vector<Claim> sampling_and_interpolating() {
  return {
      {"C4",
       "5.1",
       "Adaptively sampled distance fields store least, and constraining fine nodes to coarse neighbours "
       "avoids discontinuities.",
       {{"octree-memory.bumpy-body-takes-a-tenth", Role::supports},
        {"octree.is-continuous", Role::supports},
        {"octree.union-is-continuous", Role::supports},
        {"octree-memory.even-curve-takes-more", Role::limits}},
       Standing::conditional,
       "The body is curved unevenly: on a sphere every cell next to the surface must be as small as the "
       "grid's",
       "At the same largest error within three cells of the surface an octree of a bumpy body takes "
       "{octree-memory.bumpy-body-takes-a-tenth} of the grid's memory; one of a sphere "
       "{octree-memory.even-curve-takes-more|memory over the grid's|last}. Constrained, phi jumps by "
       "{octree.is-continuous} at most; left free, by up to {octree.is-continuous|with free nodes|largest}."},
      {"C15",
       "5.1",
       "Interpolating stored level sets in time is enough between frames.",
       {{"level-sets-in-time.blended-is-second-order", Role::supports},
        {"level-sets-in-time.carried-is-second-order", Role::supports},
        {"deforming.blended-ball-shrinks-as-derived", Role::limits}},
       Standing::conditional,
       "From frame to frame a body moves by little against its radius of curvature, or phi is interpolated "
       "along its motion",
       "Blended at the point, a ball of radius R that moves by d shrinks to sqrt(R^2 - d^2/4) and is gone "
       "beyond 2 R. Both interpolations err with second order in the time between frames; carried along with "
       "the body, the error is {level-sets-in-time.carried-errs-less} of the blended one at most, where the "
       "body is thrown."}};
}

}  // namespace

std::vector<Claim> level_set_claims() {
  std::vector<Claim> claims = storing_and_updating();
  for (Claim& claim : sampling_and_interpolating()) claims.push_back(std::move(claim));
  return claims;
}

}  // namespace foldproof
