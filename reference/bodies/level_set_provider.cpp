#include "reference/bodies/level_set_provider.h"

#include <map>
#include <mutex>
#include <string>

#include "reference/bodies/deforming_content.h"
#include "reference/bodies/grid_content.h"

namespace foldproof {

namespace {

/// Results by the key of their input.
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

LevelSetProvider memoizing_provider(const LevelSetProvider& provider) {
  const auto grids = std::make_shared<Remembered<Grid>>();
  const auto bodies = std::make_shared<Remembered<DeformingBody>>();
  return {[=](const TriangleSoup& soup, const GridMethod& method, Repair repair) {
            return grids->get(input_key(soup, method, repair),
                              [&] { return provider.make_level_set(soup, method, repair); });
          },
          [=](const MeshSequence& sequence, const OctreeSettings& settings, BetweenFrames between) {
            return bodies->get(input_key(sequence, settings) + std::to_string(int(between)), [&] {
              return provider.make_deforming_body(sequence, settings, between);
            });
          }};
}

LevelSetProvider computing_provider(const Team& team) {
  return {[=](const TriangleSoup& soup, const GridMethod& method, Repair repair) {
            return make_level_set(soup, method, repair, team);
          },
          [=](const MeshSequence& sequence, const OctreeSettings& settings, BetweenFrames between) {
            return std::make_shared<const DeformingBody>(
                make_deforming_body(sequence, settings, between, team));
          }};
}

std::shared_ptr<const Octree> make_octree(const LevelSetProvider& provider,
                                          const MeshSequence& mesh,
                                          const OctreeSettings& settings) {
  const auto body = provider.make_deforming_body(mesh, settings, BetweenFrames::blended);
  return {body, &body->frames.front().field};
}

}  // namespace foldproof
