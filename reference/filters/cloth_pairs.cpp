#include "reference/filters/cloth_pairs.h"

namespace foldproof {

ClothTree make_cloth_tree(const TriangleMesh& mesh) {
  ClothTree tree;
  tree.triangles = mesh.triangles;
  tree.edges = mesh.edges;
  return tree;
}

}  // namespace foldproof
