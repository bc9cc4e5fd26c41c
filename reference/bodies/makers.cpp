#include "reference/bodies/makers.h"

#include <map>
#include <mutex>
#include <string>

#include "reference/bodies/deforming_content.h"
#include "reference/bodies/grid_content.h"

namespace foldproof {

namespace {

/// What was made, by the key of all that it is made of.
template <class Field>
class Remembered {
 public:
  template <class Make>
  std::shared_ptr<const Field> get(const std::string& key, const Make& make) {
    const std::lock_guard lock(one_at_a_time_);
    const auto found = made_.find(key);
    return found != made_.end() ? found->second : made_.emplace(key, make()).first->second;
  }

 private:
  std::mutex one_at_a_time_;
  std::map<std::string, std::shared_ptr<const Field>> made_;
};

}  // namespace

LevelSetMakers remembering(const LevelSetMakers& makers) {
  const auto grids = std::make_shared<Remembered<Grid>>();
  const auto bodies = std::make_shared<Remembered<DeformingBody>>();
  return {[=](const TriangleSoup& soup, const GridMethod& method, Repair repair) {
            return grids->get(origin_key(soup, method, repair),
                              [&] { return makers.make_level_set(soup, method, repair); });
          },
          [=](const MeshSequence& sequence, const OctreeSettings& settings, BetweenFrames between) {
            return bodies->get(origin_key(sequence, settings) + std::to_string(int(between)),
                               [&] { return makers.make_deforming_body(sequence, settings, between); });
          }};
}

LevelSetMakers computing_makers() {
  return {make_level_set,
          [](const MeshSequence& sequence, const OctreeSettings& settings, BetweenFrames between) {
            return std::make_shared<const DeformingBody>(make_deforming_body(sequence, settings, between));
          }};
}

std::shared_ptr<const Octree> make_octree(const LevelSetMakers& makers, const PerParticle3& x,
                                          const std::vector<Triangle>& triangles,
                                          const OctreeSettings& settings) {
  const auto body = makers.make_deforming_body({triangles, {0}, {x}}, settings, BetweenFrames::blended);
  return {body, &body->frames.front().field};
}

}  // namespace foldproof
