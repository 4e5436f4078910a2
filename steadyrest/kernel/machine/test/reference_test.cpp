// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/kernel/machine/reference.hpp>

namespace steadyrest::kernel::machine {
namespace {

TEST(MachineReference, PageIsUpToDate) {
  std::ifstream in(STEADYREST_SOURCE_DIR "/docs/machine-file.md");
  const std::string page{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  EXPECT_TRUE(page == reference_page())
      << "run: cmake --build --preset release --target machine_reference";
}

}  // namespace
}  // namespace steadyrest::kernel::machine
