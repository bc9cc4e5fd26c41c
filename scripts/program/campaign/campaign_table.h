// The results of a campaign as a table, and what is expected of them all.
#pragma once

#include <string>
#include <vector>

#include "convergence/campaigns/sensitivity.h"
#include "scripts/program/campaign/standing.h"
#include "verification/verdict.h"

namespace foldproof {

/// A row a job, in the order of the campaign.
struct CampaignTable {
  std::vector<std::string> parameters;             // those that vary
  std::vector<std::string> quantities;             // all that any job has, sorted
  Units units;                                     // of the quantities
  std::vector<std::string> keys, ends, reasons;    // ends: as name_of(JobEnd), "crashed", "missing"
  std::vector<std::vector<std::string>> settings;  // a row a job, a column a parameter
  std::vector<std::vector<double>> values;         // a row a job, a column a quantity; NaN: none
  std::vector<double> seconds;
};

CampaignTable campaign_table(OpenCampaign& of);

/// What the scatter of a quantity comes from.
struct Sensitivity {
  std::string quantity, parameter;
  FirstOrderIndex of;
};

/// One for each quantity that a figure shows and each parameter of [sample] that is a number; of
/// the runs that came to their end.
std::vector<Sensitivity> sensitivities_of(const Campaign& campaign, const CampaignTable& table);

/// A line for each; "" without any.
std::string text_of(const std::vector<Sensitivity>& sensitivities);

/// CSV by RFC 4180; numbers to 17 digits.
std::string csv_of(const CampaignTable& table);

/// The same as HDF5: a dataset a column.
void write_hdf5_table(const std::string& path, const CampaignTable& table);

/// The table, the campaign's texts and figures, and the verdicts, for the report.
std::string json_of_table(const Campaign& campaign, const CampaignTable& table,
                          const std::vector<Record>& verdicts);

/// One record for each entry of [expect]: fails where more jobs than allowed break the bound,
/// inconclusive while jobs without a result could decide it. A job without the value breaks it.
std::vector<Record> judge_campaign(const Campaign& campaign, const CampaignTable& table);

}  // namespace foldproof
