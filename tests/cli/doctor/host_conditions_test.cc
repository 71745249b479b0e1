// SPDX-License-Identifier: BSD-3-Clause
// The missing parts of lcm-spy are found in an artificial file system, and a firewall's policy in
// its rules.
#include "cli/doctor/host_conditions.h"

#include "tests/cli/doctor/fixture.h"

namespace ergocast::doctor {
namespace {

class Programs : public Folder {};

TEST_F(Programs, WhatLcmSpyLacksIsNamedWithItsPackages) {
  write("opt/bin/java", "");
  write("usr/share/java/lcm.jar", "");
  const Finding jar = spy_finding(root_, "/bin:/opt/bin", true);
  EXPECT_EQ(jar.level, Level::kNote);
  EXPECT_EQ(jar.found, "missing: jchart2d.jar");
  EXPECT_EQ(jar.remedy, "apt-get install libjchart2d-java");
  EXPECT_EQ(spy_finding(root_, "/bin", true).remedy,
            "apt-get install default-jre libjchart2d-java");
  write("usr/share/java/jchart2d.jar", "");
  EXPECT_EQ(spy_finding(root_, "/bin:/opt/bin", true).level, Level::kOk);
}

TEST_F(Programs, AJarThatWasNotBuiltIsMissingThoughJavaIsThere) {
  for (const char* file : {"bin/java", "usr/share/java/lcm.jar", "usr/share/java/jchart2d.jar"}) {
    write(file, "");
  }
  const Finding no_compiler = spy_finding(root_, "/bin", false);
  EXPECT_EQ(no_compiler.level, Level::kNote);
  EXPECT_EQ(no_compiler.found, "missing: javac, ergocast-spy.jar");
  write("bin/javac", "");
  const Finding not_built = spy_finding(root_, "/bin", false);
  EXPECT_EQ(not_built.found, "missing: ergocast-spy.jar");
  EXPECT_EQ(not_built.remedy, "cmake build/release && cmake --build build/release --target spy");
}

TEST(Clock, IsANoteAtMost) {
  EXPECT_EQ(clock_finding(true).level, Level::kOk);
  EXPECT_EQ(clock_finding(false).level, Level::kNote);
  EXPECT_EQ(clock_finding(std::nullopt).level, Level::kOk);
}

TEST(Firewall, OnlyInputThatDropsByPolicyIsNoted) {
  const auto level = [](const char* rules) { return firewall_finding(rules, "239.0.0.1")->level; };
  EXPECT_FALSE(firewall_finding("", "239.0.0.1").has_value());
  EXPECT_EQ(level("table inet filter {\n\tchain input {\n"
                  "\t\ttype filter hook input priority filter; policy drop;\n\t}\n}\n"),
            Level::kNote);
  EXPECT_EQ(level("\t\ttype filter hook input priority filter; policy accept;\n"
                  "\t\ttype filter hook forward priority filter; policy drop;\n"),
            Level::kOk);
  EXPECT_EQ(firewall_finding("table inet filter {\n\tchain input {\n"
                             "\t\ttype filter hook input priority filter; policy drop;\n\t}\n}\n",
                             "239.0.0.1")
                ->remedy,
            "nft insert rule inet filter input ip daddr 239.0.0.1 accept\n"
            "nft insert rule inet filter input ip protocol igmp accept");
  EXPECT_EQ(level("table ip6 filter {\n\tchain INPUT {\n"
                  "\t\ttype filter hook input priority filter; policy drop;\n\t}\n}\n"),
            Level::kOk);
  EXPECT_EQ(level("-P INPUT DROP\n"), Level::kNote);
  EXPECT_EQ(level("-P INPUT ACCEPT\n"), Level::kOk);
}

}  // namespace
}  // namespace ergocast::doctor
