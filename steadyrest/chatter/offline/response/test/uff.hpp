// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <complex>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/core.h>

/// Universal files of any kind, written by the format's own columns.
namespace steadyrest::chatter::offline::test {

struct UffText {
  int function = 4;
  int data = 5;
  bool even = true;
  int points = 8;  ///< announced; eight are written
  int kind = 8;
  std::string unit = "m";
  std::string force = "N";
  std::string abscissa = "Hz";
  std::string abscissa_label = "Frequency";
  double per_hz = 1.0;  ///< of the abscissa
  int node = 1;
  int direction = 1;
  int force_node = 1;
  int force_direction = 1;
  std::string entity = "NONE";
  std::complex<double> value{1.0, -2.0};  ///< at each point, 100 Hz apart

  [[nodiscard]] std::string records() const {
    std::string out = "Tool tip\nNONE\n21-Nov-26\nNONE\nNONE\n";
    out += fmt::format("{:5}{:10}{:5}{:10} {:10}{:10}{:4} {:10}{:10}{:4}\n", function, 1, 1, 0,
                       entity, node, direction, entity, force_node, force_direction);
    const double step = even ? 100.0 * per_hz : 0.0;
    out += fmt::format("{:10}{:10}{:10}{:13.5E}{:13.5E}{:13.5E}\n", data, points, even ? 1 : 0,
                       step, step, 0.0);
    const auto axis = [](int type, const std::string& label, const std::string& u) {
      return fmt::format("{:10}{:5}{:5}{:5} {:20} {:20}\n", type, 0, 0, 0, label, u);
    };
    return out + axis(18, abscissa_label, abscissa) + axis(kind, "Response", unit) +
           axis(13, "Force", force) + axis(0, "NONE", "NONE");
  }

  [[nodiscard]] std::string made() const {
    std::string out = "    -1\n    58\n" + records();
    std::string line;
    for (int i = 0; i < 8; ++i) {
      if (!even) {
        line += fmt::format("{:13.5E}", 100.0 * per_hz * (i + 1));
      }
      line += data == 6 || data == 4 ? fmt::format("{:20.12E}", value.real())
                                     : fmt::format("{:13.5E}", value.real());
      if (data >= 5) {
        line += data == 6 ? fmt::format("{:20.12E}", value.imag())
                          : fmt::format("{:13.5E}", value.imag());
      }
      if (i % 2 == 1) {
        out += line + "\n";
        line.clear();
      }
    }
    return out + "    -1\n";
  }

  /// The binary form. `order` 1: little endian, 2: big; `abscissa_bytes` of an uneven abscissa.
  [[nodiscard]] std::string made_binary(int order, std::size_t abscissa_bytes = 4,
                                        const std::string& end = "\n    -1\n",
                                        int number_format = 2) const {
    const std::size_t size = data == 4 || data == 6 ? 8 : 4;
    std::string bytes;
    const auto put = [&](double number, std::size_t count) {
      const std::uint64_t word = count == 8
                                     ? std::bit_cast<std::uint64_t>(number)
                                     : std::bit_cast<std::uint32_t>(static_cast<float>(number));
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t from = order == 1 ? i : count - 1 - i;
        bytes.push_back(static_cast<char>((word >> (8 * from)) & 0xFFU));
      }
    };
    for (int i = 0; i < 8; ++i) {
      if (!even) {
        put(100.0 * per_hz * (i + 1), abscissa_bytes);
      }
      put(value.real(), size);
      if (data >= 5) {
        put(value.imag(), size);
      }
    }
    return fmt::format("    -1\n{:6}b{:6}{:6}{:12}{:12}{:6}{:6}{:12}{:12}\n", 58, order,
                       number_format, 11, bytes.size(), 0, 0, 0, 0) +
           records() + bytes + end;
  }
};

/// Dataset 164.
inline std::string units_164(int code, const std::string& name, double per_m, double per_n) {
  return fmt::format(
      "    -1\n   164\n{:10}{:20}{:10}\n{:25.16E}{:25.16E}{:25.16E}\n{:25.16E}\n    -1\n", code,
      name, 2, per_m, per_n, 1.0, 273.15);
}

}  // namespace steadyrest::chatter::offline::test
