// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/passport/file/machine_file.hpp>

/// The machines and programs of examples/.
namespace steadyrest::trial::test {

inline const std::string kExamples = STEADYREST_SOURCE_DIR "/examples/";

inline kernel::machine::Machine machine_of(const std::string& name) {
  return passport::read(kExamples + "machines/" + name).value();
}

}  // namespace steadyrest::trial::test
