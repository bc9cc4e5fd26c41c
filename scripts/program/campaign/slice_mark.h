// A mark that a slice is being worked on: schedulers that crash start a slice twice.
#pragma once

#include <chrono>
#include <string>

#include "scripts/program/campaign/batch.h"
#include "scripts/program/interruption.h"

namespace foldproof {

/// What the mark of a slice says now; "" without one.
std::string mark_of_slice(const Batch& batch, size_t slice);

/// STORE/batches/NAME/shards/0000/000000.alive, while a process works on the slice. Clocks of nodes
/// may differ, so that it is alive which changes, not which is young.
class SliceMark {
 public:
  /// Waits while another process renews the mark, then takes it. A slice that was killed costs the
  /// next one some seconds. Throws Interrupted.
  SliceMark(const Batch& batch, size_t slice, const InterruptionWatch& watch);
  ~SliceMark();
  SliceMark(const SliceMark&) = delete;
  SliceMark& operator=(const SliceMark&) = delete;

  /// To be called a few times a second; writes every few seconds.
  void renew();

 private:
  void write();

  std::string path_;
  long renewals_ = 0;
  std::chrono::steady_clock::time_point written_;
};

}  // namespace foldproof
