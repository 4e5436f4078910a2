// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cerrno>
#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/live/reloader.hpp>
#include <steadyrest/live/service.hpp>
#include <steadyrest/live/test/desk.hpp>
#include <steadyrest/live/testing/service_listener.hpp>

namespace {

/// While it holds, eventfd() fails as in a process without a descriptor left. The process keeps its
/// own: the sanitizers need some for their checks.
std::atomic<bool> no_eventfd{false};

struct WithoutEventfd {
  WithoutEventfd() { no_eventfd.store(true); }
  WithoutEventfd(const WithoutEventfd&) = delete;
  WithoutEventfd& operator=(const WithoutEventfd&) = delete;
  ~WithoutEventfd() { no_eventfd.store(false); }
};

}  // namespace

/// The room's own calls come here.
extern "C" int eventfd(unsigned int count, int flags) noexcept {
  if (no_eventfd.load()) {
    errno = EMFILE;
    return -1;
  }
  return static_cast<int>(::syscall(SYS_eventfd2, count, flags));
}

namespace steadyrest::live {
namespace {

using kernel::machine::Machine;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using ::testing::HasSubstr;

/// A loop that ends once the reloader has answered `answers` times.
class OnDesk : public ::testing::Test {
 protected:
  Result<std::unique_ptr<Successor>> make(const Machine& running) {
    limits_mm.push_back(running.contour.limit_mm);
    Machine wanted = running;
    wanted.contour.limit_mm *= 0.5;
    return std::make_unique<Successor>(
        Successor{.machine = wanted,
                  .layer = supervisor::Supervisor::make(wanted, desk.port->capability()).value(),
                  .kept = supervisor::kept(running, wanted)});
  }
  [[nodiscard]] Reloader::Config config() {
    return {.running = desk.machine,
            .make = [this](const Machine& running) { return make(running); },
            .utc_now = [] { return std::string("2026-11-26T12:00:00Z"); },
            .patience_s = 60.0};
  }
  void run_until_answered(const Reloader& reloader, std::uint64_t number) {
    finished = [&reloader, number] { return reloader.status().number >= number; };
    loop.run();
  }

  test::Desk desk;
  std::function<bool()> finished;
  std::vector<double> limits_mm;
  Loop loop{*desk.port,
            *desk.layer,
            desk.pace,
            {.period_s = 0.004,
             .contour_limit_mm = desk.machine.contour.limit_mm,
             .finished = [this] { return finished(); }}};
};

TEST_F(OnDesk, OffersTheNewLayerToTheLoop) {
  Reloader reloader(loop, config());
  EXPECT_EQ(reloader.status().number, 0U);
  EXPECT_EQ(reloader.ask(), 1U);
  run_until_answered(reloader, 1);
  const ReloadStatus status = reloader.status();
  EXPECT_TRUE(status.taken) << status.words;
  EXPECT_EQ(status.utc, "2026-11-26T12:00:00Z");
  EXPECT_EQ(loop.taken(), 1U);
}

TEST_F(OnDesk, TheNextReloadIsJudgedByTheFileThatRunsNow) {
  Reloader reloader(loop, config());
  reloader.ask();
  bool again = false;
  finished = [&] {
    if (reloader.status().number == 1 && !again) {
      again = true;
      reloader.ask();
    }
    return reloader.status().number >= 2;
  };
  loop.run();
  EXPECT_EQ(limits_mm[1], 0.5 * limits_mm[0]);
  EXPECT_EQ(loop.taken(), 2U);
}

TEST_F(OnDesk, ARefusedFileChangesNothing) {
  auto with = config();
  with.make = [](const Machine&) -> Result<std::unique_ptr<Successor>> {
    return refuse("m.toml", 3U, "a is not known", "leave it out");
  };
  Reloader reloader(loop, with);
  reloader.ask();
  run_until_answered(reloader, 1);
  EXPECT_FALSE(reloader.status().taken);
  EXPECT_EQ(reloader.status().words, "m.toml:3: a is not known; leave it out");
  EXPECT_EQ(loop.taken(), 0U);
}

TEST_F(OnDesk, ALoopThatDoesNotCycleTakesNothing) {
  auto with = config();
  with.patience_s = 0.0;
  std::atomic<bool> answered{false};
  with.on_end = [&](const ReloadStatus&) {
    answered.store(true);
    answered.notify_all();
  };
  Reloader reloader(loop, with);
  reloader.ask();
  answered.wait(false);
  EXPECT_FALSE(reloader.status().taken);
  EXPECT_THAT(reloader.status().words, HasSubstr("does not cycle"));
  EXPECT_FALSE(loop.withdraw()) << "nothing is left on offer";
}

TEST_F(OnDesk, ServesRequestsWithoutADescriptorToBeWokenBy) {
  const WithoutEventfd none;
  Reloader reloader(loop, config());
  reloader.ask();
  run_until_answered(reloader, 1);
  EXPECT_TRUE(reloader.status().taken) << reloader.status().words;
}

TEST_F(OnDesk, SignsOfLifeEndWithoutADescriptorToBeWokenBy) {
  const kernel::file::testing::OwnFolder folder;
  const testing::Listener systemd(folder.at("notify"));
  const ServiceManager manager(systemd.address, 0.004);
  const WithoutEventfd none;
  {
    const LifeSignThread sign(loop, manager);
  }
  EXPECT_EQ(systemd.heard().back(), "STOPPING=1");
}

TEST_F(OnDesk, ASignalIsARequest) {
  sigset_t hangup;
  sigset_t before;
  sigemptyset(&hangup);
  sigaddset(&hangup, SIGHUP);
  ::pthread_sigmask(SIG_BLOCK, &hangup, &before);
  {
    auto with = config();
    with.signal = SIGHUP;
    Reloader reloader(loop, with);
    ::kill(::getpid(), SIGHUP);
    run_until_answered(reloader, 1);
    EXPECT_TRUE(reloader.status().taken);
  }
  const timespec at_once{};
  while (::sigtimedwait(&hangup, nullptr, &at_once) > 0) {
  }
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace
}  // namespace steadyrest::live
