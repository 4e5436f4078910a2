// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string_view>
#include <type_traits>
#include <utility>

#include <steadyrest/chatter/offline/process/process_keys.hpp>

namespace steadyrest::chatter::offline {
namespace {

using passport::Choice;
using passport::Key;
using std::string_view;

constexpr std::array<string_view, 2> kOperations = {"milling", "turning"};
constexpr std::array<string_view, 2> kDirections = {"up", "down"};
constexpr std::array<string_view, 2> kAxes = {"x", "y"};

template <class S, auto Member>
Choice<S> choice(std::span<const string_view> words) {
  using Enum = std::remove_cvref_t<decltype(std::declval<S&>().*Member)>;
  return {words, [](S& section, std::size_t i) { section.*Member = static_cast<Enum>(i); },
          [](const S& section) { return static_cast<std::size_t>(section.*Member); }};
}

constexpr auto kMust = passport::Need::mandatory;

}  // namespace

std::span<const Key<Process>> process_keys() noexcept {
  static const std::array kKeys = {
      Key<Process>{"name", &Process::name, 1, 80, "Name of the cut in reports."},
  };
  return kKeys;
}

std::span<const Key<Tool>> tool_keys() noexcept {
  static const std::array kKeys = {
      Key<Tool>{"teeth", &Tool::teeth, 1, 64, "Number of teeth; mandatory in milling."},
      Key<Tool>{"diameter_mm", &Tool::diameter_mm, 0.01, 1e5,
                "Cutting diameter; in turning, that of the workpiece. Needed for helix and process "
                "damping."},
      Key<Tool>{"helix_deg", &Tool::helix_rad, 0, 80, "Helix angle of the teeth."},
      Key<Tool>{
          .name = "pitch_deg",
          .field = &Tool::pitch_rad,
          .min = 0.1,
          .max = 360,
          .meaning =
              "Pitch from each tooth to the one in front of it; the sum is 360. Default: even.",
          .max_entries = 64},
      Key<Tool>{.name = "runout_um",
                .field = &Tool::runout_mm,
                .min = -1e4,
                .max = 1e4,
                .meaning = "Radius of each tooth relative to the mean.",
                .max_entries = 64},
  };
  return kKeys;
}

std::span<const Key<Cut>> cut_keys() noexcept {
  static const std::array kKeys = {
      Key<Cut>{"operation", choice<Cut, &Cut::operation>(kOperations), 0, 0, "Kind of machining."},
      Key<Cut>{"direction", choice<Cut, &Cut::direction>(kDirections), 0, 0,
               "Up (conventional) or down (climb) milling."},
      Key<Cut>{"radial_immersion", &Cut::radial_immersion, 1e-4, 1,
               "Radial depth over diameter, 1 = slot; mandatory in milling."},
      Key<Cut>{"tangential_N_mm2", &Cut::tangential_n_mm2, 1, 1e5,
               "Tangential force over chip area.", kMust},
      Key<Cut>{"radial_N_mm2", &Cut::radial_n_mm2, -1e5, 1e5, "Radial force over chip area.",
               kMust},
      Key<Cut>{"tangential_edge_N_mm", &Cut::edge_tangential_n_mm, 0, 1e4,
               "Tangential edge force over depth of cut."},
      Key<Cut>{"radial_edge_N_mm", &Cut::edge_radial_n_mm, -1e4, 1e4,
               "Radial edge force over depth of cut."},
      Key<Cut>{"process_damping_N_mm", &Cut::process_damping_n_mm, 0, 1e6,
               "C of F = −C·(depth/cutting speed)·velocity along the chip thickness."},
      Key<Cut>{"feed_per_tooth_mm", &Cut::feed_per_tooth_mm, 1e-6, 100,
               "Feed per tooth, in turning per revolution; for the simulation."},
  };
  return kKeys;
}

std::span<const Key<ModeKeys>> mode_keys() noexcept {
  static const std::array kKeys = {
      Key<ModeKeys>{"axis", choice<ModeKeys, &ModeKeys::axis>(kAxes), 0, 0,
                    "The direction in which the mode vibrates."},
      Key<ModeKeys>{"angle_deg", &ModeKeys::angle_rad, -360, 360,
                    "Instead of axis: its direction, from x towards y."},
      Key<ModeKeys>{"frequency_hz", &ModeKeys::frequency_hz, 0.01, 1e6,
                    "Natural frequency, undamped.", kMust},
      Key<ModeKeys>{"damping_ratio", &ModeKeys::damping_ratio, 0, 0.999,
                    "Share of critical damping.", kMust},
      Key<ModeKeys>{"mass_kg", &ModeKeys::mass_kg, 1e-9, 1e7, "Modal mass."},
      Key<ModeKeys>{"stiffness_N_um", &ModeKeys::stiffness_n_mm, 1e-6, 1e9,
                    "Instead of the mass: modal stiffness."},
  };
  return kKeys;
}

std::span<const Key<FrfKeys>> frf_keys() noexcept {
  static const std::array kKeys = {
      Key<FrfKeys>{"file", &FrfKeys::file, 1, 1000,
                   "Measured response (CSV or universal file format 58), relative to the process "
                   "file's folder.",
                   kMust},
      Key<FrfKeys>{"axis", choice<FrfKeys, &FrfKeys::axis>(kAxes), 0, 0,
                   "Direction of measurement.", kMust},
  };
  return kKeys;
}

}  // namespace steadyrest::chatter::offline
