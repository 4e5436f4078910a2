// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/counter.h>
#include <unistd.h>

#include <steadyrest/adapters/lines/encoders/counter_encoders.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::Recorder;
using kernel::outcome::Result;
using kernel::outcome::unavailable;

constexpr const char* kSeeFolder =
    "see /sys/bus/counter/devices for the counters of this machine and their counts";

constexpr std::uint64_t kLeastRange = 256;  ///< counts, of a counter that follows an axis

std::optional<std::uint64_t> number_of(std::string_view text) noexcept {
  std::uint64_t value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || end == text.data()) {
    return std::nullopt;
  }
  return value;
}

/// The first line of a file; empty: there is none.
std::string line_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// From one value to the next, the shorter way round.
std::int64_t moved_by(std::uint64_t from, std::uint64_t to, std::uint64_t range) noexcept {
  if (range == 0) {
    return static_cast<std::int64_t>(to - from);
  }
  const std::uint64_t up = to >= from ? to - from : range - (from - to);
  return up <= range / 2 ? static_cast<std::int64_t>(up) : -static_cast<std::int64_t>(range - up);
}

std::int8_t sign_of(std::int64_t value) noexcept {
  return static_cast<std::int8_t>((value > 0 ? 1 : 0) - (value < 0 ? 1 : 0));
}

