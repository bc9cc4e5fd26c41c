#include "scripts/program/campaign/batch.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "verification/files/atomic_file.h"
#include "verification/files/shard_file.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string text_of_json(const json& value, int indent) {
  return value.dump(indent, ' ', false, json::error_handler_t::replace);
}

constexpr size_t slices_a_folder = 100;  // of shards, which a slice lists when it starts

std::string slice_name(size_t slice) { return fmt::format("{:06}", slice); }

std::string slice_file(const Batch& batch, size_t slice) {
  return batch.folder + "/slices/" + slice_name(slice) + ".jsonl";
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

}  // namespace

void write_terms(const Batch& batch) {
  const BatchTerms& t = batch.terms;
  write_text(batch.folder + "/batch.json", text_of_json({{"store", t.store},
                                                         {"campaign", t.campaign},
                                                         {"run", t.run},
                                                         {"quantities", t.quantities},
                                                         {"keep", name_of(t.keep)},
                                                         {"seconds", t.limits.seconds},
                                                         {"memory", t.limits.memory},
                                                         {"program", t.program},
                                                         {"engine", batch.engine},
                                                         {"handle", batch.handle},
                                                         {"jobs", batch.jobs},
                                                         {"slices", batch.slices}},
                                                        1) +
                                               "\n");
}

BatchWriter::BatchWriter(const BatchTerms& terms, const std::string& engine, size_t jobs_a_slice)
    : jobs_a_slice_(jobs_a_slice) {
  batch_.name = terms.campaign + "-" + new_shard_name();
  batch_.folder = terms.store + "/batches/" + batch_.name;
  batch_.terms = terms;
  batch_.engine = engine;
}

void BatchWriter::add(const BatchJob& job) {
  if (batch_.jobs % jobs_a_slice_ == 0) next_slice();
  file_ << text_of_json(json_of(job), -1) << '\n';
  ++batch_.jobs;
}

void BatchWriter::next_slice() {
  end_slice();
  fs::create_directories(batch_.folder + "/slices");
  path_ = slice_file(batch_, batch_.slices++);
  file_.open(path_);
}

void BatchWriter::end_slice() {
  if (batch_.slices == 0) return;
  file_.close();
  if (!file_) throw std::runtime_error(path_ + ": cannot be written");
}

std::optional<Batch> BatchWriter::finish() {
  if (batch_.jobs == 0) return {};
  end_slice();
  fs::create_directories(batch_.folder + "/shards");
  mark_alive(batch_);
  write_terms(batch_);
  return batch_;
}

Batch read_batch(const std::string& folder) {
  Batch batch;
  std::ifstream file(folder + "/batch.json");
  const json values = json::parse(file, nullptr, false);
  try {
    batch.folder = folder;
    batch.name = fs::path(folder).filename().string();
    batch.terms = {values.at("store"),
                   values.at("campaign"),
                   values.at("run"),
                   values.at("quantities"),
                   keep_named(values.at("keep")),
                   {values.at("seconds"), values.at("memory")},
                   values.at("program")};
    batch.engine = values.at("engine");
    batch.handle = values.at("handle");
    batch.jobs = values.at("jobs");
    batch.slices = values.at("slices");
  } catch (const json::exception&) {
    throw InputError(folder + ": is no batch of a campaign; name a folder of STORE/batches");
  }
  return batch;
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

std::string shard_folder(const Batch& batch, size_t slice) {
  return fmt::format("{}/shards/{:04}", batch.folder, slice / slices_a_folder);
}

std::vector<std::string> shards_of_slice(const Batch& batch, size_t slice) {
  std::vector<std::string> paths;
  std::error_code is_missing;  // before the first shard
  for (const auto& entry : fs::directory_iterator(shard_folder(batch, slice), is_missing))
    if (entry.path().extension() == ".jsonl" &&
        entry.path().filename().string().starts_with(slice_name(slice) + "-"))
      paths.push_back(entry.path().string());
  return paths;
}

std::string new_shard_of_slice(size_t slice) {
  return slice_name(slice) + "-" + new_shard_name() + ".jsonl";
}

void mark_alive(const Batch& batch) { std::ofstream(batch.folder + "/alive") << "\n"; }
void mark_ended(const Batch& batch) { std::ofstream(batch.folder + "/ended") << "\n"; }

bool is_marked_alive(const Batch& batch) {
  std::error_code none;
  const auto touched = fs::last_write_time(batch.folder + "/alive", none);
  return !none && fs::file_time_type::clock::now() - touched < std::chrono::minutes(1);
}

std::vector<Batch> open_batches(const std::string& store) {
  std::vector<Batch> open;
  if (!fs::is_directory(store + "/batches")) return open;
  for (const auto& entry : fs::directory_iterator(store + "/batches"))
    if (fs::exists(entry.path() / "batch.json") && !fs::exists(entry.path() / "ended"))
      open.push_back(read_batch(entry.path().string()));
  return open;
}

StoreLock::StoreLock(const std::string& store) {
  fs::create_directories(store);
  file_ = open((store + "/lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw InputError(store + ": cannot be written: " + std::strerror(errno));
  while (flock(file_, LOCK_EX) != 0 && errno == EINTR) continue;
}

StoreLock::~StoreLock() { close(file_); }

}  // namespace foldproof
