// The maps of signed distance alone.
#include "reference/post/depth_map.h"
#include "verification/oracles/depth_maps.h"
#include "verification/specimens/check.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

const std::string roundings_reason =
    "a handful of operations, each off by half an epsilon of its result; a power's exponent, at "
    "most 12 here, magnifies the roundings of its base";

/// Bands from a tenth of a millimetre to a metre, with and without a least distance,
/// shallow and deep.
std::vector<DepthBand> bands() {
  Random random(307);
  std::vector<DepthBand> all;
  for (int k = 0; k < 40; ++k) {
    const double reach = random.log_uniform(1e-4, 1);
    all.push_back({k % 3 == 0 ? 0 : random.uniform(0.01, 0.4) * reach, reach,
                   random.uniform(0.3, 6) * reach});
  }
  return all;
}

std::vector<DepthMap> bent_maps() { return {depth_map_named("power"), depth_map_named("blend")}; }

Finding is_as_defined() {
  Table measured = roundings_of("tau + t^");
  for (const DepthMap& map : bent_maps()) {
    Worst worst;
    for (const DepthBand& band : bands()) {
      for (int k = 0; k <= 200; ++k) {
        const double phi = -band.deepest + (band.reach + band.deepest) * (k / 200.0);
        const oracles::Band same{band.nearest, band.reach, band.deepest};
        const double exact =
            (map.name == "power" ? oracles::power_map : oracles::blend_map)(same, phi).value;
        worst.observe(std::abs(map.at(band, phi) - exact) /
                      (epsilon * (band.reach + band.deepest)));
      }
    }
    measured.row(std::string(map.name), worst.value());
  }
  return judge_worst(measured, 16, roundings_reason);
}

Finding ends_are_right() {
  Table measured = roundings_of("tau");
  for (const DepthMap& map : depth_maps()) {
    Worst deepest, at_reach;
    for (const DepthBand& band : bands()) {
      for (const double below : {1.0, 1.7, 40.0})
        deepest.observe(std::abs(map.at(band, -below * band.deepest) - band.nearest) /
                        (epsilon * band.reach));
      for (const double beyond : {1.0, 1.3, 900.0}) {  // these do not move, not by a bit
        // divided, because a fused difference keeps the product's rounding
        const double phi = beyond * band.reach;
        at_reach.observe(std::abs(map.at(band, phi) / phi - 1) * beyond / epsilon);
      }
    }
    measured.row(std::string(map.name) + ", from -t^ down", deepest.value());
    measured.row(std::string(map.name) + ", from tau up", at_reach.value());
  }
  return judge_worst(measured, 8, "phi + t^ at -t^ is off by a rounding of t^, at most 6 tau");
}

/// Over the last h the slope of a convex map differs from 1 by its second derivative, largest at
/// tau, times h/2.
double bend_at_reach(const DepthMap& map, const DepthBand& band) {
  const double depths = band.reach + band.deepest, band_width = band.reach - band.nearest,
               w = band_width / 2;
  return map.name == "power" ? (depths / band_width - 1) / depths
                             : (1 - (band_width - w / 2) / (depths - w / 2)) / w;
}

Finding meets_the_identity_smoothly() {
  Table measured{{"case", ""}, {"|slope - 1| over what the second derivative allows", "1"}};
  for (const DepthMap& map : bent_maps()) {
    Worst worst;
    for (const DepthBand& band : bands()) {
      const double h = 1e-4 * band.reach, slope = (band.reach - map.at(band, band.reach - h)) / h;
      worst.observe(std::abs(slope - 1) / (bend_at_reach(map, band) * h / 2));
    }
    measured.row(std::string(map.name), worst.value());
  }
  return judge_worst(measured, 1.001,
                     "Taylor's remainder over the last ten-thousandth of tau, and a rounding over "
                     "that length, 1e-12 of a slope of 1 against 1e-5");
}

