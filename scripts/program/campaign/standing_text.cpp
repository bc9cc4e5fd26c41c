#include "scripts/program/campaign/standing_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scripts/program/json_text.h"

namespace foldproof {

std::string standing_text(OpenCampaign& of, const Standing& standing) {
  std::string text = fmt::format("{}: {} jobs", of.campaign.name, of.campaign.root.jobs);
  for (const auto& [end, count] : standing.ended)
    text += fmt::format(", {} {}", count, name_of(end));
  for (const auto& [count, what] : {std::pair(standing.crashed, "crashed"),
                                    {standing.elsewhere, "running"},
                                    {standing.missing, "missing"}})
    if (count > 0) text += fmt::format(", {} {}", count, what);
  text += fmt::format("; {:.3g} s of processor time\n", standing.seconds);
  const auto conflicts = of.index.conflicts();
  if (!conflicts.empty())
    text += fmt::format(
        "{} conflicts: a repetition found something else, as for {} in {}; table conflicts of "
        "{}/index.sqlite\n",
        conflicts.size(), conflicts[0].key, conflicts[0].shard, of.store);
  return text;
}

std::string standing_json(OpenCampaign& of, const Standing& standing) {
  nlohmann::json ended = nlohmann::json::object();
  for (const auto& [end, count] : standing.ended) ended[name_of(end)] = count;
  return json_text({{"campaign", of.campaign.name},
                    {"jobs", of.campaign.root.jobs},
                    {"done", standing.done()},
                    {"ended", ended},
                    {"crashed", standing.crashed},
                    {"running", standing.elsewhere},
                    {"missing", standing.missing},
                    {"seconds", standing.seconds},
                    {"repeated", of.index.repeated()},
                    {"conflicts", of.index.conflicts().size()}}) +
         "\n";
}

}  // namespace foldproof
