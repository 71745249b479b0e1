// SPDX-License-Identifier: BSD-3-Clause
// Tables that begin at a cache line: a vector of four doubles then never lies across two lines.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace ergocast {

template <class Value>
struct LineAligned {
  using value_type = Value;
  static constexpr std::align_val_t kLine{64};

  LineAligned() = default;
  template <class Other>
  explicit LineAligned(const LineAligned<Other>&) {}

  Value* allocate(std::size_t count) {
    return static_cast<Value*>(::operator new(count * sizeof(Value), kLine));
  }
  void deallocate(Value* values, std::size_t) { ::operator delete(values, kLine); }
  bool operator==(const LineAligned&) const { return true; }
};

using AlignedDoubles = std::vector<double, LineAligned<double>>;

}  // namespace ergocast
