// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::opcua {

inline kernel::machine::Machine machine() {
  auto read = passport::read(STEADYREST_SOURCE_DIR "/examples/machines/vmc-840d-opcua.toml");
  EXPECT_TRUE(read) << kernel::outcome::text(read.error());
  return std::move(read).value();
}

inline std::shared_ptr<const nc::plan::PlannedPath> path_of(const std::string& text,
                                                            const kernel::machine::Machine& of) {
  nc::interpret::Config config;
  config.dialect = of.control.dialect;
  config.axes = "XYZ";
  return std::make_shared<const nc::plan::PlannedPath>(
      nc::plan::plan_text(text, config, of, "test.mpf").value());
}

inline std::shared_ptr<const nc::plan::PlannedPath> circles(const kernel::machine::Machine& of) {
  return path_of("G17 G90 G94 G71\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 TURN=9 F2000\nM30\n", of);
}

}  // namespace steadyrest::opcua
