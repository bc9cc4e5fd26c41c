#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "convergence/validation/wrinkle_findings.h"
#include "convergence/validation/comparison.h"
#include "convergence/validation/freedoms.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/sheets/deep_wrinkles.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

/// Equilateral triangles with rows of edges across the tension, clamped at both ends as in
/// wrinkled_sheet.h. The sheet is endless across, and all waves are alike: each is its own mirror
/// image about its crest and about its trough.
struct DeepWrinkleSheet {
  double rigidity = 0;     // D of the mesh [J]
  double tension = 0;      // T, per width [N/m]
  double young = 0;        // Y of the springs [N/m]
  double length = 0;       // L [m]
  double compression = 0;  // Delta/W, beyond what the tension narrows the sheet by [1]
  int rows = 0;            // of triangles over the length
  int edges = 0;           // in a wave, even
};

/// Of the flat sheet at rest [m].
double wavelength_of(const DeepWrinkleSheet& sheet) {
  return sheet.edges * sheet.length / sheet.rows / (std::numbers::sqrt3 / 2);
}

struct DeepWrinkle {
  // of each row's wave: half the height of a crest over a trough, of its first harmonic [m]
  std::vector<double> amplitudes;  // held rows too
  double amplitude = 0;            // halfway between the clamps [m]
  double unbalanced = 0;           // largest force over the tension on an edge [1]
  bool stable = false;             // against waves like these
};

constexpr int beyond = 3;  // edges of images on either side of half a wave

/// Half a wave, and images of it on either side. Rows of particles are 0 to rows + 1; two at
/// each end are held.
class HalfWave {
 public:
  HalfWave(const Subject& subject, const DeepWrinkleSheet& sheet)
      : sheet_(sheet),
        edge_(sheet.length / sheet.rows / (std::numbers::sqrt3 / 2)),
        scene_(equilateral_sheet(sheet.rigidity, sheet.young, edge_,
                                 (sheet.edges + 1) / 2 + 2 * beyond, sheet.rows + 1)),
        probe_(subject, scene_) {
    const PerParticle3& rest = scene_.mesh.rest;
    for (int i = 0; i < int(rest.cols()); ++i) {
      row_.push_back(int(std::lround(rest(1, i) / (edge_ * std::numbers::sqrt3 / 2))));
      half_edges_.push_back(int(std::lround(2 * rest(0, i) / edge_)) - 2 * beyond);
    }
    find_freedoms();
  }

  DeepWrinkle settled() const {
    const Hessian hessian(build_system(scene_), freedoms_);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(freedoms_.count);
    load[moving_clamp] = sheet_.tension * sheet_.edges * edge_ / 2;
    const Eigen::VectorXd scale =
        Eigen::VectorXd::Constant(freedoms_.count, sheet_.tension * edge_);
    const Settled rest = settle(
        SheetSettling{probe_, hessian, freedoms_, load, scale, 1e-9, start_height() / 4}, start());
    const SparseFactors factors(hessian.at(resting_state(rest.x), Definiteness::exact, 0));
    DeepWrinkle result{amplitudes_of(rest.x), 0, rest.unbalanced, positive_pivots(factors)};
    const std::size_t middle = std::size_t(sheet_.rows + 1) / 2,
                      other = std::size_t(sheet_.rows + 2) / 2;
    result.amplitude = (result.amplitudes[middle] + result.amplitudes[other]) / 2;
    return result;
  }

 private:
  static constexpr int moving_clamp = 0;  // its unknown

  bool clamped(std::size_t i) const { return row_[i] < 2 || row_[i] >= sheet_.rows; }

  /// Of particles in the half wave, the unknowns; of their images, the same.
  void find_freedoms() {
    const std::size_t n = row_.size();
    freedoms_ = {std::vector<std::array<Freedom, 3>>(n), std::vector<double>(n, 0), 1};
    std::map<std::array<int, 2>, std::size_t> inside;
    for (std::size_t i = 0; i < n; ++i) {
      const int place = half_edges_[i];
      if (place < 0 || place > sheet_.edges) continue;
      const bool on_mirror = place == 0 || place == sheet_.edges;
      inside[{row_[i], place}] = i;
      freedoms_.share[i] = on_mirror ? 0.5 : 1;
      auto& own = freedoms_.of[i];
      if (row_[i] >= sheet_.rows) own[1].unknown = moving_clamp;
      if (clamped(i)) continue;
      if (!on_mirror) own[0].unknown = freedoms_.count++;
      own[1].unknown = freedoms_.count++;
      own[2].unknown = freedoms_.count++;
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (freedoms_.share[i] > 0) continue;
      const int place = half_edges_[i], mirrored = place < 0 ? -place : 2 * sheet_.edges - place;
      const auto original = inside.find({row_[i], mirrored});
      // a border that no counted particle feels has none in a row
      if (original == inside.end()) continue;
      freedoms_.of[i] = freedoms_.of[original->second];
      freedoms_.of[i][0].by = -1;
    }
  }

  double cosine(std::size_t i) const {
    return std::cos(std::numbers::pi * half_edges_[i] / sheet_.edges);
  }

