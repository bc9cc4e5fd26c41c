#include "verification/subjects/pipe/portable_scene.h"

namespace foldproof {

Eigen::VectorXd scaled_rest_lengths(const PortableScene& scene) {
  return scene.material.rest_length_scale * rest_lengths(scene.mesh);
}

Eigen::VectorXd edge_stiffness(const PortableScene& scene) {
  const Eigen::ArrayXd length = rest_lengths(scene.mesh).array();
  return scene.material.young * edge_areas(scene.mesh).array() / length.square();
}

}  // namespace foldproof
