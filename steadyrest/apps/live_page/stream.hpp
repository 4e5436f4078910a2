// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <steadyrest/apps/live_page/desk.hpp>
#include <steadyrest/apps/live_page/vibration_spectrum.hpp>

namespace steadyrest::apps::live_page {

/// The messages of the stream (docs/page-api.md).
class StreamText {
 public:
  explicit StreamText(const Desk& desk) : desk_(desk) {}

  /// What a client needs before its first frame; from any thread.
  [[nodiscard]] std::string hello() const;
  /// The next frame without its first brace, with the samples since the last one; from one thread.
  [[nodiscard]] std::string frame();
  /// The vibration's spectrum, if it has changed since the last one; from the same thread, after
  /// frame(). Empty: it has not, or nothing is heard.
  [[nodiscard]] std::string spectrum();

 private:
  const Desk& desk_;
  std::uint64_t sequence_ = 0;
  std::uint64_t lost_ = 0;
  std::vector<steadyrest::live::TapSample> samples_;
  std::vector<double> readings_;
  VibrationSpectrum spectrum_;
};

}  // namespace steadyrest::apps::live_page
