// foldproof campaign watch: a line and a page about a campaign that runs elsewhere.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "scripts/program/campaign/campaign_commands.h"
#include "scripts/program/campaign/standing.h"
#include "scripts/program/campaign/standing_text.h"
#include "scripts/program/interruption.h"
#include "scripts/program/progress.h"
#include "verification/evidence.h"
#include "verification/files/atomic_file.h"

namespace foldproof {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds least_wait(2);
constexpr std::chrono::milliseconds between_signals(100);

/// Measures how fast jobs end, from the first look on.
class Rate {
 public:
  explicit Rate(size_t done) : done_before_(done) {}

  /// Of the clock, until so many jobs more have ended; NaN while none has.
  double seconds_left(size_t done, size_t jobs) const {
    if (done <= done_before_) return nan;
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    return double(jobs) * seconds / double(done - done_before_);
  }

 private:
  size_t done_before_;
  Clock::time_point start_ = Clock::now();
};

void show_standing(const OpenCampaign& of, const Standing& standing, const Rate& rate) {
  const double left = rate.seconds_left(standing.done(), standing.elsewhere);
  show_line(watch_line(of, standing, left));
  write_text(of.folder + "/watch.html", watch_page(of, standing, left));
}

/// Where a look takes long, looks are further apart.
void wait_for_next_look(Clock::duration took, const InterruptionWatch& watch) {
  const auto until = Clock::now() + std::max<Clock::duration>(least_wait, 4 * took);
  for (; Clock::now() < until; watch.check()) std::this_thread::sleep_for(between_signals);
}

}  // namespace

int watch_campaign(const Options& options) {
  OpenCampaign of = open_campaign(options.file, options.out);
  const InterruptionWatch watch;
  std::filesystem::create_directories(of.folder);
  Standing standing = stand(of, {});
  const Rate rate(standing.done());
  try {
    while (standing.elsewhere > 0) {
      show_standing(of, standing, rate);
      const auto start = Clock::now();
      standing = stand(of, {});
      wait_for_next_look(Clock::now() - start, watch);
    }
  } catch (const Interrupted& interrupted) {
    end_by(interrupted);
  }
  write_text(of.folder + "/watch.html", watch_page(of, standing, nan));
  end_line();
  fmt::print("{}", standing_text(of, standing));
  return standing.missing > 0 ? some_fail : all_hold;
}

}  // namespace foldproof
