// foldproof campaign ...: one function a command; all return the exit code.
#pragma once

#include "scripts/program/options.h"

namespace foldproof {

int plan_campaign(const Options& options);
int run_campaign(const Options& options);
int show_campaign_table(const Options& options);
int show_campaign_status(const Options& options);
int watch_campaign(const Options& options);
int cancel_campaign(const Options& options);
int emit_campaign(const Options& options);
int report_campaign(const Options& options);
int work_on_batch(const Options& options);

}  // namespace foldproof
