#include "reference/scene/read_region.h"

#include <set>

#include "reference/scene/key_values.h"

namespace foldproof {

std::vector<int> select_in_box(const KeyTable& keys, const PerParticle3& x) {
  const std::vector<Vector3> box = keys.vectors("box");
  if (box.size() != 2)
    throw InputError(keys.where("box") +
                     ": 'box' must be two points [[x, y, z], [x, y, z]], lowest and highest");
  std::vector<int> chosen;
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    if ((x.col(i).array() >= box[0].array()).all() && (x.col(i).array() <= box[1].array()).all())
      chosen.push_back(int(i));
  return chosen;
}

std::vector<int> select_in_sphere(const KeyTable& keys, const PerParticle3& x) {
  const auto sphere = keys.table("sphere");
  const Vector3 center = sphere->vector("center");
  const double radius = positive(*sphere, "radius");
  std::vector<int> chosen;
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    if ((x.col(i) - center).norm() <= radius) chosen.push_back(int(i));
  return chosen;
}

std::vector<int> numbered(const KeyTable& keys, const std::string& key, Eigen::Index count) {
  std::vector<int> chosen;
  for (long i : keys.integers(key)) {
    if (i < 0 || i >= count)
      throw InputError(keys.where(key) + ": " + key.substr(0, key.size() - 1) + " " +
                       std::to_string(i) + " does not exist; there are " + std::to_string(count));
    chosen.push_back(int(i));
  }
  return chosen;
}

std::vector<int> with_copies(std::vector<int> particles, const std::vector<int>& copy_of) {
  const std::set<int> named(particles.begin(), particles.end());
  for (int i = 0; i < int(copy_of.size()); ++i)
    if (named.contains(copy_of[size_t(i)]) && !named.contains(i)) particles.push_back(i);
  return particles;
}

}  // namespace foldproof
