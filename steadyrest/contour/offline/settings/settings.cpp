// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/contour/offline/settings/settings.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Axis;
using kernel::machine::Dialect;
using kernel::machine::Machine;
using kernel::outcome::Result;
using nc::plan::PlannedPath;

constexpr double kMostOfIt = 0.5;        ///< of the RMS, that a setting may leave
constexpr double kEqual = 1.02;          ///< gains within this are equal
constexpr double kDamped = 0.25;         ///< k·τ at most
constexpr double kWorthwhileGain = 1.1;  ///< a gain that rises by less is left alone
constexpr double kUnsure = 0.1;          ///< k·τ of a lag that the machine file does not give
constexpr std::array kWeights = {1.0, 0.95, 0.9, 0.85, 0.8, 0.7};

/// X, Y and Z as far as the machine has them.
std::vector<Axis*> linear_axes(Machine& machine) {
  std::vector<Axis*> axes;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, machine.axes.size()); ++i) {
    if (machine.axes[i].present && !machine.axes[i].rotary) {
      axes.push_back(&machine.axes[i]);
    }
  }
  return axes;
}

std::string names_of(std::span<Axis* const> axes) {
  std::string names;
  for (const Axis* axis : axes) {
    names += (names.empty() ? "" : ", ") + axis->name;
  }
  return names;
}

/// The parameter of the feed-forward with its value, by control.
std::string feed_forward_words(Dialect dialect, std::span<Axis* const> axes, double weight) {
  const std::string names = names_of(axes);
  switch (dialect) {
    case Dialect::sinumerik:
      return fmt::format(
          "MD32610 VELO_FFW_WEIGHT = {:g} on {}, MD32620 FFW_MODE = 1, MD32810 "
          "EQUIV_SPEEDCTRL_TIME = 0; FFWON in the program",
          weight, names);
    case Dialect::fanuc:
      return fmt::format("parameter 2005#1 = 1 and 2068 = {:.0f} (0.01 %) on {}", 1e4 * weight,
                         names);
    case Dialect::haas:
    case Dialect::grbl:
    case Dialect::mach3:
      return fmt::format("a velocity feed-forward of {:.1f} % on {}", 100.0 * weight, names);
    case Dialect::linuxcnc:
      break;
  }
  return fmt::format("PID FF1 = {:g} of the joints of {}", weight, names);
}

std::string gain_words(Dialect dialect, std::span<Axis* const> axes, double gain_1_s) {
  const std::string names = names_of(axes);
  switch (dialect) {
    case Dialect::sinumerik:
      return fmt::format("MD32200 POSCTRL_GAIN = {:.3g} on {}", 0.06 * gain_1_s, names);
    case Dialect::fanuc:
      return fmt::format("parameter 1825 = {:.0f} on {}", 100.0 * gain_1_s, names);
    case Dialect::haas:
    case Dialect::grbl:
    case Dialect::mach3:
      return fmt::format("a position loop gain of {:.3g} 1/s on {}", gain_1_s, names);
    case Dialect::linuxcnc:
      break;
  }
  return fmt::format("PID P = {:.3g} of the joints of {}", gain_1_s, names);
}

struct Predicted {
  double seconds = 0.0;
  ErrorFigures figures;
};

class Trials {
 public:
  Trials(const Machine& machine, const PlannedPath& path, double limit_mm)
      : machine_(machine), path_(path), map_(same_path(path)), limit_mm_(limit_mm) {}

  Result<Predicted> predict(const Machine& machine) const {
    Predicted out{.figures = ErrorFigures(limit_mm_)};
    const auto seconds = run_model({.machine = machine,
                                    .path = path_,
                                    .original = path_,
                                    .map = map_,
                                    .model = servo_models(machine.axes),
                                    .others = {},
                                    .backlash_mm = backlash_mm(machine.axes)},
                                   [&](const ModelSample& sample) {
                                     if (sample.cuts) {
                                       out.figures.add(sample, sample.line);
                                     }
                                   });
    if (!seconds) {
      return std::unexpected(seconds.error());
    }
    out.seconds = *seconds;
    return out;
  }

  /// The same machine, with these axes changed and the words for it.
  Result<Setting> setting(const std::function<std::string(Machine&)>& change) const {
    Setting out;
    out.machine = machine_;
    out.what = change(out.machine);
    auto predicted = predict(out.machine);
    if (!predicted) {
      return std::unexpected(predicted.error());
    }
    out.seconds = predicted->seconds;
    out.figures = std::move(predicted->figures);
    return out;
  }

