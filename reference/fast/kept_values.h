// For speed only: values that a run keeps between steps, so that nothing is computed twice.
#pragma once

#include <map>
#include <memory>
#include <typeindex>
#include <utility>

namespace foldproof {

/// Values by type and by the part of the system that they belong to. It serves one run of one
/// system: parts must keep their addresses and not change while it lives. Use it from one thread
/// only.
class KeptValues {
 public:
  /// The value of an owner, initially Value().
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
