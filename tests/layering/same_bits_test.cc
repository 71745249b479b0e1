// SPDX-License-Identifier: BSD-3-Clause
// The libraries whose results must agree on all processors call no function of the C library whose
// last bit is not fixed, and contain no fused multiply-add.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>
#include <regex>
#include <sstream>
#include <string>

namespace ergocast {
namespace {

std::string output_of(const std::string& command) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  EXPECT_NE(pipe, nullptr);
  std::string output;
  std::array<char, 65536> part;
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), pipe.get()))
    output.append(part.data(), count);
  return output;
}

class SameBits : public testing::TestWithParam<std::string> {};

TEST_P(SameBits, CallsNoFunctionThatDependsOnTheProcessor) {
  // Exact, and so allowed: sqrt, remainder, fmod, ldexp, frexp, ilogb, and what rounds.
  const std::regex forbidden(
      R"(^\s*U (a?(sin|cos|tan)h?|atan2|sincos|exp|exp2|exp10|expm1|log|log2|log10|log1p|pow|cbrt|)"
      R"(hypot|erfc?|[lt]gamma(_r)?|fma|j[01n]|y[01n])[fl]?$)");
  std::istringstream lines(output_of(std::string(ERGOCAST_NM) + " -u " + GetParam()));
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count)
    EXPECT_FALSE(std::regex_search(line, forbidden))
        << line << ": use core/base/portable_math.h (" << GetParam() << ")";
  EXPECT_GT(count, 10) << "nm lists nothing of " << GetParam();
}

TEST_P(SameBits, HasNoFusedMultiplyAdd) {
  const std::string found =
      output_of(std::string(ERGOCAST_OBJDUMP) + " -d --no-show-raw-insn " + GetParam() +
                R"( | awk '/>:$/ {name = $2} /\tret/ {++returns} )"
                R"(/\t(v?fn?m(add|sub)[0-9a-z]*|fml[as]) / {print name, $0} )"
                R"(END {if (returns < 5) print "objdump shows nothing"}')");
  EXPECT_EQ(found.substr(0, 2000), "") << GetParam();
}

INSTANTIATE_TEST_SUITE_P(Libraries, SameBits, testing::Values(ERGOCAST_SAME_BITS),
                         [](const testing::TestParamInfo<std::string>& library) {
                           const std::size_t from = library.param.rfind("libergocast_") + 12;
                           return library.param.substr(from, library.param.rfind('.') - from);
                         });

}  // namespace
}  // namespace ergocast
