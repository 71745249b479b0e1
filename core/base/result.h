// SPDX-License-Identifier: BSD-3-Clause
// The return type of a function that may fail: a value or a problem.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <type_traits>
#include <utility>

namespace ergocast {

/// A value, or the reason why there is none: a sentence for people, unless E says more.
///
///   const auto url = LcmUrl::parse(text);
///   if (!url) return failure(url.error());
///   use(*url);  // or url->base()
///
/// tl::expected is std::expected of C++23 for C++20. This alias becomes std::expected when all
/// compilers of Debian's stable release have it; its clang does not.
/// @pre for `*result` and `result->`: there is a value. value() checks this and throws; tests use
/// it.
template <class T, class E = std::string>
using Result = tl::expected<T, E>;

/// Makes the result of a function that has failed: `return failure("there is no such file")`.
template <class E>
tl::unexpected<std::decay_t<E>> failure(E&& problem) {
  return tl::unexpected<std::decay_t<E>>(std::forward<E>(problem));
}

}  // namespace ergocast
