// SPDX-License-Identifier: BSD-3-Clause
// A small map by (agent, incarnation) in two arrays. It is searched for every message, and it grows
// only with the roster.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/base/ids.h"

namespace ergocast {

template <class Value>
class AuthorMap {
 public:
  std::size_t size() const { return authors_.size(); }
  const std::vector<Author>& authors() const { return authors_; }  ///< ascending
  /// Null if it is not there.
  const Value* find(const Author& author) const {
    const std::size_t at = place_of(author);
    return at < authors_.size() && authors_[at] == author ? &values_[at] : nullptr;
  }
  Value* find(const Author& author) {
    return const_cast<Value*>(static_cast<const AuthorMap&>(*this).find(author));
  }
  /// Adds `Value{}` if it is not there.
  Value& operator[](const Author& author) {
    const std::size_t at = place_of(author);
    if (at == authors_.size() || authors_[at] != author) {
      const auto after = static_cast<std::ptrdiff_t>(at);
      values_.insert(values_.begin() + after, Value{});
      authors_.insert(authors_.begin() + after, author);
    }
    return values_[at];
  }

 private:
  std::size_t place_of(const Author& author) const {
    const auto at = std::lower_bound(authors_.begin(), authors_.end(), author);
    return static_cast<std::size_t>(at - authors_.begin());
  }

  std::vector<Author> authors_;  // ascending
  std::vector<Value> values_;
};

}  // namespace ergocast
