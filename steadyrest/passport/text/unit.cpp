// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/passport/text/unit.hpp>

// A key's name ends in its unit, and this table is the only place where a file's unit becomes an
// inner one (mm, s, rad, rev/s, N; ratios with 1.0 = 100 %).
namespace steadyrest::passport {
namespace {

using namespace kernel::units;  // NOLINT(google-build-using-namespace): the table below is all
                                // conversions

constexpr double same(double value) noexcept {
  return value;
}
constexpr double ms_from_s(double time_s) noexcept {
  return time_s * 1e3;
}
constexpr double ns_from_s(double time_s) noexcept {
  return time_s * 1e9;
}
constexpr double w_from_kw(double power_kw) noexcept {
  return power_kw * 1e3;
}
constexpr double kw_from_w(double power_w) noexcept {
  return power_w * 1e-3;
}
/// k [1/s] = 1000/60 · Kv [(m/min)/mm].
constexpr double m_min_mm_from_1_s(double gain_1_s) noexcept {
  return gain_1_s * (60.0 / 1000.0);
}

constexpr double s_from_min(double time_min) noexcept {
  return time_min * 60.0;
}
constexpr double min_from_s(double time_s) noexcept {
  return time_s / 60.0;
}
constexpr double s_from_h(double time_h) noexcept {
  return time_h * 3600.0;
}
constexpr double h_from_s(double time_s) noexcept {
  return time_s / 3600.0;
}
constexpr double mm_s_from_um_min(double speed_um_min) noexcept {
  return speed_um_min * (1e-3 / 60.0);
}
constexpr double um_min_from_mm_s(double speed_mm_s) noexcept {
  return speed_mm_s * 60e3;
}
/// Displacement per feed: 1 µm/(m/min) = 1e-3 mm/(1000/60 mm/s) = 6e-5 s.
constexpr double s_from_um_m_min(double gain_um_m_min) noexcept {
  return gain_um_m_min * 6e-5;
}
constexpr double um_m_min_from_s(double gain_s) noexcept {
  return gain_s / 6e-5;
}

constexpr double n_mm_from_n_um(double stiffness_n_um) noexcept {
  return stiffness_n_um * 1e3;
}
constexpr double n_um_from_n_mm(double stiffness_n_mm) noexcept {
  return stiffness_n_mm * 1e-3;
}

constexpr Unit kNone{"", "", same, same};

/// The order is free: unit_of() takes the longest matching ending.
constexpr std::array kUnits = {
    Unit{"1_s", "1/s", same, same},
    Unit{"m_min_mm", "(m/min)/mm", gain_1_s_from_m_min_mm, m_min_mm_from_1_s},
    Unit{"mm_min", "mm/min", mm_s_from_mm_min, mm_min_from_mm_s},
    Unit{"mm_s", "mm/s", same, same},
    Unit{"mm_s2", "mm/s²", same, same},
    Unit{"mm_s3", "mm/s³", same, same},
    Unit{"mm", "mm", same, same},
    Unit{"um", "µm", mm_from_um, um_from_mm},
    Unit{"um_min", "µm/min", mm_s_from_um_min, um_min_from_mm_s},
    Unit{"um_k", "µm/K", mm_from_um, um_from_mm},
    Unit{"um_m_min", "µm/(m/min)", s_from_um_m_min, um_m_min_from_s},
    Unit{"min", "min", s_from_min, min_from_s},
    Unit{"h", "h", s_from_h, h_from_s},
    Unit{"c", "°C", same, same},
    Unit{"k", "K", same, same},
    Unit{"um_s", "µm/s", mm_from_um, um_from_mm},
    Unit{"deg", "°", rad_from_deg, deg_from_rad},
    Unit{"deg_s", "°/s", rad_from_deg, deg_from_rad},
    Unit{"deg_s2", "°/s²", rad_from_deg, deg_from_rad},
    Unit{"deg_s3", "°/s³", rad_from_deg, deg_from_rad},
    Unit{"s", "s", same, same},
    Unit{"ms", "ms", s_from_ms, ms_from_s},
    Unit{"ns", "ns", s_from_ns, ns_from_s},
    Unit{"rpm", "rev/min", rev_s_from_rpm, rpm_from_rev_s},
    Unit{"rpm_s", "(rev/min)/s", rev_s_from_rpm, rpm_from_rev_s},
    Unit{"percent", "%", ratio_from_percent, percent_from_ratio},
    Unit{"percent_s", "%/s", ratio_from_percent, percent_from_ratio},
    Unit{"kw", "kW", w_from_kw, kw_from_w},
    Unit{"n_m", "N·m", same, same},
    Unit{"kg_m2", "kg·m²", same, same},
    Unit{"hz", "Hz", same, same},
    Unit{"kg", "kg", same, same},
    Unit{"N_mm", "N/mm", same, same},
    Unit{"N_mm2", "N/mm²", same, same},
    Unit{"N_um", "N/µm", n_mm_from_n_um, n_um_from_n_mm},
};

/// Units that no key has, known only to say "wrong unit" instead of "unknown key".
constexpr std::array<std::string_view, 20> kForeign = {
    "us",  "khz", "m",     "m_s",   "m_s2",   "m_min", "g", "in", "inch", "in_min",
    "ipm", "rad", "rad_s", "rev_s", "rev_s2", "ratio", "w", "nm", "m_s3", "mm_min_mm"};

/// Length of the part before `_suffix`; npos when the key has another ending. A suffix begins after
/// an underscore, or is the whole key (`percent`).
std::size_t stem_length(std::string_view key, std::string_view suffix) noexcept {
  if (key == suffix) {
    return 0;
  }
  if (key.size() > suffix.size() + 1 && key.ends_with(suffix) &&
      key[key.size() - suffix.size() - 1] == '_') {
    return key.size() - suffix.size() - 1;
  }
  return std::string_view::npos;
}

}  // namespace

const Unit& unit_of(std::string_view key) noexcept {
  const Unit* best = &kNone;
  for (const Unit& unit : kUnits) {
    if (unit.suffix.size() > best->suffix.size() &&
        stem_length(key, unit.suffix) != std::string_view::npos) {
      best = &unit;
    }
  }
  return *best;
}

/// The shortest stem belongs to the longest unit.
std::string_view stem_of(std::string_view key) noexcept {
  std::size_t shortest = key.size();
  for (const Unit& unit : kUnits) {
    shortest = std::min(shortest, stem_length(key, unit.suffix));
  }
  for (const std::string_view suffix : kForeign) {
    shortest = std::min(shortest, stem_length(key, suffix));
  }
  return key.substr(0, shortest);
}

}  // namespace steadyrest::passport
