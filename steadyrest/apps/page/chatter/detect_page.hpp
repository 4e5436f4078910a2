// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <steadyrest/apps/page/chatter/chatter_page.hpp>
#include <steadyrest/chatter/offline/signal/signal_file.hpp>

namespace steadyrest::apps::page {

struct DetectPage {
  std::string signal_name;
  std::string machine;
  std::size_t teeth = 1;
  std::size_t window = 1024;  ///< of the detector's spectrum, samples
  double chatter_hz = 0.0;    ///< the highest reported; 0: none
};

/// The page of `chatter detect`: spectrogram, course of the signal and speed. `signal` has a speed
/// for each sample and at least `window` samples.
[[nodiscard]] Json detect_page(const Json& answer, const DetectPage& page,
                               const chatter::offline::RecordedSignal& signal);

}  // namespace steadyrest::apps::page
