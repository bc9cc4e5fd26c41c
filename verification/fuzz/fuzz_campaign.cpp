// The reader of campaign files: whatever the text, jobs whose values --set reads as they are meant,
// or an InputError that names its place. Files and folders that a text names are not looked for.
#include <algorithm>
#include <cstdint>
#include <string>

#include "convergence/campaigns/campaign.h"
#include "verification/fuzz/finding.h"

namespace foldproof {

namespace {

constexpr size_t most_jobs = 200;

/// Does a parameter ask for the names in a folder?
bool asks_for_files(const KeyTable& table);

bool asks_for_files(const KeyValue& value) {
  if (const auto* below = std::get_if<std::shared_ptr<KeyTable>>(&value.data))
    return asks_for_files(**below);
  if (const auto* list = std::get_if<std::vector<KeyValue>>(&value.data))
    return std::ranges::any_of(*list, [](const KeyValue& v) { return asks_for_files(v); });
  return false;
}

bool asks_for_files(const KeyTable& table) {
  return table.entries.contains("every") ||
         std::ranges::any_of(table.entries,
                             [](const auto& entry) { return asks_for_files(entry.second); });
}

void require_same_after_set(const Assignment& one) {
  KeyTable table("", "");
  set_key(table, "value=" + one.value);
  require(text_of(table.entries.at("value")) == one.value, "--set reads what a job's value says");
}

void require_sound_jobs(const Campaign& campaign) {
  require(campaign.root.jobs >= 1 && campaign.root.jobs <= most_jobs, "jobs are counted");
  const std::vector<std::string> varied = varied_parameters(campaign);
  const std::vector<Assignment> first = job_assignments(campaign, 0);
  for (size_t i = 0; i < campaign.root.jobs; ++i) {
    const std::vector<Assignment> set = job_assignments(campaign, i);
    require(std::ranges::is_sorted(set, {}, &Assignment::key), "assignments are sorted");
    for (const Assignment& one : set) {
      if (campaign.run == "simulate" && one.key != "case") require_same_after_set(one);
      const bool is_as_in_first = std::ranges::any_of(
          first, [&](const Assignment& a) { return a.key == one.key && a.value == one.value; });
      require(is_as_in_first || std::ranges::binary_search(varied, one.key),
              "a parameter that differs is among the varied ones");
    }
  }
  for (const std::string& name : sampled_parameters(campaign))
    require(std::ranges::binary_search(varied, name), "a sampled parameter varies");
}

}  // namespace
}  // namespace foldproof

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace foldproof;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::string path = "/nowhere/fuzz.campaign.toml";
  try {
    if (asks_for_files(*parse_keys(text, path))) return -1;
    require_sound_jobs(read_campaign_text(text, path, most_jobs));
  } catch (const InputError& error) {
    require(std::string(error.what()).starts_with(path), "a refusal names its place");
  }
  return 0;
}
