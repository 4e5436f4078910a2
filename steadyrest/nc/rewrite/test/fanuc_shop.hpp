// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/test/workshop.hpp>

/// A Workshop for a Fanuc.
namespace steadyrest::nc::rewrite::test {

inline const std::string kFanuc = replaced(kPasses, "%\n", "%\r\nO1234 (PASSES)\n");

class Fanuc : public ::testing::Test {
 protected:
  explicit Fanuc(Method method = Method::fanuc) {
    shop_.settings.method = method;
    shop_.settings.window_s = 30.0;
    shop_.config.dialect = read::Dialect::fanuc;
    shop_.config.external_offset = method == Method::fanuc;
  }
  Workshop shop_;
};

}  // namespace steadyrest::nc::rewrite::test
