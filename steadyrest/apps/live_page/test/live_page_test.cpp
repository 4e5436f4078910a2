// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <boost/asio.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/live_page.hpp>
#include <steadyrest/apps/live_page/test/page_desk.hpp>
#include <steadyrest/web/accounts.hpp>

namespace steadyrest::apps::live_page {
namespace {

namespace asio = boost::asio;
using testing::StartsWith;

class BehindAProxy : public testing::Test {
 protected:
  BehindAProxy() { EXPECT_TRUE(web::Accounts().write(accounts)); }
  LivePage::Config config(const std::string& origin) const {
    LivePage::Config out;
    out.accounts_file = accounts;
    out.outer_origin = origin;
    return out;
  }
  kernel::file::testing::OwnFolder folder;
  std::string accounts = folder.at("users.json");
};

TEST_F(BehindAProxy, AnOriginIsASchemeAndANameAlone) {
  for (const char* const origin :
       {"https://mill.example", "https://Mill.example:8443", "https://[fe80::1]:8443",
        "https://10.0.0.7", "https://mill_2", ""}) {
    EXPECT_TRUE(LivePage::check(config(origin))) << origin;
  }
  for (const char* const origin :
       {"mill.example", "http://mill.example", "https://", "https://mill.example/",
        "https://me@mill.example", "https://*", "https://*.example", "https://mill..example",
        "https://.example", "https://mill.example:", "https://mill.example:0",
        "https://mill.example:99999", "https://mill.example:x", "https://[mill]",
        "https://a,https://b", "https://mill\u202e.example", "https://mill example"}) {
    EXPECT_FALSE(LivePage::check(config(origin))) << origin;
  }
}

TEST_F(BehindAProxy, OthersMayNotGoAroundIt) {
  LivePage::Config open = config("https://mill.example");
  open.address = "0.0.0.0";
  EXPECT_FALSE(LivePage::check(open));
  open.proxies = {"10.0.0.7", "fe80::1"};
  EXPECT_TRUE(LivePage::check(open));
  open.proxies = {"10.0.0.0/8"};
  EXPECT_FALSE(LivePage::check(open));
  LivePage::Config without = config("");
  without.proxies = {"10.0.0.7"};
  EXPECT_FALSE(LivePage::check(without)) << "there is no proxy";
}

TEST_F(BehindAProxy, ThePageHasItsOuterNameOnAnyPort) {
  test::PageDesk desk;
  const auto page = LivePage::open(config("https://Mill.example:8443"), desk.desk());
  ASSERT_TRUE(page.has_value()) << page.error().what;
  const std::string address = (*page)->address();
  const auto port = static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
  const auto status = [port](const std::string& head) {
    asio::io_context io;
    asio::ip::tcp::socket socket(io);
    socket.connect({asio::ip::make_address("127.0.0.1"), port});
    asio::write(socket, asio::buffer("POST /api/v1/session HTTP/1.1\r\nConnection: close\r\n" +
                                     head + "Content-Length: 0\r\n\r\n"));
    std::string got;
    boost::system::error_code fault;
    asio::read(socket, asio::dynamic_buffer(got), fault);
    return got.substr(0, 12);
  };
  const std::string origin = "Origin: https://mill.example:8443\r\n";
  EXPECT_EQ(status("Host: mill.example:8443\r\n" + origin), "HTTP/1.1 415") << "past the gate";
  EXPECT_EQ(status("Host: mill.example\r\n" + origin), "HTTP/1.1 415");
  EXPECT_EQ(status("Host: evil.example\r\n"), "HTTP/1.1 421");
  EXPECT_EQ(status("Host: mill.example\r\nOrigin: https://evil.example\r\n"), "HTTP/1.1 403");
}

}  // namespace
}  // namespace steadyrest::apps::live_page
