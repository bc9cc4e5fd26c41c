// Batches on a Slurm cluster: an array of slices, by sbatch, squeue, scontrol and scancel.
#pragma once

#include "scripts/program/campaign/batch.h"

namespace foldproof {

/// What the user says of the cluster and its machines.
struct SlurmSettings {
  std::string options;  // passed to sbatch
  std::string cache;    // folder of level sets; "": none
  std::string scratch;  // folder on each node; "": shards are written where they belong
};

/// "" if Slurm can be used here, else a reason.
std::string slurm_missing();

/// Slices that an array may have: no more than MaxArraySize, and half of what the controller keeps.
size_t slurm_most_slices();

/// Some two minutes of work for each core that a slice gets; less where the cluster has more cores
/// than that keeps busy, but not under half a minute. More where there would be too many slices.
/// seconds: of a job; NaN: not known.
size_t slurm_jobs_a_slice(size_t jobs, double seconds, const std::string& options);

/// Puts the batch into the queue. Throws InputError with what sbatch says.
void slurm_submit(const Batch& batch, const SlurmSettings& settings);

/// Whether Slurm has slices of it, or does not answer now. Releases slices that are held. Slices
/// that no one works on though Slurm believes so do not count; once only such are left, they are
/// cancelled.
bool slurm_has(const Batch& batch);

/// Ends it; what has no result yet is missing. Throws InputError with what scancel says.
void slurm_cancel(const Batch& batch);

}  // namespace foldproof
