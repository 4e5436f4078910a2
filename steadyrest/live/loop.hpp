// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/kernel/rt/ring.hpp>
#include <steadyrest/kernel/rt/snapshot.hpp>
#include <steadyrest/live/black_box.hpp>
#include <steadyrest/live/chatter_watch.hpp>
#include <steadyrest/live/live_status.hpp>
#include <steadyrest/live/pace.hpp>
#include <steadyrest/live/tap.hpp>
#include <steadyrest/live/time_figures.hpp>
#include <steadyrest/live/wish/wish_box.hpp>
#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/supervisor/wish.hpp>

namespace steadyrest::live {

/// What a run has shown so far.
struct LoopFigures {
  std::uint64_t cycles = 0;
  std::uint64_t overruns = 0;  ///< deadlines that passed while a cycle was at work
  std::uint64_t port_faults = 0;
  TimeFigures work;
  TimeFigures lateness;
  double over_limit_s = 0.0;
  bool listens = false;              ///< to chatter
  std::uint64_t chatter_events = 0;  ///< how often it began
  double chatter_s = 0.0;
  bool handed_back = true;      ///< nothing of the layer was left on the machine at the end
  std::string last_fault;       ///< of the port, in words; empty: none
  bool ended_in_fault = false;  ///< the last cycle could not read or write
  /// Cycles by the reason of the feed, spindle, offsets: one cycle may count in several.
  std::vector<std::uint64_t> by_reason;  ///< in the order of kernel::outcome::reasons()
};

/// A layer that goes on where the present one is, made from another machine file.
struct Successor {
  kernel::machine::Machine machine;
  supervisor::Supervisor layer;
  supervisor::Kept kept;
  std::uint32_t text = 0;  ///< the file's text, by its number in a record
};

/// Words on their way to the cycle.
struct LoopNote {
  static constexpr std::size_t kLongest = 160;
  std::size_t size = 0;
  std::array<char, kLongest> text{};
};

/// The layer's only loop: one cycle a period until it is told to stop. README.md has the law.
///
/// run() belongs to one thread. ask_mode() and ask_stop() may be called by any thread and by a
/// signal's handler; status() by any other thread; offer() with withdraw() by one.
class Loop {
 public:
  struct Config {
    double period_s = 0.001;        ///< 1 Hz … 4 kHz: a bus or a network may be slow
    double contour_limit_mm = 0.0;  ///< of the machine file
    double handback_s = 5.0;        ///< the longest way to neutral at the end, a thread not counted
    kernel::machine::Mode mode = kernel::machine::Mode::observe;
    std::uint64_t most_cycles = 0;  ///< 0: until it is told to stop
    double most_s = 0.0;      ///< likewise, by the pace's clock: cycles of a dead link are long
    bool port_paces = false;  ///< read() waits for the next frame
    /// Without a command for longer the machine drops what was written, by the pace's clock; 0: it
    /// stands still with the layer, or tells by its frames.
    double holds_s = 0.0;
    // NOLINTBEGIN(readability-redundant-member-init)
    /// The machine has nothing more to do; empty: never.
    std::function<bool()> finished = {};
    /// For a record, in the cycle: the mode wanted from here on, and each cycle's command.
    std::function<void(kernel::machine::Mode)> on_mode = {};
    std::function<void(const kernel::signal::Command&)> on_command = {};
    /// The held text of the machine file that took over.
    std::function<void(std::uint32_t)> on_reload = {};
    /// A fault begins: the last seconds are worth keeping.
    std::function<void(std::string_view reason)> on_fault = {};
    /// In the cycle: words for a record, of note().
    std::function<void(std::string_view words)> on_note = {};
    /// In the cycle: a wish that reached the layer, and what became of it.
    std::function<void(const supervisor::Wish&, supervisor::WishOutcome)> on_wish = {};
    /// For what is drawn of each cycle; null: nobody draws. Outlives the loop.
    Tap* tap = nullptr;
    // NOLINTEND(readability-redundant-member-init)
  };

  /// Refused: a period out of range.
  [[nodiscard]] static kernel::outcome::Result<void> check(const Config& config);

  Loop(kernel::port::Port& port, supervisor::Supervisor& layer, Pace& pace, Config config);

  /// Until a stop is asked for, `most_cycles` have passed or the machine has finished; hands back
  /// in any case.
  const LoopFigures& run() noexcept;

