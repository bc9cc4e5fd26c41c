// The engine `slurm`: arrays of slices, by sbatch, squeue, scontrol and scancel.
#pragma once

#include "scripts/program/campaign/engine.h"

namespace foldproof {

std::string slurm_missing();
size_t slurm_jobs_a_slice(size_t jobs, double seconds);
void slurm_submit(Batch& batch, const EngineSettings& settings,
                  const std::function<void(size_t)>& show);
BatchState slurm_ask(const Batch& batch);
void slurm_cancel(const Batch& batch);

}  // namespace foldproof
