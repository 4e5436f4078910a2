// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/rt/ring.hpp>
#include <steadyrest/record/chunk_store.hpp>
#include <steadyrest/record/keep_last.hpp>
#include <steadyrest/record/record_writer.hpp>
#include <steadyrest/record/run_folder.hpp>

namespace steadyrest::record {
namespace {

using kernel::outcome::Refusal;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::signal::Command;
using kernel::signal::Frame;
using kernel::signal::PathView;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kEventRing = 256;
constexpr std::size_t kMostInChunk = 4096;
constexpr auto kRotateEvery = std::chrono::minutes(1);

struct RawEvent {
  std::uint64_t before = 0;
  double time_s = 0.0;
  EventKind kind = EventKind::note;
  bool has_held = false;   ///< the text is a held one
  std::uint32_t held = 0;  ///< its number
  std::uint8_t length = 0;
  std::array<char, RecordWriter::kEventText> text{};
};

}  // namespace

/// What the control cycle touches.
struct RecordWriter::Cycle {
  kernel::rt::Ring<Sample, kRing> samples;
  kernel::rt::Ring<PathPiece, 1024> pieces;
  kernel::rt::Ring<RawEvent, kEventRing> events;
  std::atomic<std::uint64_t> dropped{0};
  std::atomic<bool> failed{false};
  std::atomic<bool> keep{false};

  Sample next;
  std::uint64_t number = 0;
  double time_s = 0.0;
  /// A path on its way into the file.
  struct Sending {
    PathView path;  ///< compared, never read after its frame
    PathPiece piece;
    std::uint64_t sent = 0;  ///< its segments
  };
  Sending path;
  Sending original;
  std::uint32_t paths = 0;

  /// Sends on as many segments as `left` has, and takes them off it.
  void send(PathView view, Sending& into, std::size_t& left) noexcept;

  void drop() noexcept { dropped.fetch_add(1, std::memory_order_relaxed); }
  void put(const RawEvent& raw) noexcept {
    if (failed.load(std::memory_order_relaxed) || !events.try_push(raw)) {
      drop();
    }
  }
};

/// The writer's thread: from the rings to the file.
class RecordWriter::Thread {
 public:
  Thread(Config config, Cycle& cycle, std::unique_ptr<ChunkStore> store)
      : config_(std::move(config)),
        cycle_(cycle),
        store_(std::move(store)),
        thread_([this] { work(); }) {}
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;
  ~Thread() {
    {
      const std::scoped_lock lock(mutex_);
      stop_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }

  void flush() {
    std::unique_lock lock(mutex_);
    const std::uint64_t wanted = ++flushes_wanted_;
    wake_.notify_all();
    flushed_.wait(lock, [&] { return flushes_done_ >= wanted; });
  }

  [[nodiscard]] std::optional<Refusal> fault() const {
    const std::scoped_lock lock(mutex_);
    return fault_;
  }

  std::uint32_t hold(std::string text) {
    const std::scoped_lock lock(mutex_);
    if (held_.empty() || held_.back() != text) {
      held_.push_back(std::move(text));
    }
    return static_cast<std::uint32_t>(held_.size() - 1);
  }

 private:
  void work() {
    auto committed = Clock::now();
    auto rotated = committed;
    for (bool stop = false; !stop;) {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, std::chrono::duration<double>(config_.drain_s),
                     [&] { return stop_ || flushes_wanted_ > flushes_done_; });
      const std::uint64_t flushes = flushes_wanted_;
      const bool keeps = cycle_.keep.exchange(false);
      const bool asked = stop_ || keeps || flushes > flushes_done_;
      stop = stop_;
      lock.unlock();
      drain();
      const auto now = Clock::now();
      if (cycle_.failed) {
        // Nothing more can be written; the rings are still emptied.
      } else if (stop) {
        keep(store_->close(cycle_.dropped.load()));
      } else if (asked || now - committed >= std::chrono::duration<double>(config_.commit_s)) {
        keep(store_->commit(cycle_.dropped.load()));
        committed = now;
      }
      if (keeps && !cycle_.failed) {
        keep_copy();
      }
      if (config_.max_bytes > 0 && now - rotated >= kRotateEvery) {
        rotate(config_.file, config_.max_bytes);
        rotated = now;
      }
      lock.lock();
      flushes_done_ = flushes;
      flushed_.notify_all();
    }
  }

  /// A copy that fails costs the run's own record nothing.
  void keep_copy() {
    const std::string utc = utc_now();
    const auto folder = std::filesystem::path(config_.file).parent_path();
    auto file = folder / fault_name(utc);
    std::error_code fault;
    for (int again = 2; std::filesystem::exists(file, fault); ++again) {
      file = folder / fault_name(utc, again);
    }
    if (auto kept = keep_last(config_.file, file.string(), config_.keep_last_s); !kept) {
      store_->add({.time_s = 0.0,
                   .kind = EventKind::note,
                   .text = "not kept: " + kernel::outcome::text(kept.error())});
    }
  }

  // Bounded by what one pass may find: a producer as fast as this thread must not keep it here.
  void drain() {
    for (std::size_t i = 0; i < kRing; ++i) {
      auto sample = cycle_.samples.try_pop();
      if (!sample) {
        break;
      }
      if (cycle_.failed) {
        cycle_.drop();
      } else {
        store_->add(*sample);
      }
      if (!cycle_.failed && store_->waiting() >= kMostInChunk) {
        keep(store_->commit(cycle_.dropped.load()));
      }
    }
    for (std::size_t i = 0; i < decltype(Cycle::pieces)::capacity(); ++i) {
      auto piece = cycle_.pieces.try_pop();
      if (!piece) {
        break;
      }
      if (!cycle_.failed) {
        store_->add(*piece);
      }
    }
    for (std::size_t i = 0; i < kEventRing; ++i) {
      auto raw = cycle_.events.try_pop();
      if (!raw) {
        break;
      }
      if (!cycle_.failed) {
        store_->add({raw->before, raw->time_s, raw->kind, text_of(*raw)});
      }
    }
  }