  void ask_mode(kernel::machine::Mode mode) noexcept { wanted_.store(mode); }
  /// Words for the record, at most LoopNote::kLongest bytes of them; from any thread. False: too
  /// many wait.
  bool note(std::string_view words);
  /// Has the layer grant a wish between two cycles, and waits for what became of it, at most about
  /// twice `patience_s`; from any thread but the loop's. None: the loop did not take it in that
  /// time, and will not.
  [[nodiscard]] std::optional<supervisor::WishOutcome> ask(const supervisor::Wish& wish,
                                                           double patience_s = 1.0) {
    return wishes_.ask(wish, patience_s);
  }
  [[nodiscard]] kernel::machine::Mode mode_wanted() const noexcept { return wanted_.load(); }
  void ask_stop() noexcept { stop_.store(true); }
  /// Takes over before the next cycle: once taken() has risen, the layer before it may go.
  void offer(Successor& next) noexcept { offered_.store(&next); }
  /// False: it takes over, or has done so.
  bool withdraw() noexcept { return offered_.exchange(nullptr) != nullptr; }
  /// How many have taken over.
  [[nodiscard]] std::uint64_t taken() const noexcept { return taken_.load(); }
  [[nodiscard]] bool stop_asked() const noexcept { return stop_.load(); }
  /// Cycles that have ended: whether the loop goes on, for other threads.
  [[nodiscard]] std::uint64_t beats() const noexcept { return beats_.load(); }
  /// The newest; of a loop that has not begun, an empty one. The loop never waits for those who
  /// look, only they for one another.
  [[nodiscard]] LiveStatus status() noexcept {
    const std::scoped_lock lock(looking_);
    return status_.load();
  }
  [[nodiscard]] const LoopFigures& figures() const noexcept { return figures_; }

 private:
  /// Passes everything on and notes when the frame was there.
  class Watched final : public kernel::port::Port {
   public:
    Watched(kernel::port::Port& port, const Pace& pace, double holds_s,
            supervisor::Supervisor* const& layer) noexcept
        : port_(port), pace_(pace), holds_s_(holds_s), layer_(layer) {}
    [[nodiscard]] kernel::port::Capability capability() const noexcept override {
      return port_.capability();
    }
    kernel::outcome::Result<kernel::signal::Frame> read() noexcept override {
      auto frame = port_.read();
      read_s = pace_.now_s();
      age_s = frame ? frame->age_s : 0.0;
      last = frame ? *frame : kernel::signal::Frame();
      if (holds_s_ > 0.0 && layer_->in_force().written && read_s - written_s_ > holds_s_) {
        layer_->was_dropped();
      }
      return frame;
    }
    kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override {
      auto done = port_.write(command);
      written_s_ = pace_.now_s();
      return done;
    }
    double read_s = 0.0;
    double age_s = 0.0;
    kernel::signal::Frame last;  ///< its path lives to the end of the cycle

   private:
    kernel::port::Port& port_;
    const Pace& pace_;
    double holds_s_;
    supervisor::Supervisor* const& layer_;  ///< of the loop: another may take over
    double written_s_ = 0.0;
  };

  void succeed() noexcept;
  void pass_note_on() noexcept;
  void grant_wish() noexcept;
  [[nodiscard]] bool stops(double now_s) const noexcept;
  [[nodiscard]] bool goes_on(double now_s) noexcept;
  void end() noexcept;
  void cycle() noexcept;
  void watch() noexcept;
  void count(const kernel::signal::Command& command) noexcept;
  void publish() noexcept;
  void note_fault(const kernel::outcome::Refusal& refusal) noexcept;

  supervisor::Supervisor* layer_;
  Watched port_;
  Pace& pace_;
  Config config_;
  std::atomic<kernel::machine::Mode> wanted_;
  std::atomic<bool> stop_{false};
  std::atomic<Successor*> offered_{nullptr};
  std::atomic<std::uint64_t> taken_{0};
  std::atomic<std::uint64_t> beats_{0};
  double began_s_ = -1.0;                      ///< the first cycle; not yet
  double stop_asked_s_ = -1.0;                 ///< when the end was first asked for; not yet
  double stopped_s_ = -1.0;                    ///< likewise, or later: a thread was being cut
  std::optional<kernel::machine::Mode> told_;  ///< by on_mode
  std::mutex noting_;
  kernel::rt::Ring<LoopNote, 32> notes_;
  WishBox wishes_;
  std::mutex looking_;
  kernel::rt::Snapshot<LiveStatus> status_;
  LiveStatus now_;
  LoopFigures figures_;
  BlackBox black_box_;
  ChatterWatch chatter_;
};

}  // namespace steadyrest::live
