// SPDX-License-Identifier: BSD-3-Clause
// Puts style, script, policy and data of a page into one file.
#include "report/web_page.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "report/base64.h"
#include "report/markup.h"

namespace ergocast {

extern const WebPage k_run_page, k_study_page;  // written by the build, web/embed.cmake

namespace {

/// 'sha256-…' of a policy.
std::string source(std::string_view sha256) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < sha256.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(std::string(sha256.substr(i, 2)), nullptr, 16));
  }
  return "'sha256-" + base64(bytes) + '\'';
}

/// JSON without '<', so that neither "</script>" nor "<!--" occurs: it stands only in strings.
std::string json_in_html(const nlohmann::ordered_json& data) {
  const std::string text = data.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

const WebPage& run_web_page() { return k_run_page; }
const WebPage& study_web_page() { return k_study_page; }

nlohmann::ordered_json page_number(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return std::strtod(text, nullptr);
}

std::string content_security_policy(const WebPage& page) {
  return "default-src 'none'; script-src " + source(page.script_sha256) + "; style-src " +
         source(page.style_sha256) +
         "; img-src data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'";
}

std::string html_file(const WebPage& page, const std::string& title,
                      const nlohmann::ordered_json& data) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"";
  html += content_security_policy(page) + "\">\n";
  html += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  html += "<title>" + escape(title) + " – Ergocast</title>\n<style>";
  html += page.style;
  html += "</style>\n</head><body>\n";
  html += page.body;
  html += "<script type=\"application/json\" id=\"data\">" + json_in_html(data) + "</script>\n";
  html += "<script>";
  html += page.script;
  return html + "</script>\n</body></html>\n";
}

}  // namespace ergocast