  std::string text_of(const RawEvent& raw) {
    if (!raw.has_held) {
      return {raw.text.data(), raw.length};
    }
    const std::scoped_lock lock(mutex_);
    return raw.held < held_.size() ? held_[raw.held] : std::string();
  }

  /// The first failure ends the record.
  void keep(Result<void> written) {
    if (written || cycle_.failed) {
      return;
    }
    const Refusal fault = std::move(written.error());
    {
      const std::scoped_lock lock(mutex_);
      fault_ = fault;
      cycle_.dropped.fetch_add(store_->lost());
      cycle_.failed = true;
    }
    if (config_.on_fault) {
      config_.on_fault(fault);
    }
  }

  const Config config_;
  Cycle& cycle_;
  std::unique_ptr<ChunkStore> store_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable flushed_;
  std::optional<Refusal> fault_;
  std::vector<std::string> held_;
  std::uint64_t flushes_wanted_ = 0;
  std::uint64_t flushes_done_ = 0;
  bool stop_ = false;
  std::thread thread_;  ///< last: it uses all the others
};

Result<std::unique_ptr<RecordWriter>> RecordWriter::make(const Config& config) {
  if (!(config.commit_s >= 0.1 && config.commit_s <= 3600.0) ||
      !(config.drain_s >= 0.001 && config.drain_s <= 3600.0) ||
      !(config.keep_last_s >= 1.0 && config.keep_last_s <= 3600.0)) {
    return refuse("commit_s, drain_s or keep_last_s is out of range",
                  "give commit_s from 0.1 to 3600, drain_s from 0.001 to 3600 and keep_last_s from "
                  "1 to 3600");
  }
  Config whole = config;
  whole.info.version = STEADYREST_VERSION;
  if (whole.info.start_utc.empty()) {
    whole.info.start_utc = utc_now();
  }
  auto store = ChunkStore::create(config.file, whole.info);
  if (!store) {
    return std::unexpected(std::move(store.error()));
  }
  if (config.max_bytes > 0) {
    rotate(config.file, config.max_bytes);
  }
  std::unique_ptr<RecordWriter> writer(new RecordWriter);
  writer->thread_ = std::make_unique<Thread>(whole, *writer->cycle_, std::move(*store));
  return writer;
}

RecordWriter::RecordWriter() : cycle_(std::make_unique<Cycle>()) {}

RecordWriter::~RecordWriter() = default;

void RecordWriter::Cycle::send(PathView view, Sending& into, std::size_t& left) noexcept {
  if (view.data() != into.path.data() || view.size() != into.path.size()) {
    into.path = view;
    into.sent = 0;
    paths += view.empty() ? 0 : 1;
    into.piece.path = view.empty() ? 0 : paths;
    into.piece.segments = view.size();
  }
  for (; left > 0 && into.sent < view.size(); --left) {
    into.piece.index = into.sent;
    into.piece.segment = view[into.sent];
    if (!pieces.try_push(into.piece)) {
      return;  // the next cycle goes on from here
    }
    ++into.sent;
  }
}

void RecordWriter::add(const Frame& frame, const Command& command) noexcept {
  Cycle& cycle = *cycle_;
  std::size_t left = kSegmentsPerCycle;
  cycle.send(frame.path, cycle.path, left);
  cycle.send(frame.original, cycle.original, left);
  Sample& next = cycle.next;
  next.number = cycle.number++;
  cycle.time_s = frame.time_s;
  if (cycle.failed.load(std::memory_order_relaxed) || frame.vibration.size() > kMaxVibration) {
    cycle.drop();
    return;
  }
  next.frame = frame;
  next.frame.path = {};
  next.frame.original = {};
  next.frame.vibration = {};
  next.command = command;
  next.path = cycle.path.piece.path;
  next.original = cycle.original.piece.path;
  next.vibrations = static_cast<std::uint32_t>(frame.vibration.size());
  std::ranges::copy(frame.vibration, next.vibration.begin());
  if (!cycle.samples.try_push(next)) {
    cycle.drop();
  }
}

void RecordWriter::event(EventKind kind, std::string_view text) noexcept {
  RawEvent raw{.before = cycle_->number, .time_s = cycle_->time_s, .kind = kind};
  raw.length = static_cast<std::uint8_t>(std::min(text.size(), kEventText));
  std::copy_n(text.begin(), raw.length, raw.text.begin());
  cycle_->put(raw);
}

void RecordWriter::event(EventKind kind, std::uint32_t held) noexcept {
  RawEvent raw{.before = cycle_->number, .time_s = cycle_->time_s, .kind = kind};
  raw.has_held = true;
  raw.held = held;
  cycle_->put(raw);
}

std::uint32_t RecordWriter::hold(std::string text) {
  return thread_->hold(std::move(text));
}

// The note first: the thread that sees the flag finds it in the ring.
void RecordWriter::keep(std::string_view reason) noexcept {
  event(EventKind::note, reason);
  cycle_->keep.store(true);
}

std::uint64_t RecordWriter::dropped() const noexcept {
  return cycle_->dropped.load(std::memory_order_relaxed);
}

bool RecordWriter::failed() const noexcept {
  return cycle_->failed.load(std::memory_order_relaxed);
}

void RecordWriter::flush() {
  thread_->flush();
}

std::optional<Refusal> RecordWriter::fault() const {
  return thread_->fault();
}

}  // namespace steadyrest::record
