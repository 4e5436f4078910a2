// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/response/uff_function.hpp>
#include <steadyrest/chatter/offline/signal/signal_names.hpp>
#include <steadyrest/chatter/offline/signal/signal_parts.hpp>
#include <steadyrest/chatter/offline/signal/signal_times.hpp>

// Each time response is a channel. The first ID line names it where the lines of all records
// differ; else the point and direction of the response do.
namespace steadyrest::chatter::offline {
namespace {

constexpr int kUffTimeAxis = 17;

std::string title_of(const UffFunction& function) {
  const std::string low = table::lower(function.title);
  return low == "none" ? std::string() : shown_name(function.title);
}

bool titles_differ(const std::vector<UffFunction>& records) {
  std::vector<std::string> titles;
  titles.reserve(records.size());
  for (const UffFunction& record : records) {
    titles.push_back(table::lower(title_of(record)));
  }
  std::ranges::sort(titles);
  return std::ranges::adjacent_find(titles) == titles.end() && !titles.front().empty();
}

/// Keeps the time responses; the note names the others.
std::optional<std::string> skip_others(std::vector<UffFunction>& functions) {
  std::map<int, std::size_t> others;
  for (const UffFunction& function : functions) {
    others[function.type] += 1;
  }
  others.erase(kUffTimeResponse);
  std::erase_if(functions, [](const UffFunction& f) { return f.type != kUffTimeResponse; });
  std::string note;
  for (const auto& [type, count] : others) {
    note += fmt::format("{}{} of function type {} ({})", note.empty() ? "" : ", ", count, type,
                        uff_type_name(type));
  }
  return note.empty() ? std::nullopt : std::optional(note + " skipped");
}

OrFault<RecordedSignal> channel_of_record(const UffFunction& record, bool by_title) {
  const UffAxis& axis = record.abscissa;
  const auto unit = axis.unit.empty() ? std::optional<std::string_view>("s") : time_unit(axis.unit);
  if (!unit || (axis.kind != kUffTimeAxis && axis.kind != 0)) {
    return std::unexpected(
        SignalFault{axis.line,
                    fmt::format("the abscissa is of type {} in \"{}\"; a time is of type 17 in s "
                                "or ms",
                                axis.kind, table::shown(axis.unit)),
                    "export the recording over time"});
  }
  if (record.complex()) {
    return std::unexpected(SignalFault{
        record.line + 1,
        fmt::format("ordinate data type {}; real is 2 (single) or 4 (double)", record.number_type),
        "export the recording as real numbers"});
  }
  const double s = *unit == "s" ? 1.0 : *unit == "ms" ? 1e-3 : *unit == "us" ? 1e-6 : 0.0;
  std::vector<double> time_s;
  RecordedSignal out;
  for (std::size_t i = 0; i < record.at.size(); ++i) {
    time_s.push_back(s * record.at[i]);
    out.value.push_back(record.value[i].real());
  }
  const std::vector<std::size_t> lines(time_s.size(), record.end);
  const auto times = even_times(time_s, lines, "the abscissa");
  if (!times) {
    return std::unexpected(times.error());
  }
  spread(*times, out.value);
  out.rate_hz = times->rate_hz;
  out.start_s = times->start_s;
  out.notes = times->notes;
  const bool point = record.points_read && record.response.stated();
  out.written = point ? uff_point_name(record.response) : title_of(record);
  out.name = by_title || !point ? title_of(record) : out.written;
  out.unit = shown_name(record.numerator.unit);
  return out;
}

/// One detector listens to all: they are of one recording.
std::optional<SignalFault> unlike(const RecordedSignal& first, const RecordedSignal& other,
                                  std::size_t line) {
  constexpr double kSameTime = 1e-6;
  const double rates = std::abs(other.rate_hz / first.rate_hz - 1.0);
  const double starts = std::abs(other.start_s - first.start_s) * first.rate_hz;
  if (rates <= kSameTime && starts < 1.0 && other.value.size() == first.value.size()) {
    return std::nullopt;
  }
  return SignalFault{
      line,
      fmt::format("{} samples at {:.6g} Hz from {:.6g} s; the first record has {} at {:.6g} Hz "
                  "from {:.6g} s",
                  other.value.size(), other.rate_hz, other.start_s, first.value.size(),
                  first.rate_hz, first.start_s),
      "export the channels of one recording, all of one rate and length"};
}

}  // namespace

OrFault<RecordedChannels> parse_uff_signals(std::string_view text) {
  constexpr std::array kRecordTypes = {kUffTimeResponse};
  auto records = read_uff_functions(text, {}, kRecordTypes);
  if (!records) {
    kernel::outcome::Refusal& refusal = records.error();
    return std::unexpected(SignalFault{
        refusal.line, std::move(refusal.what),
        refusal.line == 0 ? "export time responses (UFF dataset 58)" : std::move(refusal.to_do)});
  }
  const std::size_t first_line = records->front().line;
  const auto skipped = skip_others(*records);
  if (records->empty()) {
    return std::unexpected(
        SignalFault{first_line, fmt::format("no time response (type 1): {}", *skipped),
                    "export the recording over time; `chatter fit` reads frequency responses"});
  }
  const bool by_title = titles_differ(*records);
  RecordedChannels out;
  for (const UffFunction& record : *records) {
    auto channel = channel_of_record(record, by_title);
    if (!channel) {
      return std::unexpected(std::move(channel.error()));
    }
    channel->channel = out.size() + 1;
    out.push_back(std::move(*channel));
    if (auto fault = unlike(out.front(), out.back(), record.line)) {
      return std::unexpected(std::move(*fault));
    }
    if (skipped) {
      out.back().notes.push_back(*skipped);
    }
  }
  return out;
}

}  // namespace steadyrest::chatter::offline
