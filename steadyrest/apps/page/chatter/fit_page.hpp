// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/page/chatter/chatter_page.hpp>
#include <steadyrest/chatter/offline/response/frf.hpp>
#include <steadyrest/chatter/offline/response/mode_fit.hpp>

namespace steadyrest::apps::page {

struct FitPage {
  std::string title;
  std::string axis;  ///< of the measurement: x or y
  /// The measurements, each with its name.
  struct Measured {
    std::string name;
    const chatter::offline::Frf* frf = nullptr;
  };
  std::vector<Measured> measured;
};

/// The page of `chatter fit`: the measured responses within the fit's band, and the fitted modes'
/// response there.
[[nodiscard]] Json fit_page(const Json& answer, const FitPage& page,
                            const chatter::offline::ModeFit& fit,
                            const chatter::offline::ModeFitConfig& config);

}  // namespace steadyrest::apps::page