Result<void> check_settings(const std::filesystem::path& folder) {
  const std::string way = line_in(folder / "function");
  if (way == "increase" || way == "decrease") {
    return unavailable(
        fmt::format("{} counts one way only: its function is \"{}\"", folder.string(), way),
        "set the function to \"quadrature x4\"");
  }
  if (line_in(folder / "enable") == "0") {
    return unavailable(fmt::format("{} is switched off", folder.string()),
                       "write 1 to its file enable");
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<CounterEncoders>> CounterEncoders::open(const Recorder& recorder,
                                                               const DeviceCalls& calls) {
  std::unique_ptr<CounterEncoders> made(new CounterEncoders);
  for (std::size_t i = 0; i + 1 < recorder.inputs.size(); i += 2) {
    if (auto added = made->add(recorder.inputs[i], recorder.inputs[i + 1], calls); !added) {
      return std::unexpected(std::move(added.error()));
    }
  }
  made->watch(calls);
  made->now_.counters = made->counts_.size();
  made->start_ns_ = edge_clock_ns();
  return made;
}

Result<void> CounterEncoders::add(std::uint32_t counter, std::uint32_t number,
                                  const DeviceCalls& calls) {
  Count count;
  count.counter = counter;
  count.number = number;
  count.folder =
      calls.counters / fmt::format("counter{}", counter) / fmt::format("count{}", number);
  count.value = Descriptor(::open((count.folder / "count").c_str(), O_RDONLY | O_CLOEXEC));
  if (!count.value.is_open()) {
    return unavailable(fmt::format("the count {} cannot be opened: {}", count.folder.string(),
                                   std::strerror(errno)),
                       kSeeFolder);
  }
  if (auto fits = check_settings(count.folder); !fits) {
    return fits;
  }
  // The largest value; without it the counter is as wide as its figure.
  const auto ceiling = number_of(line_in(count.folder / "ceiling"));
  count.range = ceiling && *ceiling < std::numeric_limits<std::uint64_t>::max() ? *ceiling + 1 : 0;
  if (count.range > 0 && count.range < kLeastRange) {
    return unavailable(
        fmt::format("{} counts up to {} only", count.folder.string(), *ceiling),
        "write its largest value to its file ceiling: some counters begin with 0 there");
  }
  auto value = value_of(count);
  if (!value) {
    return std::unexpected(std::move(value.error()));
  }
  count.last = *value;
  count.edge_value = *value;
  counts_.push_back(std::move(count));
  return {};
}

/// Asks each counter to tell of every change. A driver that cannot refuses; then edges have no
/// time.
void CounterEncoders::watch(const DeviceCalls& calls) {
  for (const Count& count : counts_) {
    Descriptor& events = events_[count.counter];
    if (!events.is_open()) {
      const auto device = calls.devices / fmt::format("counter{}", count.counter);
      events = Descriptor(::open(device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
    }
    counter_watch change{.component = {.type = COUNTER_COMPONENT_COUNT,
                                       .scope = COUNTER_SCOPE_COUNT,
                                       .parent = static_cast<__u8>(count.number),
                                       .id = 0},
                         .event = COUNTER_EVENT_CHANGE_OF_STATE,
                         .channel = static_cast<__u8>(count.number)};
    if (events.is_open()) {
      calls.control(events.get(), COUNTER_ADD_WATCH_IOCTL, &change);
    }
  }
  std::erase_if(events_, [&](const auto& entry) {
    return !entry.second.is_open() ||
           calls.control(entry.second.get(), COUNTER_ENABLE_EVENTS_IOCTL, nullptr) != 0;
  });
}

Result<std::uint64_t> CounterEncoders::value_of(const Count& count) {
  std::array<char, 32> text{};
  const ssize_t size = ::pread(count.value.get(), text.data(), text.size(), 0);
  const auto value =
      size > 0 ? number_of({text.data(), static_cast<std::size_t>(size)}) : std::nullopt;
  if (!value) {
    return unavailable(fmt::format("the count {} cannot be read", count.folder.string()),
                       kSeeFolder);
  }
  return *value;
}

void CounterEncoders::take_events(std::uint32_t counter, const Descriptor& events) noexcept {
  std::array<counter_event, 64> event{};
  for (int reads = 0; reads < kMostReads; ++reads) {
    const ssize_t bytes = ::read(events.get(), event.data(), sizeof(event));
    if (bytes < static_cast<ssize_t>(sizeof(counter_event))) {
      return;
    }
    const std::size_t filled = static_cast<std::size_t>(bytes) / sizeof(counter_event);
    for (std::size_t i = 0; i < filled; ++i) {
      const auto of = std::ranges::find_if(counts_, [&](const Count& count) {
        return count.counter == counter && count.number == event.at(i).watch.component.parent;
      });
      if (of != counts_.end() && event.at(i).status == 0) {
        of->edge_step = sign_of(moved_by(of->edge_value, event.at(i).value, of->range));
        of->edge_value = event.at(i).value;
        of->edge_ns = event.at(i).timestamp;
      }
    }
  }
}

/// Counts first, then events: an edge has a time only while the event's value is the count's. A
/// full queue drops its newest events, and an edge between both is later than the reading.
Result<EncoderReading> CounterEncoders::next() {
  if (!fault_.what.empty()) {
    return std::unexpected(fault_);
  }
  const std::uint64_t now_ns = edge_clock_ns();
  std::array<std::uint64_t, kMostCounters> value{};
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    auto read = value_of(counts_[i]);
    if (!read) {
      return std::unexpected(std::move(read.error()));
    }
    value.at(i) = *read;
  }
  for (const auto& [counter, events] : events_) {
    take_events(counter, events);
  }
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    Count& count = counts_[i];
    const std::int64_t moved = moved_by(count.last, value.at(i), count.range);
    const std::uint64_t most = (count.range == 0 ? 1ULL << 32U : count.range) / 4;
    if (static_cast<std::uint64_t>(std::llabs(moved)) > most) {
      fault_ = unavailable(fmt::format("the count {} jumped from {} to {}: it was set by another "
                                       "program, or it wraps faster than the layer reads",
                                       count.folder.string(), count.last, value.at(i)),
                           kReference)
                   .error();
      return std::unexpected(fault_);
    }
    if (moved != 0) {
      now_.count.at(i) += moved;
      now_.direction.at(i) = sign_of(moved);
      now_.edge_s.at(i) = std::numeric_limits<double>::quiet_NaN();
    }
    if (count.edge_ns > start_ns_ && count.edge_ns <= now_ns && count.edge_value == value.at(i)) {
      now_.edge_s.at(i) = 1e-9 * static_cast<double>(count.edge_ns - start_ns_);
      now_.direction.at(i) = count.edge_step;
    }
    count.last = value.at(i);
  }
  now_.time_s = 1e-9 * static_cast<double>(now_ns - start_ns_);
  return now_;
}

}  // namespace steadyrest::adapters::lines
