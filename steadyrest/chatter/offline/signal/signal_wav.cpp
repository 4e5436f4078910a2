// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/signal/signal_parts.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr std::size_t kRiffHead = 12;
constexpr std::size_t kChunkHead = 8;

std::uint64_t little_endian_64(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t out = 0;
  for (std::size_t i = size; i > 0; --i) {
    out = (out << 8U) | static_cast<unsigned char>(bytes[at + i - 1]);
  }
  return out;
}

std::uint32_t little_endian(std::string_view bytes, std::size_t at, std::size_t size) {
  return static_cast<std::uint32_t>(little_endian_64(bytes, at, size));
}

struct WavFormat {
  bool floats = false;
  std::size_t channels = 1;
  std::size_t sample_bytes = 2;
  double rate_hz = 0.0;
};

SignalFault cut_off(std::size_t at, std::size_t wanted, std::size_t held) {
  return {
      0,
      fmt::format("byte {}: {} bytes announced, {} found: the file is truncated", at, wanted, held),
      "copy the recording again, or re-save it in an audio editor"};
}

OrFault<WavFormat> format_of(std::string_view bytes, std::size_t at, std::size_t size) {
  constexpr std::size_t kPlain = 16;
  constexpr std::size_t kExtensible = 40;
  constexpr std::size_t kSubFormat = 24;
  if (size < kPlain) {
    return std::unexpected(SignalFault{
        0, fmt::format("byte {}: the fmt chunk has {} bytes; it must have 16 or more", at, size),
        "re-save the recording as WAV"});
  }
  std::uint32_t tag = little_endian(bytes, at, 2);
  // WAVE_FORMAT_EXTENSIBLE: the tag proper is the start of the sub-format's GUID.
  if (tag == 0xFFFEU && size >= kExtensible) {
    tag = little_endian(bytes, at + kSubFormat, 2);
  }
  const std::uint32_t bits = little_endian(bytes, at + 14, 2);
  WavFormat out;
  out.floats = tag == 3;
  out.channels = little_endian(bytes, at + 2, 2);
  out.sample_bytes = bits / 8;
  out.rate_hz = little_endian(bytes, at + 4, 4);
  const bool pcm = tag == 1 && (bits == 8 || bits == 16 || bits == 24 || bits == 32);
  if (!pcm && !(out.floats && (bits == 32 || bits == 64))) {
    return std::unexpected(
        SignalFault{0, fmt::format("byte {}: format {} of {} bits is not supported", at, tag, bits),
                    "save it as 8, 16, 24 or 32-bit PCM, or as 32 or 64-bit float"});
  }
  if (out.channels == 0 || little_endian(bytes, at + 12, 2) != out.channels * out.sample_bytes) {
    return std::unexpected(
        SignalFault{0,
                    fmt::format("byte {}: {} channels of {} bits do not make {}-byte frames", at,
                                out.channels, bits, little_endian(bytes, at + 12, 2)),
                    "re-save the recording as WAV"});
  }
  if (auto fault = unfit_rate(out.rate_hz)) {
    return std::unexpected(std::move(*fault));
  }
  return out;
}

double sample_at(std::string_view bytes, std::size_t at, const WavFormat& format) {
  if (format.sample_bytes == 8) {
    return std::bit_cast<double>(little_endian_64(bytes, at, 8));
  }
  const std::uint32_t word = little_endian(bytes, at, format.sample_bytes);
  if (format.floats) {
    return static_cast<double>(std::bit_cast<float>(word));
  }
  if (format.sample_bytes == 1) {  // the only one without a sign
    return (static_cast<double>(word) - 128.0) / 128.0;
  }
  const std::size_t shift = 32 - 8 * format.sample_bytes;  // the sign to the top
  return static_cast<double>(static_cast<std::int32_t>(word << shift)) / 2147483648.0;
}

/// Floats may be none: gaps, as in text.
void note_gaps(RecordedSignal& signal) {
  std::size_t gaps = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < signal.value.size(); ++i) {
    if (!std::isfinite(signal.value[i])) {
      first = gaps++ == 0 ? i : first;
      signal.value[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  if (gaps > 0) {
    signal.notes.push_back(fmt::format(
        "channel {}: {} {} not {}, the first is number {} ({:.6g} s); nothing is heard there",
        signal.channel, gaps, gaps == 1 ? "sample is" : "samples are",
        gaps == 1 ? "a number" : "numbers", first + 1,
        static_cast<double>(first) / signal.rate_hz));
  }
}

OrFault<RecordedChannels> samples_of(std::string_view bytes, std::size_t at, std::size_t size,
                                     const WavFormat& format) {
  const std::size_t frame = format.channels * format.sample_bytes;
  if (size % frame != 0 || size < 2 * frame) {
    return std::unexpected(
        SignalFault{0,
                    fmt::format("byte {}: {} bytes of data are not two or more {}-byte frames", at,
                                size, frame),
                    "record again, or re-save it in an audio editor"});
  }
  // Channels apart: a mean over microphones would cancel what they hear in antiphase.
  RecordedChannels out(format.channels);
  const std::size_t samples = size / frame;
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c].channel = c + 1;
    out[c].rate_hz = format.rate_hz;
    out[c].value.resize(samples);
  }
  for (std::size_t i = 0; i < samples; ++i) {
    for (std::size_t c = 0; c < out.size(); ++c) {
      const std::size_t place = at + i * frame + c * format.sample_bytes;
      out[c].value[i] = sample_at(bytes, place, format);
    }
  }
  for (RecordedSignal& signal : out) {
    note_gaps(signal);
  }
  return out;
}

}  // namespace

OrFault<RecordedChannels> parse_wav_signals(std::string_view bytes) {
  if (bytes.size() < kRiffHead) {
    return std::unexpected(cut_off(0, kRiffHead, bytes.size()));
  }
  if (bytes.substr(8, 4) != "WAVE") {
    return std::unexpected(SignalFault{
        0, fmt::format("byte 8: RIFF of kind \"{}\", not WAVE", table::shown(bytes.substr(8, 4))),
        "give a WAV file"});
  }
  // The size in the header excludes the first eight bytes.
  if (const std::size_t riff = little_endian(bytes, 4, 4); riff + 8 > bytes.size()) {
    return std::unexpected(cut_off(4, riff, bytes.size() - 8));
  }
  std::optional<WavFormat> format;
  for (std::size_t at = kRiffHead; at + kChunkHead <= bytes.size();) {
    const std::string_view name = bytes.substr(at, 4);
    const std::size_t size = little_endian(bytes, at + 4, 4);
    const std::size_t body = at + kChunkHead;
    if (size > bytes.size() - body) {
      return std::unexpected(cut_off(at, size, bytes.size() - body));
    }
    if (name == "fmt ") {
      auto found = format_of(bytes, body, size);
      if (!found) {
        return std::unexpected(std::move(found.error()));
      }
      format = *found;
    } else if (name == "data" && format) {
      return samples_of(bytes, body, size, *format);
    }
    // RIFF pads chunks to even lengths and does not count the padding.
    at = body + size + size % 2;
  }
  return std::unexpected(
      SignalFault{0, format ? "has no data chunk" : "has no fmt chunk before the data",
                  "re-save the recording as WAV"});
}

}  // namespace steadyrest::chatter::offline
