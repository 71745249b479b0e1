// SPDX-License-Identifier: BSD-3-Clause
// The waits of a test. A wait ends when its event has happened, and also when the process that
// should cause the event has ended.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>

#include "runtime/process/child.h"

namespace ergocast::test {

/// How long a test waits for a necessary event before it fails, while all its processes run. It
/// decides no result, even on a busy machine with a tenth of the speed.
inline constexpr auto kPatience = std::chrono::seconds(300);

/// Starts a program. Every wait of the test ends if the program fails.
Child start_watched(const Child::Program& program);

/// From now on each of these programs may end in any way.
void forget_watched();

/// Waits for `condition`; false if it does not become true. The wait ends with a failure, which
/// prints the program's output, as soon as
/// - a watched program has failed: a code other than 0, or a signal that tests do not send. A
///   process of a team may end with code 4: a mission that fails ends all of them.
/// - all watched programs, and all processes that they have left, have ended.
/// An end that the test has seen, by Child::running(), ends no wait. The condition is checked again
/// after the end. A wait within a condition lasts until its own condition is true.
/// @param pause  called between two checks
bool eventually(const std::function<bool()>& condition, const std::function<void()>& pause = {});

/// The same; the wait also ends as soon as that process has ended, in any way.
bool eventually(const std::function<bool()>& condition, pid_t awaited);

}  // namespace ergocast::test
