// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <unistd.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/live/control_socket.hpp>

namespace {

/// While it lasts, accept() fails as in a process without a descriptor left. The process keeps its
/// own: the sanitizers need some for their checks.
struct Want {
  void note() {
    const std::scoped_lock lock(mutex);
    times.push_back(std::chrono::steady_clock::now());
    count.store(times.size());
    count.notify_all();
  }
  std::atomic<bool> lasts{false};
  std::mutex mutex;
  std::vector<std::chrono::steady_clock::time_point> times;
  std::atomic<std::size_t> count{0};
};
Want want;

}  // namespace

/// The server's own call comes here.
extern "C" int accept(int socket, sockaddr* address, socklen_t* length) {
  if (want.lasts.load()) {
    want.note();
    errno = EMFILE;
    return -1;
  }
  return static_cast<int>(::syscall(SYS_accept4, socket, address, length, 0));
}

namespace {

/// Whether this file was there when a server began to listen.
struct {
  std::string file;
  bool was_there = false;
} watched;

}  // namespace

/// The server's own call comes here.
extern "C" int listen(int socket, int backlog) noexcept {
  watched.was_there = ::access(watched.file.c_str(), F_OK) == 0;
  return static_cast<int>(::syscall(SYS_listen, socket, backlog));
}

namespace steadyrest::live {
namespace {

using ::testing::HasSubstr;

std::string echo(std::string_view line) {
  return "seen: " + std::string(line);
}

sockaddr_un name_of(const std::string& path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  path.copy(name.sun_path, sizeof name.sun_path - 1);
  return name;
}

int connected_to(const std::string& path) {
  const int client = ::socket(AF_UNIX, SOCK_STREAM, 0);
  const sockaddr_un name = name_of(path);
  EXPECT_EQ(::connect(client, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  return client;
}

class OnSocket : public ::testing::Test {
 protected:
  kernel::file::testing::OwnFolder folder;
  std::string path = folder.at("s");
};

TEST_F(OnSocket, IsThereOnlyOnceItListens) {
  watched.file = path;
  const auto socket = ControlSocket::open(path, echo);
  ASSERT_TRUE(socket.has_value()) << socket.error().what;
  EXPECT_FALSE(watched.was_there);
  EXPECT_TRUE(ask(path, "hello", 10.0));
}

TEST_F(OnSocket, AnswersLinesOfManyClients) {
  const auto socket = ControlSocket::open(path, echo);
  ASSERT_TRUE(socket.has_value()) << socket.error().what;
  std::vector<std::thread> clients;
  std::vector<int> good(8, 0);
  for (std::size_t i = 0; i < good.size(); ++i) {
    clients.emplace_back([&, i] {
      for (int n = 0; n < 50; ++n) {
        const std::string line = std::to_string(i) + "/" + std::to_string(n);
        const auto answer = ask(path, line, 20.0);
        good[i] += answer && *answer == "seen: " + line ? 1 : 0;
      }
    });
  }
  for (std::thread& client : clients) {
    client.join();
  }
  EXPECT_THAT(good, ::testing::Each(50));
}

TEST_F(OnSocket, IsItsOwnersAloneAndGoesWithTheLayer) {
  {
    const auto socket = ControlSocket::open(path, echo);
    ASSERT_TRUE(socket.has_value());
    struct stat file{};
    ASSERT_EQ(::stat(path.c_str(), &file), 0);
    EXPECT_EQ(file.st_mode & 0777U, 0600U);
  }
  EXPECT_NE(::access(path.c_str(), F_OK), 0);
}

TEST_F(OnSocket, ASecondLayerIsRefusedAndADeadOnesSocketReplaced) {
  {
    const auto first = ControlSocket::open(path, echo);
    const auto second = ControlSocket::open(path, echo);
    ASSERT_FALSE(second.has_value());
    EXPECT_THAT(second.error().what, HasSubstr("another layer answers"));
    EXPECT_TRUE(ask(path, "still there").has_value());
  }
  const int left = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  path.copy(name.sun_path, sizeof name.sun_path - 1);
  ASSERT_EQ(::bind(left, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  ::close(left);
  EXPECT_TRUE(ControlSocket::open(path, echo).has_value());
}

TEST_F(OnSocket, AFileIsNotReplaced) {
  std::ofstream(path) << "a file";
  const auto socket = ControlSocket::open(path, echo);
  ASSERT_FALSE(socket.has_value());
  EXPECT_THAT(socket.error().what, HasSubstr("no socket"));
  EXPECT_FALSE(ControlSocket::open(folder.at("none/s"), echo).has_value());
  EXPECT_FALSE(ControlSocket::open(std::string(200, 'x'), echo).has_value());
}

TEST_F(OnSocket, ALineTooLongIsToldSo) {
  const auto socket = ControlSocket::open(path, echo);
  const auto answer = ask(path, std::string(3 * kMostLine, 'x'), 20.0);
  ASSERT_TRUE(answer.has_value()) << answer.error().what;
  EXPECT_THAT(*answer, HasSubstr("too long"));
  EXPECT_TRUE(ask(path, std::string(kMostLine - 1, 'x'), 20.0).has_value());
}

TEST_F(OnSocket, WithoutADescriptorItWaitsBeforeItAcceptsAgain) {
  const auto socket = ControlSocket::open(path, echo);
  ASSERT_TRUE(socket.has_value());
  want.lasts.store(true);
  const int client = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  path.copy(name.sun_path, sizeof name.sun_path - 1);
  ASSERT_EQ(::connect(client, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  for (std::size_t seen = 0; seen < 2; seen = want.count.load()) {
    want.count.wait(seen);
  }
  want.lasts.store(false);
  {
    const std::scoped_lock lock(want.mutex);
    EXPECT_GE(want.times[1] - want.times[0], std::chrono::milliseconds(90));
  }
  const std::string line = "late\n";
  ASSERT_EQ(::send(client, line.data(), line.size(), 0), static_cast<ssize_t>(line.size()));
  std::string answer(11, ' ');
  EXPECT_EQ(::recv(client, answer.data(), answer.size(), MSG_WAITALL), 11);
  EXPECT_EQ(answer, "seen: late\n") << "and the client that waited is answered";
  ::close(client);
}

TEST_F(OnSocket, WhoeverOnlyHoldsConnectionsKeepsNobodyOut) {
  const auto socket = ControlSocket::open(path, echo);
  std::vector<int> idle;
  for (std::size_t i = 0; i < 3 * kMostClients; ++i) {
    idle.push_back(connected_to(path));
    const std::string part = i % 2 == 0 ? "" : "half a line";
    ::send(idle.back(), part.data(), part.size(), MSG_NOSIGNAL);
  }
  const auto answer = ask(path, "hand back", 20.0);
  ASSERT_TRUE(answer.has_value()) << answer.error().what;
  EXPECT_EQ(*answer, "seen: hand back");
  std::ranges::for_each(idle, ::close);
}

// Their answers fill the sockets' buffers.
TEST_F(OnSocket, WhoeverAsksAndNeverReadsKeepsNobodyOut) {
  const auto socket = ControlSocket::open(
      path, [](std::string_view /*line*/) { return std::string(1 << 20, 'x'); });
  std::vector<int> hogs;
  for (std::size_t i = 0; i < 2 * kMostClients; ++i) {
    hogs.push_back(connected_to(path));
    ::send(hogs.back(), "a\n", 2, MSG_NOSIGNAL);
  }
  const auto answer = ask(path, "hand back", 20.0);
  EXPECT_TRUE(answer.has_value()) << answer.error().what;
  std::ranges::for_each(hogs, ::close);
}

// Whoever is told that there is no layer starts a second one.
TEST_F(OnSocket, ALayerThatHangsIsNotTakenForNone) {
  const int hangs = ::socket(AF_UNIX, SOCK_STREAM, 0);
  const sockaddr_un name = name_of(path);
  ASSERT_EQ(::bind(hangs, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  ASSERT_EQ(::listen(hangs, 1), 0);
  const int first = connected_to(path);
  for (int i = 0; i < 2; ++i) {  // with a place in the queue, and without
    const auto answer = ask(path, "hand back", 0.2);
    ASSERT_FALSE(answer.has_value());
    EXPECT_THAT(answer.error().what, HasSubstr("runs but"));
    EXPECT_THAT(answer.error().to_do, ::testing::Not(HasSubstr("steadyrest run")));
  }
  EXPECT_FALSE(ControlSocket::check(path).has_value());
  ::close(first);
  ::close(hangs);
}

TEST_F(OnSocket, NobodyThereIsUnavailable) {
  const auto answer = ask(path, "hello");
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(answer.error().kind, kernel::outcome::Kind::unavailable);
  EXPECT_THAT(answer.error().to_do, HasSubstr("steadyrest run"));
}

}  // namespace
}  // namespace steadyrest::live
