// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <fmt/core.h>

#include <steadyrest/passport/file/thermal_section.hpp>

// [thermal] nests lists of tables three deep. Each level is read even when the one above is faulty,
// and judged only when its own keys are good.
namespace steadyrest::passport {
namespace {

using kernel::machine::kMaxThermalAmbients;
using kernel::machine::kMaxThermalModes;
using kernel::machine::Thermal;
using kernel::machine::ThermalAmbient;
using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;

/// Every table of the list `name`; a fault when it is something else.
template <class Read>
void each(const toml::table& parent, std::string_view name, std::string_view head, Faults& faults,
          Read read) {
  const toml::node* node = parent.get(name);
  if (node == nullptr) {
    return;
  }
  const toml::array* list = node->as_array();
  const bool tables = list != nullptr && std::all_of(list->begin(), list->end(),
                                                     [](const auto& e) { return e.is_table(); });
  if (!tables) {
    faults.add(line_of(node->source()), fmt::format("{} is not a list of sections", name),
               fmt::format("write {} with double brackets, once for each", head));
    return;
  }
  for (const toml::node& element : *list) {
    read(*element.as_table());
  }
}

/// G(n) is a table or a polynomial, never both: they would disagree between the table's speeds.
void check(const ThermalMode& mode, const Given& given, Faults& faults) {
  if (mode.level_mm.size() != mode.speed_rev_s.size()) {
    faults.add(given.at({"levels_um", "speeds_rpm"}),
               fmt::format("{} levels_um for {} speeds_rpm", mode.level_mm.size(),
                           mode.speed_rev_s.size()),
               "give one level per speed");
  }
  if (mode.level_mm.empty() == mode.polynomial_mm.empty()) {
    faults.add(given.at({"polynomial_um"}),
               mode.level_mm.empty() ? "the mode has no levels"
                                     : "the mode has both a table of levels and a polynomial",
               "give either speeds_rpm and levels_um, or polynomial_um");
  }
  if (std::ranges::adjacent_find(mode.speed_rev_s, std::ranges::greater_equal{}) !=
      mode.speed_rev_s.end()) {
    faults.add(given.at({"speeds_rpm"}), "speeds_rpm are not in rising order",
               "write them from lowest to highest, each once");
  }
}

/// A level is an index into the shares; a higher level is stricter, so the shares fall.
void check(const Thermal& thermal, const Given& given, Faults& faults) {
  if (std::ranges::adjacent_find(thermal.share, std::ranges::less{}) != thermal.share.end()) {
    faults.add(given.at({"shares"}), "shares rise from one level to the next",
               "a higher level is stricter: write them in falling order");
  }
  // The slow slope protects the surface in the cut. Out of the cut there is nothing to protect.
  if (thermal.retract_slope_mm_s > 0.0 && thermal.retract_slope_mm_s < thermal.slope_mm_s) {
    faults.add(given.at({"retract_slope_um_min", "slope_um_min"}),
               "retract_slope_um_min is below slope_um_min",
               "out of the cut the offset may move faster, not slower: raise it or leave it out");
  }
  if (thermal.level >= thermal.share.size()) {
    faults.add(
        given.at({"level", "shares"}),
        fmt::format("level = {}, but there are {} shares", thermal.level, thermal.share.size()),
        fmt::format("choose a level, 0 … {}", thermal.share.size() - 1));
  }
}

/// One [[thermal.axis]] with its modes and ambient inputs.
class AxisReader {
 public:
  explicit AxisReader(Faults& faults) : faults_(faults) {}

  ThermalAxis read(const toml::table& table) {
    ThermalAxis out;
    out.name.clear();
    const std::size_t before = faults_.list.size();
    SectionReader<ThermalAxis> reader(faults_, thermal_axis_keys(), "[[thermal.axis]]");
    const Given given = reader.read(table, out, {"mode", "ambient"});
    each(table, "mode", "[[thermal.axis.mode]]", faults_, [&](const toml::table& t) {
      const std::size_t faults = faults_.list.size();
      ThermalMode mode;
      SectionReader<ThermalMode> modes(faults_, thermal_mode_keys(), "[[thermal.axis.mode]]");
      const Given of_mode = modes.read(t, mode);
      if (faults_.list.size() == faults) {
        check(mode, of_mode, faults_);
      }
      out.mode.push_back(std::move(mode));
    });
    each(table, "ambient", "[[thermal.axis.ambient]]", faults_, [&](const toml::table& t) {
      ThermalAmbient ambient;
      SectionReader<ThermalAmbient> reads(faults_, thermal_ambient_keys(),
                                          "[[thermal.axis.ambient]]");
      reads.read(t, ambient);
      out.ambient.push_back(std::move(ambient));
    });
    if (faults_.list.size() == before) {
      bounds(out, given);
    }
    return out;
  }

 private:
  // Upper limits come from the fixed-size arrays of the on-line model.
  void bounds(const ThermalAxis& axis, const Given& given) {
    if (axis.mode.empty() || axis.mode.size() > kMaxThermalModes ||
        axis.ambient.size() > kMaxThermalAmbients) {
      faults_.add(given.line,
                  fmt::format("[[thermal.axis]] {} has {} modes and {} ambient inputs", axis.name,
                              axis.mode.size(), axis.ambient.size()),
                  fmt::format("give 1 … {} modes and at most {} ambient inputs", kMaxThermalModes,
                              kMaxThermalAmbients));
    }
    const std::size_t n = axis.parameters();
    // The triangle of an n × n matrix, stored row by row.
    if (!axis.covariance.empty() && axis.covariance.size() != n * (n + 1) / 2) {
      faults_.add(given.at({"covariance"}),
                  fmt::format("covariance has {} entries; {} linear parameters need {}",
                              axis.covariance.size(), n, n * (n + 1) / 2),
                  "give its lower triangle row by row, or leave it out");
    }
  }

  Faults& faults_;
};

}  // namespace

/// [thermal] is optional; its axes may be displacements that no machine axis corrects.
void read_thermal(const toml::table& root, Thermal& out, Faults& faults) {
  const toml::node* node = root.get("thermal");
  if (node == nullptr) {
    return;
  }
  const toml::table* table = node->as_table();
  if (table == nullptr) {
    faults.add(line_of(node->source()), "thermal is not a section",
               "write [thermal] on a separate line, with its keys below");
    return;
  }
  const std::size_t before = faults.list.size();
  SectionReader<Thermal> reader(faults, thermal_keys(), "[thermal]");
  const Given given = reader.read(*table, out, {"axis"});
  if (faults.list.size() == before) {
    check(out, given, faults);
  }
  AxisReader axes(faults);
  // Two sections for one axis would be two models that both try to move it.
  each(*table, "axis", "[[thermal.axis]]", faults, [&](const toml::table& t) {
    ThermalAxis axis = axes.read(t);
    const bool twice = std::ranges::any_of(
        out.axis, [&](const ThermalAxis& other) { return other.name == axis.name; });
    if (twice && !axis.name.empty()) {
      faults.add(line_of(t.source()), fmt::format("there are two [[thermal.axis]] {}", axis.name),
                 "put all modes of an axis below one [[thermal.axis]]");
    }
    out.axis.push_back(std::move(axis));
  });
}

}  // namespace steadyrest::passport
