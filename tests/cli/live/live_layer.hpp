// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "expectations.hpp"
#include "process.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <steadyrest/live/control_socket.hpp>

namespace steadyrest::test {

/// A layer that runs on the simulated machine in the background, with the usual socket in a
/// temporary folder, and its own machine file, which a test may change.
class LiveLayer {
 public:
  explicit LiveLayer(const std::string& mode = "observe", std::vector<std::string> more = {},
                     const std::string& program = "examples/programs/rib-pocket.mpf")
      : folder_((::setenv("XDG_RUNTIME_DIR", scratch_.at("").c_str(), 1), scratch_.at(""))),
        machine_(text_of_file(project_file("examples/machines/vmc-840d.toml"))),
        process_(arguments(mode, std::move(more), program), folder_) {
    EXPECT_TRUE(
        until([this] { return ::access((folder_ + "/steadyrest.sock").c_str(), F_OK) == 0; }));
  }
  LiveLayer(const LiveLayer&) = delete;
  LiveLayer& operator=(const LiveLayer&) = delete;
  ~LiveLayer() { ::unsetenv("XDG_RUNTIME_DIR"); }

  [[nodiscard]] Process& process() noexcept { return process_; }
  [[nodiscard]] std::string at(const std::string& name) const { return scratch_.at(name); }

  /// A minute at most, however busy the computer is.
  [[nodiscard]] static bool until(const std::function<bool()>& holds) {
    constexpr int kTries = 6000;
    constexpr unsigned kNap_us = 10'000;
    bool now = holds();
    for (int i = 0; i < kTries && !now; ++i) {
      ::usleep(kNap_us);
      now = holds();
    }
    return now;
  }

  /// The machine file with this line instead of that.
  void change(const std::string& line, const std::string& instead) {
    std::string text = machine_;
    const std::size_t at = text.find(line);
    ASSERT_NE(at, std::string::npos) << line;
    text.replace(at, line.size(), instead);
    scratch_.file("machine.toml", text);
  }

  /// The status, which a busy computer may be slow to give.
  [[nodiscard]] static nlohmann::json status(const std::string& socket = live::usual_socket()) {
    const auto answer = live::ask(socket, R"({"version":1,"ask":"status"})", 60.0);
    EXPECT_TRUE(answer.has_value()) << answer.error().what;
    return answer ? nlohmann::json::parse(*answer)["status"] : nlohmann::json{};
  }

  /// The status once `number` reloads have been done.
  [[nodiscard]] static nlohmann::json after_reload(int number) {
    nlohmann::json now;
    EXPECT_TRUE(until([&] {
      now = status();
      return now["reload"].is_object() && now["reload"]["number"] >= number;
    }));
    return now;
  }

 private:
  std::vector<std::string> arguments(const std::string& mode, std::vector<std::string> more,
                                     const std::string& program) {
    std::vector<std::string> all = {"run",
                                    "--machine",
                                    scratch_.file("machine.toml", machine_),
                                    "--program",
                                    program.starts_with('/') ? program : project_file(program),
                                    "--mode",
                                    mode};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  Scratch scratch_;
  std::string folder_;
  std::string machine_;
  Process process_;
};

}  // namespace steadyrest::test
