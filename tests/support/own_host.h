// SPDX-License-Identifier: BSD-3-Clause
// A host of the test's own: a network namespace with multicast on its loopback. Tests with open
// sockets then do not receive from other programs or disturb them, and can see which processes they
// left.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace ergocast::test {

/// Moves this process into new namespaces: network, mounts and host name; an ordinary user also
/// gets a new user namespace. Throws std::runtime_error with the reason if the system forbids it.
void enter_own_host();

/// Whether the process was root's.
bool is_root();

/// Whether mounting is possible there, invisible to other processes.
bool may_mount();

/// "agent (pid 12)" of every process in one of these network namespaces (as /proc/PID/ns/net shows
/// them) but this one, zombies left out.
std::vector<std::string> processes_in(const std::set<std::string>& networks);
/// The processes in this process's own network.
std::vector<std::string> processes_on_own_host();
/// The processes that this process has started since enter_own_host(), and their descendants, on
/// any network.
std::vector<std::string> descendants();

}  // namespace ergocast::test
