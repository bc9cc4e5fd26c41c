// Claims about constraints on the motion: strain limits (BMF03 section 3).
#include "verification/claims/claims.h"

namespace foldproof {

std::vector<Claim> strain_claims() {
  return {
      {"T11",
       "3",
       "Limits of +10 % and 0 % on the strain of springs let weaker springs, and with them larger steps, "
       "show the biphasic "
       "behaviour of cloth.",
       {{"biphasic.extension-is-the-bars", Role::supports},
        {"biphasic.gives-way-then-holds", Role::supports},
        {"biphasic.springs-alone-have-one-phase", Role::supports},
        {"biphasic.steps-are-larger", Role::supports},
        {"case.biphasic_pull.keeps-its-limits", Role::supports},
        {"case.biphasic_pull.stretches-to", Role::supports},
        {"strain-sweeps.grow-as-the-square.gauss_seidel", Role::limits}},
       Standing::conditional,
       "where the sweeps that keep the limits are few: what larger steps save, sweeps may cost. When the "
       "whole cloth is jerked, "
       "their number grows as the square of the cells along a side",
       "A strip of weak springs with limits follows a bar that gives way up to its limit and no further, to "
       "{biphasic.extension-is-the-bars}: between three and four times the load at which it "
       "begins to hold, it "
       "gives way {bare: biphasic.gives-way-then-holds} times as much as at first, while springs without "
       "limits have one slope "
       "to {biphasic.springs-alone-have-one-phase}. Springs that the largest load stretches by no more "
       "without limits take "
       "{bare: biphasic.steps-are-larger|steps|last} steps in place of {bare: "
       "biphasic.steps-are-larger|steps|first}. But the "
       "limits cost {bare: biphasic.steps-are-larger|sweeps a step|first} sweeps a step there, and a sheet "
       "of "
       "{bare: strain-sweeps.grow-as-the-square.gauss_seidel|cells along a side|last} cells along a side "
       "that is jerked "
       "{bare: strain-sweeps.grow-as-the-square.gauss_seidel|sweeps|last} sweeps, one of {bare: "
       "strain-sweeps.grow-as-the-square.gauss_seidel|cells along a side|first} cells {bare: "
       "strain-sweeps.grow-as-the-square.gauss_seidel|sweeps|first}. All in all the steps with limits took "
       "{biphasic.steps-are-larger|seconds|first}, those of stiff springs "
       "{biphasic.steps-are-larger|seconds|last}."},
      {"T12",
       "3",
       "Cloth whose springs may not be compressed buckles and folds instead.",
       {{"folding.area-is-kept", Role::supports},
        {"folding.area-is-lost-without", Role::supports},
        {"folding.one-arc-is-as-high-as-its-length-says", Role::supports},
        {"folding.wrinkles-are-as-long-as-rigidity-and-bed-say", Role::supports},
        {"case.buckle.keeps-its-area", Role::supports},
        {"case.buckle.leaves-its-plane", Role::supports}},
       Standing::confirmed,
       "",
       "A strip with stiff hinges and weak springs, whose ends are led together by a fifth of its length, is "
       "compressed in its plane and loses {folding.area-is-lost-without|area lost|first} of its area. With "
       "compression "
       "forbidden "
       "it rises in an arc "
       "whose height is that of a cosine as long as the strip, to "
       "{folding.one-arc-is-as-high-as-its-length-says}, and loses none; on an elastic bed it folds into "
       "waves of the length of least energy, to {folding.wrinkles-are-as-long-as-rigidity-and-bed-say}."}};
}

}  // namespace foldproof
