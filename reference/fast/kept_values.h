// For speed alone: what a run keeps from one step to the next, so that nothing is computed twice.
#pragma once

#include <map>
#include <memory>
#include <typeindex>
#include <utility>

namespace foldproof {

/// Values by their type and by the part of the system that they belong to. One run of one system
/// has it: parts keep their places and do not change while it lives. Only one thread uses it.
class KeptValues {
 public:
  /// The value of an owner, Value() at first.
  template <class Value, class Owner>
  Value& of(const Owner& owner) {
    std::shared_ptr<void>& value = values_[{typeid(Value), &owner}];
    if (!value) value = std::make_shared<Value>();
    return *static_cast<Value*>(value.get());
  }

 private:
  std::map<std::pair<std::type_index, const void*>, std::shared_ptr<void>> values_;
};

}  // namespace foldproof
