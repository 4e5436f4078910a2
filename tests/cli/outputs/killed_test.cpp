// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <random>
#include <set>
#include <string>

#include "output_folder.hpp"
#include "output_rows.hpp"
#include "process.hpp"
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

/// Verbs killed at a random moment lose nothing. STEADYREST_KILLS: how often each verb is killed (3
/// by default); STEADYREST_SEED: other moments.
namespace steadyrest::test {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

unsigned long number_from(const char* name, unsigned long otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoul(text, nullptr, 10);
}

/// Watches the files of some folders by inotify, so that a process can be killed at the very moment
/// it writes, not only while it computes.
class Watch {
 public:
  explicit Watch(const std::set<std::string>& folders) {
    constexpr auto kAll = IN_CREATE | IN_MODIFY | IN_ATTRIB | IN_CLOSE_WRITE | IN_MOVE | IN_DELETE;
    for (const std::string& folder : folders) {
      inotify_add_watch(descriptor_, folder.c_str(), kAll);
    }
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  ~Watch() { close(descriptor_); }

  /// Waits for this many events or the end of the process; returns the number of events.
  int until(int events, const Process& process) {
    int seen = 0;
    std::array<pollfd, 2> either = {{{descriptor_, POLLIN, 0}, {process.ended(), POLLIN, 0}}};
    while (seen < events && poll(either.data(), either.size(), -1) > 0) {
      if ((either[0].revents & POLLIN) != 0) {
        seen += take();
      } else {
        return seen;
      }
    }
    return seen;
  }

 private:
  int take() {
    alignas(inotify_event) std::array<char, 4096> block{};
    const ssize_t got = read(descriptor_, block.data(), block.size());
    int events = 0;
    for (ssize_t at = 0; at < got; ++events) {
      const auto* event = reinterpret_cast<const inotify_event*>(block.data() + at);
      at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
    }
    return events;
  }

  int descriptor_ = inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
};

class Killed : public testing::TestWithParam<OutputRow> {
 protected:
  // All of a new file is there: the same bytes, or, where it states how long it took, the same end.
  static bool whole(const std::string& text, const std::string& made) {
    constexpr std::size_t kEnd = 6;
    return GetParam().timed
               ? text.size() > made.size() / 2 && text.ends_with(made.substr(made.size() - kEnd))
               : text == made;
  }

  // Old or new, never a part. Only SIGKILL may leave temporary files behind, since nothing can
  // clean up after it.
  void expect_nothing_lost(const Texts& old, const Texts& made, const std::string& how) const {
    Texts found = folder_.results();
    for (const auto& [name, text] : old) {
      EXPECT_TRUE(found[name] == text || whole(found[name], made.at(name))) << how << name;
      found.erase(name);
    }
    for (const auto& [name, text] : found) {
      EXPECT_TRUE(how.starts_with("9 ") &&
                  fs::path(name).filename().string().starts_with(".steadyrest-"))
          << how << "left " << name;
    }
    EXPECT_EQ(folder_.examples(), examples_) << how;
  }

  [[nodiscard]] std::set<std::string> folders() const {
    std::set<std::string> out;
    for (const std::string& name : folder_.outputs()) {
      out.insert(fs::path(folder_.at(name)).parent_path());
    }
    return out;
  }

  OutputFolder folder_{GetParam()};
  const Texts examples_ = folder_.examples();
};

// First an undisturbed run, for the new results and the number of file events; then runs killed at
// random events or times.
TEST_P(Killed, LeavesTheOldFileOrTheNewOne) {
  ASSERT_EQ(Process(folder_.command(), folder_.path()).wait(), 0);
  const Texts made = folder_.results();
  Texts old = made;
  for (auto& [name, text] : old) {
    text += "\n";
  }
  folder_.place(old);
  const auto start = Clock::now();
  int events = 0;
  {
    Watch watch(folders());
    Process process(folder_.command(), folder_.path());
    events = watch.until(1 << 20, process);
    ASSERT_EQ(process.wait(), 0);
  }
  const auto lasts = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - start);
  ASSERT_GT(events, 0);
  std::mt19937_64 random(number_from("STEADYREST_SEED", 1));
  const auto kills = number_from("STEADYREST_KILLS", 3);
  for (unsigned long i = 0; i < kills; ++i) {
    folder_.place(old);
    const int signal = std::array{SIGKILL, SIGINT, SIGTERM, SIGHUP}[random() % 4];
    std::string how = std::to_string(signal) + " ";
    Watch watch(folders());
    Process process(folder_.command(), folder_.path());
    if (random() % 4 == 0) {  // at any time
      pollfd end{process.ended(), POLLIN, 0};
      const int ms = static_cast<int>(random() % (static_cast<std::uint64_t>(lasts.count()) + 1));
      how += "after " + std::to_string(ms) + " ms: ";
      poll(&end, 1, ms);
    } else {  // where it matters
      const int at = 1 + static_cast<int>(random() % static_cast<std::uint64_t>(events));
      how += "at event " + std::to_string(at) + ": ";
      watch.until(at, process);
    }
    process.send(signal);
    const int code = process.wait();
    EXPECT_TRUE(code == 0 || code == -signal) << how << code << process.err();
    expect_nothing_lost(old, made, how);
  }
}

INSTANTIATE_TEST_SUITE_P(OfAllVerbs, Killed,
                         testing::ValuesIn(output_rows().begin(), output_rows().end()), test_name);

}  // namespace
}  // namespace steadyrest::test
