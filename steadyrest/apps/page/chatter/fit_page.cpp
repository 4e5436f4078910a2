// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include <steadyrest/apps/page/chatter/fit_page.hpp>
#include <steadyrest/apps/page/shared/json_numbers.hpp>

// Measured and fitted response over the band of the fit.
namespace steadyrest::apps::page {
namespace {

namespace offline = chatter::offline;
using offline::Frf;
using offline::ModeFit;
using offline::ModeFitConfig;

constexpr double kUmPerMm = 1e3;
constexpr std::size_t kFitted = 1200;  ///< points of the fitted response, even in ln f …
constexpr int kOfCircle = 60;          ///< … and of each mode on each side of its peak

/// Columns of a response: frequency, real and imaginary part in µm/N.
class Columns {
 public:
  void add(double frequency_hz, const std::complex<double>& compliance_mm_n) {
    frequency_hz_.push_back(frequency_hz);
    real_.push_back(kUmPerMm * compliance_mm_n.real());
    imag_.push_back(kUmPerMm * compliance_mm_n.imag());
  }
  [[nodiscard]] Json json() const {
    return {{"frequency_hz", short_numbers(frequency_hz_)},
            {"real_um_N", short_numbers(real_)},
            {"imag_um_N", short_numbers(imag_)}};
  }

 private:
  std::vector<double> frequency_hz_;
  std::vector<double> real_;
  std::vector<double> imag_;
};

/// The band that the fit used; 0 Hz is out, for displacement is accelerance over ω².
bool in_band(double frequency_hz, const ModeFitConfig& config) {
  return frequency_hz > 0.0 && frequency_hz >= config.least_frequency_hz &&
         frequency_hz <= config.most_frequency_hz;
}

/// Only what the fit has seen is shown with it.
Json measured_json(const FitPage::Measured& measured, const ModeFitConfig& config) {
  const Frf& frf = *measured.frf;
  Columns columns;
  std::vector<double> coherence;
  for (std::size_t i = 0; i < frf.frequency_hz.size(); ++i) {
    if (in_band(frf.frequency_hz[i], config)) {
      columns.add(frf.frequency_hz[i], frf.compliance_mm_n[i]);
      if (!frf.coherence.empty()) {
        coherence.push_back(frf.coherence[i]);
      }
    }
  }
  Json out = columns.json();
  out["name"] = measured.name;
  if (!coherence.empty()) {
    out["coherence"] = short_numbers(coherence);
  }
  return out;
}

/// Lowest and highest frequency that was fitted, over all measurements.
std::pair<double, double> band_of(const FitPage& page, const ModeFitConfig& config) {
  std::pair out{std::numeric_limits<double>::infinity(), 0.0};
  for (const FitPage::Measured& measured : page.measured) {
    for (const double f : measured.frf->frequency_hz) {
      if (in_band(f, config)) {
        out = {std::min(out.first, f), std::max(out.second, f)};
      }
    }
  }
  return out;
}

/// Even in ln f, and even on the circle that each mode draws in the complex plane: with f = f₀·(1 +
/// ζ·tan φ) the angle on it is 2φ. An even grid would miss a peak of 1 % damping.
Json fitted_json(const ModeFit& fit, const std::pair<double, double>& band) {
  std::vector<double> frequency_hz;
  for (std::size_t i = 0; i < kFitted; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(kFitted - 1);
    frequency_hz.push_back(band.first * std::pow(band.second / band.first, share));
  }
  for (const offline::FittedMode& mode : fit.modes) {
    for (int i = -kOfCircle; i <= kOfCircle; ++i) {
      const double phase_rad = 0.5 * std::numbers::pi * i / (kOfCircle + 1);
      const double f = mode.frequency_hz * (1.0 + mode.damping_ratio * std::tan(phase_rad));
      if (f >= band.first && f <= band.second) {
        frequency_hz.push_back(f);
      }
    }
  }
  std::ranges::sort(frequency_hz);
  Columns columns;
  for (const double f : frequency_hz) {
    columns.add(f, offline::response_mm_n(fit, f));
  }
  return columns.json();
}

}  // namespace

/// Each measurement separately, the fit once: it is one set of modes for all of them.
Json fit_page(const Json& answer, const FitPage& page, const ModeFit& fit,
              const ModeFitConfig& config) {
  Json out = chatter_head("fit", page.title, answer);
  const auto band = band_of(page, config);
  out["axis"] = page.axis;
  out["band_hz"] = {band.first, band.second};
  out["measured"] = Json::array();
  for (const FitPage::Measured& measured : page.measured) {
    out["measured"].push_back(measured_json(measured, config));
  }
  out["fitted"] = fitted_json(fit, band);
  return out;
}

}  // namespace steadyrest::apps::page
