// The threads that loops run on. The method holds a Team and hands it on; only fast/ looks inside.
#pragma once

namespace foldproof {

/// At most so many threads, the calling one among them. No result depends on their number. A loop
/// with a number in place of a Team runs on a team of that many.
class Team {
 public:
  Team() = default;   // the calling thread alone
  Team(int threads);  // throws InputError for fewer than one
  int threads() const { return threads_; }

 private:
  int threads_ = 1;
};

}  // namespace foldproof
