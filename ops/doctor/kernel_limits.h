// SPDX-License-Identifier: BSD-3-Clause
// Settings of the kernel that decide how much is lost.
#pragma once

#include <filesystem>
#include <string>

#include "ops/doctor/finding.h"
#include "runtime/lcm_url.h"

namespace ergocast::doctor {

/// What a socket's receive buffer holds, in the kernel's own counting.
struct ReceiveBuffer {
  int granted_bytes = 0;  ///< with the URL's recv_buf_size, or the default without
  int most_bytes = 0;     ///< with the largest recv_buf_size (net.core.rmem_max)
};
ReceiveBuffer measure_receive_buffer(const LcmUrl& url);

Finding receive_buffer_finding(const LcmUrl& url, const ReceiveBuffer& buffer);

/// net.ipv4.ipfrag_high_thresh.
/// @param proc  /proc, or a folder like it
Finding fragments_finding(const std::filesystem::path& proc);

/// net.ipv4.conf.*.rp_filter of the interface the group goes over.
Finding reverse_path_finding(const std::filesystem::path& proc, const std::string& interface);

/// Bridges of this host that forget who listens.
/// @param sys  /sys, or a folder like it; it may tell of another network namespace's interfaces,
///             so only those in `own` count
Finding bridges_finding(const std::filesystem::path& sys, const std::vector<std::string>& own);

}  // namespace ergocast::doctor
