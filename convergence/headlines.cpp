#include "convergence/headlines.h"

#include <algorithm>
#include <stdexcept>

namespace foldproof {

namespace {

struct Headline {
  std::string_view study;
  std::vector<std::string_view> families;
};

const std::vector<Headline> headlines = {
    {"time-order.hinge", {"A", "B", "C", "B-is-second-order-with-variable-steps"}},
    {"time-order.sheet", {"A", "B", "C", "B-is-second-order-with-variable-steps"}},
    {"work-precision", {"mixed-steps-are-larger", "C-needs-shorter-steps", "cheapest-steps-last"}},
    {"long-contact", {"limit-lasts", "twice-the-limit-does-not-last", "longer-steps-cost-more"}},
    {"solve-tolerance", {"default-tolerance-preserves-the-order"}},
    {"mesh-error", {"usual-step-error-is-below-a-tenth-of-it"}},
    {"momentum-drift",
     {"undamped-angular-is-conserved", "damped-angular-is-conserved", "damped-drift-order.C",
      "damped-drift-exceeds-rounding.C", "linear-is-conserved"}},
    {"cg-iterations", {"fewer-than-ten-in-the-typical-setting", "do-not-grow-with-the-mesh"}},
    {"bending-scaling",
     {"edge-factor-vanishes-with-cell-width", "edge-squared-over-area-factor-tends-to-a-constant"}},
    {"elastic-limit", {"is-two-over-omega", "exponent", "both.is-the-smaller-of-the-two"}},
    {"stability-oscillator",
     {"limit-is-as-derived", "undamped-motion-grows", "heavy-damping-shortens-explicit-steps",
      "has-no-limit"}},
    {"stability-sheet",
     {"limit-does-not-depend-on-damping", "damping-never-lowers-the-limit",
      "heavy-damping-shortens-explicit-steps", "damping-limit-exponent", "limit-is-as-derived"}},
    {"variable-step-stability",
     {"alternating-steps-resonate", "damping-removes-resonance", "undamped-sheet-grows",
      "damped-sheet-does-not-grow"}},
    {"transient-growth",
     {"A.grows-with-damping", "A.growth-is-proportional-to-damping",
      "A.sheet-growth-exceeds-tenfold", "growth-is-bounded", "sheet-growth-is-bounded"}},
    {"bending-rigidity",
     {"does-not-depend-on-cell-size", "depends-on-direction", "depends-on-pattern",
      "irregular.excess-persists-under-refinement"}},
    {"cantilever", {"is-second-order", "matches-the-elastica"}},
    {"strip-vibration", {"is-second-order", "matches-the-beam"}},
    {"filtered-order",
     {"contact-leaves-no-second-order", "strain-limits-leave-no-second-order",
      "second-order-without"}},
    {"frame-long-steps",
     {"one-solve-stays-bounded", "one-solve-adds-energy", "one-solve-is-less-accurate",
      "work-grows-with-the-power-of-three-halves"}},
    {"contact-answers", {"repulsion-answers-calm-contact", "impulses-answer-fast-contact"}},
    {"fold-tests", {"height-agrees"}},
    {"pressed-strip", {"threshold-agrees"}},
    {"fabric-strip", {"measures-as-asked", "other-patterns-differ"}},
    {"heavy-cantilever", {"tip-agrees", "shape-agrees"}},
    {"strip-tests", {"height-agrees", "shape-agrees", "is-second-order"}},
    {"shape-recovery", {"shell-returns-to-its-shape", "flat-rest-angles-do-not-restore-it"}},
    {"hard-limits",
     {"is-two-over-omega", "damped-limit-is-as-derived", "energy-is-bounded-across-a-step-jump"}},
    {"buckling", {"load-matches-euler", "grows-at-the-linearised-rate"}},
    {"mirror-symmetry", {"only-rounding-breaks-it"}},
    {"artificial-damping",
     {"mode-factors-are-as-derived", "undamped-parts-stay-undamped", "energy-has-no-trend",
      "loss-grows-with-the-frequency.backward-euler",
      "change-per-period-is-as-derived.backward-euler"}},
    {"monotonicity",
     {"distance-is-as-derived", "overshoots.A", "overshoot-is-bounded", "velocity-alternates",
      "monotone", "overshoot-exceeds-the-bound-on-a-hinge.C", "overshoots-on-a-hinge.B",
      "overshoots-on-a-hinge.backward-euler", "monotone-on-a-hinge.linear-backward-euler"}},
    {"octree-memory", {"saves-on-boxes-and-bumpy-bodies", "even-bodies-save-from-128-cells-on"}},
    {"level-sets-in-time",
     {"blended-order-is-nearer-two-than-one", "carried-order-is-nearer-two-than-one"}},
    {"level-set-cache",
     {"loaded-fields-are-bitwise-equal", "runs-are-bitwise-equal", "loading-is-cheap",
      "invalid-files-are-rejected", "invalid-grids-are-rejected"}},
    {"level-set-resolution",
     {"second-order-marching-converges", "crude-start.distance-is-first-order",
      "crude-start.normals-stay-wrong"}},
    {"wrinkle-preservation",
     {"plain-flattens-wrinkles", "wavelength-is-preserved", "blend-keeps-a-share-of-depths",
      "power-crushes-deep-wrinkles"}},
    {"required-eps", {"order-is-as-derived", "derived-eps-suffices", "balls-need-the-derived-eps"}},
    {"sharp-edges",
     {"phi-is-first-order", "normals-blend-near-edges-only",
      "normal-error-persists-under-refinement"}},
    {"folding-inside-objects", {"more-folds-when-allowed-inside", "same-folds-over-a-ball"}},
    {"forecast-time",
     {"exact-on-a-plane", "second-order-on-a-resting-ball", "second-order-on-a-moving-ball",
      "second-order-on-a-turning-ball", "second-order-on-a-turning-plane"}},
    {"resting-contact", {"quieter-than-push-out", "projection-is-as-quiet"}},
    {"pointwise-contact",
     {"edge-penetration-is-second-order", "edge-penetration-is-within-the-chord",
      "a-thin-pin-passes-through"}},
    {"self-collision-cost", {"search-work-is-nearly-linear", "sheet-rests-within-the-thickness"}},
    {"crossing-queries", {"no-meeting-is-missed"}},
    {"strain-sweeps",
     {"grow-quadratically", "jacobi-is-mirror-symmetric", "sequential-sweeps-break-mirror-symmetry",
      "jacobi-needs-more-than-three-times-as-many"}},
    {"strain-momentum", {"is-conserved.B", "drift-is-first-order"}},
    {"biphasic", {"gives-way-then-holds", "limits-allow-larger-steps"}},
    {"folding",
     {"limit-preserves-area", "arc-height-matches-its-length", "wrinkle-length-matches-theory",
      "area-is-lost-without-the-limit"}},
    {"sticking-lag",
     {"lag-is-m-a-over-k", "lag-grows-with-the-step-in-C", "forecasts-damp-the-swing",
      "plain-spring-swings-forever", "limit-is-as-derived.C", "stiff-layers-are-stable"}},
    {"price-by-scene", {"C-costs-at-most-twice-the-cheapest", "C-is-not-the-cheapest"}},
    {"free-fold", {"height-agrees", "is-second-order", "floor-only-pushes"}},
    {"lateral-buckling", {"load-agrees", "isotropic-sheet-differs"}},
    {"stretched-wrinkles",
     {"wavelength-agrees", "exponent-agrees", "prefactor-agrees", "tension-stiffens-coarse-meshes",
      "amplitude-agrees"}},
    {"hanging-chain", {"sag-and-pull-agree", "frequency-agrees"}},
    {"friction-tests", {"threshold-agrees", "slide-agrees", "belt-agrees"}},
    {"hung-disc", {"energy-agrees", "depth-agrees", "three-folds-fall-to-two"}},
    {"cusick-drape",
     {"coefficient-grows-with-bending-length", "fold-number-follows-the-start",
      "folds-change-the-coefficient"}}};

}  // namespace

std::vector<std::string_view> headline_families(std::string_view study) {
  for (const Headline& headline : headlines)
    if (headline.study == study) return headline.families;
  return {};
}

void require_headline_findings(const std::string& study, const std::vector<std::string>& findings) {
  for (const std::string_view family : headline_families(study)) {
    const std::string name = study + "." + std::string(family);
    const bool is_measured = std::ranges::any_of(findings, [&](const std::string& finding) {
      return finding == name || finding.starts_with(name + ".");
    });
    if (!is_measured)
      throw std::logic_error(study + ": its sentence rests on " + name +
                             ", which it does not measure");
  }
}

}  // namespace foldproof
