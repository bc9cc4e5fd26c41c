#include "verification/subjects/pipe/portable_scene.h"

namespace foldproof {

Eigen::VectorXd edge_stiffness(const PortableScene& scene) {
  const Eigen::ArrayXd length = rest_lengths(scene.mesh).array();
  return scene.material.young * edge_areas(scene.mesh).array() / length.square();
}

}  // namespace foldproof
