// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include <boost/asio.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/web/server.hpp>

namespace steadyrest::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;

/// A certificate for an hour, signed by its own key.
void make_certificate(const std::string& certificate, const std::string& key) {
  EVP_PKEY* const pair = EVP_EC_gen("P-256");
  X509* const x509 = X509_new();
  X509_set_version(x509, X509_VERSION_3);
  ASN1_INTEGER_set(X509_get_serialNumber(x509), 1);
  X509_gmtime_adj(X509_getm_notBefore(x509), 0);
  X509_gmtime_adj(X509_getm_notAfter(x509), 3600);
  X509_set_pubkey(x509, pair);
  X509_sign(x509, pair, EVP_sha256());
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> to(std::fopen(certificate.c_str(), "w"),
                                                           std::fclose);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> key_to(std::fopen(key.c_str(), "w"),
                                                               std::fclose);
  PEM_write_X509(to.get(), x509);
  PEM_write_PrivateKey(key_to.get(), pair, nullptr, nullptr, 0, nullptr, nullptr);
  X509_free(x509);
  EVP_PKEY_free(pair);
}

class OverTls : public testing::Test {
 protected:
  OverTls() { make_certificate(certificate, key); }

  kernel::outcome::Result<std::unique_ptr<Server>> open(const std::string& with_key) {
    Server::Config config;
    config.gate.hosts = {"127.0.0.1"};
    config.certificate = certificate;
    config.key = with_key;
    return Server::open(std::move(config), {.answer =
                                                [](const Request& request) {
                                                  Response out;
                                                  out.body = request.secure ? "secure" : "open";
                                                  return out;
                                                },
                                            .admit = {},
                                            .now_s = [] { return 0.0; }});
  }

  kernel::file::testing::OwnFolder folder;
  std::string certificate = folder.at("certificate.pem");
  std::string key = folder.at("key.pem");
};

TEST_F(OverTls, AnswersAndTellsTheBrowserToStayThere) {
  const auto server = open(key);
  ASSERT_TRUE(server.has_value()) << server.error().what;
  asio::io_context io;
  asio::ssl::context context(asio::ssl::context::tls_client);
  asio::ssl::stream<asio::ip::tcp::socket> client(io, context);
  client.next_layer().connect({asio::ip::make_address("127.0.0.1"), (*server)->port()});
  client.handshake(asio::ssl::stream_base::client);
  http::request<http::empty_body> request(http::verb::get, "/", 11);
  request.set(http::field::host, "127.0.0.1");
  http::write(client, request);
  beast::flat_buffer buffer;
  http::response<http::string_body> response;
  http::read(client, buffer, response);
  EXPECT_EQ(response.body(), "secure");
  EXPECT_EQ(response["Strict-Transport-Security"], "max-age=31536000");
}

TEST_F(OverTls, WithoutItsKeyThereIsNoServer) {
  const std::string other = folder.at("other.pem");
  make_certificate(folder.at("other-certificate.pem"), other);
  EXPECT_FALSE(open(other).has_value());
  EXPECT_FALSE(open(folder.at("none.pem")).has_value());
}

TEST_F(OverTls, PlainTextIsNotAnswered) {
  const auto server = open(key);
  ASSERT_TRUE(server.has_value());
  asio::io_context io;
  asio::ip::tcp::socket client(io);
  client.connect({asio::ip::make_address("127.0.0.1"), (*server)->port()});
  asio::write(client, asio::buffer(std::string("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")));
  std::string got;
  beast::error_code fault;
  asio::read(client, asio::dynamic_buffer(got), fault);
  EXPECT_EQ(got.find("HTTP"), std::string::npos);
}

}  // namespace
}  // namespace steadyrest::web
