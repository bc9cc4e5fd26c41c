#include "convergence/any_case/framed_run.h"

namespace foldproof {

StoredResult packed_frames(const FramedRun& run) {
  StoredResult kept;
  std::vector<double> positions;
  for (const PerParticle3& x : run.x)
    positions.insert(positions.end(), x.data(), x.data() + x.size());
  kept.arrays = {{"times", run.times}, {"positions", positions}, {"seconds", {run.seconds}}};
  kept.texts["stopped"] = run.stopped;
  return kept;
}

std::vector<double> array_of(const StoredResult& kept, const std::string& name) {
  const auto found = kept.arrays.find(name);
  return found == kept.arrays.end() ? std::vector<double>() : found->second;
}

bool unpack_frames(const StoredResult& kept, Eigen::Index particles, FramedRun& run) {
  run.times = array_of(kept, "times");
  const std::vector<double> positions = array_of(kept, "positions"),
                            seconds = array_of(kept, "seconds");
  const auto stopped = kept.texts.find("stopped");
  const size_t numbers = 3 * size_t(particles);  // of a frame
  if (seconds.size() != 1 || stopped == kept.texts.end() ||
      positions.size() != run.times.size() * numbers)
    return false;
  run.seconds = seconds[0];
  run.stopped = stopped->second;
  for (size_t k = 0; k < run.times.size(); ++k)
    run.x.push_back(Eigen::Map<const PerParticle3>(positions.data() + k * numbers, 3, particles));
  return true;
}

}  // namespace foldproof
