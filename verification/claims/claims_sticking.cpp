// Claims of BMF03 section 6: dynamic sticking constraints.
#include "verification/claims/claims.h"

namespace foldproof {

namespace {

std::vector<Claim> what_bonds_keep() {
  return {{"S1",
           "6",
           "An activated constraint keeps the point's place relative to the triangle while that translates "
           "and rotates.",
           {{"sticking.follows-rigid-motion", Role::supports},
            {"sticking.follows-a-deforming-surface", Role::supports},
            {"sticking.force-is-minus-gradient-of-energy", Role::supports},
            {"sticking-lag.lag-is-m-a-over-k", Role::limits}},
           Standing::conditional,
           "Only as closely as the stiffness k holds the point's mass m under its acceleration a: it lags by "
           "m a/k",
           "On a surface that turns, swings and drifts nothing lags by more than "
           "{sticking.follows-rigid-motion} times that; on a turntable the lag is m a/k to "
           "{sticking-lag.lag-is-m-a-over-k}, for stiffnesses from "
           "{sticking-lag.lag-is-m-a-over-k|stiffness|first} to "
           "{sticking-lag.lag-is-m-a-over-k|stiffness|last}. On a triangle that deforms weights and height "
           "are kept to "
           "{sticking.follows-a-deforming-surface}."},
          {"S2",
           "6",
           "A constraint can break and form many times.",
           {{"sticking.breaks-and-forms-again", Role::supports},
            {"sticking.forms-with-every-triangle-near", Role::supports},
            {"case.sticky_layers.lets-go", Role::supports}},
           Standing::confirmed,
           "",
           "A palm that passes held particles makes and breaks {sticking.breaks-and-forms-again|bonds made "
           "in 3.9 "
           "s|smallest} bonds with each, every one in the step in which its distance says so."},
          {"S3",
           "6",
           "A point near several triangles is drawn to the mean of their targets.",
           {{"sticking.forms-with-every-triangle-near", Role::supports},
            {"sticking.force-is-minus-gradient-of-energy", Role::supports},
            {"sticking.damping-is-as-defined", Role::supports}},
           Standing::confirmed,
           "",
           "Bonds form with every triangle of a patch within reach; the spring to the mean of their targets "
           "has the "
           "energy's gradient to {sticking.force-is-minus-gradient-of-energy}, one triangle or two."}};
}

std::vector<Claim> what_forecasts_buy() {
  return {
      {"S4",
       "6",
       "A spring between predicted positions holds a point better than one between current ones.",
       {{"sticking-lag.forecasts-end-the-swing", Role::supports},
        {"sticking-lag.a-plain-spring-swings-for-ever", Role::supports},
        {"sticking-lag.lag-is-m-a-over-k", Role::supports},
        {"sticking-lag.limit.C", Role::supports},
        {"sticking-lag.stiff-layers-are-stable", Role::supports},
        {"sticking-lag.stiff-layers-need-forecasts", Role::supports},
        {"sticking-lag.limit.A", Role::limits},
        {"sticking-lag.limit.B", Role::limits}},
       Standing::conditional,
       "In every scheme it comes to rest where a plain spring swings for ever, with the same lag; it allows "
       "longer "
       "steps in scheme C only, where it is stable up to twice the forecast time however stiff. A and B stay "
       "at 2/omega",
       "A plain spring on a turntable swings by {sticking-lag.a-plain-spring-swings-for-ever|plain spring, "
       "swing over m "
       "a/k|smallest} times m a/k or more without end, one between predictions by "
       "{sticking-lag.forecasts-end-the-swing} of it. C's limit tau_s + sqrt(tau_s^2 + 4/omega^2) is met to "
       "{sticking-lag.limit.C}; two layers whose bonds have omega h up to "
       "{sticking-lag.stiff-layers-are-stable|omega h of a bond|last} are stable with tau_s = h/2."}};
}

std::vector<Claim> what_ends_bonds() {
  return {
      {"S5",
       "6",
       "The stiffness fades smoothly to zero, so that a constraint ends smoothly.",
       {{"sticking.fades-without-a-jump", Role::supports},
        {"sticking.energy-is-as-defined", Role::supports},
        {"sticking.regions-vary-in-time", Role::supports}},
       Standing::confirmed,
       "",
       "Across the distance at which bonds break the force changes by {sticking.fades-without-a-jump} at "
       "most of "
       "what a bounded slope and curvature allow, over ways down to a ten-thousandth of that distance. The "
       "paper leaves the fade open; here k = k0 (1 - (d/far)^2)^2, which has an energy."},
      {"S6",
       "6",
       "Sticky and adhering regions may vary in time.",
       {{"sticking.regions-vary-in-time", Role::supports},
        {"sticking.steps-end-at-its-times", Role::supports},
        {"case.grab.sticks", Role::supports},
        {"case.grab.is-lifted", Role::supports},
        {"case.grab.is-carried-aside", Role::supports},
        {"case.grab.lets-go", Role::supports}},
       Standing::confirmed,
       "",
       "Patches are active from one time until another and let go over a time before that. In the case grab "
       "two "
       "palms pick up a cloth, carry it aside and let it go: no particle is held at the end."}};
}

}  // namespace

std::vector<Claim> sticking_claims() {
  std::vector<Claim> claims = what_bonds_keep();
  for (const auto& part : {what_forecasts_buy(), what_ends_bonds()})
    claims.insert(claims.end(), part.begin(), part.end());
  return claims;
}

}  // namespace foldproof