  /// The weight of the feed-forward that is best for the worst lag that is possible.
  Result<Setting> feed_forward(const std::function<std::string(Machine&)>& also) const {
    std::optional<Setting> best;
    for (const double weight : kWeights) {
      auto tried = setting([&](Machine& machine) {
        const auto axes = linear_axes(machine);
        for (Axis* axis : axes) {
          axis->feed_forward = weight;
        }
        const std::string more = also ? also(machine) : std::string{};
        const std::string words = feed_forward_words(machine.control.dialect, axes, weight);
        return more.empty() ? words : fmt::format("{} with {}", words, more);
      });
      const auto done = tried ? add_unsure(*tried) : std::unexpected(tried.error());
      if (!done) {
        return std::unexpected(done.error());
      }
      if (!best || worst_mm(*tried) < worst_mm(*best)) {
        best = std::move(*tried);
      }
    }
    return std::move(*best);
  }

 private:
  static double worst_mm(const Setting& setting) {
    return std::max(setting.figures.nominal().rms_mm(), setting.unsure_rms_mm);
  }
  Result<void> add_unsure(Setting& setting) const {
    Machine slower = setting.machine;
    for (Axis* axis : linear_axes(slower)) {
      if (!axis->velocity_lag_known) {
        axis->velocity_lag_s = kUnsure / axis->servo_gain_1_s;
        setting.unsure_lag_s = std::max(setting.unsure_lag_s, axis->velocity_lag_s);
      }
    }
    if (setting.unsure_lag_s > 0.0) {
      const auto predicted = predict(slower);
      if (!predicted) {
        return std::unexpected(predicted.error());
      }
      setting.unsure_rms_mm = predicted->figures.nominal().rms_mm();
    }
    return {};
  }

  const Machine& machine_;
  const PlannedPath& path_;
  PathMap map_;
  double limit_mm_;
};

std::string all_gains(Machine& machine, double gain_1_s) {
  const auto axes = linear_axes(machine);
  for (Axis* axis : axes) {
    axis->servo_gain_1_s = gain_1_s;
  }
  return gain_words(machine.control.dialect, axes, gain_1_s);
}

/// The highest gain that all axes may have; 0 where a lag sets none.
double damped_gain_1_s(std::span<Axis* const> axes) {
  double gain = kernel::machine::kUnlimited;
  for (const Axis* axis : axes) {
    gain = std::min(gain, axis->velocity_lag_s > 0.0 ? kDamped / axis->velocity_lag_s : 0.0);
  }
  return axes.empty() ? 0.0 : gain;
}

}  // namespace

Result<std::vector<Setting>> cheapest_settings(const Machine& machine, const PlannedPath& path,
                                               double limit_mm) {
  Machine copy = machine;
  const auto axes = linear_axes(copy);
  if (axes.empty()) {
    return std::vector<Setting>{};
  }
  const auto [low, high] =
      std::ranges::minmax(axes, {}, [](const Axis* axis) { return axis->servo_gain_1_s; });
  const double lowest = low->servo_gain_1_s;
  const bool unequal = high->servo_gain_1_s > kEqual * lowest;
  const auto equal = [lowest](Machine& changed) { return all_gains(changed, lowest); };
  const Trials trials(machine, path, limit_mm);
  const auto now = trials.predict(machine);
  if (!now) {
    return std::unexpected(now.error());
  }
  std::vector<Setting> out;
  Result<void> fault;
  const auto add = [&](Result<Setting> setting) {
    if (!setting) {
      fault = std::unexpected(setting.error());
    } else if (setting->figures.nominal().rms_mm() <= kMostOfIt * now->figures.nominal().rms_mm() &&
               setting->unsure_rms_mm <= kMostOfIt * now->figures.nominal().rms_mm()) {
      out.push_back(std::move(*setting));
    }
  };
  if (now->figures.nominal().max_mm <= limit_mm) {
    return out;
  }
  add(trials.feed_forward(nullptr));
  if (unequal) {
    add(trials.setting(equal));
    add(trials.feed_forward(equal));
  }
  if (const double gain = damped_gain_1_s(axes); gain > kWorthwhileGain * lowest) {
    add(trials.setting([gain](Machine& changed) { return all_gains(changed, gain); }));
  }
  if (!fault) {
    return std::unexpected(fault.error());
  }
  std::ranges::stable_sort(out, {}, [](const Setting& setting) {
    return std::max(setting.figures.nominal().rms_mm(), setting.unsure_rms_mm);
  });
  return out;
}

}  // namespace steadyrest::contour::offline
