// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/motion/offline/log/edge_log.hpp>

namespace steadyrest::motion::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;

struct CloseFile {
  void operator()(std::FILE* file) const noexcept {
    if (file != stdin) {
      std::fclose(file);
    }
  }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

Refusal unreadable(const std::string& path, const char* what) {
  return bad_input(path, std::string(what) + ": " + std::strerror(errno),
                   "check the path and the permissions");
}

/// Bytes of a file; 0 where unknown (a pipe). Only for the progress.
double size_of(const std::string& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  return error ? 0.0 : static_cast<double>(size);
}

/// Every stamp is a multiple of the period, within `tolerance_s` and the rounding of a double.
bool divides(const EdgeLog& log, double period_s, double tolerance_s) {
  return std::ranges::all_of(log.rows, [&](const LogRow& row) {
    const double off = std::abs(row.t_s - std::round(row.t_s / period_s) * period_s);
    return off <= tolerance_s + 1e-15 * std::abs(row.t_s);
  });
}

}  // namespace

// In blocks of a megabyte, so that a log larger than memory, or a pipe, can be read.
EdgeLogResult read_edge_log(const std::string& path, const EdgeLogConfig& config,
                            const ReadShare& share) {
  const bool from_stdin = path == "-";
  const std::string name = from_stdin ? "stdin" : path;
  const File file(from_stdin ? stdin : std::fopen(path.c_str(), "rb"));
  if (!file) {
    return std::unexpected(unreadable(name, "cannot be opened"));
  }
  const double whole = from_stdin ? 0.0 : size_of(path);
  constexpr std::size_t kBlock = 1U << 20;
  const auto block = std::make_unique<std::array<char, kBlock>>();
  EdgeLogReader reader(name, config);
  double done = 0.0;
  for (;;) {
    const std::size_t got = std::fread(block->data(), 1, kBlock, file.get());
    if (got == 0) {
      break;
    }
    if (!reader.take({block->data(), got})) {
      return reader.finish();
    }
    done += static_cast<double>(got);
    if (share && whole > 0.0) {
      share(done / whole);
    }
  }
  if (std::ferror(file.get()) != 0) {
    return std::unexpected(unreadable(name, "cannot be read"));
  }
  return reader.finish();
}

// The coarsest period that all stamps are multiples of: recorders count ticks of 1, 2 or 5·10⁻ⁿ s.
// Coarsest first, since every finer one fits too.
double clock_of(const EdgeLog& log) {
  // Half of the last printed digit; a hair more, because that half is itself a rounded number.
  const double tolerance_s = 0.5000001 * std::pow(10.0, -std::min(log.decimals, 20));
  for (int n = 1; n <= 9; ++n) {
    for (const double digit : {10.0, 5.0, 2.0}) {
      const double period_s = digit * std::pow(10.0, -n);
      if (tolerance_s < 0.51 * period_s && divides(log, period_s, tolerance_s)) {
        return period_s;
      }
    }
  }
  return divides(log, 1e-9, tolerance_s) ? 1e-9 : 0.0;
}

}  // namespace steadyrest::motion::offline
