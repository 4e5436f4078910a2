// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <csignal>
#include <vector>

#include <fcntl.h>
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <tests/lines/module_server.hpp>
#include <unistd.h>

namespace steadyrest::test::lines {
namespace {

constexpr const char* kPython = "/usr/bin/python3";

}  // namespace

std::unique_ptr<ModuleServer> ModuleServer::start(const std::string& serial_device) {
  std::array<int, 2> in{};
  std::array<int, 2> out{};
  if (::pipe2(in.data(), O_CLOEXEC) != 0 || ::pipe2(out.data(), O_CLOEXEC) != 0) {
    ADD_FAILURE() << "no pipe";
    return nullptr;
  }
  std::vector<std::string> words = {kPython, STEADYREST_SOURCE_DIR "/tests/lines/module_server.py",
                                    serial_device.empty() ? "tcp" : "serial"};
  if (!serial_device.empty()) {
    words.push_back(serial_device);
  }
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  std::unique_ptr<ModuleServer> server(new ModuleServer);
  const int fault =
      ::posix_spawn(&server->process_, kPython, &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(in[0]);
  ::close(out[1]);
  server->to_ = ::fdopen(in[1], "w");
  server->from_ = ::fdopen(out[0], "r");
  if (fault != 0 || std::sscanf(server->answer().c_str(), "ready %d", &server->port_) != 1) {
    ADD_FAILURE() << "module_server.py does not start";
    return nullptr;
  }
  return server;
}

ModuleServer::~ModuleServer() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  std::fclose(to_);
  std::fclose(from_);
}

std::string ModuleServer::answer() {
  std::array<char, 128> line{};
  return std::fgets(line.data(), line.size(), from_) != nullptr ? line.data() : "";
}

ModuleServer::Terminals ModuleServer::tell(const std::string& line) {
  std::fputs((line + "\n").c_str(), to_);
  std::fflush(to_);
  unsigned long long outputs = 0;
  unsigned long long written = 0;
  unsigned long long reads = 0;
  const std::string got = answer();
  EXPECT_EQ(std::sscanf(got.c_str(), "%llx %llu %llu", &outputs, &written, &reads), 3) << got;
  return {.outputs = outputs, .written = written, .reads = reads};
}

ModuleServer::Terminals ModuleServer::exchange(std::uint64_t inputs, double now_s) {
  return tell(fmt::format("{:x} {:.9f}", inputs, now_s));
}

}  // namespace steadyrest::test::lines
