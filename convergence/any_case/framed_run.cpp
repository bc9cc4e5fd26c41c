#include "convergence/any_case/framed_run.h"

#include <algorithm>
#include <cmath>

#include "verification/evidence.h"

namespace foldproof {

bool is_whole(const FramedRun& run) { return run.stopped.empty() && !run.x.empty(); }

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

double longest_side(const PerParticle3& x) {
  return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
}

double rounding_floor(double size) { return 1e3 * epsilon * size; }

double mean_square_root(const PerParticle3& u, const PerParticle& mass) {
  const Eigen::VectorXd squares = u.colwise().squaredNorm().transpose();
  return std::sqrt(squares.dot(mass.matrix()) / mass.sum());
}

double largest_difference(const std::vector<PerParticle3>& a, const std::vector<PerParticle3>& b,
                          const PerParticle& mass) {
  Worst worst;
  for (size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    worst.observe(mean_square_root(a[k] - b[k], mass));
  return worst.value();
}

double frame_distance(const std::vector<PerParticle3>& a, const std::vector<PerParticle3>& b,
                      const PerParticle& mass) {
  return a.size() == b.size() && !a.empty() ? largest_difference(a, b, mass) : nan;
}

double field_difference(const FramedRun& a, const FramedRun& b, const PerParticle& mass) {
  return is_whole(a) && is_whole(b) ? frame_distance(a.x, b.x, mass) : nan;
}

double largest_motion(const std::vector<PerParticle3>& x, const PerParticle& mass) {
  Worst worst;
  for (const PerParticle3& frame : x) worst.observe(mean_square_root(frame - x.front(), mass));
  return worst.value();
}

}  // namespace foldproof
