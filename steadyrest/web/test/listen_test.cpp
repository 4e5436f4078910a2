// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/web/listen.hpp>

namespace steadyrest::web {
namespace {

using testing::HasSubstr;

TEST(ListenPlace, IsAPortAnAddressOrANameOfThisComputer) {
  struct Case {
    const char* text;
    const char* address;
    const char* name;
    std::uint16_t port;
  };
  for (const Case& at :
       {Case{"8080", "127.0.0.1", "", 8080}, Case{"0", "127.0.0.1", "", 0},
        Case{"0.0.0.0:443", "0.0.0.0", "", 443}, Case{"[::1]:8080", "::1", "", 8080},
        Case{"[::]:1", "::", "", 1}, Case{"[::ffff:127.0.0.1]:1", "127.0.0.1", "", 1},
        Case{"LocalHost:8080", "127.0.0.1", "localhost", 8080}}) {
    const auto got = listen_place(at.text);
    ASSERT_TRUE(got) << at.text << got.error().what;
    EXPECT_EQ(got->address, at.address) << at.text;
    EXPECT_EQ(got->name, at.name) << at.text;
    EXPECT_EQ(got->port, at.port) << at.text;
  }
}

TEST(ListenPlace, IsRefusedWhereItIsNoneOrLeadsElsewhere) {
  for (const char* const text : {"nowhere", "", ":8080", "localhost", "localhost:", "localhost:x",
                                 "127.0.0.1:65536", "127.0.0.1:-1", "::1:8080", "[::1]", "[::1",
                                 "[localhost]:8080", "no such name:8080", "name.invalid:8080"}) {
    EXPECT_FALSE(listen_place(text)) << text;
  }
  const auto open = listen_place("0:8080");  // the resolver's spelling of 0.0.0.0
  ASSERT_FALSE(open);
  EXPECT_THAT(open.error().what, HasSubstr("0.0.0.0, which others reach"));
}

TEST(AnAddress, HasOneSpelling) {
  EXPECT_EQ(address_of("::FFFF:10.0.0.7"), "10.0.0.7");
  EXPECT_EQ(address_of("FE80:0::1"), "fe80::1");
  EXPECT_EQ(address_of("mill.example"), std::nullopt);
  EXPECT_TRUE(is_loopback("127.9.9.9") && is_loopback("::1"));
  EXPECT_FALSE(is_loopback("10.0.0.7") || is_loopback("::") || is_loopback("127.example"));
}

}  // namespace
}  // namespace steadyrest::web