  double start_height() const {
    return wavelength_of(sheet_) / std::numbers::pi * std::sqrt(sheet_.compression);
  }

  /// Compressed across, stretched along, and folded where the tension does not keep it flat: up to
  /// about (T/Y Delta)^(1/2)/k from the clamps.
  PerParticle3 start() const {
    const double poisson = oracles::equilateral_sheet_moduli(sheet_.young).poisson.value;
    const double strain = sheet_.tension / sheet_.young;
    const double k = 2 * std::numbers::pi / wavelength_of(sheet_);
    const double flat = std::sqrt(strain / (2 * sheet_.compression)) / k;
    PerParticle3 x = scene_.mesh.rest;
    x.row(0) *= 1 - sheet_.compression - poisson * strain;
    x.row(1) *= 1 + strain;
    for (std::size_t i = 0; i < row_.size(); ++i) {
      if (clamped(i)) continue;
      const double from_clamp =
          std::min(row_[i] - 0.5, sheet_.rows + 0.5 - row_[i]) * sheet_.length / sheet_.rows;
      const double height = start_height() * std::tanh(from_clamp / flat);
      x(0, Eigen::Index(i)) +=
          k * height * height / 8 * std::sin(2 * std::numbers::pi * half_edges_[i] / sheet_.edges);
      x(2, Eigen::Index(i)) = height * cosine(i);
    }
    return x;
  }

  std::vector<double> amplitudes_of(const PerParticle3& x) const {
    std::vector<double> amplitudes(std::size_t(sheet_.rows + 2), 0);
    for (std::size_t i = 0; i < row_.size(); ++i)
      amplitudes[std::size_t(row_[i])] +=
          4.0 / sheet_.edges * freedoms_.share[i] * cosine(i) * x(2, Eigen::Index(i));
    return amplitudes;
  }

  DeepWrinkleSheet sheet_;
  double edge_;  // m
  Scene scene_;
  Probe probe_;
  std::vector<int> row_, half_edges_;  // of each particle, from the crest
  Freedoms freedoms_;
};

/// Lets half a wave settle. One clamp may move along the tension, which is a force.
DeepWrinkle deep_wrinkle(const Subject& subject, const DeepWrinkleSheet& sheet) {
  return HalfWave(subject, sheet).settled();
}

// of an amplitude, and of the law where the plate is not yet far beyond the onset [1]
constexpr double height_resolution = 0.01, law_resolution = 0.05;

constexpr double tension = 2.9;          // N/m
constexpr double length = 0.15;          // m
constexpr double tension_strain = 1e-4;  // T/Y [1]

/// One compression on three meshes. Amplitudes are over (1/pi) wavelength (Delta/W)^(1/2).
struct DepthLadder {
  double over_onset = 0;   // Delta over that of the law's onset
  double compression = 0;  // Delta/W [1]
  oracles::DeepWrinkles plate;
  Comparison amplitude;
  DeepWrinkle finest;
  double unit = 0;  // (1/pi) wavelength (Delta/W)^(1/2) on the finest mesh [m]
};

/// With so many edges in a wave.
DeepWrinkleSheet sheet_of(double over_onset, int edges) {
  DeepWrinkleSheet sheet{0, tension, tension / tension_strain, length, 0, 3 * edges, edges};
  // the law's rigidity for this wavelength, and its onset
  const double reach = std::pow(wavelength_of(sheet), 2) / (4 * std::numbers::pi * length);
  sheet.rigidity = tension * reach * reach;
  sheet.compression = over_onset * 2 * std::numbers::pi * reach / length * tension_strain;
  return sheet;
}

oracles::DeepWrinkles plate_of(const DeepWrinkleSheet& sheet) {
  return {std::sqrt(sheet.rigidity / sheet.tension) / sheet.length,
          wavelength_of(sheet) / sheet.length, sheet.young * sheet.compression / sheet.tension};
}

DepthLadder ladder_at(const Subject& subject, double over_onset, Tier tier, Table& levels) {
  DepthLadder result;
  result.over_onset = over_onset;
  Ladder amplitudes;
  amplitudes.ratio = 1.5;
  amplitudes.floor = 1e-6;
  const std::vector<int> edges_a_wave =
      tier == Tier::quick ? std::vector{12, 18, 27} : std::vector{16, 24, 36};
  for (const int edges : edges_a_wave) {
    const DeepWrinkleSheet sheet = sheet_of(over_onset, edges);
    result.finest = deep_wrinkle(subject, sheet);
    result.compression = sheet.compression;
    result.plate = plate_of(sheet);
    result.unit = wavelength_of(sheet) / std::numbers::pi * std::sqrt(sheet.compression);
    amplitudes.values.push_back(result.finest.amplitude / result.unit);
    levels.row(over_onset, sheet.compression, sheet.rows, amplitudes.values.back(),
               result.finest.stable ? result.finest.unbalanced : nan);
  }
  result.amplitude = compare_ladder(fmt::format("amplitude at {:g} onsets", over_onset), amplitudes,
                                    oracles::deep_wrinkles_by_series(result.plate, {}).middle);
  return result;
}

