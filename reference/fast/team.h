// The threads that loops run on. The method holds a Team and hands it on; only fast/ looks inside.
#pragma once

namespace foldproof {

/// An upper limit on threads, including the calling one. No result depends on it. A loop given a
/// number in place of a Team runs on a team of that size.
class Team {
 public:
  Team() = default;   // the calling thread alone
  Team(int threads);  // throws InputError for fewer than one
  int threads() const { return threads_; }

 private:
  int threads_ = 1;
};

}  // namespace foldproof
