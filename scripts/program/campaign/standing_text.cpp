#include "scripts/program/campaign/standing_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <tuple>

#include "scripts/program/json_text.h"

namespace foldproof {

namespace {

constexpr size_t most_reasons = 5;

/// End, words and count of what does not hold, the commonest first.
std::vector<std::tuple<std::string, std::string, size_t>> commonest_reasons(
    const Standing& standing) {
  std::vector<std::tuple<std::string, std::string, size_t>> reasons;
  for (const auto& [of, count] : standing.reasons)
    reasons.emplace_back(name_of(of.first), of.second, count);
  std::ranges::stable_sort(reasons, std::greater(), [](const auto& r) { return std::get<2>(r); });
  reasons.resize(std::min(reasons.size(), most_reasons));
  return reasons;
}

/// Counts that are not zero, each with its name.
std::vector<std::pair<std::string, size_t>> counts_of(const Standing& standing) {
  std::vector<std::pair<std::string, size_t>> counts;
  for (const auto& [end, count] : standing.ended) counts.emplace_back(name_of(end), count);
  for (const auto& [name, count] : {std::pair("crashed", standing.crashed),
                                    {"running", standing.elsewhere},
                                    {"missing", standing.missing}})
    if (count > 0) counts.emplace_back(name, count);
  return counts;
}

/// Processor hours of what runs and what is missing, at the mean of the jobs that ended.
std::string work_left(const Standing& standing) {
  const size_t left = standing.elsewhere + standing.missing;
  if (left == 0 || standing.done() == 0) return "";
  const double hours = standing.seconds / double(standing.done()) * double(left) / 3600;
  return fmt::format(", about {:.3g} hours of it left", hours);
}

std::string html(const std::string& text) {
  std::string escaped;
  for (const char c : text)
    escaped += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return escaped;
}

}  // namespace

std::string standing_text(OpenCampaign& of, const Standing& standing) {
  std::string text = fmt::format("{}: {} jobs", of.campaign.name, of.campaign.root.jobs);
  for (const auto& [name, count] : counts_of(standing)) text += fmt::format(", {} {}", count, name);
  text += fmt::format("; {:.3g} s of processor time{}\n", standing.seconds, work_left(standing));
  for (const auto& [end, words, count] : commonest_reasons(standing))
    text += fmt::format("  {} {}: {}\n", count, end, words);
  const auto conflicts = of.index.conflicts();
  if (!conflicts.empty())
    text += fmt::format(
        "{} conflicts: a repetition found something else, as for {} in {}; table conflicts of "
        "{}/index.sqlite\n",
        conflicts.size(), conflicts[0].key, conflicts[0].shard, of.store);
  return text;
}

std::string standing_json(OpenCampaign& of, const Standing& standing) {
  using nlohmann::json;
  json ended = json::object(), reasons = json::array();
  for (const auto& [end, count] : standing.ended) ended[name_of(end)] = count;
  for (const auto& [end, words, count] : commonest_reasons(standing))
    reasons.push_back({{"outcome", end}, {"reason", words}, {"jobs", count}});
  return json_text({{"campaign", of.campaign.name},
                    {"jobs", of.campaign.root.jobs},
                    {"done", standing.done()},
                    {"ended", ended},
                    {"reasons", reasons},
                    {"crashed", standing.crashed},
                    {"running", standing.elsewhere},
                    {"missing", standing.missing},
                    {"seconds", standing.seconds},
                    {"repeated", of.index.repeated()},
                    {"conflicts", of.index.conflicts().size()}}) +
         "\n";
}

std::string watch_line(const OpenCampaign& of, const Standing& standing, double seconds_left) {
  std::string line =
      fmt::format("{}: {} of {} done", of.campaign.name, standing.done(), of.campaign.root.jobs);
  for (const auto& [name, count] : counts_of(standing))
    if (name != "holds") line += fmt::format(", {} {}", count, name);
  if (std::isnan(seconds_left)) return line;
  return line + (seconds_left < 90 ? fmt::format("; {:.0f} s left", seconds_left)
                                   : fmt::format("; {:.0f} min left", seconds_left / 60));
}

std::string watch_page(const OpenCampaign& of, const Standing& standing, double seconds_left) {
  const std::string title = html(of.campaign.title);
  std::string rows;
  for (const auto& [name, count] : counts_of(standing))
    rows += fmt::format("<tr><td>{}<td>{}<td>\n", html(name), count);
  for (const auto& [end, words, count] : commonest_reasons(standing))
    rows += fmt::format("<tr><td>{}<td>{}<td>{}\n", html(end), count, html(words));
  const size_t done = standing.done(), jobs = of.campaign.root.jobs;
  return fmt::format(
      "<!doctype html>\n<meta charset=\"utf-8\">{}\n<title>{} of {}: {}</title>\n"
      "<style>body{{font:16px/1.5 sans-serif;max-width:50em;margin:2em auto;padding:0 "
      "1em}}progress{{width:100%}}td{{padding:0 1em 0 "
      "0;vertical-align:top}}td:nth-child(2){{text-align:right}}</style>\n"
      "<h1>{}</h1>\n<progress value=\"{}\" max=\"{}\"></progress>\n<p>{}\n"
      "<table>\n{}</table>\n",
      standing.elsewhere > 0 ? "\n<meta http-equiv=\"refresh\" content=\"2\">" : "", done, jobs,
      title, title, done, jobs, html(watch_line(of, standing, seconds_left)), rows);
}

}  // namespace foldproof
