// SPDX-License-Identifier: BSD-3-Clause
// Kernel settings that affect how many datagrams are lost.
#pragma once

#include <filesystem>
#include <string>

#include "cli/doctor/finding.h"
#include "runtime/bus/lcm_url.h"

namespace ergocast::doctor {

/// The size of a socket's receive buffer, as the kernel counts it.
struct ReceiveBuffer {
  int granted_bytes = 0;  ///< with the URL's recv_buf_size, or what our programs ask for
  int most_bytes = 0;     ///< with the largest recv_buf_size (net.core.rmem_max)
};
ReceiveBuffer measure_receive_buffer(const LcmUrl& url);

Finding receive_buffer_finding(const LcmUrl& url, const ReceiveBuffer& buffer);

/// Checks net.ipv4.ipfrag_high_thresh.
/// @param proc  /proc, or a folder like it
Finding fragments_finding(const std::filesystem::path& proc);

/// Checks net.ipv4.conf.*.rp_filter of the interface that the group uses.
Finding reverse_path_finding(const std::filesystem::path& proc, const std::string& interface);

/// Checks the bridges of this host: some forget which ports have listeners.
/// @param sys  /sys, or a folder like it; it may list interfaces of another network namespace, so
///             only those in `own` count
Finding bridges_finding(const std::filesystem::path& sys, const std::vector<std::string>& own);

}  // namespace ergocast::doctor
