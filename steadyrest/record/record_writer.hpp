// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/command.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/record/sample.hpp>

namespace steadyrest::record {

/// Records a live run, each cycle exactly, without holding up the cycle.
///
/// add() and event() belong to the control cycle: one thread, bounded, no allocation, no lock, no
/// I/O. They put plain values into rings; a thread of the writer's own empties these and writes a
/// transaction each `commit_s`. What finds a ring full is lost and counted. When the disk fails the
/// record ends with a reason, and the run goes on without it.
/// A path is copied as it is used, `kSegmentsPerCycle` in each cycle: it needs to live only as long
/// as its frame. It counts as the same path while its address and its length are the same.
class RecordWriter {
 public:
  static constexpr std::size_t kRing = 4096;  ///< samples: 4 s at 1 kHz
  static constexpr std::size_t kSegmentsPerCycle = 32;
  static constexpr std::size_t kEventText = 240;  ///< bytes; longer texts are cut

  struct Config {
    std::string file;
    // Designated initialisers may leave it out.
    // NOLINTNEXTLINE(readability-redundant-member-init)
    RunInfo info = {};
    double commit_s = 1.0;  ///< [0.1, 3600]: what a power cut may cost
    double drain_s = 0.1;   ///< [0.001, 3600]: how often the rings are emptied
    /// Limit of the file's folder, checked at the start of a run and every minute: older runs are
    /// removed first. 0: none.
    std::uint64_t max_bytes = 0;
    double keep_last_s = 30.0;  ///< [1, 3600]: what keep() copies
    /// Told once, of the writer's thread, when the record ends before its run; empty: nobody.
    // NOLINTNEXTLINE(readability-redundant-member-init)
    std::function<void(const kernel::outcome::Refusal&)> on_fault = {};
  };

  /// Makes the file. Refuses one that exists, and a folder that cannot be written.
  static kernel::outcome::Result<std::unique_ptr<RecordWriter>> make(const Config& config);
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;
  /// Writes what is left.
  ~RecordWriter();

  /// In the cycle.
  void add(const kernel::signal::Frame& frame, const kernel::signal::Command& command) noexcept;
  /// In the cycle, from the same thread: what happens before the next sample.
  void event(EventKind kind, std::string_view text) noexcept;
  /// Not in the cycle: keeps a text of any length for event(); returns its number.
  [[nodiscard]] std::uint32_t hold(std::string text);
  /// In the cycle: an event with a held text.
  void event(EventKind kind, std::uint32_t held) noexcept;
  /// In the cycle, after a fault: notes the reason, and the writer's thread soon copies the last
  /// `keep_last_s` into `fault-<time>.sqlite` beside the record, which no rotation removes. Several
  /// calls before that make one copy.
  void keep(std::string_view reason) noexcept;
  /// Samples and events lost so far.
  [[nodiscard]] std::uint64_t dropped() const noexcept;
  /// The record has ended before its run; fault() says why.
  [[nodiscard]] bool failed() const noexcept;

  /// Not in the cycle: waits until everything so far is on the disk, or the record has failed.
  void flush();
  /// Not in the cycle: why the record ended.
  [[nodiscard]] std::optional<kernel::outcome::Refusal> fault() const;

 private:
  struct Cycle;
  class Thread;

  RecordWriter();

  std::unique_ptr<Cycle> cycle_;
  std::unique_ptr<Thread> thread_;
};

}  // namespace steadyrest::record
