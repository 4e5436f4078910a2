// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <steadyrest/motion/online/edges/edge_stream.hpp>
#include <steadyrest/motion/online/estimator/refusal.hpp>

namespace steadyrest::motion::online {

kernel::outcome::Result<EdgeStream> EdgeStream::make(const Config& config) {
  if (!(config.count_mm > 0.0 && std::isfinite(config.count_mm))) {
    return std::unexpected(
        refuse_config("count " + std::to_string(config.count_mm) + " mm is not above 0"));
  }
  if (!(config.clock_hz > 0.0 && std::isfinite(config.clock_hz))) {
    return std::unexpected(
        refuse_config("clock " + std::to_string(config.clock_hz) + " Hz is not above 0"));
  }
  const auto fits = [&](double error) { return std::abs(error) <= 100.0 * config.count_mm; };
  if (!std::all_of(config.line_error_mm.begin(), config.line_error_mm.end(), fits)) {
    return std::unexpected(refuse_config(
        "table of line errors has an entry that is not a number or exceeds 100 counts"));
  }
  if (config.periodic && config.line_error_mm.empty()) {
    return std::unexpected(refuse_config("table of line errors is periodic and empty"));
  }
  return EdgeStream(config);
}

double EdgeStream::seconds(std::uint64_t ticks) noexcept {
  if (!started_) {
    started_ = true;
    zero_ticks_ = ticks;
  }
  // The first edge may lie before the first tick.
  return static_cast<double>(static_cast<std::int64_t>(ticks - zero_ticks_)) / config_.clock_hz;
}

double EdgeStream::line_mm(std::int64_t line) const noexcept {
  const double nominal = static_cast<double>(line) * config_.count_mm;
  const auto size = static_cast<std::int64_t>(config_.line_error_mm.size());
  if (size == 0) {
    return nominal;
  }
  std::int64_t i = line - config_.first_line;
  if (config_.periodic) {
    i = ((i % size) + size) % size;
  }
  const bool inside = i >= 0 && i < size;
  return inside ? nominal + config_.line_error_mm[static_cast<std::size_t>(i)] : nominal;
}

std::optional<Edge> EdgeStream::edge(const EdgeEvent& event) noexcept {
  const std::uint8_t unfit =
      config_.take_guesses ? kTimeUnknown : static_cast<std::uint8_t>(kTimeUnknown | kLineGuessed);
  lost_ += event.lost;
  if ((event.uncertain & unfit) != 0) {
    ++lost_;
    return std::nullopt;
  }
  Edge out;
  out.t_s = seconds(event.ticks);
  out.position_mm = line_mm(event.line);
  out.line = event.line;
  out.direction = event.direction;
  // A good edge carries the number of unfit ones before it.
  out.lost = static_cast<std::uint8_t>(std::min<std::uint64_t>(lost_, 255));
  lost_ = 0;
  return out;
}

Tick EdgeStream::tick(std::uint64_t ticks, std::int64_t count) noexcept {
  return {seconds(ticks), count, line_mm(count), line_mm(count + 1)};
}

}  // namespace steadyrest::motion::online
