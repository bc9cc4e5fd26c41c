// The engine `slurm`: arrays of slices, by sbatch, squeue, scontrol and scancel.
#pragma once

#include "scripts/program/campaign/engine.h"

namespace foldproof {

std::string slurm_missing();

/// Some two minutes of work for each core that a slice gets; less where the cluster has more cores
/// than that keeps busy, but not under half a minute.
size_t slurm_jobs_a_slice(size_t jobs, double seconds, const EngineSettings& settings);

void slurm_submit(Batch& batch, const EngineSettings& settings,
                  const std::function<void(size_t)>& show);
BatchState slurm_ask(const Batch& batch);
void slurm_cancel(const Batch& batch);

}  // namespace foldproof
