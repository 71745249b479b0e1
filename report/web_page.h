// SPDX-License-Identifier: BSD-3-Clause
// Makes one HTML file from a page of report/web/ and its data; the file loads no other resource.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace ergocast {

/// A page as the build has bundled it. The hashes are SHA-256 in hexadecimal digits.
struct WebPage {
  std::string_view body;
  std::string_view style, style_sha256;
  std::string_view script, script_sha256;
};

/// The page of a run, and that of a study.
const WebPage& run_web_page();
const WebPage& study_web_page();

/// A number with that many digits as JSON; null if it is not finite.
nlohmann::ordered_json page_number(double value, int digits = 6);

/// The page's Content-Security-Policy, for the header and the file. It allows this one script and
/// style, pictures that the page makes, and requests to its own origin.
std::string content_security_policy(const WebPage& page);

/// Makes the file. `data` is in an element that is not executed, and no text in it can end this
/// element. Bytes that are not UTF-8 are replaced.
/// @param title  plain text
std::string html_file(const WebPage& page, const std::string& title,
                      const nlohmann::ordered_json& data);

}  // namespace ergocast
