#include "scripts/program/campaign/slice_mark.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "verification/files/shard_file.h"

namespace foldproof {

namespace {

constexpr std::chrono::seconds between_renewals(2);
constexpr std::chrono::seconds until_dead(8);  // four renewals that did not come

std::string path_of_mark(const Batch& batch, size_t slice) {
  return fmt::format("{}/{:06}.alive", shard_folder(batch, slice), slice);
}

std::string text_of_mark(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

std::string mark_of_slice(const Batch& batch, size_t slice) {
  return text_of_mark(path_of_mark(batch, slice));
}

SliceMark::SliceMark(const Batch& batch, size_t slice, const InterruptionWatch& watch)
    : path_(path_of_mark(batch, slice)) {
  std::string last = text_of_mark(path_);
  for (auto seen = std::chrono::steady_clock::now();
       !last.empty() && std::chrono::steady_clock::now() - seen < until_dead;) {
    watch.check();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::string now = text_of_mark(path_);
    if (now == last) continue;
    last = std::move(now);
    seen = std::chrono::steady_clock::now();
  }
  std::filesystem::create_directories(shard_folder(batch, slice));
  write();
}

SliceMark::~SliceMark() {
  std::error_code already_gone;
  std::filesystem::remove(path_, already_gone);
}

void SliceMark::renew() {
  if (std::chrono::steady_clock::now() - written_ > between_renewals) write();
}

void SliceMark::write() {
  const std::string next = path_ + "." + new_shard_name();
  std::ofstream(next) << host_name() << ' ' << getpid() << ' ' << renewals_++ << '\n';
  std::error_code not_renewed;  // a full disk: the slice says so when it writes its results
  std::filesystem::rename(next, path_, not_renewed);
  written_ = std::chrono::steady_clock::now();
}

}  // namespace foldproof