/// Number of ascending depths whose mapped depth falls, or stays where it must rise.
double disorder(const DepthMap& map, const DepthBand& band, bool has_to_rise) {
  double wrong = 0, last = map.at(band, -band.deepest);
  for (int k = 1; k <= 500; ++k) {
    const double next = map.at(band, -band.deepest + (band.reach + band.deepest) * (k / 500.0));
    wrong += !(has_to_rise ? next > last : next >= last);
    last = next;
  }
  return wrong;
}

Finding order_is_kept() {
  Table measured{{"case", ""}, {"neighbours out of order", "1"}};
  for (const DepthMap& map : depth_maps()) {
    double wrong = 0;
    for (const DepthBand& band : bands()) wrong += disorder(map, band, map.name == "blend");
    measured.row(std::string(map.name), wrong);
  }
  return judge_worst(
      measured, 0,
      "f rises; none of 500 steps over the band may fall, and for the blend none may stay equal",
      "The power law rises too, but its steps at the bottom can be smaller than a rounding of "
      "eps.");
}

Finding compression_is_bounded() {
  Table measured("case; compression over its bound [1]; compression by the power law [1]");
  for (const DepthBand& band : bands()) {
    const double depths = band.reach + band.deepest, band_width = band.reach - band.nearest,
                 w = band_width / 2;
    const double bound = (depths - w / 2) / (band_width - w / 2);
    Worst worst, power;
    for (int k = 0; k < 100; ++k) {
      const double phi = -band.deepest + depths * (k / 100.0), step = depths / 100;
      const auto compression = [&](const char* name) {
        const DepthMap& map = depth_map_named(name);
        return step / (map.at(band, phi + step) - map.at(band, phi));
      };
      worst.observe(compression("blend") / bound);
      power.observe(compression("power"));
    }
    measured.row(std::to_string(bound) + " is the bound", worst.value(), power.value());
  }
  return judge_worst(measured, "compression over its bound", 1 + 1e-12,
                     "by construction the slope is nowhere below m; 1e-12 for roundings of "
                     "differences a hundredth of the band apart");
}

Finding senseless_bands_are_rejected() {
  const double infinite = INFINITY;
  const std::vector<DepthBand> senseless = {{-0.01, 0.2, 1}, {0.2, 0.2, 1},    {0.3, 0.2, 1},
                                            {0, 0.2, -1e-3}, {0, infinite, 1}, {0, 0.2, infinite},
                                            {NAN, 0.2, 1},   {0, NAN, 1},      {0, 0.2, NAN}};
  Table measured{{"case", ""}, {"accepted", "1"}};
  for (const DepthBand& band : senseless) {
    const std::string name = "eps " + std::to_string(band.nearest) + ", tau " +
                             std::to_string(band.reach) + ", t^ " + std::to_string(band.deepest);
    measured.row(name, rejection_message([&] { check_band(band); }).empty());
  }
  return judge_worst(measured, 0,
                     "without 0 <= eps < tau and t^ >= 0, all finite, there is no such map");
}

}  // namespace

std::vector<Check> depth_map_checks() {
  const std::string source = "BMF03 section 5.3";
  return {{"projection.map-is-as-defined",
           "The power law and the blend are those that their conditions define.", source,
           is_as_defined},
          {"projection.map-runs-from-eps-to-tau",
           "Every map is eps from the deepest penetration down and phi from tau up.", source,
           ends_are_right},
          {"projection.map-joins-smoothly", "The power law and the blend have slope 1 at tau.",
           source, meets_the_identity_smoothly},
          {"projection.map-preserves-order", "No map turns the order of two depths round.", source,
           order_is_kept},
          {"projection.blend-compression-is-bounded",
           "The blend compresses no depths by more than (tau + t^ - w/2)/(tau - eps - w/2).",
           source, compression_is_bounded},
          {"projection.impossible-bands-are-rejected", "A band that no map can have is refused.",
           source, senseless_bands_are_rejected}};
}

}  // namespace foldproof
