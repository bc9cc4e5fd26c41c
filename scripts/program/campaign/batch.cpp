#include "scripts/program/campaign/batch.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "verification/files/atomic_file.h"
#include "verification/files/shard_file.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr size_t slices_a_folder = 100;  // of shards, which a slice lists when it starts

std::string line_text(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string slice_file(const Batch& batch, size_t slice) {
  return fmt::format("{}/slices/{:06}.jsonl", batch.folder, slice);
}

std::string shard_folder(const Batch& batch, size_t slice) {
  return fmt::format("{}/shards/{:04}", batch.folder, slice / slices_a_folder);
}

json json_of(const BatchJob& job) {
  json set = json::array();
  for (const Assignment& a : job.set) set.push_back({a.key, a.value});
  return {{"key", job.key}, {"label", job.label}, {"set", set}, {"starts", job.starts}};
}

BatchJob job_of(const json& value) {
  BatchJob job{value.at("key"), value.at("label"), {}, value.at("starts")};
  for (const json& pair : value.at("set")) job.set.push_back({pair.at(0), pair.at(1)});
  return job;
}

json json_of(const Batch& batch) {
  const BatchTerms& t = batch.terms;
  return {{"store", t.store},           {"campaign", t.campaign},  {"run", t.run},
          {"quantities", t.quantities}, {"keep", name_of(t.keep)}, {"seconds", t.limits.seconds},
          {"memory", t.limits.memory},  {"program", t.program},    {"engine", batch.engine},
          {"writer", batch.writer},     {"jobs", batch.jobs},      {"slices", batch.slices}};
}

}  // namespace

BatchWriter::BatchWriter(const BatchTerms& terms, const std::string& engine, size_t jobs_a_slice)
    : jobs_a_slice_(jobs_a_slice) {
  batch_.name = terms.campaign + "-" + new_shard_name();
  batch_.folder = terms.store + "/batches/" + batch_.name;
  batch_.terms = terms;
  batch_.engine = engine;
  batch_.writer = fmt::format("{} {}", host_name(), getpid());
}

void BatchWriter::add(const BatchJob& job) {
  if (batch_.jobs % jobs_a_slice_ == 0) {
    end_slice();
    if (!lock_) lock_.emplace(lock_of_slice(batch_, 0));
    file_.open(slice_file(batch_, batch_.slices++));
  }
  file_ << line_text(json_of(job));
  ++batch_.jobs;
}

void BatchWriter::end_slice() {
  if (batch_.slices == 0) return;
  file_.close();
  if (!file_) throw std::runtime_error(batch_.folder + "/slices: cannot be written");
}

std::optional<Batch> BatchWriter::finish() {
  if (batch_.jobs == 0) return {};
  end_slice();
  write_text(batch_.folder + "/batch.json", json_of(batch_).dump(1) + "\n");
  return batch_;
}

Batch read_batch(const std::string& folder) {
  std::ifstream file(folder + "/batch.json");
  const json values = json::parse(file, nullptr, false);
  try {
    const BatchTerms terms{values.at("store"),
                           values.at("campaign"),
                           values.at("run"),
                           values.at("quantities"),
                           keep_named(values.at("keep")),
                           {values.at("seconds"), values.at("memory")},
                           values.at("program")};
    return {folder,
            fs::path(folder).filename().string(),
            terms,
            values.at("engine"),
            values.at("writer"),
            values.at("jobs"),
            values.at("slices")};
  } catch (const json::exception&) {
    throw InputError(folder + ": is no batch of a campaign; name a folder of STORE/batches");
  }
}

std::vector<BatchJob> read_slice(const Batch& batch, size_t slice) {
  const std::string path = slice_file(batch, slice);
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be read; the batch has no such slice");
  std::vector<BatchJob> jobs;
  try {
    for (std::string line; std::getline(file, line);) jobs.push_back(job_of(json::parse(line)));
  } catch (const json::exception&) {
    throw InputError(fmt::format("{}:{}: is no job", path, jobs.size() + 1));
  }
  return jobs;
}

std::vector<std::string> shards_of_slice(const Batch& batch, size_t slice) {
  std::vector<std::string> paths;
  std::error_code is_missing;  // before the first shard
  for (const auto& entry : fs::directory_iterator(shard_folder(batch, slice), is_missing))
    if (entry.path().extension() == ".jsonl" &&
        entry.path().filename().string().starts_with(fmt::format("{:06}-", slice)))
      paths.push_back(entry.path().string());
  return paths;
}

std::string new_shard_of_slice(const Batch& batch, size_t slice) {
  return fmt::format("{}/{:06}-{}.jsonl", shard_folder(batch, slice), slice, new_shard_name());
}

void mark_ended(const Batch& batch) { std::ofstream(batch.folder + "/ended") << "\n"; }

std::vector<Batch> open_batches(const std::string& store) {
  std::vector<Batch> open;
  if (!fs::is_directory(store + "/batches")) return open;
  for (const auto& entry : fs::directory_iterator(store + "/batches"))
    if (fs::exists(entry.path() / "batch.json") && !fs::exists(entry.path() / "ended"))
      open.push_back(read_batch(entry.path().string()));
  return open;
}

FileLock::FileLock(const std::string& path, const std::function<void()>& wait) {
  fs::create_directories(fs::path(path).parent_path());
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw InputError(path + ": cannot be written: " + std::strerror(errno));
  while (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK && errno != EINTR) {
      const std::string why = std::strerror(errno);
      close(file_);
      throw InputError(path + ": cannot be locked: " + why + "; use a folder with file locks");
    }
    wait();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

FileLock::~FileLock() { close(file_); }

bool FileLock::is_held(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_held = file >= 0 && flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (file >= 0) close(file);
  return is_held;
}

std::string lock_of_store(const std::string& store) { return store + "/lock"; }
std::string lock_of_slice(const Batch& batch, size_t slice) { return slice_file(batch, slice); }

}  // namespace foldproof
