// SPDX-License-Identifier: BSD-3-Clause
// Rule sets as nft prints them: which drop all fragments to our ports, and which only seem to.
#include "cli/doctor/fragment_rule.h"

#include "tests/cli/doctor/fixture.h"

namespace ergocast::doctor {
namespace {

/// A rule set as nft writes it.
/// @param more  additional matches
/// @param before  a rule before it
std::string ruleset(const std::string& hook, const std::string& ports, const std::string& verdict,
                    const std::string& more = "", const std::string& before = "") {
  return R"({"nftables": [{"metainfo": {"version": "1.0.6"}},
    {"table": {"family": "inet", "name": "ergocast", "handle": 3}},
    {"chain": {"family": "inet", "table": "ergocast", "name": "in", "type": "filter", "hook": ")" +
         hook + R"(", "prio": -10, "policy": "accept"}},)" + before + R"(
    {"rule": {"family": "inet", "table": "ergocast", "chain": "in", "handle": 3, "expr": [)" +
         more +
         R"({"match": {"op": "==", "left": {"payload": {"protocol": "udp", "field": "dport"}}, "right": )" +
         ports +
         R"(}}, {"match": {"op": "==", "left": {"payload": {"base": "th", "offset": 64, "len": 32}},
    "right": 1279471667}}, {"counter": {"packets": 0, "bytes": 0}}, {")" +
         verdict + R"(": null}]}}]})";
}

/// A rule for the same port, with another verdict.
std::string other_rule(const std::string& verdict) {
  return R"({"rule": {"family": "inet", "table": "ergocast", "chain": "in", "handle": 2, "expr": [
      {"match": {"op": "==", "left": {"payload": {"protocol": "udp", "field": "dport"}},
                 "right": 24000}}, {")" +
         verdict + R"(": null}]}},)";
}

Finding finding(const std::optional<std::string>& rules, int port = 24000) {
  return fragment_rule_finding(url_of("ttl=1", port), rules, "/share/ergocast.nft");
}

TEST(FragmentRule, InForceAtAllThreePortsIsAllRight) {
  EXPECT_EQ(finding(ruleset("input", R"({"range": [24000, 26999]})", "drop")).level, Level::kOk);
  EXPECT_EQ(
      finding(ruleset("input", R"({"set": [7667, {"range": [24000, 24002]}]})", "drop")).level,
      Level::kOk);
}

TEST(FragmentRule, ThatDropsNotAllOfThemIsNoted) {
  EXPECT_EQ(finding(ruleset("input", R"({"range": [24000, 24001]})", "drop")).found,
            "a rule drops them at 2 of our 3 ports");
  for (const std::string& rules :
       {ruleset("output", R"({"range": [24000, 26999]})", "drop"),
        ruleset("input", R"({"range": [24000, 26999]})", "accept"),
        ruleset("input", R"({"range": [25000, 26999]})", "drop"),
        ruleset(
            "input", R"({"range": [24000, 26999]})", "drop",
            R"({"match": {"op": "==", "left": {"meta": {"key": "iifname"}}, "right": "eth9"}},)"),
        ruleset("input", R"({"range": [24000, 26999]})", "drop",
                R"({"limit": {"rate": 1, "burst": 5, "per": "hour"}},)"),
        ruleset("input", R"({"range": [24000, 26999]})", "drop", "", other_rule("accept")),
        std::string(R"({"nftables": []})"), std::string("{}"), std::string("no JSON")}) {
    EXPECT_EQ(finding(rules).level, Level::kNote) << rules;
    EXPECT_EQ(finding(rules).found, "no rule drops them") << rules;
    EXPECT_EQ(finding(rules).remedy, "nft -f /share/ergocast.nft");
  }
}

TEST(FragmentRule, BehindOneThatAlsoDropsStillDropsTheRest) {
  const auto rules =
      ruleset("input", R"({"range": [24000, 26999]})", "drop", "", other_rule("drop"));
  EXPECT_EQ(finding(rules).level, Level::kOk);
}

TEST(FragmentRule, IsOfferedToUsersThatCannotReadTheRules) {
  const Finding unknown = finding(std::nullopt);
  EXPECT_EQ(unknown.level, Level::kNote);
  EXPECT_TRUE(contains(unknown.found, "only root"));
  EXPECT_EQ(unknown.remedy, "nft -f /share/ergocast.nft");
}

TEST(FragmentRule, IsMadeForThePortsOfTheUrl) {
  EXPECT_EQ(finding(std::nullopt, 9000).remedy,
            "sed 's/^define.*{/& 9000-9002,/' /share/ergocast.nft | nft -f -");
}

}  // namespace
}  // namespace ergocast::doctor
