// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/kernel/link/host_port.hpp>

namespace steadyrest::kernel::link {
namespace {

std::string shown(std::string_view text) {
  const auto got = host_and_port(text, "502");
  return got ? got->host + " " + got->port : "none";
}

TEST(HostPort, NamesAndNumbersWithAndWithoutAPort) {
  EXPECT_EQ(shown("10.0.0.5"), "10.0.0.5 502");
  EXPECT_EQ(shown("io-module_1.shop.example:1502"), "io-module_1.shop.example 1502");
  EXPECT_EQ(shown("[fe80::1%eth0]"), "fe80::1%eth0 502");
  EXPECT_EQ(shown("[fe80::1%br-lan]"), "fe80::1%br-lan 502");
  EXPECT_EQ(shown("[::1]:65535"), "::1 65535");
}

TEST(HostPort, NothingElse) {
  for (const char* const text : {"",
                                 ":",
                                 ":502",
                                 "host:",
                                 "host:0",
                                 "host:65536",
                                 "host:99999999999",
                                 "host:5x",
                                 "host:-1",
                                 "[::1",
                                 "[]",
                                 "[::1]x",
                                 "[::1]:",
                                 "::1",
                                 "http://host",
                                 "host/path",
                                 "user:pw@host",
                                 "user@host:502",
                                 "a b",
                                 "[host]"}) {
    EXPECT_EQ(shown(text), "none") << text;
  }
}

}  // namespace
}  // namespace steadyrest::kernel::link
