// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/replace/replace.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>
#include <steadyrest/nc/rewrite/tube/verify_tube.hpp>

namespace steadyrest::nc::rewrite::test {

/// A workshop whose programs have blocks replaced.
class TubeShop : public Workshop {
 public:
  explicit TubeShop(std::string changes = "predistort", double tube = 0.2)
      : told{{.name = "changes", .value = std::move(changes)},
             {.name = "tube-mm", .value = fmt::format("{:g}", tube)}} {}

  /// Writes both programs; the text of the changed one.
  std::string change(const std::string& program, const NewLines& lines) const {
    write_file(original(), program);
    const auto out = replace(original(), config.dialect, lines, told);
    EXPECT_TRUE(out.has_value());
    write_file(changed(), out ? out->text : "");
    return out ? out->text : "";
  }
  [[nodiscard]] kernel::outcome::Result<TubeProof> prove() const {
    const auto mark = read_replaced_mark(changed());
    if (!mark) {
      return std::unexpected(mark.error());
    }
    const auto permitted = permitted_of(changed(), *mark, {}, &machine);
    if (!permitted) {
      return std::unexpected(permitted.error());
    }
    return verify_tube(original(), changed(), config, *permitted);
  }
  /// Of the changed program as it is: `changed.nc:5: what`, or `proved`.
  [[nodiscard]] std::string verdict() const {
    const auto proof = prove();
    if (proof) {
      return "proved";
    }
    const std::string name = proof.error().file == original() ? "original" : "changed";
    return fmt::format("{}:{}: {}", name, proof.error().line, proof.error().what);
  }
  [[nodiscard]] std::string verdict(const std::string& program, const NewLines& lines) const {
    change(program, lines);
    return verdict();
  }

  std::vector<Told> told;
};

}  // namespace steadyrest::nc::rewrite::test
