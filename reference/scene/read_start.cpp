#include "reference/scene/read_start.h"

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "reference/scene/key_values.h"

namespace foldproof {

namespace {

//    ______ ______        A serpentine: straight runs, one above the other, joined by half circles
//   (______               whose diameter is the gap between two runs. Lengths along it are kept.
//          ______)   ^ up
//   start            |    -> along
struct Serpentine {
  double run, gap;  // length of a straight run, distance between two [m]
  double last;      // number of runs before the last

  /// The fraction of the last run at arc length s [m]: 0 before it, 1 at its end.
  double along_last(double s) const {
    return std::max(0.0, (s - last * (run + pi * gap / 2)) / run);
  }

  /// The place of the point at arc length s [m]: along, up [m].
  Eigen::Vector2d at(double s) const {
    const double radius = gap / 2, turn = pi * radius;
    const double below = std::floor(s / (run + turn));  // runs completed
    const double into = s - below * (run + turn);
    const bool forth = std::fmod(below, 2) == 0;
    double across = into, height = 0;
    if (into > run) {
      const double angle = (into - run) / radius;
      across = run + radius * std::sin(angle);
      height = radius * (1 - std::cos(angle));
    }
    return {forth ? across : run - across, below * gap + height};
  }
};

/// Folds the cloth, flat and perpendicular to `up`, into a serpentine of that many layers.
void fold(const KeyTable& keys, PerParticle3& x) {
  const long layers = keys.integer("layers");
  if (!(layers >= 2 && layers <= 1000))
    throw InputError(keys.where("layers") + ": 'layers' must lie in 2 .. 1000");
  const double gap = positive(keys, "gap");
  const Vector3 along = keys.vector_or("along", {1, 0, 0}).normalized(),
                up = keys.vector_or("up", {0, 1, 0}).normalized();
  if (!(std::abs(along.dot(up)) < 1e-9 && along.norm() > 0 && up.norm() > 0))
    throw InputError(keys.where("up") + ": 'up' must be square to 'along', and both be directions");
  const Eigen::RowVectorXd s = along.transpose() * x, height = up.transpose() * x;
  const double start = s.minCoeff(), length = s.maxCoeff() - start,
               turns = double(layers - 1) * pi * gap / 2;
  if (!(height.maxCoeff() - height.minCoeff() <= 1e-6 * length))
    throw InputError(keys.where() +
                     ": the cloth must lie flat, square to 'up', before it is folded");
  const Serpentine serpentine{(length - turns) / double(layers), gap, double(layers - 1)};
  if (!(serpentine.run > gap))
    throw InputError(keys.where("layers") +
                     ": the cloth is too short for so many layers with that gap");
  const double dip = keys.number_or("dip", 0);
  const Eigen::RowVectorXd across = along.cross(up).transpose() * x;
  const double width = across.maxCoeff() - across.minCoeff();
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Eigen::Vector2d place = serpentine.at(s[i] - start);
    const double to_corner =
        serpentine.along_last(s[i] - start) * (across[i] - across.minCoeff()) / width;
    x.col(i) += (start + place[0] - s[i]) * along + (place[1] - dip * to_corner) * up;
  }
}

/// One factor for all directions, or one for each of x, y, z.
Vector3 read_start_stretch(const KeyTable& keys) {
  if (!keys.is_list("stretch")) return Vector3::Constant(positive_or(keys, "stretch", 1));
  const Vector3 stretch = keys.vector("stretch");
  if (!(stretch.minCoeff() > 0))
    throw InputError(keys.where("stretch") + ": 'stretch' must be > 0");
  return stretch;
}

}  // namespace

void read_start(const KeyTable& keys, Scene& scene) {
  if (const auto folded = keys.table("folded")) fold(*folded, scene.x);
  const Vector3 center = scene.x.rowwise().mean();
  const Vector3 stretch = read_start_stretch(keys);
  scene.x = (stretch.asDiagonal() * (scene.x.colwise() - center)).colwise() + center;

  const Vector3 spin = keys.vector_or("spin", Vector3::Zero()) * radians_per_degree;
  const Vector3 velocity = keys.vector_or("velocity", Vector3::Zero());
  const double noise = non_negative_or(keys, "noise", 0);
  std::mt19937_64 random(std::uint64_t(keys.integer_or("seed", 1)));
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const Vector3 arm = scene.x.col(i) - center;
    scene.v.col(i) = velocity + spin.cross(arm);
    for (int k = 0; k < 3; ++k) scene.x(k, i) += noise * (2 * double(random() >> 11) * 0x1p-53 - 1);
  }
}

}  // namespace foldproof