NamedFinding amplitude_agrees(const std::vector<DepthLadder>& ladders) {
  Table table = no_comparisons("1");
  for (const DepthLadder& one : ladders) add_comparison(table, one.amplitude, height_resolution);
  return {"stretched-wrinkles.amplitude-agrees",
          "Beyond the onset, wrinkles are halfway between the clamps as high as those of a plate "
          "whose sections are all compressed alike, within one percent.",
          judge_comparisons(std::move(table), height_resolution, "one percent of an amplitude",
                            "over (1/pi) wavelength (Delta/W)^(1/2)")};
}

/// At the greatest compression, over the law for a sine along the length.
NamedFinding sections_fold_alike(const DepthLadder& deepest) {
  const double law = oracles::folded_in_the_mean, u = 1 - deepest.amplitude.should.value;
  return {"stretched-wrinkles.each-section-folds-its-own-compression",
          "At eight times the onset's compression, wrinkles halfway between the clamps are lower "
          "by 2^(1/2), within five percent of it, than the law for a sine along the length, which "
          "folds the compression away in the mean only.",
          judge_comparison({fmt::format("amplitude at {:g} onsets", deepest.over_onset),
                            deepest.amplitude.simulated / law,
                            deepest.amplitude.numerical / law,
                            {oracles::folded_in_each_section / law, std::abs(u) / law}},
                           law_resolution, "five percent of the law's amplitude",
                           "over (2^(1/2)/pi) wavelength (Delta/W)^(1/2); the uncertainty of D is "
                           "its distance from the plate")};
}

NamedFinding deep_wrinkles_rest(const Table& levels) {
  return {"stretched-wrinkles.deep-wrinkles-are-at-rest",
          "Every deep wrinkle is at rest, and stable against waves with its symmetries.",
          judge_worst(levels, "largest force over T edge", 1e-8,
                      "less than a thousandth of what bends the gentlest of them; the search ends "
                      "at a tenth of it")};
}

Figure depth_figure(const std::vector<DepthLadder>& ladders) {
  Figure figure{"amplitudes",
                "Amplitude of a wrinkle by its compression",
                {"compression over the onset's", "1", Scale::log},
                {"amplitude over (1/pi) wavelength (Delta/W)^(1/2)", "1"},
                "Halfway between the clamps. A sine along the length that folds the compression "
                "away in the mean would be at 2^(1/2), at any compression."};
  Curve simulated{"simulated"}, plate{"plate under tension"}, mean{"sine, in the mean"},
      each{"in each section"};
  for (const DepthLadder& one : ladders) {
    simulated.point(one.over_onset, one.amplitude.simulated);
    plate.point(one.over_onset, one.amplitude.should.value);
  }
  for (const DepthLadder* one : {&ladders.front(), &ladders.back()}) {
    mean.point(one->over_onset, oracles::folded_in_the_mean);
    each.point(one->over_onset, oracles::folded_in_each_section);
  }
  figure.curves = {simulated, plate, mean, each};
  return figure;
}

Figure deep_profiles(const std::vector<DepthLadder>& ladders) {
  Figure figure{"deep-profiles",
                "Deep wrinkles along the tension",
                {"place over the length", "1"},
                {"amplitude over (1/pi) wavelength (Delta/W)^(1/2)", "1"},
                "The finest meshes beside the plate: the farther beyond the onset, the flatter."};
  const std::vector<double> places = linear_range(0, 1, 101);
  for (const DepthLadder* one : {&ladders.front(), &ladders.back()}) {
    Curve simulated{fmt::format("simulated, {:g} onsets", one->over_onset)};
    const std::vector<double>& rows = one->finest.amplitudes;
    for (std::size_t i = 1; i + 1 < rows.size(); i += 2)  // row 0 is half a row before the clamp
      simulated.point((double(i) - 0.5) / double(rows.size() - 2), rows[i] / one->unit);
    figure.curves.push_back(std::move(simulated));
    figure.curves.push_back({fmt::format("plate, {:g} onsets", one->over_onset), places,
                             oracles::deep_wrinkles_by_series(one->plate, places).heights});
  }
  return figure;
}

}  // namespace

void add_deep_wrinkles(const Subject& subject, Tier tier, const Progress& progress,
                       StudyResult& result) {
  Table levels(
      "compression over the onset's [1]; Delta/W [1]; rows of triangles [1]; amplitude [1]; "
      "largest force over T edge [1]");  // no number: not stable
  std::vector<DepthLadder> ladders;
  const std::vector<double> depths =
      tier == Tier::quick ? std::vector{4.0, 8.0} : std::vector{2.0, 3.0, 4.0, 6.0, 8.0};
  for (const double depth : depths) {
    ladders.push_back(ladder_at(subject, depth, tier, levels));
    progress((1 + double(ladders.size()) / double(depths.size())) / 2);
  }
  result.add(
      {amplitude_agrees(ladders), sections_fold_alike(ladders.back()), deep_wrinkles_rest(levels)});
  result.figures.push_back(depth_figure(ladders));
  result.figures.push_back(deep_profiles(ladders));
  result.tables.push_back({"deep-meshes", "Every deep wrinkle on every mesh", std::move(levels)});
}

}  // namespace foldproof
