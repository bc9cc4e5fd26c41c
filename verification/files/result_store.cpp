#include "verification/files/result_store.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "reference/types.h"
#include "verification/files/hdf5_file.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string one_line(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

ResultStore::ResultStore(std::string folder) : folder_(std::move(folder)) {
  if (folder_.empty()) return;
  if (fs::exists(folder_) && !fs::is_directory(folder_))
    throw InputError(folder_ + ": results are kept in a folder, and this is none");
  shard_ = new_shard_name();
  if (!fs::is_directory(folder_ + "/shards")) return;
  std::vector<fs::directory_entry> shards;
  for (const auto& entry : fs::directory_iterator(folder_ + "/shards"))
    if (entry.path().extension() == ".jsonl") shards.push_back(entry);
  std::ranges::sort(shards, {}, [](const auto& entry) { return entry.last_write_time(); });
  for (const auto& entry : shards) read_shard(entry.path().string(), entry.path().stem().string());
}

void ResultStore::read_shard(const std::string& path, const std::string& shard) {
  read_whole_lines(path, 0, [&](const std::string& text) {
    const json record = json::parse(text, nullptr, false);
    try {
      if (record.contains("start")) ++starts_[record.at("start").get<std::string>()];
      if (!record.contains("result")) return;
      const Line line{record.at("texts").get<std::map<std::string, std::string>>(),
                      record.at("arrays").get<std::map<std::string, size_t>>(), shard};
      results_[record.at("result").get<std::string>()].push_back(line);
    } catch (const json::exception&) {  // none of ours
    }
  });
}

std::string ResultStore::arrays_file(const std::string& key, const std::string& shard) const {
  return folder_ + "/arrays/" + key.substr(0, 2) + "/" + key + "-" + shard + ".h5";
}

std::optional<StoredResult> ResultStore::read(const std::string& key, const Line& line) const {
  StoredResult result{{}, line.texts};
  try {
    const Hdf5 file = Hdf5::open_file(arrays_file(key, line.shard));
    for (const auto& [name, length] : line.lengths) {
      result.arrays[name] = file.read_doubles(name);
      if (result.arrays[name].size() != length) return {};
    }
  } catch (const std::exception&) {
    return {};  // as if it had never been made
  }
  return result;
}

std::optional<StoredResult> ResultStore::find(const std::string& key) const {
  std::vector<Line> lines;
  {
    const std::lock_guard held(mutex_);
    const auto kept = results_.find(key);
    if (kept == results_.end()) return {};
    lines = kept->second;
  }
  for (auto line = lines.rbegin(); line != lines.rend(); ++line)
    if (auto result = read(key, *line)) return result;
  return {};
}

bool ResultStore::contains(const std::string& key) const {
  const std::lock_guard held(mutex_);
  return results_.contains(key);
}

void ResultStore::append(const std::string& line) {
  if (!file_) file_ = std::make_unique<ShardFile>(folder_ + "/shards/" + shard_ + ".jsonl");
  file_->append(line);
}

void ResultStore::start(const std::string& key, const std::string& label) {
  if (folder_.empty()) return;
  const std::lock_guard held(mutex_);
  append(one_line({{"start", key}, {"label", label}}));
  ++starts_[key];
}

void ResultStore::keep(const std::string& key, const StoredResult& result) {
  if (folder_.empty()) return;
  const std::lock_guard held(mutex_);
  const std::string path = arrays_file(key, shard_);
  fs::create_directories(fs::path(path).parent_path());
  Line line{result.texts, {}, shard_};
  write_hdf5(path, [&](const Hdf5& file) {
    for (const auto& [name, values] : result.arrays) {
      if (values.empty()) continue;
      file.dataset(name, values);
      line.lengths[name] = values.size();
    }
  });
  append(one_line({{"result", key}, {"texts", line.texts}, {"arrays", line.lengths}}));
  results_[key].push_back(line);
}

int ResultStore::starts(const std::string& key) const {
  const std::lock_guard held(mutex_);
  const auto found = starts_.find(key);
  return found == starts_.end() ? 0 : found->second;
}

}  // namespace foldproof
