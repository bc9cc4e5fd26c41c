#include "convergence/validation/deep_wrinkle.h"

#include <cmath>
#include <map>
#include <numbers>

#include "convergence/validation/freedoms.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/homogenised_bending.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr double density = 0.2;  // kg/m^2; sets the pace of the search alone
constexpr int beyond = 3;        // edges of images on either side of half a wave

/// Half a wave, and images of it on either side. Rows of particles are 0 to rows + 1; two at
/// each end are held.
class HalfWave {
 public:
  HalfWave(const Subject& subject, const DeepWrinkleSheet& sheet)
      : sheet_(sheet),
        edge_(sheet.length / sheet.rows / (std::numbers::sqrt3 / 2)),
        scene_(scene_of(sheet, edge_)),
        probe_(subject, scene_) {
    const PerParticle3& rest = scene_.mesh.rest;
    for (int i = 0; i < int(rest.cols()); ++i) {
      row_.push_back(int(std::lround(rest(1, i) / (edge_ * std::numbers::sqrt3 / 2))));
      half_edges_.push_back(int(std::lround(2 * rest(0, i) / edge_)) - 2 * beyond);
    }
    find_freedoms();
  }

  DeepWrinkle settled() const {
    const Hessian hessian(scene_, freedoms_);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(freedoms_.count);
    load[moving_clamp] = sheet_.tension * sheet_.edges * edge_ / 2;
    const Eigen::VectorXd scale =
        Eigen::VectorXd::Constant(freedoms_.count, sheet_.tension * edge_);
    const Settled rest =
        settle({probe_, hessian, freedoms_, load, scale, 1e-9, start_height() / 4}, start());
    const SparseFactors factors(hessian.at(rest.x, Definiteness::exact, 0));
    DeepWrinkle result{amplitudes_of(rest.x), 0, rest.unbalanced, positive_pivots(factors)};
    const std::size_t middle = std::size_t(sheet_.rows + 1) / 2,
                      other = std::size_t(sheet_.rows + 2) / 2;
    result.amplitude = (result.amplitudes[middle] + result.amplitudes[other]) / 2;
    return result;
  }

 private:
  static constexpr int moving_clamp = 0;  // its unknown

  static Scene scene_of(const DeepWrinkleSheet& sheet, double edge) {
    const int columns = (sheet.edges + 1) / 2 + 2 * beyond;
    Scene scene = scene_at_rest(
        make_sheet({SheetPattern::equilateral, columns * edge, 0, columns, sheet.rows + 1}),
        density);
    const Eigen::Matrix3d R = oracles::relaxed_rigidity(oracles::equilateral_triangles(1));
    scene.bending = BendingMaterial{sheet.rigidity / oracles::cylinder_rigidity(R, 0), 0,
                                    Weighting::rest, DampingFactor::edge, "sine"};
    scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
    scene.stretch = StretchMaterial{sheet.young, 0, 1};
    return scene;
  }

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

}  // namespace

double wavelength_of(const DeepWrinkleSheet& sheet) {
  return sheet.edges * sheet.length / sheet.rows / (std::numbers::sqrt3 / 2);
}

DeepWrinkle deep_wrinkle(const Subject& subject, const DeepWrinkleSheet& sheet) {
  return HalfWave(subject, sheet).settled();
}

}  // namespace foldproof
