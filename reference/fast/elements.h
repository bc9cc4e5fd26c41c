// Springs, hinges, dampers: lists of elements that push on particles, and the loops over them.
//
// For speed, elements are divided among the threads of a team by particle. Each thread owns a range
// of particles, visits the elements that touch it in ascending order, and adds only to its own
// particles. So each particle adds up the same numbers in the same order as on one thread. An
// element across a border is computed by each of its owners.
#pragma once

#include <array>
#include <initializer_list>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "reference/fast/loops.h"
#include "reference/types.h"

namespace foldproof {

/// An allocator that leaves new elements of a vector uninitialised, for threads to fill.
template <class T>
struct Unfilled : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = Unfilled<U>;
  };
  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U{std::forward<Arguments>(arguments)...};
  }
};

/// Consecutive elements; is_inside: all their particles belong to the thread.
struct ElementRun {
  size_t first, end;
  bool is_inside;
};

/// A thread's particles, first to end - 1, and the elements that touch them, in ascending order.
struct OwnedParticles {
  int first, end;
  std::vector<ElementRun> runs;

  bool has(int particle) const { return first <= particle && particle < end; }
};

/// All particles: for the only thread, or for a run of elements inside one thread's range.
struct AllParticles {
  static constexpr bool has(int) { return true; }
};

/// The division of a list of elements; if null, one thread has them all.
struct DividedElements {
  size_t elements = 0;
  std::vector<OwnedParticles> owners;  // one per thread
};
using Division = std::shared_ptr<const DividedElements>;

/// Divides elements with these particles among a team, N particles in even ranges.
///   elements   of each its particles; a spring's are listed twice
Division divide(const Team& team, Eigen::Index particles,
                const std::vector<std::array<int, 4>>& elements);

/// The target of an element: adds only to its particles that belong to the thread.
template <class Owner, class Target>
class Adder {
 public:
  Adder(const Owner& owner, Target& target) : owner_(owner), target_(target) {}

  /// Adds to particle i: a vector to its column of a PerParticle3, a number to a PerParticle.
  template <class Value>
  void add(int i, const Value& value) const {
    if (!owner_.has(i)) return;
    if constexpr (Target::RowsAtCompileTime == 3)
      target_.col(i) += value;
    else
      target_[i] += value;
  }

 private:
  const Owner& owner_;
  Target& target_;
};

/// A list of elements. Its loops run on the team among which it was last divided.
template <class Element>
class Elements {
 public:
  Elements() = default;
  Elements(std::initializer_list<Element> list) : all_(list) {}

  size_t size() const { return all_.size(); }
  bool empty() const { return all_.empty(); }
  auto begin() const { return all_.begin(); }
  auto end() const { return all_.end(); }
  auto begin() { return all_.begin(); }
  auto end() { return all_.end(); }
  const Element& operator[](size_t k) const { return all_[k]; }
  Element& operator[](size_t k) { return all_[k]; }
  void reserve(size_t count) { all_.reserve(count); }
  void push_back(const Element& one) { all_.push_back(one); }

  /// Divides the list, whose length must not change afterwards.
  void divide(const Team& team, Eigen::Index particles) {
    std::vector<std::array<int, 4>> corners;
    if (team.threads() > 1)
      for (const Element& one : all_) corners.push_back(particles_of(one));
    division_ = foldproof::divide(team, particles, corners);
  }

  /// Appends another list; the joined list runs on one thread.
  void append(Elements more) {
    if (empty()) {
      *this = std::move(more);
      return;
    }
    division_.reset();
    all_.insert(all_.end(), more.all_.begin(), more.all_.end());
  }

  /// act(element, to) adds to the element's particles by to.add(i, value).
  template <class Target, class Act>
  void push(Target& target, const Act& act) const {
    push_each(target, [&](size_t k, const auto& to) { act(all_[k], to); });
  }

  /// The same with another list's element of the same index: act(element, other, to).
  template <class Other, class Target, class Act>
  void push(const Elements<Other>& others, Target& target, const Act& act) const {
    push_each(target, [&](size_t k, const auto& to) { act(all_[k], others[k], to); });
  }

  /// The list of make(element), or make(element, other), divided in the same way.
  template <class Make>
  auto map(const Make& make) const {
    return map_each([&](size_t k) { return make(all_[k]); });
  }
  template <class Other, class Make>
  auto map(const Elements<Other>& others, const Make& make) const {
    return map_each([&](size_t k) { return make(all_[k], others[k]); });
  }

  /// The sum of term(element, other), in blocks.
  template <class Other, class Term>
  double sum(const Elements<Other>& others, const Term& term) const {
    const auto n = Eigen::Index(size());
    return sum_of_blocks(team(), n, block_of_sums, [&](Eigen::Index first, Eigen::Index count) {
      double sum = 0;
      for (Eigen::Index k = first; k < first + count; ++k)
        sum += term(all_[size_t(k)], others[size_t(k)]);
      return sum;
    });
  }

  /// The largest term(element, other) above 0; else 0. Skips NaN.
  template <class Other, class Term>
  double largest(const Elements<Other>& others, const Term& term) const {
    const auto find = [&](Eigen::Index first, Eigen::Index count, std::vector<double>& found) {
      double largest = 0;
      for (Eigen::Index k = first; k < first + count; ++k)
        largest = std::max(largest, term(all_[size_t(k)], others[size_t(k)]));
      found = {largest};
    };
    double largest = 0;
    for (const double one : found_in_order<double>(team(), Eigen::Index(size()), find))
      largest = std::max(largest, one);
    return largest;
  }

 private:
  template <class>
  friend class Elements;

  /// The corners of an element that lists them, or the two ends a and b of one, each twice.
  static std::array<int, 4> particles_of(const Element& one) {
    if constexpr (requires { one.particles; })
      return one.particles;
    else
      return {one.a, one.b, one.a, one.b};
  }

  Team team() const { return division_ ? Team(int(division_->owners.size())) : Team(); }

  template <class Target, class Act>
  void push_each(Target& target, const Act& act) const {
    const auto loop = [&](const ElementRun& run, const auto& owner) {
      const Adder to(owner, target);
      for (size_t k = run.first; k < run.end; ++k) act(k, to);
    };
    const ElementRun all{0, size(), true};
    if (!division_) return call(loop, all, AllParticles{});
    if (division_->elements != size()) throw std::logic_error("elements were added or removed");
    try {
      in_parallel(int(division_->owners.size()), [&](int thread) {
        const OwnedParticles& own = division_->owners[size_t(thread)];
        for (const ElementRun& run : own.runs)
          run.is_inside ? call(loop, run, AllParticles{}) : call(loop, run, own);
      });
    } catch (...) {
      call(loop, all, AllParticles{});  // throws at the element where one thread would fail first
      throw;
    }
  }

  template <class Make>
  auto map_each(const Make& make) const {
    Elements<std::decay_t<decltype(make(size_t(0)))>> made;
    made.division_ = division_;
    made.all_.resize(size());
    for_each_range(team(), Eigen::Index(size()), [&](Eigen::Index first, Eigen::Index count) {
      for (auto k = size_t(first); k < size_t(first + count); ++k) made.all_[k] = make(k);
    });
    return made;
  }

  std::vector<Element, Unfilled<Element>> all_;
  Division division_;
};

}  // namespace foldproof
