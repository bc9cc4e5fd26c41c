// A campaign: one question asked of many parameters, as its file states it.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "reference/scene/key_file.h"

namespace foldproof {

/// A parameter of a job and its value, as after --set.
struct Assignment {
  std::string key, value;
};

/// Parameters that vary together: row r gives keys[k] the value rows[r][k].
struct CampaignAxis {
  std::vector<std::string> keys;
  std::vector<std::vector<std::string>> rows;
  bool is_sample = false;
};

/// What [set], [grid], [[zip]], [sample] and [[part]] say at one level: every combination of the
/// axes, each with every job of one of the parts, if there are parts.
struct CampaignBlock {
  std::vector<Assignment> fixed;
  std::vector<CampaignAxis> axes;
  std::vector<CampaignBlock> parts;
  size_t jobs = 1;  // of this block
};

enum class Keep { none, failures, all };

Keep keep_named(const std::string& name);
std::string name_of(Keep keep);

/// Of one job.
struct JobLimits {
  double seconds = 3600;  // of the processor; of the clock ten times as long
  double memory = 4e9;    // of its process [bytes]
};

/// One entry of [expect]: the share of all jobs whose value keeps the bound.
struct CampaignExpectation {
  std::string quantity;
  bool is_at_most = true;
  double bound = 0;
  double share = 1;  // of the jobs that must keep it
  std::string why;
};

/// A picture of the report: a quantity over one, two or three parameters.
struct CampaignFigure {
  std::string quantity, title;
  std::vector<std::string> over;  // across, up (or one curve each), a small picture each
  bool is_logarithmic = false;    // the colours, or the axis of values
};

struct Campaign {
  std::string file, name, title, about;  // name: of the file, without .campaign.toml
  std::string run = "simulate";          // the command
  CampaignBlock root;
  Keep keep = Keep::none;
  JobLimits limits;
  std::string quantities;  // its [[quantity]] tables as one TOML assignment; "" without any
  std::vector<CampaignExpectation> expectations;
  std::vector<CampaignFigure> figures;
  std::map<std::string, std::string> names;  // of parameters and quantities, for readers
};

/// Reads a campaign file. Throws InputError "file:line: ..." for unknown keys, lists of different
/// lengths in a [[zip]], a parameter without values, and more than 10^7 jobs. Cases are not read.
Campaign read_campaign(const std::string& path);

/// The same for text; `path` names it.
Campaign read_campaign_text(const std::string& text, const std::string& path,
                            size_t most_jobs = 10'000'000);

/// The assignments of job i < campaign.root.jobs, sorted by key; of two with one key the
/// innermost counts.
std::vector<Assignment> job_assignments(const Campaign& campaign, size_t i);

/// The parameters that differ between jobs, sorted.
std::vector<std::string> varied_parameters(const Campaign& campaign);

/// Those that vary with others as samples, sorted.
std::vector<std::string> sampled_parameters(const Campaign& campaign);

/// A value as TOML, or as the bare word that means the same after --set.
std::string text_of(const KeyValue& value);

}  // namespace foldproof
