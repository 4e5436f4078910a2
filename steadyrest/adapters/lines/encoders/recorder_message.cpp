// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/adapters/lines/encoders/recorder_message.hpp>

// A message is stuffed so that a zero byte only ever ends one (consistent overhead byte stuffing,
// Cheshire and Baker 1999): whatever was lost, the next message is found.
namespace steadyrest::adapters::lines {
namespace {

constexpr std::uint8_t kSample = 'S';
constexpr std::size_t kHead = 12;    ///< kind, counters, sequence, clock's rate, ticks
constexpr std::size_t kCounter = 9;  ///< count, edge, flags
constexpr std::size_t kCheck = 2;
constexpr std::uint8_t kUp = 1;
constexpr std::uint8_t kDown = 2;
constexpr std::uint8_t kLost = 4;
constexpr std::size_t kLongestRun = 254;

using Bytes = std::span<const std::uint8_t>;

std::uint32_t word32(Bytes bytes, std::size_t at) noexcept {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8U |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16U |
         static_cast<std::uint32_t>(bytes[at + 3]) << 24U;
}

std::uint16_t word16(Bytes bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8U);
}

void put(std::uint32_t value, std::size_t bytes, std::vector<std::uint8_t>& out) {
  for (std::size_t i = 0; i < bytes; ++i) {
    out.push_back(static_cast<std::uint8_t>(value >> (8U * i) & 0xFFU));
  }
}

/// Undone in place; 0: it is no stuffed message.
std::size_t unstuffed(std::span<std::uint8_t> bytes) noexcept {
  std::size_t from = 0;
  std::size_t to = 0;
  while (from < bytes.size()) {
    const std::size_t run = bytes[from];
    if (run == 0 || from + run > bytes.size()) {
      return 0;
    }
    for (std::size_t i = 1; i < run; ++i) {
      bytes[to++] = bytes[from + i];
    }
    from += run;
    if (run <= kLongestRun && from < bytes.size()) {
      bytes[to++] = 0;
    }
  }
  return to;
}

std::vector<std::uint8_t> stuffed(Bytes bytes) {
  std::vector<std::uint8_t> out;
  std::size_t head = 0;
  out.push_back(1);
  for (const std::uint8_t byte : bytes) {
    if (byte == 0) {
      head = out.size();
      out.push_back(1);
      continue;
    }
    out.push_back(byte);
    ++out[head];
  }
  out.push_back(0);
  return out;
}

}  // namespace

std::uint16_t crc16(Bytes bytes) noexcept {
  std::uint32_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= static_cast<std::uint32_t>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc << 1U) ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U);
    }
    crc &= 0xFFFFU;
  }
  return static_cast<std::uint16_t>(crc);
}

bool RecorderParser::feed(Bytes bytes, RecorderSample& newest) noexcept {
  bool got = false;
  for (const std::uint8_t byte : bytes) {
    if (byte != 0) {
      too_long_ = too_long_ || size_ == message_.size();
      if (!too_long_) {
        message_[size_++] = byte;
      }
      continue;
    }
    RecorderSample sample;
    if (too_long_ || (size_ > 0 && !take(sample))) {
      ++counts_.broken;
    } else if (size_ > 0) {
      counts_.missing += started_ ? static_cast<std::uint16_t>(sample.sequence - sequence_ - 1) : 0;
      started_ = true;
      sequence_ = sample.sequence;
      ++counts_.samples;
      for (std::size_t i = 0; i < kMostCounters; ++i) {
        CounterSample& counter = sample.counter.at(i);
        counter.lost = counter.lost || newest.counter.at(i).lost;
      }
      newest = sample;
      got = true;
    }
    size_ = 0;
    too_long_ = false;
  }
  return got;
}

bool RecorderParser::take(RecorderSample& sample) noexcept {
  const std::size_t size = unstuffed({message_.data(), size_});
  const Bytes bytes(message_.data(), size);
  if (size < kHead + kCheck || bytes[0] != kSample) {
    return false;
  }
  sample.counters = bytes[1];
  if (sample.counters > kMostCounters || size != kHead + kCounter * sample.counters + kCheck ||
      crc16(bytes.first(size - kCheck)) != word16(bytes, size - kCheck)) {
    return false;
  }
  sample.sequence = word16(bytes, 2);
  sample.clock_hz = word32(bytes, 4);
  sample.ticks = word32(bytes, 8);
  for (std::size_t i = 0; i < sample.counters; ++i) {
    const std::size_t at = kHead + kCounter * i;
    const std::uint8_t flags = bytes[at + 8];
    sample.counter.at(i) = {.count = static_cast<std::int32_t>(word32(bytes, at)),
                            .edge_ticks = word32(bytes, at + 4),
                            .direction = static_cast<std::int8_t>((flags & kUp) != 0     ? 1
                                                                  : (flags & kDown) != 0 ? -1
                                                                                         : 0),
                            .lost = (flags & kLost) != 0};
  }
  return sample.clock_hz > 0;
}

std::vector<std::uint8_t> message_of(const RecorderSample& sample) {
  std::vector<std::uint8_t> bytes = {kSample, sample.counters};
  put(sample.sequence, 2, bytes);
  put(sample.clock_hz, 4, bytes);
  put(sample.ticks, 4, bytes);
  for (std::size_t i = 0; i < sample.counters; ++i) {
    const CounterSample& counter = sample.counter.at(i);
    put(static_cast<std::uint32_t>(counter.count), 4, bytes);
    put(counter.edge_ticks, 4, bytes);
    const unsigned way = counter.direction > 0 ? kUp : counter.direction < 0 ? kDown : 0U;
    bytes.push_back(static_cast<std::uint8_t>(way | (counter.lost ? kLost : 0U)));
  }
  put(crc16(bytes), kCheck, bytes);
  return stuffed(bytes);
}

}  // namespace steadyrest::adapters::lines
