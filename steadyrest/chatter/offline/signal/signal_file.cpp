// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/response/uff_lines.hpp>
#include <steadyrest/chatter/offline/signal/signal_parts.hpp>
#include <steadyrest/chatter/offline/signal/signal_rate.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

constexpr std::size_t kMaxBytes = 256U << 20U;
constexpr double kRateSlack = 1e-6;  // stamps are rounded

OrFault<std::string> bytes_of(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return std::unexpected(SignalFault{0, "is a folder", "give a recording as CSV, WAV or UFF"});
  }
  std::ifstream in(path, std::ios::binary);
  std::string out;
  constexpr std::size_t kChunk = 1U << 16U;
  while (in && out.size() <= kMaxBytes) {
    const std::size_t before = out.size();
    out.resize(before + kChunk);
    in.read(out.data() + before, static_cast<std::streamsize>(kChunk));
    out.resize(before + static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad() || (!in.eof() && out.size() <= kMaxBytes)) {
    return std::unexpected(
        SignalFault{0, "cannot be read", "give the path of a recording as CSV, WAV or UFF"});
  }
  return out;
}

Refusal refusal_of(SignalFault fault, const std::string& file) {
  return bad_input(file, fault.line, std::move(fault.what), std::move(fault.to_do));
}

bool named_wav(const std::string& file) {
  std::string end = std::filesystem::path(file).extension().string();
  std::ranges::transform(end, end.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  });
  return end == ".wav";
}

OrFault<RecordedChannels> parse(std::string_view bytes, const std::string& file,
                                const table::Format& format) {
  if (bytes.size() > kMaxBytes) {
    return std::unexpected(SignalFault{0, fmt::format("larger than {} MB", kMaxBytes >> 20U),
                                       "cut out the minutes that matter"});
  }
  if (bytes.starts_with("RIFF")) {
    return parse_wav_signals(bytes);
  }
  if (named_wav(file)) {
    return std::unexpected(SignalFault{
        0, "is not RIFF: its first bytes are \"" + table::shown(bytes.substr(0, 4)) + "\"",
        "save the recording as WAV (RIFF, PCM)"});
  }
  if (is_universal(bytes)) {
    return parse_uff_signals(bytes);
  }
  if (bytes.find('\0') != std::string_view::npos) {
    return std::unexpected(SignalFault{0, "is neither text nor RIFF",
                                       "give CSV in UTF-8, WAV (RIFF, PCM) or UFF (dataset 58)"});
  }
  return parse_csv_signals(bytes, format);
}

/// The rate that the file has and another that was given: one of them is wrong.
std::optional<SignalFault> contradicts(const RecordedSignal& signal, const table::Format& format) {
  constexpr double kSameRate = 0.01;
  if (!format.rows_are_samples ||
      std::abs(signal.rate_hz - format.sample_hz) <= kSameRate * signal.rate_hz) {
    return std::nullopt;
  }
  return SignalFault{0,
                     fmt::format("has {:.6g} samples a second by itself, {:.6g} are given",
                                 signal.rate_hz, format.sample_hz),
                     "leave out --rate-hz or --sample-hz"};
}

}  // namespace

FiniteRange finite_range(const std::vector<double>& values) noexcept {
  FiniteRange out;
  for (const double value : values) {
    if (std::isfinite(value)) {
      out.least = std::min(out.least, value);
      out.most = std::max(out.most, value);
    }
  }
  return out;
}

std::optional<SignalFault> unfit_rate(double rate_hz) {
  if (rate_hz >= kLeastRateHz * (1.0 - kRateSlack) && rate_hz <= kMostRateHz * (1.0 + kRateSlack)) {
    return std::nullopt;
  }
  return SignalFault{0, fmt::format("{:.6g} samples a second; allowed: 1000 … 1000000", rate_hz),
                     rate_hz > kMostRateHz ? "record at 1 MHz or less; 50 kHz is ample"
                                           : "record at 1 kHz or more"};
}

Result<RecordedChannels> parse_signals(std::string_view bytes, const std::string& file,
                                       const table::Format& format) {
  auto out = parse(bytes, file, format);
  if (!out) {
    return std::unexpected(refusal_of(std::move(out.error()), file));
  }
  if (auto fault = contradicts(out->front(), format)) {
    return std::unexpected(refusal_of(std::move(*fault), file));
  }
  for (RecordedSignal& signal : *out) {
    reduce_rate(signal);
  }
  return std::move(*out);
}

Result<RecordedChannels> read_signals(const std::string& path, const table::Format& format) {
  auto bytes = bytes_of(path);
  if (!bytes) {
    return std::unexpected(refusal_of(std::move(bytes.error()), path));
  }
  return parse_signals(*bytes, path, format);
}

std::optional<Refusal> no_signal(const RecordedSignal& signal, const std::string& file) {
  constexpr double kLargest = 1e100;
  constexpr double kSmallest = 1e-100;
  const auto [least, most] = finite_range(signal.value);
  if (!(least <= most)) {
    return bad_input(file, "value is not a number in any sample: no signal",
                     "check the column, and the sensor's cable");
  }
  if (least == most) {
    return bad_input(file, fmt::format("value is {:.6g} in every sample: no signal", least),
                     "check the sensor, its supply and the channel that was recorded");
  }
  if (std::max(-least, most) > kLargest || most - least < kSmallest) {
    return bad_input(file,
                     fmt::format("value lies within {:.6g} … {:.6g}; it may reach {:g} and must "
                                 "change by {:g} or more",
                                 least, most, kLargest, kSmallest),
                     "check the column and its unit; a sensor gives some 1e-6 … 1e6");
  }
  return std::nullopt;
}

}  // namespace steadyrest::chatter::offline
