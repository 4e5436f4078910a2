// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <steadyrest/motion/offline/log/log_record.hpp>

// Bytes in, nothing unfit out: whatever the log reader accepts must be safe to estimate from, and
// every refusal must say what to do.
namespace {

using namespace steadyrest::motion;

void must(bool holds) {
  if (!holds) {
    std::abort();
  }
}

/// Whatever the reader accepts must be fit to estimate from.
void must_be_fit(const offline::EdgeLog& log) {
  must(!log.rows.empty() && log.finding_count >= log.findings.size());
  for (std::size_t i = 0; i < log.rows.size(); ++i) {
    must(std::isfinite(log.rows[i].t_s));
    must(i == 0 || log.rows[i].t_s >= log.rows[i - 1].t_s);
  }
  // Few ticks, or a log with one wild time stamp would take the fuzzer's memory.
  offline::LogRecordConfig config;
  config.max_ticks = 1000;
  const auto record = offline::record_of(log, config);
  if (record) {
    for (const online::Edge& edge : record->edges) {
      must(std::isfinite(edge.position_mm) && (edge.direction == 1 || edge.direction == -1));
    }
    must(record->how.clock_s >= 0.0 && record->ticks.size() <= 1001);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto log = offline::parse_edge_log(text, "fuzz.csv");
  if (log) {
    must_be_fit(*log);
  } else {
    must(!log.error().what.empty() && !log.error().to_do.empty());
  }
  // The same in two blocks: the border between them must not matter.
  offline::EdgeLogReader reader("fuzz.csv", {});
  if (reader.take(text.substr(0, size / 2))) {
    reader.take(text.substr(size / 2));
  }
  const auto again = reader.finish();
  must(again.has_value() == log.has_value());
  must(!log ||
       (again->rows.size() == log->rows.size() && again->finding_count == log->finding_count));
  return 0;
}
