// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace steadyrest::live::testing {

/// What systemd would hear.
class Listener {
 public:
  explicit Listener(const std::string& at)
      : address(at), socket_(::socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    address.copy(name.sun_path, sizeof name.sun_path - 1);
    if (name.sun_path[0] == '@') {
      name.sun_path[0] = '\0';
    }
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&name),
                     static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address.size())),
              0);
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  ~Listener() { ::close(socket_); }

  /// Waits for one.
  [[nodiscard]] std::string next() const {
    std::array<char, 512> text{};
    const ssize_t got = ::recv(socket_, text.data(), text.size(), 0);
    return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(0, got))};
  }
  /// What has come so far.
  [[nodiscard]] std::vector<std::string> heard() const {
    std::vector<std::string> all;
    std::array<char, 512> text{};
    for (ssize_t got = 0; (got = ::recv(socket_, text.data(), text.size(), MSG_DONTWAIT)) > 0;) {
      all.emplace_back(text.data(), static_cast<std::size_t>(got));
    }
    return all;
  }

  const std::string address;

 private:
  int socket_;
};

}  // namespace steadyrest::live::testing
